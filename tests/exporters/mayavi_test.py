#!/usr/bin/env python3
"""mayavi_test.py PROGRAM OUT [--now]: three scenes of mayavi by its save_rib, drawn under hidden, compared with mayavi's own
pictures. Status 77 where mayavi2
or Xvfb is not installed.

Tolerance, in codes of 0 to 255 and on average over the picture: 12. Shapes and colours are the same; but mayavi's three lamps
are fixed to the
camera, and the exporter (VTK's) writes their places in the camera's space as if they were in the world's, so light comes from
elsewhere."""
import os
import subprocess
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import display  # noqa: E402

HERE = os.path.dirname(os.path.abspath(__file__))
LIMIT = 12.0


def main():
    if len(sys.argv) < 3:
        print(__doc__)
        return 2
    why = display.skipped("Xvfb")
    python = "" if why else display.python_with("mayavi")
    if why or not python:
        print(why or "skipped: not installed: mayavi2")
        return 77
    program, out, failed = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2]), 0
    os.makedirs(out, exist_ok=True)
    with display.Screen() as environment:
        subprocess.run(
            [python, os.path.join(HERE, "mayavi_scenes.py"), out],
            env=dict(environment, QT_QPA_PLATFORM="offscreen"),
            check=True,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            timeout=600,
        )
    for name in ("surface", "knot", "shell"):
        codes, said = display.drawn(program, out, name, "hidden")
        bad = codes is None or codes > LIMIT
        print("%s: %s%s" % (name, said if codes is None else "%.2f codes apart" % codes, "; WRONG" if bad else ""))
        failed |= bad
    return int(failed)


sys.exit(main())
