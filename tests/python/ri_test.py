"""alpenglow.ri: the interface of cgkit's module."""
import os
import pathlib
import subprocess
import sys
import unittest

import numpy

import alpenglow
from alpenglow.ri import *  # noqa: F401,F403
from common import BALLS, PROGRAM, InFolder, read_exr, run


def draw_balls():
    RiFormat(48, 32, 1)
    RiHider("path")
    RiPixelSamples(3, 3)
    RiProjection(RI_PERSPECTIVE, RI_FOV, 40)
    RiTranslate(0, 0, 5)
    RiWorldBegin()
    RiLightSource("distantlight", "from", [1, 2, -3], "to", [0, 0, 0], intensity=2)
    RiAttributeBegin()
    RiColor([1, 0.3, 0.1])
    RiSurface("plastic", Kd=0.6)
    RiTranslate([-0.7, 0, 0])
    RiSphere(1, -1, 1, 360)
    RiAttributeEnd()
    RiAttributeBegin()
    RiColor((0.2, 0.6, 1))
    RiTranslate(1, 0, 0.5)
    RiRotate(30, 0, 1, 0)
    RiSphere(0.7, -0.7, 0.7, 360, RI_NULL)
    RiAttributeEnd()
    RiWorldEnd()


class Ri(InFolder):
    def setUp(self):
        super().setUp()
        RiErrorHandler(RiErrorPrint)

    def test_the_same_bits_as_rib(self):
        RiBegin("alpenglow")
        RiDisplay("python.exr", RI_FILE, RI_RGBA)
        draw_balls()
        RiEnd()
        pathlib.Path("scene.rib").write_text('Display "rib.exr" "file" "rgba"\n' + BALLS)
        self.assertEqual(run(PROGRAM, "render", "-q", "scene.rib")[0], 0)
        python, rib = read_exr("python.exr"), read_exr("rib.exr")
        for channel in "RGBA":
            numpy.testing.assert_array_equal(python[channel], rib[channel])

    def test_files_and_forms_of_parameters(self):
        RiBegin("a.rib")
        RiSurface("plastic", "Kd", 0.5, "Ks", [0.25])
        RiSurface("plastic", {"Kd": 0.5, "Ks": 0.25})
        RiSurface("plastic", Kd=0.5, Ks=0.25)
        RiPolygon(P=[0, 0, 0, 1, 0, 0, 1, 1, 0])
        RiPatchMesh(RI_BILINEAR, 2, RI_NONPERIODIC, 2, RI_NONPERIODIC, RI_P, numpy.zeros((4, 3)))
        RiBasis(RiBezierBasis, RI_BEZIERSTEP, RiPowerBasis, RI_POWERSTEP)
        RiPixelFilter(RiGaussianFilter, 2, 2)
        RiMotionBegin(0, 0.5, 1)
        RiMotionEnd()
        RiMotionBegin([0, 1])
        RiDepthOfField(8, 0.1, 5)
        RiDepthOfField()
        RiEnd()
        lines = [l.strip() for l in pathlib.Path("a.rib").read_text().splitlines() if not l.startswith("##")]
        self.assertEqual(lines, ['Surface "plastic" "Kd" [0.5] "Ks" [0.25]'] * 3 + [
            'Polygon "P" [0 0 0 1 0 0 1 1 0]',
            'PatchMesh "bilinear" 2 "nonperiodic" 2 "nonperiodic" "P" [0 0 0 0 0 0 0 0 0 0 0 0]', 'Basis "bezier" 3 "power" 4',
            'PixelFilter "gaussian" 2 2', "MotionBegin [0 0.5 1]", "MotionEnd", "MotionBegin [0 1]", "DepthOfField 8 0.1 5",
            "DepthOfField"])

    def test_filters_are_functions(self):
        self.assertEqual(RiBoxFilter(0.3, 0.2, 1, 1), 1)
        self.assertEqual(RiTriangleFilter(0.5, 0, 2, 2), 0.5)
        self.assertAlmostEqual(RiGaussianFilter(1, 0, 2, 2), numpy.exp(-2))  # RISpec 3.2, appendix E
        self.assertEqual(RiCatmullRomFilter(0, 0, 4, 4), 2)
        self.assertAlmostEqual(RiSincFilter(0.5, 0, 4, 4), 2 / numpy.pi)

    def test_standard_output_is_the_default(self):
        code = "from alpenglow.ri import *\nRiBegin(RI_NULL)\nRiWorldBegin()\nRiSphere(1,-1,1,360)\nRiWorldEnd()\nRiEnd()\n"
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
        self.assertEqual([l.strip() for l in done.stdout.splitlines()[1:]], ["WorldBegin", "Sphere 1 -1 1 360", "WorldEnd"])
        status, _, said = run(PROGRAM, "render", "-q", "-o", "piped.exr", "-", text=done.stdout)
        self.assertEqual(status, 0, said)

    def test_contexts(self):
        one = RiBegin("one.rib")
        RiSphere(1, -1, 1, 360)
        two = RiBegin("two.rib")
        RiCone(1, 1, 360)
        self.assertIs(RiGetContext(), two)
        RiContext(one)
        RiDisk(0, 1, 360)
        RiEnd()
        RiContext(two)
        RiEnd()
        self.assertIn("Disk", pathlib.Path("one.rib").read_text())
        self.assertNotIn("Cone", pathlib.Path("one.rib").read_text())
        self.assertIn("Cone", pathlib.Path("two.rib").read_text())

    def test_errors(self):
        heard = []
        RiErrorHandler(lambda code, severity, text: heard.append((code, severity)))
        RiBegin("alpenglow")
        RiAttributeEnd()
        self.assertEqual(heard, [(RIE_NESTING, RIE_ERROR)])
        import alpenglow.ri
        self.assertEqual(alpenglow.ri.RiLastError, RIE_NESTING)
        RiErrorHandler(RiErrorAbort)
        with self.assertRaises(RIException):
            RiAttributeEnd()
        RiErrorHandler(RiErrorIgnore)
        RiAttributeEnd()
        RiEnd()
        with self.assertRaises(RIException):
            RiSurface("plastic", "Kd")

    def test_procedurals_objects_and_archives(self):
        def ball(data, detail):
            RiSphere(data, -data, data, 360)

        RiBegin("p.rib")
        RiProcedural(2, [-2, 2] * 3, ball, RiProcFree)
        RiProcedural("part.rib", [-2, 2] * 3, RiProcDelayedReadArchive)
        handle = RiObjectBegin()
        RiObjectEnd()
        RiObjectInstance(handle)
        RiArchiveRecord(RI_COMMENT, "%d of %s", 1, "two")
        RiReadArchive("part.rib")
        RiEnd()
        text = pathlib.Path("p.rib").read_text()
        for line in ("Sphere 2 -2 2 360", 'Procedural "DelayedReadArchive" ["part.rib"] [-2 2 -2 2 -2 2]', "#1 of two",
                     'ReadArchive "part.rib"'):
            self.assertIn(line, text)

    def test_transform_points(self):
        RiBegin("alpenglow")
        RiTranslate(0, 0, 5)
        RiWorldBegin()
        RiTranslate(1, 2, 3)
        RiCoordinateSystem("here")
        self.assertEqual(RiTransformPoints("here", "world", [[0, 0, 0], [1, 1, 1]]), [1, 2, 3, 2, 3, 4])
        self.assertEqual(RiTransformPoints("world", "camera", [0, 0, 0]), [0, 0, 5])
        self.assertIsNone(RiTransformPoints("nowhere", "camera", [0, 0, 0]))
        RiDisplay("x", "null", "rgb")
        RiEnd_quietly()

    def test_every_function_of_the_specification(self):
        """The functions of the C binding of RISpec 3.2."""
        names = """ArchiveRecord AreaLightSource Atmosphere Attribute AttributeBegin AttributeEnd Basis Begin Blobby Bound Clipping
            Color ColorSamples ConcatTransform Cone Context CoordinateSystem CoordSysTransform CropWindow Curves Cylinder Declare
            DepthOfField Detail DetailRange Disk Displacement Display End ErrorHandler Exposure Exterior Format FrameAspectRatio
            FrameBegin FrameEnd GeneralPolygon GeometricApproximation Geometry GetContext Hider Hyperboloid Identity Illuminate
            Imager Interior LightSource MakeCubeFaceEnvironment MakeLatLongEnvironment MakeShadow MakeTexture Matte MotionBegin
            MotionEnd NuPatch ObjectBegin ObjectEnd ObjectInstance Opacity Option Orientation Paraboloid Patch PatchMesh Perspective
            PixelFilter PixelSamples PixelVariance Points PointsGeneralPolygons PointsPolygons Polygon Procedural Projection
            Quantize ReadArchive RelativeDetail ReverseOrientation Rotate Scale ScreenWindow ShadingInterpolation ShadingRate
            Shutter Sides Skew SolidBegin SolidEnd Sphere SubdivisionMesh Surface TextureCoordinates Torus Transform TransformBegin
            TransformEnd TransformPoints Translate TrimCurve WorldBegin WorldEnd BoxFilter CatmullRomFilter GaussianFilter
            SincFilter TriangleFilter ErrorAbort ErrorIgnore ErrorPrint ProcDelayedReadArchive ProcDynamicLoad ProcRunProgram
            BezierBasis BSplineBasis CatmullRomBasis HermiteBasis PowerBasis""".split()
        self.assertEqual([n for n in names if "Ri" + n not in globals()], [])


def RiEnd_quietly():
    RiErrorHandler(RiErrorIgnore)
    RiWorldEnd()
    RiEnd()


if __name__ == "__main__":
    unittest.main()
