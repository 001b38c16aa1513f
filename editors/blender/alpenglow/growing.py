"""The picture while it grows: the program sends it as it sends pictures to the viewer tev, to a socket of ours on this
machine."""
import socket
import struct
import threading

import numpy as np

CREATE, UPDATE = 4, 6  # kinds of packets; the protocol is that of github.com/Tom94/tev
MOST = 1 << 28  # bytes of a packet


class Growing:
    """Listens until close(). take() gives the picture when it has changed."""

    def __init__(self, name):
        self.name, self.pixels, self.names, self.fresh, self.lock = name, None, [], False, threading.Lock()
        self.listener = socket.socket()
        self.listener.bind(("127.0.0.1", 0))
        self.listener.listen(1)
        self.port = self.listener.getsockname()[1]
        threading.Thread(target=self._serve, daemon=True).start()

    def close(self):
        self.listener.close()

    def take(self):
        """(height, width, 4) floats from the top, None where nothing is new."""
        with self.lock:
            if not self.fresh:
                return None
            self.fresh = False
            return self.pixels.copy()

    def _serve(self):
        try:
            self.listener.settimeout(120)
            connection, _ = self.listener.accept()
            with connection:
                while self._packet(connection):
                    pass
        except (OSError, ValueError, struct.error):
            pass  # the picture in the end comes from a file

    @staticmethod
    def _bytes(connection, count):
        out = bytearray()
        while len(out) < count:
            got = connection.recv(min(1 << 20, count - len(out)))
            if not got:
                return None
            out += got
        return bytes(out)

    def _packet(self, connection):
        head = self._bytes(connection, 4)
        if head is None:
            return False
        (length,) = struct.unpack("<I", head)
        if not 6 <= length <= MOST:
            raise ValueError("a packet of %d bytes" % length)
        data = self._bytes(connection, length - 4)
        if data is None:
            return False
        kind, end = data[0], data.index(b"\0", 2)
        if data[2:end].decode(errors="replace") == self.name:
            (self._create if kind == CREATE else self._update if kind == UPDATE else lambda *_: None)(data, end + 1)
        return True

    @staticmethod
    def _names(data, p):
        (count,) = struct.unpack_from("<i", data, p)
        names, p = [], p + 4
        for _ in range(count):
            end = data.index(b"\0", p)
            names.append(data[p:end].decode())
            p = end + 1
        return names, p

    def _create(self, data, p):
        width, height = struct.unpack_from("<ii", data, p)
        if 0 < width * height <= MOST // 16:
            with self.lock:
                self.pixels = np.zeros((height, width, 4), np.float32)

    def _update(self, data, p):
        names, p = self._names(data, p)
        x, y, w, h = struct.unpack_from("<4i", data, p)
        p += 16 + 16 * len(names)  # channels lie pixel by pixel
        values = np.frombuffer(data, "<f4", w * h * len(names), p).reshape(h, w, len(names))
        with self.lock:
            if self.pixels is None:
                return
            for i, name in enumerate(names):
                if name in "RGBA":
                    self.pixels[y : y + h, x : x + w, "RGBA".index(name)] = values[..., i]
            self.fresh = True
