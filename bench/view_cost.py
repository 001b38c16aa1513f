#!/usr/bin/env python3
"""bench/RESULTS.md, "Looking at it": what a viewer costs, and how soon it sees what it asked for.

view_cost.py PROGRAM SCENE [--turns N] [--spp N] [--browser]
Processor time of `alpenglow view` for the same samples, with somebody who takes every picture and with nobody, in turns; then the time from a
request to a changed picture, and pictures a second while the camera is dragged.
"""
import argparse
import json
import os
import signal
import statistics
import struct
import subprocess
import sys
import threading
import time
import urllib.request

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', 'tests', 'view'))


class View:
    def __init__(self, program, scene, *more):
        self.process = subprocess.Popen([program, 'view', '-q', scene, *more], stdout=subprocess.PIPE, text=True)
        self.address = self.process.stdout.readline().strip()

    def picture(self, have=0, plane='picture'):
        body = urllib.request.urlopen(f'{self.address}picture?have={have}&plane={plane}').read()
        n = struct.unpack('<I', body[:4])[0]
        return json.loads(body[4:4 + n]), len(body) - 4 - n

    def do(self, **what):
        urllib.request.urlopen(urllib.request.Request(self.address + 'do', data=json.dumps(what).encode())).read()

    def seconds(self):
        """Processor time of the process so far."""
        with open(f'/proc/{self.process.pid}/stat') as f:
            fields = f.read().rsplit(')', 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf('SC_CLK_TCK')

    def end(self):
        self.process.send_signal(signal.SIGINT)
        self.process.wait()


def cost(program, scene, spp, watched):
    v = View(program, scene)
    v.do(do='set', wishes={'continuous': False, 'spp': spp})
    pictures = serial = 0
    while True:
        if watched:
            s, size = v.picture(serial)
            serial = s['serial']
            pictures += size > 0
            if s['done'] and s['figures']['spp'] == spp:
                break
        else:  # only the time of the process is looked at, once in a while
            time.sleep(0.5)
            before = v.seconds()
            time.sleep(0.3)
            if v.seconds() - before < 0.05 and v.picture()[0]['done']:
                break
    used = v.seconds()
    v.end()
    return used, pictures


def warm(program, scene):
    """From the start of the program to a picture in the viewer's hands."""
    times = []
    for _ in range(5):
        begun = time.monotonic()
        v = View(program, scene)
        size = serial = 0
        while not size:
            s, size = v.picture(serial)
            serial = s['serial']
        times.append(time.monotonic() - begun)
        v.end()
    return statistics.median(times)


def latency(program, scene):
    """From a request of another camera to the first picture of it, and pictures a second while it goes on."""
    v = View(program, scene)
    s, _ = v.picture()
    while s['phase'] != 'whole':
        s, _ = v.picture(s['serial'])
    v.do(do='camera', orbit=[1, 0], drag=True)
    waits, serial, tag = [], 0, ''
    begun = time.monotonic()
    for i in range(40):
        asked = time.monotonic()
        v.do(do='camera', orbit=[1, 0], drag=True)
        generation = None
        while True:
            s, size = v.picture(serial)
            serial = s['serial']
            if generation is None:
                generation = s['generation']
            if size and s.get('tag') != tag:
                tag = s['tag']
                break
        waits.append(time.monotonic() - asked)
    rate = 40 / (time.monotonic() - begun)
    v.end()
    return statistics.median(waits), rate


def browser(program, scene):
    """The same in Chromium: from the mouse to what is drawn."""
    import chromium
    v = View(program, scene)
    b = chromium.Browser()
    begun = time.monotonic()
    b.open(v.address)
    b.until('window.alpenglow && alpenglow.pictures > 0')
    first = time.monotonic() - begun
    b.key('c')
    b.mouse('Moved', 400, 300)
    b.mouse('Pressed', 400, 300)
    waits, begun = [], time.monotonic()
    for i in range(40):
        had = b.js('alpenglow.pictures')
        asked = time.monotonic()
        b.mouse('Moved', 400 + 2 * i, 300, down=True)
        while b.js('alpenglow.pictures') == had:
            pass
        waits.append(time.monotonic() - asked)
    rate = 40 / (time.monotonic() - begun)
    b.mouse('Released', 480, 300)
    b.close()
    v.end()
    return first, statistics.median(waits), rate


def main():
    p = argparse.ArgumentParser()
    p.add_argument('program')
    p.add_argument('scene')
    p.add_argument('--turns', type=int, default=5)
    p.add_argument('--spp', type=int, default=32)
    p.add_argument('--browser', action='store_true')
    a = p.parse_args()
    ratios = []
    for turn in range(a.turns):
        pair = {}
        for watched in ((True, False) if turn % 2 else (False, True)):
            pair[watched], pictures = cost(a.program, a.scene, a.spp, watched)
            if watched:
                shown = pictures
        ratios.append(pair[True] / pair[False])
        print(f'turn {turn}: {pair[False]:.2f} s unwatched, {pair[True]:.2f} s watched ({shown} pictures), ratio {ratios[-1]:.4f}', flush=True)
    print(f'cost of viewing: {100 * (statistics.median(ratios) - 1):.2f} % (median of {a.turns})')
    print(f'from the start of the program to a picture: {1000 * warm(a.program, a.scene):.0f} ms')
    wait, rate = latency(a.program, a.scene)
    print(f'from a request to its picture: {1000 * wait:.0f} ms; {rate:.1f} pictures a second while the camera moves')
    if a.browser:
        first, wait, rate = browser(a.program, a.scene)
        print(f'in Chromium: first picture {first:.2f} s after the address; {1000 * wait:.0f} ms from the mouse to the page; {rate:.1f} a second')


if __name__ == '__main__':
    main()
