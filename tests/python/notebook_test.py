"""The cells of examples/alpenglow.ipynb run, and those that end with a picture show one. No Jupyter is needed."""
import ast
import contextlib
import io
import json
import os
import unittest

from common import SOURCE, InFolder, png_pixels


def run_cell(source, names):
    """Runs a cell; the value of the expression that ends it, or None."""
    tree = ast.parse(source)
    last = tree.body.pop() if tree.body and isinstance(tree.body[-1], ast.Expr) else None
    exec(compile(tree, "cell", "exec"), names)
    return eval(compile(ast.Expression(last.value), "cell", "eval"), names) if last else None


class Notebook(InFolder):
    def test_every_cell_runs(self):
        with open(os.path.join(SOURCE, "examples/alpenglow.ipynb")) as f:
            cells = json.load(f)["cells"]
        names, pictures = {"__name__": "__main__"}, []
        for cell in cells:
            self.assertIn(cell["cell_type"], ("code", "markdown"))
            if cell["cell_type"] != "code":
                continue
            self.assertEqual(cell["outputs"], [], "outputs are not kept in the repository")
            said = io.StringIO()
            with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
                value = run_cell("".join(cell["source"]), names)
            self.assertNotIn("error", said.getvalue())
            if hasattr(value, "_repr_png_"):
                pictures.append(png_pixels(value._repr_png_()))
        self.assertEqual([p.shape for p in pictures], [(160, 240, 3)] * 2)
        for p in pictures:
            self.assertGreater(p.std(), 10)  # neither black nor of one colour
        self.assertEqual(names["bands"]["Ci"].shape, (64, 64, 3))
        self.assertEqual(os.listdir("."), [])


if __name__ == "__main__":
    unittest.main()
