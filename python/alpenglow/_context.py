"""From RiBegin to RiEnd: what alpenglow.prman and alpenglow.ri share."""
from __future__ import annotations

import difflib
import os
import shlex
import sys
from typing import Any, Callable, Dict, List, Optional, Sequence, Tuple

from . import _alpenglow
from ._messages import Error, Message, Receiver
from ._tokens import TOKENS

_HERE = os.path.dirname(os.path.abspath(__file__))
_RENDER = ("__render", "alpenglow", "prman", "renderdl", "aqsis", "rendrib", "render")

REQUESTS: Dict[str, Dict[str, Any]] = {r["name"]: r for r in _alpenglow.requests()}

#: Flags of `alpenglow render` for contexts that begin from here on (prman.Init()), behind those of the environment.
default_flags: List[str] = []


def place() -> Tuple[str, int]:
    """File and line of the caller outside of this package."""
    frame = sys._getframe(1)
    while frame.f_back and os.path.dirname(frame.f_code.co_filename) == _HERE:
        frame = frame.f_back
    return frame.f_code.co_filename, frame.f_lineno


class Context:
    """What requests go to. Before begin() only Option and Declare are taken, and done when it comes."""

    def __init__(self, keep: bool = False, progress: Optional[Callable] = None, flags: Optional[Sequence[str]] = None) -> None:
        self._session: Any = None
        self._pending: List[Tuple] = []
        self._rib: Dict[str, Any] = {}
        self._opening: Optional[str] = None  # a RIB file whose Option "rib" may still come
        self._handler: Any = "print"
        self._keep = keep
        self._progress = progress
        self._flags = flags
        self._serial = 0
        self._receiver = Receiver("warning", self._heard)
        self._raised: Optional[Error] = None
        self.last_error = 0

    # --- errors ---

    def _heard(self, message: Message) -> None:
        if message.level >= 2:
            self.last_error = message.code
        if callable(self._handler):
            self._handler(message.code, message.level, message.message)
        elif self._handler == "abort" and message.level >= 2:
            raise Error(str(message))

    def set_handler(self, handler: Any) -> None:
        """"print", "ignore", "abort" (an error raises Error), or a function of code, severity (0 to 3) and text."""
        if isinstance(handler, str):
            handler = str(handler)
        self._handler = handler
        quiet = callable(handler) or handler == "ignore"
        self._receiver.least = 4 if quiet else 1
        if handler == "abort":
            self._receiver.least = 1

    @property
    def messages(self) -> List[Message]:
        return self._receiver.all

    def fault(self, code: int, text: str) -> None:
        file, line = place()
        if self._session is not None:
            self._session.fault(code, text, file, line)
            return
        self._receiver({"severity": "error", "code": code, "file": file, "line": line, "column": 0, "message": text, "hint": "",
                        "text": f"{file}:{line}: error: {text}\n", "always": False})

    # --- begin and end ---

    @property
    def open(self) -> bool:
        return self._session is not None or self._opening is not None

    def begin(self, name: Optional[str]) -> None:
        if self.open:
            return self.fault(24, "Begin within Begin")
        self._rib_kept = dict(self._rib)
        if name is None or os.path.basename(str(name)) in _RENDER and not os.path.splitext(str(name))[1]:
            flags = shlex.split(os.environ.get("ALPENGLOW_OPTIONS", ""))
            flags += default_flags if self._flags is None else self._flags
            self._session = _alpenglow.Session(flags, place()[0], self._keep, self._receiver, self._progress)
            self._replay()
        elif str(name).startswith("|"):
            raise Error("a pipe to a program is not opened: write a file, or \"-\" for standard output")
        else:
            self._opening = os.fspath(name)

    def _replay(self) -> None:
        pending, self._pending = self._pending, []
        for request, arguments, parameters, file, line in pending:
            self._session.call(request, file, line, parameters, *arguments)

    def _opened(self) -> Any:
        """The session; makes the RIB file when its first request comes."""
        if self._opening is not None:
            name, self._opening = self._opening, None

            def of(key: str, default: str = "") -> str:
                value = self._rib.get(key, default)
                return str(value[0] if isinstance(value, (list, tuple)) and value else value)

            style = of("asciistyle")
            gzip = "gzip" in of("compression") or name.endswith((".gz", ".ribz"))
            sys.stdout.flush()
            self._session = _alpenglow.rib_writer(name, of("format") == "binary", gzip, 4 if "indented" in style else 0,
                                                  0 if "wide" in style else 100, self._receiver)
            self._replay()
        return self._session

    def end(self) -> None:
        session = self._opened()
        if session is None:
            return self.fault(23, "End without Begin")
        try:
            session.end(*place())
        finally:
            self._session = None
            self._last = session

    @property
    def finished(self) -> Any:
        """The session that is open, or the last one."""
        return self._session or getattr(self, "_last", None)

    # --- requests ---

    def new_handle(self, kind: str) -> str:
        self._serial += 1
        return f"{kind}_{self._serial}"

    def call(self, request: str, arguments: Sequence[Any] = (), parameters: Optional[Dict[str, Any]] = None) -> None:
        file, line = place()
        if request == "Option" and arguments and arguments[0] == "rib" and parameters:
            for token, value in parameters.items():
                self._rib[token.split()[-1]] = value
            if self._session is None or self._session.writing:
                return  # how RIB is written is no part of it
        session = self._session if self._opening is None else self._opened()
        if session is None:
            if request in ("Option", "Declare"):
                self._pending.append((request, tuple(arguments), parameters, file, line))
                return
            return self.fault(23, f"{request} before Begin")
        session.call(request, file, line, parameters, *arguments)

    def light(self, request: str, name: str, parameters: Dict[str, Any]) -> str:
        parameters = dict(parameters)
        handle = parameters.pop(TOKENS["HANDLEID"], None)
        for token in [t for t in parameters if t.split()[-1:] == [TOKENS["HANDLEID"]]]:
            handle = parameters.pop(token)
        if isinstance(handle, (list, tuple)):
            handle = handle[0] if handle else None
        handle = str(handle) if handle is not None else self.new_handle("light")
        self.call(request, (name, handle), parameters)
        return handle

    def record(self, kind: str, text: str) -> None:
        session = self._opened()
        if session is None:
            return self.fault(23, "ArchiveRecord before Begin")
        session.record(str(kind), text, *place())

    def read_archive(self, name: str, heard: Optional[Callable], parameters: Optional[Dict[str, Any]]) -> None:
        session = self._opened()
        if heard is None or session is None:
            return self.call("ReadArchive", (name,), parameters)
        session.read_archive(name, heard, *place())

    def procedural(self, make: Callable[[float], Any], bound: Sequence[float]) -> None:
        session = self._opened()
        if session is None:
            return self.fault(23, "Procedural before Begin")
        session.procedural(make, bound, *place())

    def transform_points(self, from_space: str, to_space: str, points: Any) -> Any:
        session = self._opened()
        return session.transform_points(from_space, to_space, points) if session is not None else None


def format_record(text: str, values: Sequence[Any]) -> str:
    """RiArchiveRecord's format and values."""
    return text % tuple(values) if values else text


def near(name: str, names: Sequence[str]) -> str:
    found = difflib.get_close_matches(name, names, 1)
    return f"; did you mean {found[0]}?" if found else ""


class Filter(str):
    """The name of a pixel filter, which is also the function (RISpec 3.2, appendix E)."""

    def __call__(self, x: float, y: float, xwidth: float, ywidth: float) -> float:
        from ._filters import FILTERS
        return FILTERS[str(self)](x, y, xwidth, ywidth)
