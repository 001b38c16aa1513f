"""The RenderMan Interface in the shape of cgkit's module `ri`: functions of the C binding, parameters as pairs or keywords.

    from alpenglow.ri import *
    RiBegin("alpenglow")             # renders; "scene.rib" writes RIB, RI_NULL writes it to standard output
    RiDisplay("sphere.exr", "openexr", "rgba")
    RiProjection(RI_PERSPECTIVE, fov=40)
    RiWorldBegin()
    RiTranslate(0, 0, 5)
    RiSurface("matte", Kd=0.8)
    RiSphere(1, -1, 1, 360, "Cs", [1, 0, 0])
    RiWorldEnd()
    RiEnd()

Arguments are those of the requests in RIB: counts that follow from lists are not given. RiBegin() makes a context current, which is
that of the whole process, as in C; each has a handle for RiContext()."""
from __future__ import annotations

import sys
from typing import Any, Callable, Dict, List, Optional, Sequence, Tuple

from . import _context
from ._context import REQUESTS, Context, Filter, format_record
from ._messages import Error
from ._tokens import ERRORS, NUMBERS, SEVERITIES, TOKENS

__all__: List[str] = ["RIException"]

RIException = Error


class _State:
    """The contexts that are open, and the current one."""

    def __init__(self) -> None:
        self.current: Optional[Context] = None
        self.handler: Any = "print"

    def context(self) -> Context:
        if self.current is None:
            self.current = Context()
            self.current.set_handler(self.handler)
        return self.current


_state = _State()


def _parameters(request: str, rest: Sequence[Any], keywords: Dict[str, Any]) -> Dict[str, Any]:
    parameters: Dict[str, Any] = {}
    rest = [r for r in rest if r is not None]  # RI_NULL ends C's lists
    at = 0
    while at < len(rest):
        if isinstance(rest[at], dict):
            parameters.update(rest[at])
            at += 1
        elif isinstance(rest[at], str) and at + 1 < len(rest):
            parameters[rest[at]] = rest[at + 1]
            at += 2
        else:
            raise Error(f"Ri{request}: parameters are pairs of a name and a value")
    parameters.update(keywords)
    return parameters


def _split(request: Dict[str, Any], arguments: Tuple[Any, ...]) -> Tuple[Tuple[Any, ...], Tuple[Any, ...]]:
    """Arguments of the signature, and what comes behind them."""
    at = 0
    for _, form, count, optional in request["arguments"]:
        if at >= len(arguments):
            break
        value = arguments[at]
        if optional and (isinstance(value, str) != (form == "string")) and not isinstance(value, (list, tuple)):
            continue
        at += 1
        if form in ("number", "int") and count > 1:  # four numbers, or one list of them
            taken = 1
            while taken < count and isinstance(value, (int, float)) and at < len(arguments) and not isinstance(arguments[at], str):
                at += 1
                taken += 1
    return arguments[:at], arguments[at:]


def _function(request: Dict[str, Any]) -> Callable:
    name = request["name"]

    def function(*arguments: Any, **keywords: Any) -> None:
        own, rest = _split(request, arguments)
        parameters = _parameters(name, rest, keywords)
        if parameters and not request["parameters"]:
            raise Error(f"Ri{name} takes no parameters")
        _state.context().call(name, own, parameters or None)

    function.__name__ = function.__qualname__ = "Ri" + name
    function.__doc__ = f"{name} {request['signature']}\n\n{request['doc']}"
    return function


def RiBegin(name: Optional[str] = None) -> Context:
    """A file name writes RIB; RI_NULL writes it to standard output, as cgkit does; the name of a renderer renders. Gives back a
    handle for RiContext()."""
    context = Context()
    context.set_handler(_state.handler)
    _state.current = context
    context.begin("-" if name is None else name)
    return context


def RiEnd() -> None:
    _state.context().end()


def RiGetContext() -> Context:
    return _state.context()


def RiContext(handle: Context) -> None:
    """Makes a context current."""
    if not isinstance(handle, Context):
        return _state.context().fault(ERRORS["BADHANDLE"], "RiContext: there is no such context")
    _state.current = handle


def RiErrorIgnore(code: int, severity: int, message: str) -> None:
    """A handler that does nothing."""


def RiErrorPrint(code: int, severity: int, message: str) -> None:
    """A handler that prints."""
    print(message, file=sys.stderr)


