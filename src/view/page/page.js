// The page of alpenglow view.
import { Stage } from './stage.js';
import { Curves, short } from './curves.js';
import { showLights, showMessages, showShaders } from './panels.js';

const $ = (id) => document.getElementById(id);
const page = { serial: 0, messages: 0, points: 0, scene: -1, curveOf: -1, tag: '', plane: 'picture', frames: 0, state: null, connected: false };
window.alpenglow = page; // for tests

// --- to the server ---
async function post(what) {
  const r = await fetch('do', { method: 'POST', body: JSON.stringify(what) });
  const answer = r.ok ? await r.json() : { error: await r.text() };
  if (answer.error) say(answer.error);
  return answer;
}
let said = -1e9;
function say(text) {
  $('status').textContent = text;
  said = performance.now();
  setTimeout(() => { if (page.state && page.connected) showState(page.state); }, 4100);
}
const set = (wishes) => post({ do: 'set', wishes });
/** One request of a kind at a time; what comes meanwhile is put together. */
function gather(join, send) {
  let waiting = null, busy = false;
  return async (change) => {
    waiting = waiting ? join(waiting, change) : change;
    if (busy) return;
    busy = true;
    while (waiting) {
      const next = waiting;
      waiting = null;
      try { await send(next); } catch { break; }
    }
    busy = false;
  };
}
const camera = gather((a, b) => {
  const c = { ...a, ...b };
  for (const k of ['orbit', 'pan']) if (a[k] && b[k]) c[k] = [a[k][0] + b[k][0], a[k][1] + b[k][1]];
  if (a.dolly && b.dolly) c.dolly = a.dolly * b.dolly;
  return c;
}, (c) => post({ do: 'camera', ...c }));
const dim = gather((a, b) => ({ dim: { ...a.dim, ...b.dim } }), set);
const parameters = gather((a, b) => new Map([...a, ...b]), async (m) => { for (const p of m.values()) await post({ do: 'parameter', ...p }); });
let settling = 0;
function nudgeCamera(change) { // by keys and wheel: it comes to rest by itself
  camera({ ...change, drag: true });
  clearTimeout(settling);
  settling = setTimeout(() => camera({ settle: true }), 350);
}

// --- the stage ---
const stage = new Stage($('view'), $('wipe'), {
  camera,
  wheelCamera: (factor) => nudgeCamera({ dolly: factor }),
  crop: (c) => set({ crop: c }),
  hover,
  changed: () => { page.frames++; },
});
page.stage = stage;
const curves = new Curves($('curves'));
let hovered = null, asking = false;
function hover(at) {
  const w = stage.whole;
  hovered = at && w && at[0] >= 0 && at[1] >= 0 && at[0] < w.width && at[1] < w.height ? at.map(Math.floor) : null;
  if (!hovered) { $('values').textContent = ''; return; }
  askPixel();
}
async function askPixel() {
  if (asking) return;
  asking = true;
  while (hovered) {
    const [x, y] = hovered;
    let v;
    try { v = (await (await fetch(`pixel?x=${x}&y=${y}&plane=${encodeURIComponent(page.plane)}`)).json()).values || {}; } catch { break; }
    const n = (k) => v[k] === undefined ? '–' : v[k] === null ? '∞' : short(v[k]);
    let text = `${x}, ${y}   r ${n('picture/r')}  g ${n('picture/g')}  b ${n('picture/b')}  a ${n('picture/a')}  z ${v['picture/z'] > 1e30 ? '∞' : n('picture/z')}`;
    const own = Object.keys(v).filter((k) => k.startsWith(page.plane + '/') && page.plane !== 'picture');
    if (own.length) text += `\n${page.plane}   ${own.map((k) => `${k.slice(page.plane.length + 1)} ${n(k)}`).join('  ')}`;
    if (hovered) $('values').textContent = text;
    if (!hovered || (hovered[0] === x && hovered[1] === y)) break;
  }
  asking = false;
}

