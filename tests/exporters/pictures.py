"""Pictures as NumPy arrays: reading, comparing by blocks, joining side by side."""
import os
import struct
import sys
import zlib

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.append(os.environ.get("ALPENGLOW_ADDON", os.path.join(HERE, "..", "..", "editors", "blender")))
from alpenglow import exr  # noqa: E402


def channels(path):
    """All channels of an OpenEXR file by name, rows from the top."""
    return exr.read(path)[0]


def three(found, prefix=""):
    """Red, green and blue of a file's channels, of the layer that ends in prefix."""

    def one(letter):
        return next(v for k, v in found.items() if k == letter or k.endswith(prefix + "." + letter))

    return np.stack([one("R"), one("G"), one("B")], -1).astype(np.float64)


def read(path):
    return three(channels(path))


def blocks(a, n=8):
    """Means over n by n pixels: noise goes, structure stays."""
    h, w = a.shape[0] // n * n, a.shape[1] // n * n
    return a[:h, :w].reshape(h // n, n, w // n, n, -1).mean((1, 3))


def compared(a, b, n=8):
    """ratio: of the means of red, green and blue; difference: mean absolute difference of blocks over the mean of b; worst:
    the largest, over
    the same; correlation: of blocks."""
    x, y = blocks(a, n), blocks(b, n)
    d = np.abs(x - y)
    return {
        "ratio": (a.mean((0, 1)) / b.mean((0, 1))).round(4).tolist(),
        "difference": round(float(d.mean() / y.mean()), 4),
        "worst": round(float(d.max() / y.mean()), 4),
        "correlation": round(float(np.corrcoef(x.ravel(), y.ravel())[0, 1]), 5),
    }


def png(path, beside):
    """Pictures of light side by side, in sRGB."""
    v = np.clip(np.concatenate(beside, 1), 0, 1)
    u = (np.where(v <= 0.0031308, 12.92 * v, 1.055 * np.power(np.maximum(v, 1e-9), 1 / 2.4) - 0.055) * 255 + 0.5).astype(
        np.uint8
    )
    h, w, _ = u.shape

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data) & 0xFFFFFFFF)

    rows = np.concatenate([np.zeros((h, 1), np.uint8), u.reshape(h, -1)], 1).tobytes()
    with open(path, "wb") as f:
        f.write(
            b"\x89PNG\r\n\x1a\n"
            + chunk(b"IHDR", struct.pack(">IIBBBBB", w, h, 8, 2, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(rows, 6))
            + chunk(b"IEND", b"")
        )
