"""What the tests of the Python module share."""
import os
import signal
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

import numpy

sys.dont_write_bytecode = True
signal.signal(signal.SIGINT, signal.default_int_handler)  # background jobs of a shell ignore it; tests send it
os.environ["ALPENGLOW_RC"] = "off"  # not that of who runs the tests
PROGRAM = os.environ.get("ALPENGLOW_PROGRAM", "alpenglow")
SOURCE = os.environ.get("ALPENGLOW_SOURCE", os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))))


class InFolder(unittest.TestCase):
    """Each test in a folder of its own, which is the current one."""

    def setUp(self):
        self._before = os.getcwd()
        self._folder = tempfile.TemporaryDirectory()
        os.chdir(self._folder.name)

    def tearDown(self):
        os.chdir(self._before)
        self._folder.cleanup()


def run(*words, text=None):
    """A program's status, standard output and standard error."""
    done = subprocess.run([str(w) for w in words], capture_output=True, text=True, input=text)
    return done.returncode, done.stdout, done.stderr


def read_exr(file):
    """Channels of an uncompressed or zipped OpenEXR file of float scanlines, by name ("OpenEXR File Layout", openexr.com)."""
    with open(file, "rb") as f:
        data = f.read()
    assert data[:4] == b"\x76\x2f\x31\x01"
    at, channels, compression, box = 8, [], None, None
    while data[at]:
        end = data.index(b"\0", at)
        name, at = data[at:end].decode(), end + 1
        end = data.index(b"\0", at)
        at = end + 1
        size, at = struct.unpack_from("<i", data, at)[0], at + 4
        value, at = data[at:at + size], at + size
        if name == "channels":
            c = 0
            while value[c]:
                e = value.index(b"\0", c)
                channels.append((value[c:e].decode(), struct.unpack_from("<i", value, e + 1)[0]))
                c = e + 17
        elif name == "compression":
            compression = value[0]
        elif name == "dataWindow":
            box = struct.unpack("<4i", value)
    at += 1
    width, height = box[2] - box[0] + 1, box[3] - box[1] + 1
    rows = {0: 1, 2: 1, 3: 16}[compression]
    made = {name: numpy.zeros((height, width), numpy.float32) for name, _ in channels}
    blocks = (height + rows - 1) // rows
    for offset in struct.unpack_from(f"<{blocks}Q", data, at):
        y, size = struct.unpack_from("<ii", data, offset)
        y -= box[1]
        count = min(rows, height - y)
        raw = data[offset + 8:offset + 8 + size]
        whole = count * width * sum({1: 2, 2: 4}[k] for _, k in channels)
        if compression and size < whole:
            raw = zlib.decompress(raw)
            b = numpy.frombuffer(raw, numpy.uint8).astype(numpy.int64)
            b[1:] -= 128
            b = (numpy.cumsum(b) & 255).astype(numpy.uint8)
            half = (len(b) + 1) // 2
            out = numpy.empty(len(b), numpy.uint8)
            out[0::2], out[1::2] = b[:half], b[half:]
            raw = out.tobytes()
        p = 0
        for row in range(count):
            for name, kind in channels:
                dtype, n = (numpy.float16, 2) if kind == 1 else (numpy.float32, 4)
                made[name][y + row] = numpy.frombuffer(raw, dtype, width, p)
                p += n * width
    return made


def png_pixels(data):
    """Pixels of a PNG file of 8 bits whose rows have filter 0 (ISO 15948)."""
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    at, packed = 8, b""
    while at < len(data):
        size, kind = struct.unpack_from(">I4s", data, at)
        body = data[at + 8:at + 8 + size]
        assert struct.unpack_from(">I", data, at + 8 + size)[0] == zlib.crc32(kind + body)
        if kind == b"IHDR":
            width, height, bits, colour = struct.unpack_from(">IIBB", body)
        elif kind == b"IDAT":
            packed += body
        at += 12 + size
    assert bits == 8
    channels = {2: 3, 6: 4}[colour]
    rows = numpy.frombuffer(zlib.decompress(packed), numpy.uint8).reshape(height, 1 + width * channels)
    assert not rows[:, 0].any()
    return rows[:, 1:].reshape(height, width, channels)


#: A wall of one colour before the eye, at depth 3.
WALL = """
Format 8 6 1
PixelSamples 2 2
PixelFilter "box" 1 1
Projection "orthographic"
WorldBegin
Color [0.25 0.5 1]
Surface "constant"
Patch "bilinear" "P" [-9 -9 3  9 -9 3  -9 9 3  9 9 3]
WorldEnd
"""

#: Light on two balls, by path.
BALLS = """
Format 48 32 1
Hider "path"
PixelSamples 3 3
Projection "perspective" "fov" 40
Translate 0 0 5
WorldBegin
LightSource "distantlight" 1 "from" [1 2 -3] "to" [0 0 0] "intensity" 2
AttributeBegin
Color [1 0.3 0.1]
Surface "plastic" "Kd" 0.6
Translate -0.7 0 0
Sphere 1 -1 1 360
AttributeEnd
AttributeBegin
Color [0.2 0.6 1]
Translate 1 0 0.5
Rotate 30 0 1 0
Sphere 0.7 -0.7 0.7 360
AttributeEnd
WorldEnd
"""
