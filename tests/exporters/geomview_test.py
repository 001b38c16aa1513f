#!/usr/bin/env python3
"""geomview_test.py PROGRAM OUT [--now]: shapes that ship with Geomview by its rib-snapshot, drawn under hidden, compared with
Geomview's own pictures.
Status 77 where geomview, Xvfb or python3-numpy is not installed.

Held to: every shape is seen where Geomview shows it (99 % of the pixels are shape or background in both; edges are sampled by
OpenGL in
their middle), and blocks of 8 by 8 pixels on it are correlated by .95. No more, because the lights mean different things:
Geomview reads its ambient light
by .3 and adds highlights by the vertex, its RIB asks for Ka .3 of `plastic`, whose highlight is another one."""
import os
import subprocess
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import display  # noqa: E402

GEOM = "/usr/share/geomview/geom"
SHAPES = ("dodec.off", "icosa.off", "facecube.off", "octa.off", "tref.off", "teapot.bez")
SIZE = 300
SAME_PIXELS, CORRELATION = 0.99, 0.95


def snapshots(out, environment):
    """NAME.ppm and NAME.rib of every shape, each by a Geomview of its own."""
    for shape in SHAPES:
        name = shape.split(".")[0]
        script = os.path.join(out, name + ".cmd")
        with open(script, "w", encoding="ascii") as f:
            f.write(
                "(load %s/%s geometry)(normalization allgeoms each)(bbox-draw allgeoms no)(window default {size %d %d})\n"
                % (GEOM, shape, SIZE, SIZE)
            )
            f.write(
                "(snapshot c0 %s.ppm ppm)(rib-snapshot c0 %s.rib)(exit)\n" % (os.path.join(out, name), os.path.join(out, name))
            )
        subprocess.run(["geomview", "-nopanels", "-c", script], env=environment, capture_output=True, timeout=120, check=False)


def compare(program, out):
    import numpy as np
    import pictures

    failed = 0
    for shape in SHAPES:
        name = shape.split(".")[0]
        theirs, rib = os.path.join(out, name + ".ppm"), name + ".rib"
        if not os.path.exists(theirs):
            print("%s: Geomview wrote no picture" % shape)
            failed = 1
            continue
        with open(theirs, "rb") as f:
            head = f.readline(), f.readline()
            while head[1].startswith(b"#"):
                head = head[0], f.readline()
            width, height = map(int, head[1].split())
            f.readline()
            b = np.frombuffer(f.read(), np.uint8)[: width * height * 3].reshape(height, width, 3) / 255
        done = subprocess.run(
            [
                program,
                "render",
                "-q",
                "--hider",
                "hidden",
                "--gamma",
                "1",
                "--spp",
                "16",
                "--format",
                "%dx%d" % (width, height),
                "-o",
                name + ".exr",
                rib,
            ],
            cwd=out,
            capture_output=True,
            text=True,
            check=False,
        )
        if done.returncode != 0:
            print("%s: status %d\n%s" % (shape, done.returncode, done.stderr))
            failed = 1
            continue
        a = pictures.read(os.path.join(out, name + ".exr"))
        pictures.png(os.path.join(out, name + ".png"), [np.clip(x, 0, 1) ** 2.2 for x in (a, b)])
        seen = [np.abs(x - x[2, 2]).max(2) > 0.02 for x in (a, b)]
        same = float((seen[0] == seen[1]).mean())
        x, y, on = (
            pictures.blocks(a),
            pictures.blocks(b),
            pictures.blocks((seen[0] & seen[1])[..., None].astype(float))[..., 0] == 1,
        )
        correlation = float(np.corrcoef(x[on].ravel(), y[on].ravel())[0, 1])
        bad = same < SAME_PIXELS or correlation < CORRELATION or on.sum() < 20
        print(
            "%s: %.4f of the pixels are shape or background in both, correlation %.3f%s"
            % (shape, same, correlation, "; WRONG" if bad else "")
        )
        failed |= bad
    return int(failed)


def main():
    if len(sys.argv) < 3:
        print(__doc__)
        return 2
    why = display.skipped("geomview", "Xvfb")
    python = "" if why else display.python_with("numpy")
    if why or not python:
        print(why or "skipped: not installed: python3-numpy")
        return 77
    program, out = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
    os.makedirs(out, exist_ok=True)
    if "--compare" in sys.argv:
        return compare(program, out)
    with display.Screen() as environment:
        snapshots(out, environment)
    return subprocess.run([python, os.path.abspath(__file__), program, out, "--now", "--compare"], check=False).returncode


sys.exit(main())
