"""What the renderer reports, for people and for programs."""
from __future__ import annotations

import sys
from typing import Any, Callable, Dict, List, Optional

from . import _alpenglow

Error = _alpenglow.Error

_LEVELS = {"info": 0, "warning": 1, "error": 2, "severe": 3}


class Message:
    """One message: a fault of a scene or of a shader, with its place, or a note.

    severity: "info", "warning", "error" or "severe". code: of RISpec 3.2, 7.2. file, line, column: 0 and "" where they are not
    known. hint: what may help, or "". str() gives what the program prints."""

    __slots__ = ("severity", "code", "file", "line", "column", "message", "hint", "_text")

    def __init__(self, found: Dict[str, Any]) -> None:
        self.severity: str = found["severity"]
        self.code: int = found["code"]
        self.file: str = found["file"]
        self.line: int = found["line"]
        self.column: int = found["column"]
        self.message: str = found["message"]
        self.hint: str = found["hint"]
        self._text: str = found["text"]

    @property
    def level(self) -> int:
        """0 to 3, RIE_INFO to RIE_SEVERE."""
        return _LEVELS[self.severity]

    def __str__(self) -> str:
        return self._text.rstrip("\n")

    def __repr__(self) -> str:
        return f"<alpenglow.Message {self.severity}: {self.message}>"


class Receiver:
    """Collects messages, and prints those of at least a severity to sys.stderr."""

    def __init__(self, least: str = "warning", then: Optional[Callable[[Message], None]] = None) -> None:
        self.all: List[Message] = []
        self.least = _LEVELS[least]
        self.then = then

    def __call__(self, found: Dict[str, Any]) -> None:
        message = Message(found)
        self.all.append(message)
        if message.level >= self.least or (found["always"] and self.least <= 1):
            print(str(message), file=sys.stderr)
        if self.then:
            self.then(message)

    @property
    def errors(self) -> List[Message]:
        return [m for m in self.all if m.level >= 2]

    @property
    def warnings(self) -> List[Message]:
        return [m for m in self.all if m.level == 1]


def first_error(messages: List[Message], otherwise: str) -> Error:
    """The exception for the first error among messages, with all of them as its attribute `messages`."""
    errors = [m for m in messages if m.level >= 2]
    e = Error(str(errors[0]) if errors else otherwise)
    e.messages = messages
    return e
