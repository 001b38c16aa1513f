#!/usr/bin/env python3
"""blender_test.py PROGRAM OUT [--now] [SCENE ...]: scenes of blender_scenes.py by the add-on and by Cycles, headless; `features` is what has no
counterpart in a picture. Status 77 where Blender is not installed, 1 where pictures do not agree.

Tolerances: the means of red, green and blue within 2.5 %, blocks of 8 by 8 pixels within 4 % of the mean on average, and correlated by .985.
Both path tracers are without bias, and 64 samples a pixel leave half a per cent of noise in a mean and 1 to 2 % in a block. The rest is what the
add-on states: Fresnel's factor of facets and Burley's diffuse lobe are means over directions of light (up to 2 % where light comes from a sun
alone, docs/blender.md), Cycles' tubes of hair have 8 sides, subdivided meshes are the smooth surface here and facets there."""
import json
import os
import shutil
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
LIMITS = {"ratio": .025, "difference": .04, "correlation": .985}
SCENES = ("default", "materials", "lights", "crowd", "lens")


def blender(script, program, *arguments):
    """Runs a script in Blender; what it prints, and the status."""
    environment = dict(os.environ, ALPENGLOW_PROGRAM=os.path.abspath(program), PYTHONDONTWRITEBYTECODE="1",
                       ALPENGLOW_ADDON=os.path.join(HERE, "..", "..", "editors", "blender"))
    done = subprocess.run(["blender", "-b", "--factory-startup", "--python-exit-code", "1", "--python", os.path.join(HERE, script), "--", *arguments],
                          capture_output=True, text=True, env=environment, stdin=subprocess.DEVNULL, check=False)
    return done.stdout + done.stderr, done.returncode


def wrong(found):
    """What is beyond the limits, as text."""
    out = ["%s of the means %.4f" % (name, r) for name, r in zip(("red", "green", "blue"), found["ratio"]) if abs(r - 1) > LIMITS["ratio"]]
    if found["difference"] > LIMITS["difference"]:
        out.append("blocks differ by %.4f" % found["difference"])
    if found["correlation"] < LIMITS["correlation"]:
        out.append("blocks are correlated by %.4f" % found["correlation"])
    return out


def main():
    if len(sys.argv) < 3:
        print(__doc__)
        return 2
    if not os.environ.get("ALPENGLOW_NIGHTLY") and "--now" not in sys.argv:
        print("skipped: only in ./check --all (or with --now)")
        return 77
    if not shutil.which("blender"):
        print("Blender is not installed (Debian: blender)")
        return 77
    program, out, failed = sys.argv[1], os.path.abspath(sys.argv[2]), 0
    os.makedirs(out, exist_ok=True)
    for name in [a for a in sys.argv[3:] if a != "--now"] or SCENES + ("features",):
        script, more = ("blender_features.py", [out]) if name == "features" else ("blender_render.py", [name, out, "64"])
        text, status = blender(script, program, *more)
        line = next((t for t in text.splitlines() if t.startswith("COMPARED ")), None)
        if status != 0 or (line is None and name != "features"):
            print("%s: Blender ended with status %d\n%s" % (name, status, "\n".join(t for t in text.splitlines() if not t.startswith("Fra:"))))
            failed = 1
            continue
        if line is not None:
            found = json.loads(line[9:])
            bad = wrong(found)
            print("%s: %s%s" % (name, json.dumps(found), "; WRONG: " + ", ".join(bad) if bad else ""))
            failed |= bool(bad)
        else:
            print("%s: as expected" % name)
    return int(failed)


sys.exit(main())