// --- what comes ---
let abort = null;
async function poll() {
  for (;;) {
    abort = new AbortController();
    try {
      const q = `have=${page.serial}&plane=${encodeURIComponent(page.plane)}&messages=${page.messages}&points=${page.points}&tag=${encodeURIComponent(page.tag)}`;
      const r = await fetch(`picture?${q}`, { signal: abort.signal });
      if (!r.ok) throw new Error(await r.text());
      take(await r.arrayBuffer());
      page.connected = true;
    } catch (e) {
      if (e.name === 'AbortError') continue;
      page.connected = false;
      $('status').textContent = 'The renderer is gone; waiting for it…';
      await new Promise((f) => setTimeout(f, 1000));
    }
  }
}
function again() {
  page.serial = 0;
  page.tag = '';
  if (abort) abort.abort();
}

function take(buffer) {
  const n = new DataView(buffer).getUint32(0, true);
  const s = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, n)));
  page.state = s;
  page.serial = s.serial;
  if (s.scene !== page.scene) { // read or built anew
    page.scene = s.scene;
    if (page.messages) { page.messages = page.points = 0; again(); }
    page.sceneData = null;
    loadScene();
  }
  if (s.curveOf !== page.curveOf) {
    page.curveOf = s.curveOf;
    curves.points = [];
    if (page.points) { page.points = 0; again(); }
  }
  if (page.points === s.pointCount - s.points.length) {
    curves.points.push(...s.points);
    page.points = s.pointCount;
  }
  if (s.messageCount < page.messages) { page.messages = 0; again(); }
  else if (page.messages === s.messageCount - s.messages.length) {
    showMessages($('messages'), s.messages, page.messages);
    page.messages = s.messageCount;
    $('messagecount').textContent = s.messageCount + s.lost ? `(${s.messageCount + s.lost})` : '';
  }
  if (s.picture && s.picture.pixels) {
    page.tag = s.tag;
    const first = !stage.whole;
    if (first) { Object.assign(stage.curve, s.curve); showCurve(); }
    if (s.picture.plane === page.plane) {
      stage.take(s.picture, new Uint16Array(buffer, 4 + n));
      page.pictures = (page.pictures || 0) + 1;
      page.last = performance.now();
    }
  }
  showState(s);
}

