"""Drives a headless Chromium by its own protocol, with nothing but Python's library."""
import base64
import json
import os
import re
import shutil
import socket
import struct
import subprocess
import tempfile
import time
import urllib.request


def program():
    """The browser, or None where there is none."""
    return shutil.which('chromium') or shutil.which('chromium-browser') or shutil.which('google-chrome')


class Browser:
    def __init__(self, size=(1280, 800), dark=False):
        self.folder = tempfile.mkdtemp(prefix='alpenglow-browser-')
        # Without its sandbox: a test often runs as root, which the sandbox refuses. It sees only pages of ours.
        arguments = [program(), '--headless=new', '--no-sandbox', '--disable-gpu', '--remote-debugging-port=0', '--no-first-run',
                     '--disable-extensions', '--disable-background-networking', '--user-data-dir=' + self.folder, '--hide-scrollbars',
                     f'--window-size={size[0]},{size[1]}', 'about:blank']
        self.process = subprocess.Popen(arguments, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        port = None
        for line in self.process.stderr:
            found = re.search(r'ws://127.0.0.1:(\d+)/', line)
            if found:
                port = int(found[1])
                break
        if not port:
            raise RuntimeError('the browser did not start')
        path = None
        while not path:
            tabs = json.load(urllib.request.urlopen(f'http://127.0.0.1:{port}/json'))
            path = next((t['webSocketDebuggerUrl'].split(str(port), 1)[1] for t in tabs if t['type'] == 'page'), None)
        self.socket = socket.create_connection(('127.0.0.1', port))
        self.socket.settimeout(120)
        key = base64.b64encode(os.urandom(16)).decode()
        self.socket.sendall((f'GET {path} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n'
                             f'Sec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n').encode())
        self.stream = self.socket.makefile('rb')
        while self.stream.readline() not in (b'\r\n', b''):
            pass
        self.number = 0
        self.faults, self.requests = [], []
        for domain in ('Page', 'Runtime', 'Log', 'Network'):
            self.do(domain + '.enable')
        self.resize(*size)
        self.scheme('dark' if dark else 'light')

    def resize(self, width, height):
        self.do('Emulation.setDeviceMetricsOverride', width=width, height=height, deviceScaleFactor=1, mobile=False)

    def scheme(self, name):
        self.do('Emulation.setEmulatedMedia', features=[{'name': 'prefers-color-scheme', 'value': name}])

    def _send(self, text):
        data, mask = text.encode(), os.urandom(4)
        n = len(data)
        head = bytes([0x81, 0x80 | n]) if n < 126 else b'\x81\xfe' + struct.pack('>H', n) if n < 65536 else b'\x81\xff' + struct.pack('>Q', n)
        self.socket.sendall(head + mask + bytes(b ^ mask[i & 3] for i, b in enumerate(data)))

    def _receive(self):
        text = b''
        while True:
            first, n = self.stream.read(2)
            n &= 127
            if n == 126:
                n = struct.unpack('>H', self.stream.read(2))[0]
            elif n == 127:
                n = struct.unpack('>Q', self.stream.read(8))[0]
            text += self.stream.read(n)
            if first & 0x80:
                return json.loads(text)

    def do(self, method, **parameters):
        self.number += 1
        me = self.number
        self._send(json.dumps({'id': me, 'method': method, 'params': parameters}))
        while True:
            m = self._receive()
            if m.get('id') == me:
                if 'error' in m:
                    raise RuntimeError(f'{method}: {m["error"]}')
                return m['result']
            if m.get('method') == 'Network.requestWillBeSent':
                self.requests.append(m['params']['request']['url'])
            elif m.get('method') in ('Runtime.exceptionThrown', 'Log.entryAdded'):
                self.faults.append(json.dumps(m['params'])[:600])

    def js(self, expression):
        """The value of an expression in the page; promises are waited for."""
        r = self.do('Runtime.evaluate', expression=expression, awaitPromise=True, returnByValue=True)
        if 'exceptionDetails' in r:
            raise RuntimeError(expression + ': ' + json.dumps(r['exceptionDetails'])[:600])
        return r['result'].get('value')

    def until(self, expression, seconds=60):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            if self.js(f'Promise.resolve({expression}).then(Boolean)'):
                return
            time.sleep(0.02)
        raise AssertionError(f'{expression} did not come true; faults of the page: {self.faults}')

    def open(self, address):
        self.do('Page.navigate', url=address)

    def mouse(self, kind, x, y, down=False, **more):
        """kind: Pressed, Released, Moved, Wheel."""
        self.do('Input.dispatchMouseEvent', type='mouse' + kind, x=x, y=y, button='left' if down or kind in ('Pressed', 'Released') else 'none',
                buttons=1 if down or kind == 'Pressed' else 0, clickCount=1 if kind in ('Pressed', 'Released') else 0, **more)

    def drag(self, x0, y0, x1, y1, steps=8, **more):
        self.mouse('Moved', x0, y0)
        self.mouse('Pressed', x0, y0, **more)
        for i in range(1, steps + 1):
            self.mouse('Moved', x0 + (x1 - x0) * i / steps, y0 + (y1 - y0) * i / steps, down=True, **more)
        self.mouse('Released', x1, y1, **more)

    def key(self, key, **more):
        text = {'text': key} if len(key) == 1 else {}
        self.do('Input.dispatchKeyEvent', type='keyDown', key=key, **text, **more)
        self.do('Input.dispatchKeyEvent', type='keyUp', key=key, **more)

    def screenshot(self, name):
        with open(name, 'wb') as f:
            f.write(base64.b64decode(self.do('Page.captureScreenshot', format='png')['data']))

    def close(self):
        self.process.kill()
        self.process.wait()
        shutil.rmtree(self.folder, ignore_errors=True)
