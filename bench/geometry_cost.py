#!/usr/bin/env python3
# What many primitives cost, and what movement does (bench/RESULTS.md, "Many primitives"): writes scenes to a folder, renders each in a process of its own, and prints
# processor seconds of the user (the machine may be busy) and the resident memory at most.
# geometry_cost.py ALPENGLOW [case...]   cases: curves points subdivision instances triangles moving; all without one
import array
import math
import os
import random
import sys
import tempfile

HEAD = ('Format 400 400 1\nProjection "perspective" "fov" 40\nHider "path"\nPixelSamples 1 1\nShutter 0 1\nTranslate 0 0 4\nRotate -20 1 0 0\n'
        'WorldBegin\nLightSource "distantlight" 1 "from" [1 2 -2] "to" [0 0 0]\nSurface "matte"\n')


def numbers(values, form="%.5g"):
    return " ".join(form % v for v in values)


def points_in_slab(n, seed=1):
    r = random.Random(seed)
    return [(2 * r.random() - 1, .6 * r.random() - .3, 2 * r.random() - 1) for _ in range(n)]


def curves(f):
    """A million cubic curves of four points: a lawn of blades a twentieth high."""
    n = 1_000_000
    r = random.Random(2)
    f.write('Curves "cubic" [' + "4 " * n + '] "nonperiodic" "constantwidth" .001 "P" [')
    for x, y, z in points_in_slab(n):
        a, b = .02 * r.random(), .02 * r.random()
        f.write("%.5g 0 %.5g %.5g .017 %.5g %.5g .033 %.5g %.5g .05 %.5g\n" % (x, z, x + a / 3, z, x + a, z + b / 3, x + 2 * a, z + b))
    f.write("]\n")


def points(f):
    f.write('Points "constantwidth" .004 "P" [')
    for p in points_in_slab(1_000_000):
        f.write("%.4g %.4g %.4g\n" % p)
    f.write("]\n")


def sheet(n, bend):
    """n by n cells of a bent sheet 2 wide; its points."""
    for j in range(n + 1):
        for i in range(n + 1):
            x, z = 2 * i / n - 1, 2 * j / n - 1
            yield x, bend * math.sin(5 * x) * math.cos(4 * z), z


def subdivision(f):
    n = 100
    f.write('SubdivisionMesh "catmull-clark" [' + "4 " * n * n + "] [")
    for j in range(n):
        for i in range(n):
            a = j * (n + 1) + i
            f.write("%d %d %d %d " % (a, a + n + 1, a + n + 2, a + 1))
    f.write('] ["interpolateboundary"] [0 0] [] [] "P" [')
    for p in sheet(n, .2):
        f.write("%.5g %.5g %.5g " % p)
    f.write("]\n")


def triangles(f, n=2236, bend=.2, end=None):
    """2 n n triangles: ten million unless said."""
    count = 2 * n * n
    text = 'PointsPolygons [' + "3 " * count + "] ["
    rows = []
    for j in range(n):
        a = array.array("l", range(j * (n + 1), j * (n + 1) + n))
        rows.append(" ".join("%d %d %d %d %d %d" % (k, k + n + 1, k + 1, k + 1, k + n + 1, k + n + 2) for k in a))
    for b in [bend] if end is None else [bend, end]:
        f.write(text)
        for row in rows:
            f.write(row + "\n")
        f.write('] "P" [')
        for p in sheet(n, b):
            f.write("%.5g %.5g %.5g\n" % p)
        f.write("]\n")


def instances(f):
    """A million places of a mesh of 10,000 triangles."""
    f.write("ObjectBegin 1\nScale .02 .02 .02\n")
    triangles(f, 71)
    f.write("ObjectEnd\n")
    r = random.Random(3)
    for p in points_in_slab(1_000_000, 4):
        f.write("TransformBegin\nTranslate %.4g %.4g %.4g\nRotate %d 1 2 3\nObjectInstance 1\nTransformEnd\n" % (*p, r.randrange(360)))


def moving(f, how):
    """A mesh of 100,000 triangles: still, going, deforming."""
    if how == "going":
        f.write("MotionBegin [0 1]\nTranslate 0 0 0\nTranslate .1 .1 0\nMotionEnd\n")
    if how == "deforming":
        f.write("MotionBegin [0 1]\n")
        triangles(f, 224, .2, .3)
        f.write("MotionEnd\n")
    else:
        triangles(f, 224)


def write(folder, name, make, head=HEAD):
    path = os.path.join(folder, name + ".rib")
    with open(path, "w", buffering=1 << 22) as f:
        f.write(head)
        make(f)
        f.write("WorldEnd\n")
    return path


def run(program, path, spp):
    """User seconds, MiB at most, rays."""
    arguments = [program, "render", "--progress", "none", "--spp", str(spp), "-o", path + ".exr", path]
    log = (os.POSIX_SPAWN_OPEN, 2, path + ".log", os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o644)
    pid = os.posix_spawn(program, arguments, os.environ, file_actions=[log])
    _, status, used = os.wait4(pid, 0)
    if status:
        print("failed:", open(path + ".log").read())
    rays = [line.split()[1] for line in open(path + ".log") if line.startswith("  rays ")]
    return used.ru_utime, used.ru_maxrss / 1024, int(rays[0].rstrip(",").replace(",", "")) if rays else 0


def main():
    program, wanted = os.path.abspath(sys.argv[1]), sys.argv[2:]
    with tempfile.TemporaryDirectory() as folder:
        for make in (curves, points, subdivision, instances, triangles):
            if wanted and make.__name__ not in wanted:
                continue
            path = write(folder, make.__name__, make)
            first, memory, few = run(program, path, 1)
            more, _, many = run(program, path, 3)
            text = os.path.getsize(path) / 2**20
            print("%-12s %7.0f MiB of text, %8.2f s user at 1 sample, %7.0f MiB at most; %6.2f us a ray of %d in two samples more"
                  % (make.__name__, text, first, memory, 1e6 * (more - first) / (many - few), many - few), flush=True)
            os.remove(path)
        if not wanted or "moving" in wanted:
            paths = {how: write(folder, how, lambda f: moving(f, how)) for how in ("still", "going", "deforming")}
            least = {}
            for _ in range(3):  # in turns: what else the machine does meets all of them
                for how, path in paths.items():
                    for spp in (1, 17):
                        least[how, spp] = min(least.get((how, spp), 1e9), run(program, path, spp)[0])
            for how in paths:
                cost = least[how, 17] - least[how, 1]
                print("%-12s %8.2f s user for 16 samples, %.2f times still" % (how, cost, cost / (least["still", 17] - least["still", 1])), flush=True)


if __name__ == "__main__":
    main()