const phases = { reading: 'Reading the scene', building: 'Building', coarse: 'Rendering', crop: 'Rendering the crop', whole: 'Rendering', idle: 'Done' };
function showState(s) {
  $('title').textContent = document.title = s.file.replace(/.*\//, '');
  const f = s.figures || {}, w = s.wishes;
  if (performance.now() - said > 4000)
    $('status').textContent = `${w.paused ? 'Paused' : phases[s.phase]} · ${f.spp ? `${short(f.spp)}${w.continuous ? '' : ` of ${w.spp}`} samples · ` : ''}${s.width} × ${s.height}`;
  document.querySelector('#bar i').style.width = s.phase === 'idle' || w.continuous ? '0' : `${Math.min(100, 100 * (f.spp || 0) / w.spp)}%`;
  const percent = (v) => v > 0 ? `${(100 * v).toPrecision(3)} %` : '–';
  const rows = [['Samples', short(f.spp)], ['Seconds', (f.seconds || 0).toFixed(1)], ['Rays/ms', short(f.raysPerMS)], ['noiseRSE', short(f.noiseRSE)],
    ['noiseRSE999', short(f.noiseRSE999)], ['Efficiency', short(f.efficiency)], ['Noise', percent(f.noise)], ['Noise, 95 % sure', percent(f.noiseAtMost)]];
  const dl = $('figures');
  if (!dl.children.length) for (const [name] of rows) dl.insertAdjacentHTML('beforeend', `<dt>${name}</dt><dd></dd>`);
  rows.forEach(([, v], i) => { dl.children[2 * i + 1].textContent = v; });
  curves.draw();
  const put = (id, v) => { const e = $(id); if (document.activeElement !== e) e.type === 'checkbox' ? (e.checked = v) : (e.value = v); };
  for (const k of ['continuous', 'direct', 'indirect', 'lights']) put(k, w[k]);
  for (const k of ['spp', 'depth', 'hider', 'factor', 'clamp']) put(k, String(w[k]));
  $('spp').disabled = w.continuous && document.activeElement !== $('spp');
  $('pause').setAttribute('aria-pressed', String(w.paused));
  stage.crop = w.crop;
  $('cropout').textContent = w.crop ? w.crop.map((v) => +v.toFixed(3)).join(' ') : 'none';
  $('cameraout').textContent = s.moved ? 'moved' : 'the scene’s';
  $('recamera').disabled = !s.moved;
  $('uncrop').disabled = !w.crop;
  const saved = s.saved.length ? s.saved[s.saved.length - 1] : '';
  if (saved && page.saved !== undefined && page.saved !== saved + s.saved.length) say(`Saved ${saved}`);
  page.saved = saved + s.saved.length;
  showPlanes(s);
  showRange();
  if (page.sceneData) showLights($('lightlist'), page.sceneData.lights, w, true, dim);
}

function showPlanes(s) {
  const names = ['picture', 'noise', ...s.wishes.channels, ...(s.wishes.lights && page.sceneData ? page.sceneData.lights.map((l) => `light:${l}`) : [])];
  const select = $('plane');
  if (select.dataset.have !== names.join('\n')) {
    select.dataset.have = names.join('\n');
    select.replaceChildren(...names.map((n) => new Option(n === 'picture' ? 'Picture (Ci)' : n === 'noise' ? 'Map of the noise' : n, n)));
  }
  if (!names.includes(page.plane)) choosePlane('picture');
  if (document.activeElement !== select) select.value = page.plane;
}
function choosePlane(name) {
  if (page.plane === name) return;
  page.plane = name;
  stage.range = null;
  $('auto').checked = true;
  $('plane').value = name;
  again();
}
function showRange() {
  const r = stage.shownRange || [0, 1], auto = $('auto').checked;
  const used = stage.whole && (stage.whole.kind === 'range' || stage.whole.kind === 'heat');
  for (const [id, v] of [['low', r[0]], ['high', r[1]]]) {
    if (auto || !used) $(id).value = used ? +v.toPrecision(4) : '';
    $(id).disabled = auto || !used;
  }
}
function showCurve() {
  const c = stage.curve;
  $('exposure').value = Math.log2(c.gain);
  $('exposureout').textContent = (+$('exposure').value).toFixed(1);
  $('gamma').value = c.gamma;
  $('gammaout').textContent = String(+(+c.gamma).toFixed(2));
  $('gamma').disabled = c.srgb;
  $('srgb').checked = c.srgb;
}
async function loadScene() {
  const open = $('shadersbox').open;
  if (page.loading) { page.loadAgain = true; return; }
  page.loading = true;
  try {
    const data = await (await fetch('scene')).json();
    page.sceneData = data;
    $('outputs').replaceChildren(...['a', 'z', 'N', ...data.computed, 'direct', 'indirect', 'lpe:CL', 'lpe:C<RD>L', 'lpe:C<RD><RD>+L', 'lpe:C<RG>.*L', ...data.outputs].map((o) => new Option(o)));
    const names = data.shaders.map((s) => `${s.name} ${s.about ? 1 : 0}`).join();
    if (open && (page.shadersHave !== names || !$('shaderlist').contains(document.activeElement))) {
      page.shadersHave = names;
      showShaders($('shaderlist'), data.shaders, (p) => parameters(new Map([[`${p.shader} ${p.name}`, p]])),
        (number) => copyRib((d) => d.shaders[number].rib, 'the shader'));
    }
    if (page.state) showState(page.state);
  } catch { /* the next state says so */ }
  page.loading = false;
  if (page.loadAgain) { page.loadAgain = false; loadScene(); }
}

// --- what was tuned, as RIB ---
async function toClipboard(text) {
  try { await navigator.clipboard.writeText(text); return; } catch { /* an old browser, or not allowed */ }
  const area = document.createElement('textarea');
  area.value = text;
  document.body.append(area);
  area.select();
  const done = document.execCommand('copy');
  area.remove();
  if (!done) throw new Error('the browser does not let this page copy');
}
async function copyRib(part, what) {
  try {
    const text = part(await (await fetch('scene')).json());
    page.copied = text;
    if (!text) { say(`Nothing was changed of ${what}`); return; }
    await toClipboard(text);
    say(`Copied ${what} as RIB`);
  } catch (e) { say(`Not copied: ${e.message}`); }
}

// --- controls ---
function tool(name) {
  stage.tool = name;
  $('view').dataset.tool = name;
  for (const b of document.querySelectorAll('[data-tool]')) if (b.tagName === 'BUTTON') b.setAttribute('aria-pressed', String(b.dataset.tool === name));
}
for (const b of document.querySelectorAll('button[data-tool]')) b.addEventListener('click', () => tool(b.dataset.tool));
const save = (type) => post({ do: 'save', type, ...stage.curve });
function pause() { set({ paused: !(page.state && page.state.wishes.paused) }); }
function compare(mode) {
  const now = stage.setCompare(stage.compare === mode ? '' : mode);
  $('wipego').setAttribute('aria-pressed', String(now === 'wipe'));
  $('diffgo').setAttribute('aria-pressed', String(now === 'difference'));
}
function keep() {
  if (!stage.keep()) return;
  $('keptout').textContent = `Kept: ${stage.kept.plane} at ${short(page.state.figures.spp)} samples. Left of the wipe, and what the difference is to.`;
  $('wipego').disabled = $('diffgo').disabled = false;
}
function setCurve(change) {
  Object.assign(stage.curve, change);
  showCurve();
  stage.tone(false);
}
$('fit').onclick = () => stage.fit();
$('actual').onclick = () => { stage.zoom = 1 / (devicePixelRatio || 1); stage.redraw(); };
$('pause').onclick = pause;
$('savepng').onclick = () => save('png');
$('saveexr').onclick = () => save('exr');
$('help').onclick = () => $('keys').showModal();
$('plane').onchange = () => choosePlane($('plane').value);
function addOutput() {
  const name = $('add').value.trim();
  if (!name || !page.state) return;
  const channels = page.state.wishes.channels.includes(name) ? page.state.wishes.channels : [...page.state.wishes.channels, name];
  set({ channels }).then((a) => { if (!a.error) { $('add').value = ''; page.state.wishes.channels = channels; showPlanes(page.state); choosePlane(name); } });
}
$('addgo').onclick = addOutput;
$('add').onkeydown = (e) => { if (e.key === 'Enter') addOutput(); };
$('exposure').oninput = () => setCurve({ gain: 2 ** +$('exposure').value });
$('gamma').oninput = () => setCurve({ gamma: +$('gamma').value });
$('srgb').onchange = () => setCurve({ srgb: $('srgb').checked });
$('auto').onchange = () => { stage.range = $('auto').checked ? null : stage.shownRange; stage.tone(false); showRange(); };
for (const id of ['low', 'high'])
  $(id).onchange = () => { if (!$('auto').checked) { stage.range = [+$('low').value, +$('high').value]; stage.tone(false); } };
for (const id of ['continuous', 'direct', 'indirect', 'lights']) $(id).onchange = () => set({ [id]: $(id).checked });
for (const id of ['spp', 'depth', 'factor', 'clamp']) $(id).onchange = () => { if ($(id).value !== '') set({ [id]: +$(id).value }); };
$('hider').onchange = () => set({ hider: $('hider').value });
$('uncrop').onclick = () => set({ crop: null });
$('recamera').onclick = () => post({ do: 'camera', reset: true, settle: true });
$('copycamera').onclick = () => copyRib((d) => d.cameraRib, 'the camera');
$('copylights').onclick = () => copyRib((d) => d.lightsRib, 'the lights');
$('keep').onclick = keep;
$('wipego').onclick = () => compare('wipe');
$('diffgo').onclick = () => compare('difference');
$('gain').onchange = () => { stage.difference = +$('gain').value; stage.tone(false); };
$('shadersbox').ontoggle = () => { if ($('shadersbox').open) { page.shadersHave = ''; loadScene(); } };
$('lightsbox').ontoggle = () => { if (page.sceneData && page.state) showState(page.state); };
matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => curves.draw());
addEventListener('resize', () => curves.draw());

