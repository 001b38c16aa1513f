"""The RenderMan Interface in the shape of Pixar's Python module.

    import prman                     # or: from alpenglow import prman
    ri = prman.Ri()
    ri.Begin("__render")             # renders; ri.Begin("scene.rib") writes RIB
    ri.Display("sphere.exr", "openexr", "rgba")
    ri.Projection(ri.PERSPECTIVE, {ri.FOV: 40})
    ri.WorldBegin()
    ri.Translate(0, 0, 5)
    ri.Surface("matte")
    ri.Sphere(1, -1, 1, 360, {"Cs": [1, 0, 0]})
    ri.WorldEnd()
    ri.End()

Arguments are those of the requests in RIB (docs/rib.md), with parameters in a dictionary at the end, or as keywords. Faults of the
scene are messages with the line of the script; `ri.ErrorHandler(ri.ERRORABORT)` makes them exceptions."""
from __future__ import annotations

import inspect
from typing import Any, Callable, Dict, List, Optional, Sequence

from . import _context, _oslc
from ._context import REQUESTS, Context, format_record, near
from ._messages import Error
from ._tokens import ERRORS, NUMBERS, SEVERITIES, TOKENS

_oslc.add_to_path()

__all__ = ["Cleanup", "Error", "GetProgramName", "Init", "Ri", "Ric"]


def Init(arguments: Sequence[str] = ()) -> None:
    """Flags of `alpenglow render`, or of prman, for all contexts that begin later: ["-t:4", "-progress"], ["--spp", "16"]."""
    _context.default_flags = [str(a) for a in arguments]


def Cleanup() -> None:
    """Takes back what Init() said."""
    _context.default_flags = []


def GetProgramName() -> str:
    return "alpenglow"


def _accepts(function: Callable, count: int) -> bool:
    try:
        inspect.signature(function).bind(*range(count))
    except (TypeError, ValueError):
        return False
    return True


class _BuiltIn(str):
    """Name of a procedural that the renderer has."""


