"""Alpenglow in Python: scenes to arrays, RSL on arrays, and the RenderMan Interface.

    import alpenglow
    result = alpenglow.render("scene.rib", spp=64, hider="path")
    result.image            # float32, height x width x channels
    result["N"]             # an output by name, where a display shows it
    result.stats            # what --stats writes

alpenglow.prman is in the shape of Pixar's prman, alpenglow.ri in that of cgkit's ri. docs/python.md tells more."""
from __future__ import annotations

import json
import os
from typing import Any, Callable, Dict, List, Optional, Sequence, Tuple, Union

from . import _alpenglow
from ._messages import Error, Message, Receiver, first_error

__all__ = ["Error", "Interrupted", "Message", "Picture", "Result", "compile", "eval", "info", "render", "requests", "shade",
           "version"]

#: "0.2.0"
__version__ = _alpenglow.software().split()[1]

Scene = Union[str, bytes, "os.PathLike[str]"]


def version() -> str:
    """Name, version and commit: "Alpenglow 0.2.0 (5f06283)"."""
    return _alpenglow.software()


def __getattr__(name: str) -> Any:
    if name in ("Picture", "Result"):  # they need NumPy, which the RenderMan Interface does not
        from . import _result
        return getattr(_result, name)
    raise AttributeError(f"module 'alpenglow' has no attribute {name!r}")


class Interrupted(KeyboardInterrupt):
    """Ctrl-C while render() was at work. `result` has what was done: under path the passes that are whole."""

    def __init__(self, result: Any) -> None:
        super().__init__("rendering was interrupted")
        self.result = result


def _is_rib(text: str) -> bool:
    return "\n" in text or "WorldBegin" in text


def _scenes(scene: Union[Scene, Sequence[Scene]]) -> List[Tuple[str, Optional[bytes]]]:
    if not isinstance(scene, (list, tuple)):
        scene = [scene]  # type: ignore[list-item]
    made: List[Tuple[str, Optional[bytes]]] = []
    for s in scene:
        if isinstance(s, bytes):
            made.append(("RIB", s))
        elif isinstance(s, str) and _is_rib(s):
            made.append(("RIB", s.encode()))
        elif isinstance(s, (str, os.PathLike)):
            made.append((os.fspath(s), None))
        else:
            raise Error(f"a scene is a path, RIB as text or bytes, or a list of these, not {type(s).__name__}")
    if not made:
        raise Error("there is no scene")
    return made


def render(scene: Union[Scene, Sequence[Scene]], *, aovs: Sequence[str] = (), write: bool = False, strict: bool = False,
           progress: Optional[Callable[[Dict[str, Any]], Optional[bool]]] = None,
           message: Optional[Callable[[Message], None]] = None, quiet: bool = False, verbose: bool = False,
           **options: Any) -> Any:
    """Renders a scene and gives back a Result.

    scene: the path of a RIB file or of a model, RIB itself (a str with a line end or WorldBegin in it, or bytes, also binary or
    gzipped), or a list of these. options: those of `alpenglow render`, with _ for -: spp=16, hider="path", format=(640, 480),
    noise=0.02, threads=4, searchpath=["shaders"], allow_exec=True, rib='Option ...', output="x.exr".

    aovs: outputs of shaders to render beside what the scene's displays show: ["N", "z", "albedo"].
    write: the scene's displays write their files, too; without it nothing is written but what output= names.
    strict: any error of the scene raises Error; otherwise Error comes only where nothing could be rendered.
    progress: called about 20 times a second with {"fraction": 0..1 or negative where nobody knows, "samples", "total", "noise",
    "rays_per_ms", "what"}. False as its answer ends the render as Ctrl-C would. What it raises ends it and is raised.
    message: called with each Message. Warnings and errors are printed to sys.stderr; quiet: errors only; verbose: notes, too.

    Ctrl-C raises Interrupted (a KeyboardInterrupt), whose `result` has what was done. Other threads of Python run meanwhile."""
    from ._result import Result
    from ._options import flags

    given = dict(options)
    displays = given.pop("display", [])
    displays = [displays] if isinstance(displays, str) else list(displays)
    displays += [f"null:{name}:{name}" for name in aovs]
    receiver = Receiver("error" if quiet else "info" if verbose else "warning", message)
    made = _alpenglow.render(flags({**given, "display": displays}), _scenes(scene), write or bool(given.get("output") or given.get("o")),
                             receiver, progress)
    result = Result(made, receiver.all)
    raised = made["raised"]
    if raised is not None:
        if type(raised) is KeyboardInterrupt:
            raise Interrupted(result) from None
        raise raised
    if (not result.frames_rendered and not result.interrupted) or (strict and result.errors):
        raise first_error(receiver.all, "no world was rendered: there is none between WorldBegin and WorldEnd in what was read")
    return result


