"""python3 -m alpenglow [options of alpenglow render] SCRIPT.py [its arguments]: runs a script that says `import prman`, with these
options for every context that renders: --spp 16, --format 320x240, --hider path, -v, --allow-exec ..."""
from __future__ import annotations

import os
import runpy
import sys

from . import _context, prman


def main() -> int:
    words = sys.argv[1:]
    at = next((i for i, w in enumerate(words) if w.endswith(".py")), None)
    if at is None:
        print(__doc__, file=sys.stderr)
        return 0 if words[:1] in (["-h"], ["--help"]) else 2
    _context.default_flags = words[:at]
    prman.Init = lambda arguments=(): None  # the command line has the last word
    sys.modules["prman"] = prman
    sys.argv = words[at:]
    sys.path.insert(0, os.path.dirname(os.path.abspath(sys.argv[0])))
    runpy.run_path(sys.argv[0], run_name="__main__")
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except prman.Error as e:
        print(f"alpenglow: {e}", file=sys.stderr)
        sys.exit(2)
