"""Whole scripts of `import prman`, run as their authors run them."""
import os
import sys
import unittest

from common import SOURCE, InFolder, read_exr, run


class Course(InFolder):
    """Scripts that are written as those of courses and exporters: constants, helper modules, records."""

    def test_all_scripts_of_the_folder_run(self):
        folder = os.path.join(SOURCE, "tests/python/scripts")
        names = sorted(n for n in os.listdir(folder) if n.endswith(".py"))
        self.assertGreater(len(names), 2)
        for name in names:
            status, _, said = run(sys.executable, "-m", "alpenglow", "--format", "32x24", "--spp", "4",
                                  os.path.join(folder, name))
            self.assertEqual(status, 0, name + said)
            self.assertNotIn("error:", said, name)
            self.assertNotIn("Traceback", said, name)


class Oslc(InFolder):
    """Scripts that compile their OSL by `oslc` before they render (docs/python.md, "prman")."""

    SCRIPT = ("import os, subprocess, sys\nimport prman\n"
              "for name in sys.argv[1:]:\n"
              "    if not os.path.isfile(name + '.oso'):\n"
              "        subprocess.check_call(['oslc', '-q', name + '.osl'])\n"
              "ri = prman.Ri()\nri.Begin(ri.RENDER)\nri.Display('a.exr', 'openexr', 'rgba')\nri.Format(8, 8, 1)\n"
              "ri.PixelSamples(1, 1)\nri.WorldBegin()\nri.Pattern('half', 'h')\n"
              "ri.Bxdf('PxrConstant', 'b', {'reference color emitColor': ['h:Cout']})\n"
              "ri.Translate(0, 0, 1)\nri.Sphere(1, -1, 1, 360)\nri.WorldEnd()\nri.End()\n")

    def write(self, name, text):
        with open(name, "w") as f:
            f.write(text)

    def test_a_script_finds_one(self):
        self.write("half.osl", "shader half(output color Cout = 0) { Cout = color(.5, .25, 1); }\n")
        self.write("a.py", self.SCRIPT)
        for _ in range(2):  # with and without the note half.oso
            status, _out, said = run(sys.executable, "a.py", "half")
            self.assertEqual((status, said), (0, ""))
        self.assertIn("half.osl", open("half.oso").read())
        self.assertAlmostEqual(float(read_exr("a.exr")["G"].max()), .25, 5)

    def test_scripts_that_ask_for_the_release(self):
        import alpenglow.prman
        self.assertEqual(alpenglow.prman.Ri().PRMAN_VERSION_STR.split(".")[0], "24")

    def test_faults_end_it(self):
        self.write("half.osl", "shader half(output color Cout = 0) { Cout = nowhere; }\n")
        self.write("a.py", self.SCRIPT)
        status, _out, said = run(sys.executable, "a.py", "half")
        self.assertNotEqual(status, 0)
        self.assertIn("half.osl:1", said)
        self.assertFalse(os.path.exists("half.oso"))
        status, _out, said = run(sys.executable, "a.py", "missing")
        self.assertNotEqual(status, 0)
        self.assertIn("missing.osl was not found", said)

    def test_case_of_letters(self):
        self.write("Half.osl", "shader half(output color Cout = 0) { Cout = color(.5, .25, 1); }\n")
        self.write("a.py", self.SCRIPT)
        status, _out, said = run(sys.executable, "a.py", "half")
        self.assertEqual(status, 0)
        self.assertIn("Half.osl", said)
        self.assertAlmostEqual(float(read_exr("a.exr")["G"].max()), .25, 5)


if __name__ == "__main__":
    unittest.main()