def eval(expression: str, *, setup: str = "", lanes: int = 16, dialect: str = "", allow_exec: bool = False, **variables: Any) -> Any:
    """The value of an RSL expression, as `alpenglow eval` has it: a float, a str, or an array of the numbers of a colour, point,
    vector, normal or matrix; of statements what they printed.

    setup: statements that run first. variables: predefined ones (P=, N=, u=, Cs= ...), each one value, or an array with a value
    for each point; then the answer is an array, too. Points have three numbers in the last dimension."""
    receiver = Receiver("severe")
    found = _alpenglow.evaluate(expression, setup, lanes, dialect, allow_exec, receiver)
    if not found["ok"]:
        raise first_error(receiver.all, "the expression cannot be evaluated")
    if variables:
        if found["type"] in ("void", "string"):
            raise Error("only numbers can be evaluated on arrays")
        text = f"surface eval(output varying {found['type']} result = 0;) {{\n{setup}\n; result = (\n{expression}\n); }}\n"
        made = shade("eval", source=text, outputs=["result"], lanes=lanes, dialect=dialect, allow_exec=allow_exec, **variables)
        return made["result"]
    if found["type"] == "void" or not found["numbers"]:
        return found["printed"]
    if found["type"] == "string":
        return found["text"]
    if len(found["numbers"]) == 1:
        return found["numbers"][0]
    import numpy
    return numpy.array(found["numbers"], numpy.float32)


#: Predefined variables with one number; the others have three.
_SCALARS = {"u", "v", "s", "t", "du", "dv", "time", "dtime", "ncomps", "alpha"}
_TRIPLES = {"P", "N", "Ng", "I", "E", "dPdu", "dPdv", "dPdtime", "Cs", "Os", "Ci", "Oi"}


def shade(shader: str, *, outputs: Sequence[str] = (), params: Optional[Dict[str, Any]] = None, source: str = "", kind: str = "",
          searchpath: Sequence[str] = (), lanes: int = 16, dialect: str = "", allow_exec: bool = False, quiet: bool = False,
          **variables: Any) -> Dict[str, Any]:
    """Runs a shader at points and gives back its outputs by name, float32 arrays in the shape of the points.

    shader: a name on the search path, or a file. source: its text instead. variables: predefined ones, each a value for all points or
    an array of them: P= and N= of any shape with 3 in the last dimension, u= and v= of that shape without it. What is not given is
    as on the unit patch of `alpenglow shade --patch`: P is (u, v, 0), N (0, 0, 1), Cs and Os 1. params: of the shader; one value, or
    one for each point. outputs: names; when there are none those of the shader's kind (Ci and Oi of a surface, P and N of a
    displacement). There are no lights and nothing for rays to meet. Error where the shader cannot be run."""
    import numpy

    shape: Optional[Tuple[int, ...]] = None
    rows: Dict[str, Any] = {}

    def points_of(name: str, value: Any, width: int) -> Any:
        nonlocal shape
        array = numpy.asarray(value, numpy.float32)
        lead = array.shape[:-1] if width > 1 else array.shape
        if width > 1 and (not array.shape or array.shape[-1] != width):
            raise Error(f"{name}: its last dimension is {array.shape[-1:] or 'missing'}, not {width}")
        if not lead:
            return (array.reshape(-1), False)
        if shape is not None and lead != shape:
            raise Error(f"{name}: has {lead} points where others have {shape}")
        shape = lead
        return (array.reshape(-1, width) if width > 1 else array.reshape(-1), True)

    for name, value in variables.items():
        if name not in _SCALARS and name not in _TRIPLES:
            raise Error(f"there is no predefined variable {name!r}; parameters go into params=")
        rows[name] = points_of(name, value, 1 if name in _SCALARS else 3)
    numbers: Dict[str, Any] = {}
    strings: Dict[str, str] = {}
    for name, value in (params or {}).items():
        if isinstance(value, str):
            strings[name] = value
            continue
        array = numpy.asarray(value, numpy.float32)
        each = shape is not None and array.ndim >= len(shape) and array.shape[:len(shape)] == shape and array.ndim - len(shape) <= 1
        if each:
            width = array.shape[-1] if array.ndim > len(shape) else 1
            numbers[name] = (array.reshape(-1, width) if width > 1 else array.reshape(-1), True)
        else:
            numbers[name] = (array.reshape(-1), False)
    count = int(numpy.prod(shape)) if shape is not None else 1
    receiver = Receiver("error" if quiet else "warning")
    receiver.least = 3 if quiet else 1
    made = _alpenglow.shade(shader, source, kind, count, rows, numbers, strings, list(outputs), [os.fspath(s) for s in searchpath],
                            lanes, dialect, allow_exec, receiver)
    if not made:
        raise first_error(receiver.all, "the shader gives nothing back")
    lead = shape or ()
    return {name: a.reshape(lead + (a.shape[1],)) if a.shape[1] > 1 else a.reshape(lead) for name, a in made.items()}


def info(shader: str, *, searchpath: Sequence[str] = (), dialect: str = "", allow_exec: bool = False) -> Dict[str, Any]:
    """What a shader is: its kind, parameters with defaults, what it writes; as `alpenglow info --json` has it."""
    receiver = Receiver("severe")
    text = _alpenglow.info(shader, [os.fspath(s) for s in searchpath], dialect, allow_exec, receiver)
    if not text:
        raise first_error(receiver.all, "there is no such shader")
    return json.loads(text)


def compile(shader: str, *, searchpath: Sequence[str] = (), dialect: str = "", allow_exec: bool = False) -> List[Message]:
    """Checks a shader: its messages, which are none where there is nothing to say."""
    receiver = Receiver("severe")
    receiver.least = 4
    _alpenglow.info(shader, [os.fspath(s) for s in searchpath], dialect, allow_exec, receiver)
    return receiver.all


def requests() -> List[Dict[str, Any]]:
    """Every request of the RenderMan Interface: name, signature, arguments, doc."""
    return _alpenglow.requests()
