#!/usr/bin/env python3
"""The page of alpenglow view in a real browser: every switch is used as a person would, and pixels are looked at.

browser_test.py PROGRAM [FOLDER]: screenshots go into the folder. Only in ./check --all; without Chromium it is skipped (77).
"""
import json
import os
import signal
import subprocess
import sys
import tempfile
import time
import urllib.request

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import chromium  # noqa: E402

SCENE = '''Display "x.exr" "openexr" "rgba"
Format 160 120 1
PixelFilter "box" 1 1
Hider "path"
Projection "perspective" "fov" 40
Translate 0 0 5
WorldBegin
LightSource "pointlight" "key" "from" [2 3 -4] "intensity" 20
LightSource "distantlight" "fill" "to" [1 0 1] "intensity" 0.3
Surface "mine" "float level" 0.5
Sphere 1 -1 1 360
Surface "nowhere"
Sphere 0.1 -0.1 0.1 360
Surface "matte"
Translate 0 -1.6 0
Sphere 1 -1 1 360
WorldEnd
'''
SHADER = 'surface mine(float level = 1; string note = "") { Ci = level * Cs * diffuse(normalize(N)); Oi = 1; Ci = color(level, comp(Ci, 1), 0); }\n'


def encode(v, gain=1.0, gamma=None):
    """The code of a linear value: sRGB (IEC 61966-2-1), or a power."""
    v = max(v * gain, 0)
    v = v ** (1 / gamma) if gamma else 12.92 * v if v <= 0.0031308 else 1.055 * v ** (1 / 2.4) - 0.055
    return round(min(v, 1) * 255)


