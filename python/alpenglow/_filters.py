"""Pixel filters as RISpec 3.2, appendix E, has them."""
from math import exp, pi, sin, sqrt


def _box(x, y, xwidth, ywidth):
    return 1.0


def _triangle(x, y, xwidth, ywidth):
    return max(0.0, (1 - abs(x) / (xwidth / 2)) * (1 - abs(y) / (ywidth / 2)))


def _catmull_rom(x, y, xwidth, ywidth):
    r2 = x * x + y * y
    r = sqrt(r2)
    if r >= 2:
        return 0.0
    return 3 * r * r2 - 5 * r2 + 2 if r < 1 else -r * r2 + 5 * r2 - 8 * r + 4


def _gaussian(x, y, xwidth, ywidth):
    x, y = x * 2 / xwidth, y * 2 / ywidth
    return exp(-2 * (x * x + y * y))


def _sinc1(x):
    return 1.0 if abs(x) < 1e-4 else sin(pi * x) / (pi * x)


def _sinc(x, y, xwidth, ywidth):
    return _sinc1(x) * _sinc1(y)


FILTERS = {"box": _box, "triangle": _triangle, "catmull-rom": _catmull_rom, "gaussian": _gaussian, "sinc": _sinc}
