#!/usr/bin/env python3
"""vtk_test.py PROGRAM OUT [--now]: six scenes of VTK by its vtkRIBExporter, drawn here under hidden and under path, compared with
VTK's own pictures.
Status 77 where python3-vtk9 or Xvfb is not installed.

Tolerance, in codes of 0 to 255 and on average over the picture: 2. Both light by the same formulas; edges are sampled in
another pattern, VTK's
vertex normals and colours go through 8 bits. 4 where things are transparent: VTK draws those in the order of whole triangles.
`--dialect rispec`: VTK writes
roughness as 1 / power. Under path the convex scenes alone are compared: between others light goes to and fro."""
import os
import subprocess
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import display  # noqa: E402

HERE = os.path.dirname(os.path.abspath(__file__))
LIMIT, SORTED = 2.0, 4.0
CONVEX = ("ball", "shine", "heights")
SCENES = ("ball", "shine", "shapes", "heights", "glassy", "contour")


def main():
    if len(sys.argv) < 3:
        print(__doc__)
        return 2
    why = display.skipped("Xvfb")
    python = "" if why else display.python_with("vtk")
    if why or not python:
        print(why or "skipped: not installed: python3-vtk9")
        return 77
    program, out = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
    os.makedirs(out, exist_ok=True)
    with display.Screen() as environment:
        subprocess.run(
            [python, os.path.join(HERE, "vtk_scenes.py"), out], env=environment, check=True, stderr=subprocess.DEVNULL
        )
    failed = 0
    for name in SCENES:
        for hider in ("hidden", "path") if name in CONVEX else ("hidden",):
            codes, said = display.drawn(program, out, name, hider)
            bad = codes is None or codes > (SORTED if name == "glassy" else LIMIT)
            print(
                "%s, %s: %s%s" % (name, hider, said if codes is None else "%.2f codes apart" % codes, "; WRONG" if bad else "")
            )
            failed |= bad
    return int(failed)


sys.exit(main())
