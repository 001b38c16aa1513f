"""Keyword arguments as options of `alpenglow render`, which describes and checks them."""
from __future__ import annotations

import os
from typing import Any, List

from ._messages import Error

#: How the parts of a sequence are written, where that is not by commas.
_JOINED = {"format": "x", "samples": ":", "part": "/", "searchpath": ":"}
#: Options that may come more than once.
_REPEATED = {"display", "rib"}
_SHORT = {"output": "-o", "o": "-o", "q": "-q", "v": "-v"}


def _text(value: Any) -> str:
    if isinstance(value, float):
        return repr(value)
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if isinstance(value, bytes):
        return os.fsdecode(value)
    return str(value)


def flags(options: dict) -> List[str]:
    """spp=16, format=(640, 480), allow_exec=True to ["--spp", "16", "--format", "640x480", "--allow-exec"]."""
    made: List[str] = []
    for name, value in options.items():
        flag = _SHORT.get(name, "--" + name.replace("_", "-"))
        if value is None or value is False:
            continue
        if value is True:
            made.append(flag)
        elif name in _REPEATED and not isinstance(value, str):
            for v in value:
                made += [flag, _text(v)]
        elif isinstance(value, dict):
            raise Error(f"{name}: takes a text, a number or a sequence of them, not a dictionary")
        elif isinstance(value, (list, tuple, range)):
            made += [flag, _JOINED.get(name, ",").join(_text(v) for v in value)]
        else:
            made += [flag, _text(value)]
    return made