class View:
    """The program and its page."""

    def __init__(self, program, folder, shots):
        self.shots = shots
        self.folder = folder
        self.write('s.rib', SCENE)
        self.write('mine.sl', SHADER)
        self.process = subprocess.Popen([program, 'view', '--watch', '-q', 's.rib'], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        self.address = self.process.stdout.readline().strip()
        assert self.address.startswith('http://127.0.0.1:'), self.address
        self.b = chromium.Browser()
        self.b.open(self.address)
        self.b.until('window.alpenglow && alpenglow.pictures > 0')

    def write(self, name, text):
        whole = os.path.join(self.folder, name)
        with open(whole + '.new', 'w') as f:
            f.write(text)
        os.rename(whole + '.new', whole)

    def shot(self, name):
        self.b.screenshot(os.path.join(self.shots, name + '.png'))

    def set(self, control, value):
        """As a person does: the control gets a value, and says that it changed."""
        self.b.js(f'''(() => {{ const e = document.getElementById('{control}'); if (e.type === 'checkbox') {{ if (e.checked !== {json.dumps(value)}) e.click(); return; }}
            e.focus(); e.value = {json.dumps(str(value))}; e.dispatchEvent(new Event('input', {{bubbles: true}})); e.dispatchEvent(new Event('change', {{bubbles: true}})); e.blur(); }})()''')

    def click(self, control):
        self.b.js(f'document.getElementById({json.dumps(control)}).click()')

    def settled(self):
        """All samples are there and drawn."""
        time.sleep(0.05)  # for what was clicked to be on its way
        self.b.until("fetch('picture?have=0').then((r) => r.arrayBuffer()).then((b) => JSON.parse(new TextDecoder().decode(new Uint8Array(b, 4, "
                     "new DataView(b).getUint32(0, true))))).then((s) => s.done && alpenglow.state.done && alpenglow.serial >= s.serial)", 120)

    def place(self, x, y):
        """Where a pixel of the picture is on the page."""
        return self.b.js(f'''(() => {{ const s = alpenglow.stage, r = s.canvas.getBoundingClientRect(), o = s.origin(), k = s.scale();
            return [r.left + o[0] + ({x} + .5) * k, r.top + o[1] + ({y} + .5) * k]; }})()''')

    def seen(self, x, y):
        """Red, green and blue of what the canvas shows there."""
        return self.b.js(f'''(() => {{ const s = alpenglow.stage, o = s.origin(), k = s.scale(), d = devicePixelRatio; s.draw();
            return [...s.canvas.getContext('2d').getImageData((o[0] + ({x} + .5) * k) * d, (o[1] + ({y} + .5) * k) * d, 1, 1).data].slice(0, 3); }})()''')

    def linear(self, x, y, plane='picture', channels='rgb'):
        """What the renderer says is there."""
        with urllib.request.urlopen(f'{self.address}pixel?x={x}&y={y}&plane={plane}') as r:
            v = json.load(r)['values']
        return [v[f'{plane}/{c}'] for c in channels]

    def close(self):
        self.b.close()
        self.process.send_signal(signal.SIGINT)
        self.process.wait(20)


def near(a, b, most=2):
    return all(abs(p - q) <= most for p, q in zip(a, b))


def check_growth(v):
    v.b.until('alpenglow.state.figures.spp >= 4')
    before = v.b.js('alpenglow.pictures')
    v.b.until(f'alpenglow.pictures > {before}')
    v.b.until('alpenglow.points >= 3')
    inked = v.b.js('''[...document.querySelectorAll('#curves canvas')].map((c) => c.getContext('2d').getImageData(0, 0, c.width, c.height).data.some((x) => x > 0))''')
    assert inked == [True] * 4, inked
    text = v.b.js("document.getElementById('figures').innerText")
    for name in ('Samples', 'Rays/ms', 'noiseRSE', 'Efficiency'):
        assert name in text, text
    outside = [u for u in v.b.requests if not u.startswith(v.address) and not u.startswith('data:')]
    assert not outside, outside
    v.shot('growing')


def check_number_of_samples(v):
    v.set('continuous', False)
    v.set('spp', 16)
    v.settled()
    assert v.b.js('alpenglow.state.figures.spp') == 16
    assert 'Done' in v.b.js("document.getElementById('status').textContent")


def check_pixels(v):
    for x, y in ((80, 50), (70, 40), (95, 60)):
        assert near(v.seen(x, y), [encode(c) for c in v.linear(x, y)]), (v.seen(x, y), v.linear(x, y))
    assert v.seen(2, 2) == [0, 0, 0]
    v.set('exposure', 1)
    assert near(v.seen(70, 40), [encode(c, 2) for c in v.linear(70, 40)])
    v.set('exposure', 0)
    v.set('srgb', False)
    v.set('gamma', 2.2)
    assert near(v.seen(70, 40), [encode(c, 1, 2.2) for c in v.linear(70, 40)])
    v.set('srgb', True)


def check_zoom(v):
    x, y = v.place(80, 50)
    v.b.mouse('Moved', x, y)
    v.b.until("document.getElementById('values').textContent.startsWith('80, 50')")
    text = v.b.js("document.getElementById('values').textContent")
    assert 'r 0.5' in text and 'z 4' in text, text
    for _ in range(12):
        v.b.do('Input.dispatchMouseEvent', type='mouseWheel', x=x, y=y, deltaX=0, deltaY=-200)
    v.b.until('alpenglow.stage.scale() > 60')
    # What was under the mouse stays there, and its numbers stand in it.
    assert v.b.js(f'''(() => {{ const s = alpenglow.stage, r = s.canvas.getBoundingClientRect(); return s.pixelAt({x} - r.left, {y} - r.top).map(Math.floor); }})()''') == [80, 50]
    colours = v.b.js('''(() => { const s = alpenglow.stage, o = s.origin(), k = s.scale(); s.draw();
        const d = s.canvas.getContext('2d').getImageData(o[0] + 80 * k + 2, o[1] + 50 * k + 2, k - 4, k - 4).data, all = new Set();
        for (let i = 0; i < d.length; i += 4) all.add(d[i] << 16 | d[i + 1] << 8 | d[i + 2]); return all.size; })()''')
    assert colours > 3, colours
    v.shot('pixels')
    left = v.b.js('alpenglow.stage.centre[0]')
    v.b.drag(x, y, x + 100, y)
    assert v.b.js('alpenglow.stage.centre[0]') < left
    v.b.key('f')
    assert v.b.js('alpenglow.stage.zoom') == 0


def check_outputs(v):
    v.set('add', 'N')
    v.click('addgo')
    v.settled()
    v.b.until("alpenglow.stage.whole.plane === 'N'")
    n = v.linear(80, 50, 'N', ('N.x', 'N.y', 'N.z'))
    assert n[2] < -0.8, n
    assert near(v.seen(80, 50), [round((c + 1) / 2 * 255) for c in n], 3), (v.seen(80, 50), n)
    v.shot('normals')
    v.set('add', 'lpe:C<RD>L')
    v.click('addgo')
    v.settled()
    v.b.until("alpenglow.stage.whole.plane === 'lpe:C<RD>L'")
    light = v.linear(70, 92, 'lpe:C<RD>L', 'rgb')
    assert light[1] > 0.05 and near(v.seen(70, 92), [encode(c) for c in light]), (light, v.seen(70, 92))
    v.b.key('n')
    v.b.until("alpenglow.stage.whole.plane === 'noise'")
    assert v.seen(2, 2) == [0, 0, 4] and sum(v.seen(80, 92)) > 20, v.seen(80, 92)
    v.shot('noise')
    v.b.key('n')
    v.b.until("alpenglow.stage.whole.plane === 'picture'")


def check_messages(v):
    text = v.b.js("document.getElementById('messages').innerText")
    assert 'nowhere' in text and 's.rib:12' in text and 'error' in text, text


def check_switches(v):
    lit = v.linear(70, 40)
    v.set('direct', False)
    v.settled()
    assert v.linear(70, 40)[1] < 0.2 * lit[1], (v.linear(70, 40), lit)
    assert near(v.seen(70, 40), [encode(c) for c in v.linear(70, 40)])
    v.set('direct', True)
    v.set('depth', 1)
    v.set('clamp', 3)
    v.set('indirect', False)
    v.set('hider', 'raytrace')
    v.settled()
    w = v.b.js('alpenglow.state.wishes')
    assert (w['depth'], w['clamp'], w['indirect'], w['hider']) == (1, 3, False, 'raytrace'), w
    v.set('hider', '')
    v.set('factor', 0.5)
    v.settled()
    assert v.b.js('[alpenglow.stage.whole.width, alpenglow.stage.whole.height]') == [80, 60]
    for control, value in (('factor', 1), ('depth', -1), ('clamp', 0), ('indirect', True)):
        v.set(control, value)
    v.settled()
    assert v.linear(70, 40) == lit


def check_crop(v):
    v.b.key('x')
    v.b.drag(*v.place(40, 30), *v.place(120, 90))
    v.b.until('alpenglow.state.wishes.crop !== null')
    crop = v.b.js('alpenglow.state.wishes.crop')
    assert near([c * 160 for c in crop[:2]] + [c * 120 for c in crop[2:]], [40, 120, 30, 90], 1.5), crop
    v.set('spp', 32)
    v.settled()
    v.shot('crop')
    v.b.key('Escape')
    v.b.until('alpenglow.state.wishes.crop === null')
    v.b.key('v')
    v.set('spp', 16)
    v.settled()


def check_camera(v):
    still = v.b.js('Array.from(alpenglow.stage.whole.half.slice(0))')
    v.b.key('c')
    x, y = v.place(80, 60)
    v.b.mouse('Moved', x, y)
    v.b.mouse('Pressed', x, y)
    came = v.b.js('alpenglow.pictures')
    for i in range(20):
        v.b.mouse('Moved', x, y + 4 * i, down=True)
        time.sleep(0.03)
    v.b.until(f'alpenglow.pictures > {came}')  # it is seen while it moves
    v.b.mouse('Released', x, y + 76)
    v.settled()
    assert v.b.js('alpenglow.state.moved') is True
    moved = v.b.js('Array.from(alpenglow.stage.whole.half.slice(0))')
    assert sum(a != b for a, b in zip(still, moved)) > 1000
    v.shot('orbit')
    v.b.do('Input.dispatchMouseEvent', type='mouseWheel', x=x, y=y, deltaX=0, deltaY=-300)
    v.b.drag(x, y, x + 60, y, modifiers=8)
    v.b.key('ArrowLeft')
    v.settled()
    v.b.key('r')
    v.b.until('alpenglow.state.moved === false')
    v.settled()
    assert v.b.js('Array.from(alpenglow.stage.whole.half.slice(0))') == still
    v.b.key('v')


def check_shaders(v):
    v.b.js("document.getElementById('shadersbox').open = true")
    v.b.until("document.querySelector('[data-parameter=level]')")
    v.b.js('''(() => { const e = document.querySelector('[data-parameter=level] input'); e.closest('details').open = true; e.value = 0.8;
        e.dispatchEvent(new Event('input', {bubbles: true})); })()''')
    v.settled()
    assert abs(v.linear(80, 50)[0] - 0.8) < 0.01, v.linear(80, 50)
    assert near(v.seen(80, 50), [encode(c) for c in v.linear(80, 50)])
    v.b.js("document.getElementById('shadersbox').scrollIntoView()")
    v.shot('shaders')


def check_lights(v):
    v.b.js("document.getElementById('lightsbox').open = true")
    v.set('lights', True)
    v.settled()
    v.b.until("document.querySelector('[data-light=key] input[type=range]:not(:disabled)')")
    lit, generation = v.seen(90, 40), v.b.js('alpenglow.state.generation')
    for handle in ('key', 'fill'):
        v.b.js(f"document.querySelector('[data-light={handle}] input[type=checkbox]').click()")
    v.b.until("alpenglow.state.wishes.dim.key === 0 && alpenglow.state.wishes.dim.fill === 0")
    v.settled()
    whole, key, fill = v.linear(70, 92), v.linear(70, 92, 'light:key'), v.linear(70, 92, 'light:fill')
    assert whole[1] > 0.1 and key[1] > 0.05
    rest = [a - b - c for a, b, c in zip(whole, key, fill)]
    assert near(v.seen(70, 92), [encode(c) for c in rest], 4), (v.seen(70, 92), rest)
    assert v.seen(70, 92)[1] < 40
    assert v.b.js('alpenglow.state.generation') == generation  # without a new render
    for handle in ('key', 'fill'):
        v.b.js(f"document.querySelector('[data-light={handle}] input[type=checkbox]').click()")
    v.b.until("alpenglow.state.wishes.dim.key === 1")
    v.settled()
    assert near(v.seen(90, 40), lit)
    v.set('lights', False)
    v.settled()


def check_compare(v):
    v.b.js("document.getElementById('keep').closest('details').open = true")
    v.b.key('k')
    kept = v.linear(70, 40), v.linear(90, 40)
    v.set('direct', False)
    v.settled()
    now = v.linear(70, 40), v.linear(90, 40)
    assert abs(kept[0][1] - now[0][1]) > 0.02
    v.b.key('w')
    assert near(v.seen(70, 40), [encode(c) for c in kept[0]])  # left of the middle: what was kept
    assert near(v.seen(90, 40), [encode(c) for c in now[1]])
    v.shot('wipe')
    x, y = v.place(80, 60)
    v.b.drag(x, y, *v.place(100, 60))
    assert near(v.seen(90, 40), [encode(c) for c in kept[1]])
    v.b.key('d')
    assert near(v.seen(70, 40), [encode(abs(a - b)) for a, b in zip(kept[0], now[0])], 4), v.seen(70, 40)
    v.shot('difference')
    v.b.key('d')
    v.set('direct', True)
    v.settled()


def check_save(v):
    v.b.js("document.getElementById('view').focus()")
    v.b.key('s')
    v.b.key('S', modifiers=8)
    v.b.until('alpenglow.state.saved.length === 2')
    assert sorted(v.b.js('alpenglow.state.saved')) == ['Pathtraced_16_0.exr', 'Pathtraced_16_0.png']
    for name in ('Pathtraced_16_0.exr', 'Pathtraced_16_0.png'):
        assert os.path.getsize(os.path.join(v.folder, name)) > 500
    assert not os.path.exists(os.path.join(v.folder, 'x.exr'))


def check_watch(v):
    begun = time.monotonic()
    v.write('mine.sl', SHADER.replace('color(level, comp(Ci, 1), 0)', 'color(0, 0, level)'))
    v.b.until("alpenglow.stage.whole.half[(50 * 160 + 80) * 4] === 0 && alpenglow.stage.whole.half[(50 * 160 + 80) * 4 + 2] > 0x3000", 30)
    print(f'    a changed shader was seen after {time.monotonic() - begun:.2f} s')
    v.settled()
    assert v.seen(80, 50)[0] == 0 and v.seen(80, 50)[2] > 100
    v.write('s.rib', SCENE + 'WorldEnd\n')
    v.b.until("document.getElementById('messages').innerText.includes('s.rib:18')")
    v.write('s.rib', SCENE)
    v.b.until("!document.getElementById('messages').innerText.includes('s.rib:18')")
    v.settled()


def check_looks(v):
    width = 'document.documentElement.scrollWidth <= innerWidth'
    contrast = '''(() => { const lum = (c) => { const v = c.match(/[\\d.]+/g).slice(0, 3).map((x) => { x /= 255; return x <= 0.03928 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4; });
          return 0.2126 * v[0] + 0.7152 * v[1] + 0.0722 * v[2]; };
        const behind = (e) => { for (; e; e = e.parentElement) { const c = getComputedStyle(e).backgroundColor; if (!/, 0\\)|transparent/.test(c)) return c; } return 'rgb(255, 255, 255)'; };
        let worst = 99; for (const e of document.querySelectorAll('summary, label, button:not(:disabled), #status, dt, dd, .quiet, figcaption, #messages li, #messages span, #messages .place')) {
          const a = lum(getComputedStyle(e).color), b = lum(behind(e)); worst = Math.min(worst, (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05)); } return worst; })()'''
    for scheme in ('light', 'dark'):
        v.b.scheme(scheme)
        assert v.b.js(contrast) >= 4.5, (scheme, v.b.js(contrast))
        v.shot(scheme)
    v.b.resize(390, 780)
    v.b.until('alpenglow.stage.canvas.clientWidth <= 390')
    assert v.b.js(width)
    small = v.b.js("Math.min(...[...document.querySelectorAll('nav button')].map((b) => b.getBoundingClientRect().height))")
    assert small >= 32, small  # for a finger
    assert near(v.seen(80, 50), [encode(c) for c in v.linear(80, 50)], 4)
    v.shot('small')
    v.b.scheme('light')
    v.b.resize(1280, 800)
    unnamed = v.b.js('''[...document.querySelectorAll('input, select, button')].filter((e) => !(e.labels && e.labels.length) && !e.getAttribute('aria-label') && !e.textContent.trim()).map((e) => e.outerHTML)''')
    assert not unnamed, unnamed


def check_keyboard(v):
    v.b.key('?')
    v.b.until("document.getElementById('keys').open")
    v.shot('keys')
    v.b.js("document.getElementById('keys').close(); document.getElementById('view').focus()")
    before = v.b.js('alpenglow.stage.scale()')
    v.b.key('+')
    assert v.b.js('alpenglow.stage.scale()') > before
    v.b.key('f')
    v.b.key(' ')
    v.b.until('alpenglow.state.wishes.paused === true')
    v.b.key(' ')
    v.b.until('alpenglow.state.wishes.paused === false')
    v.settled()


def check_others(v):
    """A second viewer, and a page that goes away."""
    second = chromium.Browser((600, 500))
    try:
        second.open(v.address)
        second.until('window.alpenglow && alpenglow.pictures > 0')
        v.set('spp', 20)
        second.until('alpenglow.state.wishes.spp === 20 && alpenglow.state.figures.spp === 20')
    finally:
        second.close()
    v.set('spp', 16)
    v.settled()


def check_end(v):
    v.process.send_signal(signal.SIGINT)
    assert v.process.wait(20) == 0
    v.b.until("document.getElementById('status').textContent.includes('gone')")
    real = [f for f in v.b.faults if 'ERR_' not in f and '"level": "warning"' not in f]
    assert not real, real


def main():
    if not os.environ.get('ALPENGLOW_NIGHTLY') and '--now' not in sys.argv:
        print('skipped: only in ./check --all')
        return 77
    if not chromium.program():
        print('skipped: there is no Chromium here (apt-get install chromium)')
        return 77
    rest = [a for a in sys.argv[1:] if a != '--now']
    shots = rest[1] if len(rest) > 1 else tempfile.mkdtemp(prefix='alpenglow-view-shots-')
    os.makedirs(shots, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        v = View(os.path.abspath(rest[0]), folder, shots)
        try:
            for check in (check_growth, check_number_of_samples, check_pixels, check_zoom, check_outputs, check_messages, check_switches, check_crop,
                          check_camera, check_compare, check_shaders, check_lights, check_save, check_watch, check_looks, check_keyboard,
                          check_others, check_end):
                begun = time.monotonic()
                try:
                    check(v)
                except BaseException:
                    v.shot('failed')
                    raise
                print(f'{check.__name__[6:]}: {time.monotonic() - begun:.1f} s', flush=True)
        finally:
            v.close()
    print(f'screenshots: {shots}')
    return 0


if __name__ == '__main__':
    sys.exit(main())
