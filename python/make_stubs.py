#!/usr/bin/env python3
"""Writes alpenglow/prman.pyi and alpenglow/ri.pyi beside this file, from the table of requests and the signatures of the rest:

    PYTHONPATH=build/release/python python3 python/make_stubs.py [FOLDER]

tests/python/package_test.py holds them to it."""
import inspect
import os
import sys

import alpenglow
from alpenglow import prman, ri

HEAD = '''"""Made by python/make_stubs.py."""
from typing import Any, Callable, Dict, List, Optional, Sequence, Tuple, Union

from ._context import Context, Filter
from ._messages import Error as Error, Message

'''
TYPES = {"number": "float", "int": "int", "string": "str", "handle": "Union[str, int]", "basis": "Union[str, Sequence[float]]"}
KEYWORDS = {"from", "None", "True", "False", "lambda", "in", "is", "type"}


def arguments_of(request):
    """Parameters of a method; numbers that may come one by one or as a list make all of them positional."""
    made = []
    for name, form, count, optional in request["arguments"]:
        kind = TYPES[form]
        if form in ("number", "int") and count > 1:
            return ["*arguments: Any"] + (["**parameters: Any"] if request["parameters"] else [])
        if count == 0:
            kind = f"Sequence[{kind}]"
        made.append(f"{name + '_' if name in KEYWORDS else name}: " + (f"Optional[{kind}] = ..." if optional else kind))
    if request["parameters"]:
        made += ["*parameters: Any", "**keywords: Any"]
    return made


def signature_of(function):
    made = []
    for p in inspect.signature(function).parameters.values():
        text = {p.VAR_POSITIONAL: "*", p.VAR_KEYWORD: "**"}.get(p.kind, "") + p.name
        if p.kind == p.KEYWORD_ONLY and not any(m.startswith("*") for m in made):
            made.append("*")
        if p.annotation is not p.empty:
            text += f": {p.annotation}"
        if p.default is not p.empty:
            text += " = ..."
        made.append(text)
    result = inspect.signature(function).return_annotation
    return f"({', '.join(made)}) -> {'None' if result is inspect.Signature.empty else str(result)}: ..."


def prman_stub():
    lines = [HEAD + "def Init(arguments: Sequence[str] = ...) -> None: ...", "def Cleanup() -> None: ...",
             "def GetProgramName() -> str: ...", "", "class Ri:"]
    table = {r["name"]: r for r in alpenglow.requests()}
    for name, value in sorted(vars(prman.Ri).items()):
        if name.startswith("_") and name not in ("__init__", "__enter__", "__exit__"):
            continue
        if isinstance(value, property):
            lines += ["    @property", f"    def {name}{signature_of(value.fget)}"]
        elif inspect.isfunction(value):
            made = name in table and value.__module__ == "alpenglow.prman" and value.__code__.co_name == "method"
            lines.append(f"    def {name}" + (f"({', '.join(['self'] + arguments_of(table[name]))}) -> None: ..." if made
                                              else signature_of(value)))
        else:
            lines.append(f"    {name}: {'None' if value is None else type(value).__name__.replace('_BuiltIn', 'str')}")
    lines += ["", "class Ric:"] + [f"    def {n}{signature_of(f)}" for n, f in vars(prman.Ric).items() if inspect.isfunction(f)]
    return "\n".join(lines) + "\n"


def ri_stub():
    lines = [HEAD + "RIException = Error"]
    table = {"Ri" + r["name"]: r for r in alpenglow.requests()}
    for name in sorted(ri.__all__):
        value = getattr(ri, name)
        if name == "RIException":
            continue
        if inspect.isfunction(value):
            if name in table and value.__code__.co_name == "function":
                lines.append(f"def {name}({', '.join(arguments_of(table[name]))}) -> None: ...")
            else:
                lines.append(f"def {name}{signature_of(value)}")
        else:
            lines.append(f"{name}: {'None' if value is None else type(value).__name__}")
    return "\n".join(lines + ["RiLastError: int"]) + "\n"


if __name__ == "__main__":
    folder = sys.argv[1] if len(sys.argv) > 1 else os.path.join(os.path.dirname(os.path.abspath(__file__)), "alpenglow")
    for name, text in (("prman.pyi", prman_stub()), ("ri.pyi", ri_stub())):
        with open(os.path.join(folder, name), "w") as f:
            f.write(text)
