"""The package: its type stubs, its documentation, how it is found."""
import ast
import importlib
import os
import re
import subprocess
import sys
import unittest

import alpenglow
from common import SOURCE, InFolder, run


class Stubs(InFolder):
    def test_they_are_what_the_table_makes(self):
        os.mkdir("made")
        done = subprocess.run([sys.executable, os.path.join(SOURCE, "scripts/python_stubs"), "made"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        for name in ("prman.pyi", "ri.pyi"):
            with open(os.path.join("made", name)) as made, open(os.path.join(SOURCE, "python/alpenglow", name)) as kept:
                self.assertEqual(made.read(), kept.read(), f"{name} is old: scripts/python_stubs makes it")

    def test_every_name_in_them_is_there(self):
        for module in ("prman", "ri", "_alpenglow"):
            loaded = importlib.import_module("alpenglow." + module)
            with open(os.path.join(SOURCE, "python/alpenglow", module + ".pyi")) as f:
                tree = ast.parse(f.read())
            names = 0
            for node in tree.body:
                if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
                    self.assertTrue(hasattr(loaded, node.name), f"{module}.{node.name}")
                    names += 1
                elif isinstance(node, ast.AnnAssign):
                    self.assertTrue(hasattr(loaded, node.target.id), f"{module}.{node.target.id}")
                    names += 1
                for member in getattr(node, "body", []):
                    if isinstance(node, ast.ClassDef) and isinstance(member, ast.FunctionDef):
                        self.assertTrue(hasattr(getattr(loaded, node.name), member.name), f"{node.name}.{member.name}")
            self.assertGreater(names, 4)

    def test_the_package_is_typed(self):
        self.assertTrue(os.path.exists(os.path.join(os.path.dirname(alpenglow.__file__), "py.typed")))


class Finding(InFolder):
    def test_prman_needs_no_numpy(self):
        code = ("import sys\nsys.modules['numpy'] = None\nimport prman\nri = prman.Ri()\nri.Begin('a.rib')\nri.Sphere(1, -1, 1, 360)\n"
                "ri.End()\nprint(open('a.rib').read())\n")
        status, out, said = run(sys.executable, "-c", code)
        self.assertEqual(status, 0, said)
        self.assertIn("Sphere 1 -1 1 360", out)

    def test_it_brings_only_its_names(self):
        """The rooms stay inside of the module: libraries of the same names elsewhere in the process are left alone."""
        listed = subprocess.run(["nm", "-D", "--defined-only", alpenglow._alpenglow.__file__], capture_output=True, text=True)
        if listed.returncode:
            self.skipTest("there is no nm")
        names = [l.split()[-1] for l in listed.stdout.splitlines()]
        self.assertIn("PyInit__alpenglow", names)
        self.assertEqual([n for n in names if not n.startswith(("Ri", "PyInit"))], [])

    def test_the_environment_has_options(self):
        code = ("import prman\nri = prman.Ri()\nri.Begin()\nri.Display('x', 'null', 'rgb')\nri.WorldBegin()\nri.WorldEnd()\nri.End()\n"
                "print(ri.stats['width'])\n")
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True,
                              env={**os.environ, "ALPENGLOW_OPTIONS": "--format 12x4"})
        self.assertEqual(done.stdout, "12\n", done.stderr)


class Manual(InFolder):
    def test_programs_on_the_page_run(self):
        with open(os.path.join(SOURCE, "docs/python.md")) as f:
            programs = re.findall(r"```python\n(.*?)```", f.read(), re.S)
        self.assertEqual(len(programs), 3)
        with open("scene.rib", "w") as f:
            f.write('Format 16 12 1\nProjection "perspective" "fov" 40\nWorldBegin\nTranslate 0 0 5\nSphere 1 -1 1 360\nWorldEnd\n')
        with open("mine.sl", "w") as f:
            f.write("surface mine() { Ci = Cs; Oi = Os; }\n")
        for program in programs:
            done = subprocess.run([sys.executable, "-c", "import numpy\nimport alpenglow\npoints = numpy.zeros((4, 3))\n"
                                   "normals = points + [0, 0, 1]\n" + program], capture_output=True, text=True,
                                  env={**os.environ, "ALPENGLOW_OPTIONS": "--format 16x12"})
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertNotIn("error", done.stderr)
        self.assertTrue(os.path.exists("look.png") and os.path.exists("ball.exr"))


if __name__ == "__main__":
    unittest.main()