def RiErrorAbort(code: int, severity: int, message: str) -> None:
    """A handler that raises RIException, of errors."""
    if severity >= SEVERITIES["ERROR"]:
        raise Error(message)


def RiErrorHandler(handler: Any) -> None:
    """RiErrorPrint, RiErrorIgnore, RiErrorAbort, or a function of code, severity and message."""
    known = {RiErrorIgnore: "ignore", RiErrorPrint: "print", RiErrorAbort: "abort"}
    _state.handler = known.get(handler, handler)
    _state.context().set_handler(_state.handler)


def RiDeclare(name: str, declaration: str) -> str:
    _state.context().call("Declare", (name, declaration))
    return name


def RiArchiveRecord(kind: str, text: str, *values: Any) -> None:
    _state.context().record(kind, format_record(text, values))


def RiReadArchive(name: str, callback: Optional[Callable] = None, *rest: Any, **keywords: Any) -> None:
    """callback(kind, text) hears the archive's comments."""
    _state.context().read_archive(name, callback, _parameters("ReadArchive", rest, keywords) or None)


def RiObjectBegin(*rest: Any) -> str:
    context = _state.context()
    handle = context.new_handle("object")
    context.call("ObjectBegin", (handle,))
    return handle


def RiLightSource(name: str, *rest: Any, **keywords: Any) -> str:
    return _state.context().light("LightSource", name, _parameters("LightSource", rest, keywords))


def RiAreaLightSource(name: str, *rest: Any, **keywords: Any) -> str:
    return _state.context().light("AreaLightSource", name, _parameters("AreaLightSource", rest, keywords))


def RiMotionBegin(*times: Any) -> None:
    flat = times[0] if len(times) == 1 and not isinstance(times[0], (int, float)) else times
    _state.context().call("MotionBegin", (list(flat),))


def RiTransformPoints(from_space: str, to_space: str, points: Any) -> Optional[List[float]]:
    return _state.context().transform_points(from_space, to_space, points)


def RiProcFree(data: Any) -> None:
    """A free function that does nothing: Python frees."""


def _built_in(kind: str) -> Callable:
    def procedure(data: Any, detail: float) -> None:
        arguments = [data] if isinstance(data, str) else list(data)
        _state.context().call("Procedural", (kind, arguments, [-1e30, 1e30] * 3))

    procedure.__name__ = "RiProc" + kind
    procedure.kind = kind  # type: ignore[attr-defined]
    return procedure


RiProcDelayedReadArchive = _built_in("DelayedReadArchive")
RiProcRunProgram = _built_in("RunProgram")
RiProcDynamicLoad = _built_in("DynamicLoad")


def RiProcedural(data: Any, bound: Sequence[float], subdivide: Callable, free: Optional[Callable] = None) -> None:
    """subdivide(data, detail) makes the content by requests, at once; free(data) is called then."""
    kind = getattr(subdivide, "kind", None)
    try:
        if kind:
            _state.context().call("Procedural", (kind, [data] if isinstance(data, str) else list(data), bound))
        else:
            _state.context().procedural(lambda detail: subdivide(data, detail), bound)
    finally:
        if callable(free):
            free(data)


for _name, _request in REQUESTS.items():
    if _name[0].isupper() and "Ri" + _name not in globals():
        globals()["Ri" + _name] = _function(_request)
for _name, _value in {**TOKENS, **NUMBERS}.items():
    globals()["RI_" + _name] = _value
RI_NULL = None
for _name, _value in {**ERRORS, **SEVERITIES}.items():
    globals()["RIE_" + _name] = _value
RiBoxFilter, RiTriangleFilter, RiCatmullRomFilter, RiGaussianFilter, RiSincFilter = map(
    Filter, ("box", "triangle", "catmull-rom", "gaussian", "sinc"))
RiBezierBasis, RiBSplineBasis, RiCatmullRomBasis, RiHermiteBasis, RiPowerBasis = (
    "bezier", "b-spline", "catmull-rom", "hermite", "power")


def __getattr__(name: str) -> Any:
    if name == "RiLastError":
        return _state.context().last_error
    raise AttributeError(f"there is no {name}" + _context.near(name, list(globals())))


__all__ += [n for n in globals() if n.startswith(("Ri", "RI_", "RIE_"))]
