"""Pictures in memory."""
from __future__ import annotations

import json
import struct
import zlib
from typing import Any, Dict, Iterator, List, Optional, Tuple

import numpy

from ._messages import Message


def srgb(light: numpy.ndarray) -> numpy.ndarray:
    """Light from 0 to 1 by the curve of sRGB (IEC 61966-2-1), beyond it cut, as bytes."""
    x = numpy.clip(numpy.nan_to_num(light, nan=0.0), 0, 1)
    curved = numpy.where(x <= 0.0031308, 12.92 * x, 1.055 * numpy.power(x, 1 / 2.4) - 0.055)
    return numpy.rint(curved * 255).astype(numpy.uint8)


def png(pixels: numpy.ndarray) -> bytes:
    """Bytes of height x width x 3 (or 4, the last one coverage) as a PNG file (ISO 15948)."""
    height, width, channels = pixels.shape

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    rows = numpy.zeros((height, width * channels + 1), numpy.uint8)  # each row begins with its filter, 0
    rows[:, 1:] = pixels.reshape(height, -1)
    header = struct.pack(">IIBBBBB", width, height, 8, {3: 2, 4: 6}[channels], 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows.tobytes(), 6)) + chunk(b"IEND", b"")


class Picture:
    """One picture: what a Display would get, after filter and exposure and before the quantiser.

    name, type: of the Display. frame: number of its FrameBegin, 0 where there is none. size: (width, height) of the whole picture.
    window: (x0, y0, x1, y1), the pixels of it that are here (CropWindow). channels: names, "r", "g", "b", "a", "N.x" ... data: float32,
    height x width x channels, rows from the top."""

    def __init__(self, made: Dict[str, Any]) -> None:
        self.name: str = made["name"]
        self.type: str = made["type"]
        self.frame: int = made["frame"]
        self.size: Tuple[int, int] = made["size"]
        self.window: Tuple[int, int, int, int] = made["window"]
        self.pixel_aspect: float = made["pixel_aspect"]
        self.channels: List[str] = made["channels"]
        self.data: numpy.ndarray = made["data"]
        self._variables: Dict[str, Tuple[int, int]] = {}
        for name, first, count in made["variables"]:
            self._variables.setdefault(name, (first, count))

    @property
    def variables(self) -> List[str]:
        """Names that [] takes, beside those of channels: "Ci", "a", "z", "N" ..."""
        return list(self._variables)

    def __contains__(self, name: str) -> bool:
        return self._find(name) is not None

    def __getitem__(self, name: str) -> numpy.ndarray:
        """A variable: height x width, or height x width x its channels."""
        found = self._find(name)
        if found is None:
            raise KeyError(f"the picture has no {name!r}; it has {', '.join(self._variables)}")
        first, count = found
        return self.data[:, :, first] if count == 1 else self.data[:, :, first:first + count]

    def _find(self, name: str) -> Optional[Tuple[int, int]]:
        if name in self._variables:
            return self._variables[name]
        if name in self.channels:
            return self.channels.index(name), 1
        if name in ("Ci", "rgb") and self.channels[:3] == ["r", "g", "b"]:
            return 0, 3
        return None

    def rgb(self) -> numpy.ndarray:
        """Bytes to look at: height x width x 3, light by the curve of sRGB; one channel as grey."""
        found = self._find("rgb")
        first, count = found if found else (0, min(3, len(self.channels)))
        light = self.data[:, :, first:first + count]
        if count < 3:
            light = numpy.repeat(light[:, :, :1], 3, axis=2)
        return srgb(light)

    def _repr_png_(self) -> bytes:
        return png(self.rgb())

    def save(self, file: str) -> None:
        """Writes a PNG file to look at. (Rendering with output="x.exr" writes other formats.)"""
        with open(file, "wb") as f:
            f.write(self._repr_png_())

    def __repr__(self) -> str:
        return f"<alpenglow.Picture {self.name!r} {self.data.shape[1]}x{self.data.shape[0]} {' '.join(self.channels)}>"


class Result:
    """What came of render(): pictures, figures, messages. In a notebook it shows its first picture."""

    def __init__(self, made: Dict[str, Any], messages: List[Message]) -> None:
        self.status: int = made["status"]
        self.pictures: List[Picture] = [Picture(p) for p in made["pictures"]]
        self.stats: Dict[str, Any] = json.loads(made["stats"])
        self.messages = messages
        self.frames_rendered: int = made["rendered"]

    @property
    def interrupted(self) -> bool:
        return self.status == 130

    @property
    def errors(self) -> List[Message]:
        return [m for m in self.messages if m.level >= 2]

    @property
    def warnings(self) -> List[Message]:
        return [m for m in self.messages if m.level == 1]

    @property
    def picture(self) -> Picture:
        """The first picture that shows Ci, else the first."""
        if not self.pictures:
            raise ValueError("there is no picture")
        return next((p for p in self.pictures if "rgb" in p), self.pictures[0])

    @property
    def image(self) -> numpy.ndarray:
        """Its pixels: float32, height x width x channels."""
        return self.picture.data

    def frame(self, number: int) -> List[Picture]:
        """The pictures of one frame."""
        return [p for p in self.pictures if p.frame == number]

    def __contains__(self, name: str) -> bool:
        return any(name in p for p in self.pictures)

    def __getitem__(self, name: str) -> numpy.ndarray:
        """A variable by name, from the first picture that has it: result["N"], result["z"]."""
        for p in self.pictures:
            if name in p:
                return p[name]
        names = dict.fromkeys(v for p in self.pictures for v in p.variables)
        raise KeyError(f"no picture has {name!r}; there are {', '.join(names) or 'none'}")

    def __iter__(self) -> Iterator[Picture]:
        return iter(self.pictures)

    def __len__(self) -> int:
        return len(self.pictures)

    def _repr_png_(self) -> Optional[bytes]:
        return self.picture._repr_png_() if self.pictures else None

    def __repr__(self) -> str:
        return f"<alpenglow.Result status {self.status}, {len(self.pictures)} pictures, {len(self.errors)} errors>"
