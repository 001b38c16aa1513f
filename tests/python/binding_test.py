"""The same scene by the C binding (libalpenglow.so, by ctypes), by Python and as RIB, in one process: the same bits."""
import ctypes
import os
import unittest

import numpy

import alpenglow
from alpenglow import prman
from common import BALLS, PROGRAM, InFolder, read_exr
from prman_test import draw_balls

LIBRARY = os.path.join(os.path.dirname(os.path.dirname(PROGRAM)), "lib", "libalpenglow.so")


def pairs(**values):
    """n, tokens and values of the forms that end in V; numbers are floats."""
    tokens = (ctypes.c_char_p * max(1, len(values)))(*[k.encode() for k in values])
    arrays = [(ctypes.c_float * len(v))(*v) for v in values.values()]
    pointers = (ctypes.c_void_p * max(1, len(values)))(*[ctypes.cast(a, ctypes.c_void_p) for a in arrays])
    pairs.kept = arrays
    return len(values), tokens, pointers


@unittest.skipUnless(os.path.exists(LIBRARY), "the C binding is not built")
class Binding(InFolder):
    def draw(self, c):
        f, three = ctypes.c_float, ctypes.c_float * 3
        for name in ("RiLightSourceV",):
            getattr(c, name).restype = ctypes.c_void_p
        c.RiBegin(None)
        c.RiDisplayV(b"c.exr", b"openexr", b"rgba", *pairs())
        c.RiFormat(48, 32, f(1))
        c.RiHiderV(b"path", *pairs())
        c.RiPixelSamples(f(3), f(3))
        c.RiProjectionV(b"perspective", *pairs(fov=[40]))
        c.RiTranslate(f(0), f(0), f(5))
        c.RiWorldBegin()
        c.RiLightSourceV(b"distantlight", *pairs(**{"from": [1, 2, -3], "to": [0, 0, 0], "intensity": [2]}))
        c.RiAttributeBegin()
        c.RiColor(three(1, 0.3, 0.1))
        c.RiSurfaceV(b"plastic", *pairs(Kd=[0.6]))
        c.RiTranslate(f(-0.7), f(0), f(0))
        c.RiSphereV(f(1), f(-1), f(1), f(360), *pairs())
        c.RiAttributeEnd()
        c.RiAttributeBegin()
        c.RiColor(three(0.2, 0.6, 1))
        c.RiTranslate(f(1), f(0), f(0.5))
        c.RiRotate(f(30), f(0), f(1), f(0))
        c.RiSphereV(f(0.7), f(-0.7), f(0.7), f(360), *pairs())
        c.RiAttributeEnd()
        c.RiWorldEnd()
        c.RiEnd()

    def test_all_three_agree(self):
        rib = alpenglow.render(BALLS).image
        self.assertGreater(rib[:, :, :3].max(), 0.1)
        self.draw(ctypes.CDLL(LIBRARY))
        c = read_exr("c.exr")
        numpy.testing.assert_array_equal(numpy.stack([c[k] for k in "RGBA"], 2), rib)
        ri = prman.Ri(keep_pictures=True)
        ri.Begin("__render")
        ri.Display("x", "null", "rgba")
        draw_balls(ri)
        ri.End()
        numpy.testing.assert_array_equal(ri.pictures[0].data, rib)


if __name__ == "__main__":
    unittest.main()