class Ri:
    """A context. keep_pictures: `pictures` has what displays got, as arrays. progress: as of alpenglow.render(). flags: of
    `alpenglow render`, instead of Init()'s."""

    ProcDelayedReadArchive = _BuiltIn("DelayedReadArchive")
    ProcRunProgram = _BuiltIn("RunProgram")
    ProcDynamicLoad = _BuiltIn("DynamicLoad")
    Proc2DelayedReadArchive = _BuiltIn("DelayedReadArchive2")
    Proc2RunProgram = _BuiltIn("RunProgram2")
    Proc2DynamicLoad = _BuiltIn("DynamicLoad2")
    ProcFree = None
    SimpleBound = "SimpleBound"
    DSOBound = "DSOBound"
    LastError = 0
    PRMAN_VERSION_STR = "24.0"  # scripts ask which plug-ins there are; the materials are those of that release

    def __init__(self, *, keep_pictures: bool = False, progress: Optional[Callable] = None,
                 flags: Optional[Sequence[str]] = None) -> None:
        self._context = Context(keep_pictures, progress, flags)

    # --- contexts ---

    def Begin(self, name: Optional[str] = "__render", *ignored: Any) -> None:
        """"__render" renders; any other name is a RIB file to write, "-" standard output."""
        self._context.begin(name)

    def End(self) -> None:
        """Closes what is open, and the file."""
        self._context.end()

    def GetContext(self) -> "Ri":
        return self

    def Context(self, handle: "Ri") -> None:
        """Requests go to where those of another Ri go."""
        self._context = handle._context

    @property
    def messages(self) -> list:
        """What was reported so far."""
        return self._context.messages

    @property
    def pictures(self) -> list:
        """Pictures that came since this was asked last (keep_pictures=True)."""
        from ._result import Picture
        session = self._context.finished
        return [Picture(p) for p in session.pictures()] if session else []

    @property
    def stats(self) -> Dict[str, Any]:
        import json
        session = self._context.finished
        return json.loads(session.stats()) if session else {}

    # --- requests that are more than their RIB form ---

    def ErrorHandler(self, handler: Any) -> None:
        """ri.ERRORPRINT, ri.ERRORIGNORE, ri.ERRORABORT (raises Error), or a function of code, severity and text."""
        self._context.set_handler(handler)

    def Declare(self, name: str, declaration: str) -> str:
        self._context.call("Declare", (name, declaration))
        return name

    def ArchiveRecord(self, kind: str, text: str, *values: Any) -> None:
        """ri.COMMENT, ri.STRUCTURE, or ri.VERBATIM: RIB as it is, which is read where the context renders."""
        self._context.record(kind, format_record(text, values))

    def ReadArchive(self, name: str, *more: Any, **keywords: Any) -> None:
        """callback(kind, text), if there is one, hears the archive's comments."""
        heard = next((m for m in more if callable(m)), None)
        parameters = next((m for m in more if isinstance(m, dict)), {})
        self._context.read_archive(name, heard, {**parameters, **keywords} or None)

    def ObjectBegin(self, *name: Any) -> str:
        """A handle for ObjectInstance, a str."""
        handle = self._context.new_handle("object")
        parameters = next((n for n in name if isinstance(n, dict)), {})
        for n in list(name) + [v for k, v in parameters.items() if k.split()[-1:] == [TOKENS["HANDLEID"]]]:
            if isinstance(n, (list, tuple)) and n:
                n = n[0]
            if isinstance(n, (str, int)):
                handle = str(n)
        self._context.call("ObjectBegin", (handle,))
        return handle

    def LightSource(self, name: str, *more: Any, **keywords: Any) -> str:
        """A handle for Illuminate, a str; {ri.HANDLEID: name} chooses it."""
        return self._light("LightSource", name, more, keywords)

    def AreaLightSource(self, name: str, *more: Any, **keywords: Any) -> str:
        """The same for a light of the primitives that follow."""
        return self._light("AreaLightSource", name, more, keywords)

    def _light(self, request: str, name: str, more: Sequence[Any], keywords: Dict[str, Any]) -> str:
        parameters: Dict[str, Any] = {}
        for m in more:
            if isinstance(m, dict):
                parameters.update(m)
            elif isinstance(m, (str, int)):
                parameters.setdefault(TOKENS["HANDLEID"], str(m))
        parameters.update(keywords)
        return self._context.light(request, name, parameters)

    def MotionBegin(self, *times: Any) -> None:
        """Times, as a list or one by one."""
        self._context.call("MotionBegin", (times[0] if len(times) == 1 and not isinstance(times[0], (int, float)) else list(times),))

    def TransformPoints(self, from_space: str, to_space: str, points: Any) -> Optional[List[float]]:
        """Numbers of the points in the other space; None where a space is not known, or RIB is written."""
        return self._context.transform_points(from_space, to_space, points)

    def Procedural(self, data: Any, bound: Sequence[float], subdivide: Any = None, free: Optional[Callable] = None) -> None:
        """subdivide(data, detail), or (ri, data, detail), makes the content by requests, at once; free(data) is called then. What it
        raises comes out here. Ri.ProcDelayedReadArchive, Ri.ProcRunProgram and Ri.ProcDynamicLoad take data as in RIB. In RIB that
        is written the content stands instead."""
        if subdivide is None and isinstance(data, str):  # the RIB form
            raise Error("Procedural: takes data, bound, subdivide and free")
        if isinstance(subdivide, str) or subdivide is None:
            arguments = [data] if isinstance(data, str) else list(data)
            self._context.call("Procedural", (str(subdivide), arguments, bound))
        else:
            whole = _accepts(subdivide, 3) and not _accepts(subdivide, 2)
            try:
                self._context.procedural(
                    lambda detail: subdivide(self, data, detail) if whole else subdivide(data, detail), bound)
            finally:
                if callable(free):
                    free(data)
            return
        if callable(free):
            free(data)

    def Procedural2(self, subdivide: Any, bound: Any, *more: Any, **keywords: Any) -> None:
        """Ri.Proc2DelayedReadArchive with "string filename", or a function subdivide(ri, detail, parameters); the bound is "float[6]
        __bound" with Ri.SimpleBound, or what bound(parameters) gives."""
        parameters: Dict[str, Any] = {}
        for m in more:
            if not isinstance(m, dict):
                raise Error("Procedural2: takes a function, a bound and parameters")
            parameters.update(m)
        parameters.update(keywords)
        if isinstance(subdivide, str):
            known = {"__bound": "bound", "__data": "data"}
            named = {" ".join(k.split()[:-1] + [known.get(k.split()[-1], k.split()[-1])]) if k.split() else k: v
                     for k, v in parameters.items()}
            return self._context.call("Procedural2", (str(subdivide), str(bound)), named)
        plain = {k.split()[-1]: v for k, v in parameters.items() if k.split()}
        box = bound(parameters) if callable(bound) else plain.get("__bound", plain.get("bound"))
        self._context.procedural(lambda detail: subdivide(self, detail, parameters), [-1e30, 1e30] * 3 if box is None else box)

    def Options(self, name: str, handle: str = "", parameters: Optional[Dict[str, Any]] = None, **keywords: Any) -> None:
        """PRManOptions of PRMan 24: "type category:name" of each parameter is an Option, several numbers are an array. Left out are
        empty texts, which mean what there is already, and the categories that are requests of their own: Ri, hider, Shutter."""
        for token, value in {**(parameters or {}), **keywords}.items():
            kind, _, rest = token.rpartition(" ")
            category, colon, plain = rest.partition(":")
            values = [value] if isinstance(value, (str, int, float)) else list(value)
            if kind in ("int", "float", "string") and len(values) > 1:
                kind += f"[{len(values)}]"
            if colon and any(v != "" for v in values) and category not in ("Ri", "hider", "Shutter"):
                self._context.call("Option", (category,), {f"{kind} {plain}".strip(): value})

    def __getattr__(self, name: str) -> Any:
        raise AttributeError(f"there is no request and no constant {name}" + near(name, list(REQUESTS) + list(TOKENS)))

    def __enter__(self) -> "Ri":
        return self

    def __exit__(self, kind: Any, *_: Any) -> None:
        if kind is None and self._context.open:
            self.End()


