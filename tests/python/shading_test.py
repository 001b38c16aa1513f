"""alpenglow.eval(), shade(), info(), compile()."""
import math
import unittest

import numpy

import alpenglow
from common import PROGRAM, InFolder, run


class Eval(InFolder):
    def test_values_have_their_types(self):
        self.assertEqual(alpenglow.eval("1 + 2 * 3"), 7.0)
        self.assertEqual(alpenglow.eval('concat("a", "b")'), "ab")
        numpy.testing.assert_array_equal(alpenglow.eval("color(1, 0.5, 0.25)"), numpy.float32([1, 0.5, 0.25]))
        self.assertEqual(alpenglow.eval('printf("%d", 5)'), "5")
        self.assertEqual(alpenglow.eval("x * x", setup="float x = 3;"), 9.0)
        numpy.testing.assert_allclose(alpenglow.eval("P"), [0, 0, 0])

    def test_it_is_what_the_program_says(self):
        for e in ("noise(1.5, 2.25)", "sqrt(2)", "spline(0.3, 0, 1, 4, 9)", "mod(-7, 3)"):
            _, out, _ = run(PROGRAM, "eval", e)
            self.assertEqual("%.7g" % alpenglow.eval(e), out.strip())

    def test_on_arrays(self):
        u = numpy.linspace(0, 1, 1000, dtype=numpy.float32).reshape(20, 50)
        numpy.testing.assert_allclose(alpenglow.eval("u * u", u=u), u * u, rtol=1e-6)
        p = numpy.random.default_rng(1).uniform(-2, 2, (7, 3)).astype(numpy.float32)
        numpy.testing.assert_allclose(alpenglow.eval("length(P)", P=p), numpy.linalg.norm(p, axis=1), rtol=1e-6)
        self.assertEqual(alpenglow.eval("P * 2", P=p).shape, (7, 3))

    def test_faults(self):
        with self.assertRaisesRegex(alpenglow.Error, "nonsense"):
            alpenglow.eval("nonsense(1)")
        with self.assertRaises(alpenglow.Error):
            alpenglow.eval("P", Q=3)


SHADER = """
surface bands(uniform float n = 4; varying float shift = 0; color tint = 1; string mode = "plain";
              output varying float band = 0;)
{
    band = floor(n * s + shift);
    Ci = tint * band * Cs;
    if (mode == "negative") Ci = -Ci;
    Oi = Os;
}
"""


class Shade(InFolder):
    def test_outputs_over_arrays(self):
        s = numpy.float32([[0.05, 0.3, 0.55], [0.8, 0.99, 0]])
        made = alpenglow.shade("bands", source=SHADER, s=s, outputs=["Ci", "band"])
        numpy.testing.assert_array_equal(made["band"], numpy.floor(4 * s))
        self.assertEqual(made["Ci"].shape, (2, 3, 3))
        numpy.testing.assert_array_equal(made["Ci"][:, :, 1], numpy.floor(4 * s))

    def test_parameters(self):
        s = numpy.float32([0.1, 0.6])
        made = alpenglow.shade("bands", source=SHADER, s=s, outputs=["Ci", "band"],
                               params={"n": 10, "shift": numpy.float32([0, 100]), "tint": [1, 2, 3], "mode": "negative"})
        numpy.testing.assert_array_equal(made["band"], [1, 106])
        numpy.testing.assert_array_equal(made["Ci"], [[-1, -2, -3], [-106, -212, -318]])

    def test_a_shader_in_a_file_and_one_that_ships(self):
        with open("bands.sl", "w") as f:
            f.write(SHADER)
        self.assertEqual(alpenglow.shade("bands", s=0.5, outputs=["band"])["band"], 2)
        constant = alpenglow.shade("constant", Cs=numpy.float32([[1, 2, 3], [4, 5, 6]]))
        numpy.testing.assert_array_equal(constant["Ci"], [[1, 2, 3], [4, 5, 6]])

    def test_many_points(self):
        n = 10001  # more than a batch, and no multiple of one
        p = numpy.zeros((n, 3), numpy.float32)
        p[:, 0] = numpy.arange(n)
        text = "surface s(output varying float x = 0;) { x = xcomp(P) * 2; Ci = 1; }"
        numpy.testing.assert_array_equal(alpenglow.shade("s", source=text, P=p, outputs=["x"])["x"], numpy.arange(n) * 2)

    def test_derivatives_are_those_given(self):
        p = numpy.zeros((5, 3), numpy.float32)
        text = "surface s(output varying float a = 0;) { a = area(P); Ci = 1; }"
        made = alpenglow.shade("s", source=text, P=p, dPdu=[2, 0, 0], dPdv=[0, 3, 0], du=0.5, dv=0.25, outputs=["a"])
        numpy.testing.assert_allclose(made["a"], numpy.full(5, 2 * 0.5 * 3 * 0.25), rtol=1e-6)

    def test_displacement(self):
        text = "displacement up(float h = 1;) { P += h * normalize(N); N = calculatenormal(P); }"
        p = numpy.float32([[0, 0, 0], [1, 2, 3]])
        numpy.testing.assert_allclose(alpenglow.shade("up", source=text, P=p, params={"h": 0.5})["P"], p + [0, 0, 0.5])

    def test_faults(self):
        for wrong in (dict(params={"m": 1}), dict(params={"n": [1, 2]}), dict(params={"n": "text"}), dict(q=1), dict(P=[1, 2]),
                      dict(s=[1, 2], t=[1, 2, 3]), dict(kind="volume"), dict(source="surface s( {")):
            arguments = {"source": SHADER, "quiet": True, **wrong}
            with self.assertRaises(alpenglow.Error, msg=str(wrong)):
                alpenglow.shade("bands", **arguments)
        with self.assertRaisesRegex(alpenglow.Error, "nowhere"):
            alpenglow.shade("nowhere", quiet=True)


class Info(InFolder):
    def test_parameters_of_a_shader(self):
        found = alpenglow.info("plastic")
        self.assertEqual(found["name"], "plastic")
        names = [p["name"] for p in found["parameters"]]
        self.assertIn("roughness", names)
        with self.assertRaises(alpenglow.Error):
            alpenglow.info("nowhere")

    def test_compile_says_what_is_wrong(self):
        with open("bad.sl", "w") as f:
            f.write("surface bad() {\n    Ci = unknown;\n}\n")
        messages = alpenglow.compile("bad.sl")
        self.assertTrue(any(m.level >= 2 and m.line == 2 for m in messages), messages)
        self.assertFalse([m for m in alpenglow.compile("matte") if m.level >= 2])

    def test_version_and_requests(self):
        self.assertTrue(alpenglow.version().startswith("Alpenglow " + alpenglow.__version__))
        sphere = next(r for r in alpenglow.requests() if r["name"] == "Sphere")
        self.assertEqual(sphere["signature"], "number[4] shape; ..")
        self.assertTrue(math.isclose(sum(1 for _ in alpenglow.requests()) / 100, 1, abs_tol=0.9))


if __name__ == "__main__":
    unittest.main()
