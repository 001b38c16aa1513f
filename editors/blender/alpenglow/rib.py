"""Writing RIB: requests as text, arrays of numbers as binary RIB blocks (RISpec 3.2, appendix C.2), which reading mixes
freely."""
import struct

import numpy as np

SMALL = 64  # arrays up to this length are written as text, so that a file shows what it holds


def quoted(text):
    """A RIB string. Input: any text; output: it in quotes, with escapes."""
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n") + '"'


def number(value):
    return "%d" % value if float(value).is_integer() and abs(value) < 1e9 else "%.9g" % value


class Rib:
    """A RIB file that is being written. `binary` False writes every number as text."""

    def __init__(self, path, binary=True):
        self.file = open(path, "wb")
        self.binary = binary

    def close(self):
        self.file.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def comment(self, text):
        self.file.write(("# " + text.replace("\n", " ") + "\n").encode())

    def request(self, name, *values):
        """One request. A str is quoted, numbers stand as they are, sequences and arrays in brackets; a dict is a parameter
        list."""
        self.file.write(name.encode())
        for value in values:
            if isinstance(value, dict):
                for token, data in value.items():
                    self._value(token)
                    self._value(data)
            else:
                self._value(value)
        self.file.write(b"\n")

    def _value(self, value):
        write = self.file.write
        if isinstance(value, str):
            write((" " + quoted(value)).encode())
        elif isinstance(value, np.ndarray):
            self._array(value)
        elif isinstance(value, (list, tuple)):
            if value and isinstance(value[0], str):
                write((" [" + " ".join(quoted(v) for v in value) + "]").encode())
            else:
                write((" [" + " ".join(number(v) for v in value) + "]").encode())
        else:
            write((" " + number(value)).encode())

    def _array(self, a):
        flat = a.ravel()
        if flat.dtype.kind in "iub":
            self.file.write((" [" + " ".join(map(str, flat.tolist())) + "]").encode())
        elif self.binary and flat.size > SMALL:
            self.file.write(b" " + bytes([0o313]) + struct.pack(">I", flat.size) + flat.astype(">f4").tobytes())
        else:
            self.file.write((" [" + " ".join(number(v) for v in flat.tolist()) + "]").encode())


class Block:
    """`with Block(rib, "Attribute"):` writes AttributeBegin and AttributeEnd."""

    def __init__(self, rib, name, *values):
        self.rib, self.name, self.values = rib, name, values

    def __enter__(self):
        self.rib.request(self.name + "Begin", *self.values)

    def __exit__(self, *_):
        self.rib.request(self.name + "End")


def matrix(m):
    """A mathutils.Matrix (columns) as the 16 numbers of RIB (rows)."""
    return np.array(m.transposed(), dtype=np.float64).ravel()


def transform(rib, matrices, times):
    """ConcatTransform, in a motion block where the matrices of the times differ. matrices: arrays of 16; times: as many."""
    if len(matrices) == 1 or all(np.array_equal(matrices[0], m) for m in matrices[1:]):
        rib.request("ConcatTransform", matrices[0])
        return
    rib.request("MotionBegin", list(times))
    for m in matrices:
        rib.request("ConcatTransform", m)
    rib.request("MotionEnd")
