#!/usr/bin/env python3
"""Fits the polynomials of src/shadeops/elementary.h.

Remez exchange in double precision; then the coefficients are rounded to float one after another, lowest first, each time refitting the rest.
Each fit minimises max |weight(x) * (target(x) - q(x))| over an interval. Prints C++ arrays and the error reached.
Run: python3 tools/fit_elementary.py
"""
import math
import struct


def to_float(x):
    return struct.unpack("f", struct.pack("f", x))[0]


def solve(a, b):
    n = len(b)
    for i in range(n):
        p = max(range(i, n), key=lambda r: abs(a[r][i]))
        a[i], a[p], b[i], b[p] = a[p], a[i], b[p], b[i]
        for r in range(i + 1, n):
            f = a[r][i] / a[i][i]
            if f:
                for c in range(i, n):
                    a[r][c] -= f * a[i][c]
                b[r] -= f * b[i]
    x = [0.0] * n
    for i in reversed(range(n)):
        x[i] = (b[i] - sum(a[i][c] * x[c] for c in range(i + 1, n))) / a[i][i]
    return x


def horner(c, x):
    r = 0.0
    for k in reversed(c):
        r = r * x + k
    return r


def remez(target, weight, lo, hi, degree, fixed):
    """Coefficients fixed[0..) are given; finds the others. Returns (coefficients, error)."""
    first, unknown = len(fixed), degree + 1 - len(fixed)
    grid = [lo + (hi - lo) * (0.5 - 0.5 * math.cos(math.pi * i / 3000)) for i in range(3001)]
    t = [target(x) - horner(fixed, x) for x in grid]
    w = [weight(x) for x in grid]
    if unknown == 0:
        return list(fixed), max(abs(a * b) for a, b in zip(t, w))
    n = unknown + 1
    points = [round(3000 * (0.5 - 0.5 * math.cos(math.pi * (2 * i + 1) / (2 * n)))) for i in range(n)]
    for _ in range(40):
        rows = [[grid[p] ** (first + j) for j in range(unknown)] + [(-1) ** i / w[p]] for i, p in enumerate(points)]
        solution = solve(rows, [t[p] for p in points])
        c = solution[:unknown]
        e = [w[i] * (t[i] - grid[i] ** first * horner(c, grid[i])) for i in range(3001)]
        # one extremum per run of one sign
        runs, start = [], 0
        for i in range(1, 3002):
            if i == 3001 or (e[i] > 0) != (e[start] > 0):
                runs.append(max(range(start, i), key=lambda k: abs(e[k])))
                start = i
        while len(runs) > n:
            if abs(e[runs[0]]) < abs(e[runs[-1]]):
                runs.pop(0)
            else:
                runs.pop()
        worst = max(abs(v) for v in e)
        if len(runs) < n or worst <= abs(solution[-1]) * 1.0001:
            break
        points = runs
    return list(fixed) + c, worst


def fit(name, target, weight, lo, hi, degree):
    fixed = []
    _, best = remez(target, weight, lo, hi, degree, [])
    for i in range(degree + 1):
        # Powers from x^i on span no Haar space when 0 lies inside: then plain rounding.
        c, _ = remez(target, weight, lo, hi, degree, fixed if lo >= 0 else [])
        fixed.append(to_float(c[i]))
    xs = [lo + (hi - lo) * i / 5000 for i in range(5001)]
    worst = max(abs(weight(x) * (target(x) - horner(fixed, x))) for x in xs)
    print(f"// error {worst:.2g} (unrounded {best:.2g})")
    literals = ", ".join(c.hex().replace("0000000p", "p") + "f" for c in fixed)
    print(f"inline constexpr float {name}[] = {{{literals}}};")


def odd(f):
    """(f(r)/r - 1)/s as a function of s = r*r: f(r) = r + r s q(s)."""
    def g(s):
        r = math.sqrt(s)
        return (f(r) / r - 1) / s
    return g


EPS = 1e-4
SQRT_HALF = math.sqrt(0.5)
LOG2E = 1 / math.log(2)
LOG2E_HALF_HI = to_float(-LOG2E / 2)


def log_rest(f):
    return (math.log1p(f) - f + f * f / 2) / f ** 3 if abs(f) > 2e-3 else 1 / 3 - f / 4 + f * f / 5


def log2_rest(f):
    """The same in base 2."""
    return LOG2E * log_rest(f)


def exp_rest(r):
    return (math.expm1(r) - r) / (r * r) if abs(r) > 1e-3 else 0.5 + r / 6 + r * r / 24


def exp2_rest(f):
    return math.expm1(f * math.log(2)) / f if abs(f) > 1e-9 else math.log(2)


def main():
    h = math.pi / 2 * 1.004
    fit("kSin", odd(math.sin), lambda s: s * math.sqrt(s) / math.sin(math.sqrt(s)), EPS, h * h, 3)
    q = math.pi / 4 * 1.0005
    fit("kTan", odd(math.tan), lambda s: s * math.sqrt(s) / math.tan(math.sqrt(s)), EPS, q * q, 5)
    fit("kAsin", odd(math.asin), lambda s: s * math.sqrt(s) / math.asin(math.sqrt(s)), EPS, 0.2501, 4)
    fit("kAtan", odd(math.atan), lambda s: s * math.sqrt(s) / math.atan(math.sqrt(s)), EPS, 1.0, 7)
    ln = math.log(2) / 2 * 1.001
    fit("kExp", exp_rest, lambda r: r * r / math.exp(r), -ln, ln, 4)
    fit("kExp2", exp2_rest, lambda f: abs(f) / 2 ** f, -0.501, 0.501, 5)
    lo, hi = SQRT_HALF - 1 - 1e-4, 2 * SQRT_HALF - 1 + 1e-4
    fit("kLog", log_rest, lambda f: f ** 3 / math.log1p(f) if f else 0.0 + 1e-12, lo, hi, 7)
    fit("kLog2", log2_rest, lambda f: abs(f) ** 3 + 1e-12, lo, hi, 7)
    for name, v in (("pi", math.pi), ("log2e", LOG2E), ("ln2", math.log(2)), ("-log2e/2", -LOG2E / 2)):
        a = to_float(v)
        print(f"// {name}: {a.hex()} {to_float(v - a).hex()}")


if __name__ == "__main__":
    main()
