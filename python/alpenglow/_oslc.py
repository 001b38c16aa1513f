"""oslc FILE.osl ...: what scripts for PRMan run before they render. Shaders are read as source here: each is checked, and a note
FILE.oso stands in place of the object file, for scripts that look for it. A render reads FILE.osl."""
from __future__ import annotations

import os
import sys
from typing import List, Optional, Sequence

#: Flags of oslc that have a value behind them.
_VALUED = ("-o", "-I", "-D", "-U")
_NOTE = "OpenShadingLanguage: no code. Alpenglow reads {} itself.\n"


def add_to_path() -> None:
    """Puts the folder of this oslc behind PATH, so that scripts that import prman find one."""
    folder = os.path.join(os.path.dirname(os.path.abspath(__file__)), "bin")
    path = os.environ.get("PATH", os.defpath)
    if folder not in path.split(os.pathsep) and os.path.isfile(os.path.join(folder, "oslc")):
        os.environ["PATH"] = path + os.pathsep + folder
        os.environ["ALPENGLOW_PYTHON"] = sys.executable


def _find(name: str) -> Optional[str]:
    """The file, also in other case, as scripts from systems that do not tell it apart name it."""
    if os.path.exists(name):
        return name
    folder, base = os.path.split(name)
    try:
        same = sorted(f for f in os.listdir(folder or ".") if f.lower() == base.lower())
    except OSError:
        return None
    return os.path.join(folder, same[0]) if same else None


def main(arguments: Sequence[str]) -> int:
    files: List[str] = []
    output = None
    rest = iter(arguments)
    for word in rest:
        if word in _VALUED:
            value = next(rest, None)
            output = value if word == "-o" else output
        elif not word.startswith("-"):
            files.append(word)
    if not files:
        print(__doc__, file=sys.stderr)
        return 0 if arguments and arguments[0] in ("-h", "--help") else 1
    from . import compile as check
    failed = 0
    for name in files:
        path = _find(name)
        if path is None:
            print(f"oslc: error: {name} was not found", file=sys.stderr)
            failed = 1
            continue
        said = check(path)
        for message in said:
            print(str(message).rstrip(), file=sys.stderr)
        if any(m.level >= 2 for m in said):
            failed = 1
            continue
        if path != name:  # scripts would look for the time of a file that is not there
            print(f"oslc: warning: {name} was not found; {path} is checked", file=sys.stderr)
            continue
        with open(output or os.path.splitext(name)[0] + ".oso", "w", encoding="utf-8") as note:
            note.write(_NOTE.format(os.path.basename(path)))
    return failed


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