const keys = [
  ['V', 'Move and zoom the picture', () => tool('pan')],
  ['C', 'Camera: drag orbits, Shift or the right button pans, the wheel dollies', () => tool('camera')],
  ['X', 'Crop: drag what is rendered first; a click takes it back', () => tool('crop')],
  ['F', 'The whole picture', () => stage.fit()],
  ['1', 'One pixel for one', () => $('actual').click()],
  ['+', 'Nearer', () => stage.tool === 'camera' ? nudgeCamera({ dolly: 1.1 }) : stage.zoomBy(1.25)],
  ['-', 'Farther', () => stage.tool === 'camera' ? nudgeCamera({ dolly: 1 / 1.1 }) : stage.zoomBy(0.8)],
  [' ', 'Pause, go on', pause],
  ['E', 'Exposure up, Shift E down', (e) => setCurve({ gain: stage.curve.gain * (e.shiftKey ? Math.SQRT1_2 : Math.SQRT2) })],
  ['N', 'Map of the noise, and back', () => choosePlane(page.plane === 'noise' ? 'picture' : 'noise')],
  ['K', 'Keep this picture to compare with', keep],
  ['W', 'Wipe', () => compare('wipe')],
  ['D', 'Difference', () => compare('difference')],
  ['R', 'The scene’s camera', () => $('recamera').click()],
  ['S', 'Save PNG, Shift S EXR', (e) => save(e.shiftKey ? 'exr' : 'png')],
  ['?', 'This list', () => $('keys').showModal()],
];
$('keytable').innerHTML = [...keys.map(([k, what]) => [k === ' ' ? 'Space' : k, what]), ['Arrows', 'Move; with Camera: orbit, Shift pans'], ['Esc', 'No crop']]
  .map(([k, what]) => `<tr><td><kbd>${k}</kbd></td><td>${what}</td></tr>`).join('');
addEventListener('keydown', (e) => {
  if (e.ctrlKey || e.metaKey || e.altKey || $('keys').open) return;
  const tag = document.activeElement ? document.activeElement.tagName : '';
  if (tag === 'INPUT' && document.activeElement.type !== 'checkbox' || tag === 'SELECT') return;
  if (e.key === ' ' && (tag === 'BUTTON' || tag === 'SUMMARY' || tag === 'INPUT')) return;
  const arrow = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[e.key];
  if (arrow && (document.activeElement === $('view') || document.activeElement === document.body)) {
    e.preventDefault();
    if (stage.tool !== 'camera') stage.moveBy(-40 * arrow[0], -40 * arrow[1]);
    else nudgeCamera(e.shiftKey ? { pan: [0.05 * arrow[0], -0.05 * arrow[1]] } : { orbit: [5 * arrow[0], 5 * arrow[1]] });
    return;
  }
  if (e.key === 'Escape') { set({ crop: null }); return; }
  const k = keys.find(([name]) => name === (e.key === '=' ? '+' : e.key.length === 1 ? e.key.toUpperCase() : e.key));
  if (k) { e.preventDefault(); k[2](e); }
});
tool('pan');
poll();