def _method(request: Dict[str, Any]) -> Callable:
    name = request["name"]
    takes = request["parameters"]

    def method(self: Ri, *arguments: Any, **keywords: Any) -> None:
        parameters: Optional[Dict[str, Any]] = None
        if arguments and isinstance(arguments[-1], dict):
            parameters = arguments[-1]
            arguments = arguments[:-1]
        if keywords:
            parameters = {**(parameters or {}), **keywords}
        if parameters and not takes:
            raise Error(f"{name} takes no parameters")
        self._context.call(name, arguments, parameters or None)

    method.__name__ = method.__qualname__ = name
    method.__doc__ = f"{name} {request['signature']}\n\n{request['doc']}"
    return method


for _name, _request in REQUESTS.items():
    if _name not in vars(Ri):
        setattr(Ri, _name, _method(_request))
for _name, _value in {**TOKENS, **NUMBERS}.items():
    if _name not in vars(Ri):
        setattr(Ri, _name, _value)
for _name, _value in {**ERRORS, **SEVERITIES}.items():
    setattr(Ri, "RIE_" + _name, _value)
Ri.NULL = None  # type: ignore[attr-defined]
Ri.BOXFILTER, Ri.TRIANGLEFILTER, Ri.CATMULLROMFILTER, Ri.GAUSSIANFILTER, Ri.SINCFILTER = map(  # type: ignore[attr-defined]
    _context.Filter, ("box", "triangle", "catmull-rom", "gaussian", "sinc"))


class Ric:
    """Progress and the end of a render, for scripts that ask: there is nothing to do here, a render is over when WorldEnd returns."""

    def GetProgress(self) -> int:
        return 100

    def ProcessCallbacks(self) -> None:
        pass

    def Option(self, *ignored: Any) -> None:
        pass
