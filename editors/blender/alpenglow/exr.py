"""OpenEXR files of scan lines (none, ZIPS, ZIP; half, float, uint) as NumPy arrays, and back without compression.

Blender's own loader reads one picture; this reads every channel of a file with outputs. Format: OpenEXR file layout,
openexr.com."""
import struct
import zlib

import numpy as np

TYPES = {0: "<u4", 1: "<f2", 2: "<f4"}


def _header(data):
    if data[:4] != b"\x76\x2f\x31\x01":
        raise ValueError("not an OpenEXR file")
    p, attributes = 8, {}
    while data[p] != 0:
        end = data.index(b"\0", p)
        name, p = data[p:end].decode(), end + 1
        end = data.index(b"\0", p)
        (size,) = struct.unpack_from("<i", data, end + 1)
        attributes[name] = data[end + 5 : end + 5 + size]
        p = end + 5 + size
    return attributes, p + 1


def _channels(data):
    found, p = [], 0
    while data[p] != 0:
        end = data.index(b"\0", p)
        (kind,) = struct.unpack_from("<i", data, end + 1)
        found.append((data[p:end].decode(), kind))
        p = end + 17
    return found


def _unpacked(block, size, compression):
    if compression == 0 or len(block) == size:
        return block
    a = np.frombuffer(zlib.decompress(block), np.uint8).astype(np.int64)
    a[1:] -= 128
    a = (np.cumsum(a) & 255).astype(np.uint8)
    half = (len(a) + 1) // 2
    out = np.empty_like(a)
    out[0::2], out[1::2] = a[:half], a[half:]
    return out.tobytes()


def read(path):
    """(channels, window, size): name -> float32 array of rows from the top; (x, y) of the first pixel; (width, height) of the
    whole
    picture. Raises OSError, ValueError."""
    with open(path, "rb") as f:
        data = f.read()
    attributes, p = _header(data)
    channels = _channels(attributes["channels"])
    x0, y0, x1, y1 = struct.unpack("<4i", attributes["dataWindow"])
    d = struct.unpack("<4i", attributes["displayWindow"])
    width, height, compression = x1 - x0 + 1, y1 - y0 + 1, attributes["compression"][0]
    if compression not in (0, 2, 3):
        raise ValueError("compression %d of OpenEXR is not read" % compression)
    lines = 16 if compression == 3 else 1
    out = {name: np.zeros((height, width), np.float32) for name, _ in channels}
    for offset in struct.unpack_from("<%dQ" % -(-height // lines), data, p):
        y, size = struct.unpack_from("<ii", data, offset)
        rows = min(lines, y1 - y + 1)
        whole = sum((2 if kind == 1 else 4) * width for _, kind in channels) * rows
        block, k = _unpacked(data[offset + 8 : offset + 8 + size], whole, compression), 0
        for row in range(y - y0, y - y0 + rows):
            for name, kind in channels:
                out[name][row] = np.frombuffer(block, TYPES[kind], width, k)
                k += width * (2 if kind == 1 else 4)
    return out, (x0 - d[0], y0 - d[1]), (d[2] - d[0] + 1, d[3] - d[1] + 1)


def write(path, pixels):
    """pixels: (height, width, 3 or 4) numbers, rows from the top, red green blue (alpha). Floats, no compression."""
    height, width, count = pixels.shape
    order = [(3, b"A")][: max(0, count - 3)] + [(2, b"B"), (1, b"G"), (0, b"R")]

    def attribute(name, kind, value):
        return name + b"\0" + kind + b"\0" + struct.pack("<i", len(value)) + value

    box = struct.pack("<4i", 0, 0, width - 1, height - 1)
    channels = b"".join(name + b"\0" + struct.pack("<iB3xii", 2, 0, 1, 1) for _, name in order) + b"\0"
    head = (
        b"\x76\x2f\x31\x01\x02\0\0\0"
        + attribute(b"channels", b"chlist", channels)
        + attribute(b"compression", b"compression", b"\0")
        + attribute(b"dataWindow", b"box2i", box)
        + attribute(b"displayWindow", b"box2i", box)
        + attribute(b"lineOrder", b"lineOrder", b"\0")
        + attribute(b"pixelAspectRatio", b"float", struct.pack("<f", 1))
        + attribute(b"screenWindowCenter", b"v2f", struct.pack("<2f", 0, 0))
        + attribute(b"screenWindowWidth", b"float", struct.pack("<f", 1))
        + b"\0"
    )
    row = len(order) * width * 4
    first = len(head) + 8 * height
    rows = np.ascontiguousarray(pixels[:, :, [i for i, _ in order]].transpose(0, 2, 1), "<f4")
    with open(path, "wb") as f:
        f.write(head + struct.pack("<%dQ" % height, *(first + y * (row + 8) for y in range(height))))
        for y in range(height):
            f.write(struct.pack("<ii", y, row) + rows[y].tobytes())
