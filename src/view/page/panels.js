// Panels that the scene fills: lights, shaders, messages.
const el = (tag, props = {}, ...children) => {
  const e = Object.assign(document.createElement(tag), props);
  e.append(...children);
  return e;
};
export const placeText = (p) => p && p.file ? `${p.file}${p.line > 0 ? `:${p.line}` : ''}${p.line > 0 && p.column > 0 ? `:${p.column}` : ''}` : '';
let ids = 0;

export function showMessages(list, messages, from) {
  if (from === 0) list.replaceChildren();
  for (const m of messages) {
    const li = el('li', {}, el('span', { className: m.severity.includes('error') ? 'error' : m.severity, textContent: `${m.severity}: ` }), m.text);
    if (placeText(m.place)) li.prepend(el('div', { className: 'place', textContent: placeText(m.place) }));
    if (m.line) li.append(el('pre', { textContent: m.line }));
    for (const n of m.notes) li.append(el('div', { className: 'quiet', textContent: n }));
    if (m.hint) li.append(el('div', { className: 'quiet', textContent: m.hint }));
    list.append(li);
  }
  if (!list.children.length) list.append(el('li', { className: 'quiet', textContent: 'None.' }));
  else if (list.children.length > 1 && list.firstChild.textContent === 'None.') list.firstChild.remove();
}

export function showLights(box, lights, wishes, path, send) {
  const have = lights.join('\n');
  if (box.dataset.have !== have) {
    box.dataset.have = have;
    box.replaceChildren();
    for (const handle of lights) {
      const id = `light${++ids}`;
      const on = el('input', { type: 'checkbox', checked: true });
      on.setAttribute('aria-label', `light ${handle} on`);
      const dim = el('input', { type: 'range', min: 0, max: 4, step: 0.01, value: 1, id });
      const out = el('output', { textContent: '1' });
      let last = 1;
      const set = (v) => { out.textContent = String(+v.toFixed(2)); send({ dim: { [handle]: v } }); };
      dim.addEventListener('input', () => { on.checked = +dim.value > 0; set(+dim.value); });
      on.addEventListener('change', () => {
        if (!on.checked) last = +dim.value || 1;
        dim.value = on.checked ? last : 0;
        set(+dim.value);
      });
      const row = el('div', { className: 'param' }, el('label', { htmlFor: id, className: 'inline', title: handle }, on, handle), dim, out);
      row.dataset.light = handle;
      box.append(row);
    }
    if (!lights.length) box.append(el('p', { className: 'quiet', textContent: 'The scene has no lights with a handle.' }));
  }
  for (const row of box.querySelectorAll('[data-light]')) {
    const [on, dim] = row.querySelectorAll('input');
    on.disabled = dim.disabled = !wishes.lights || !path;
    const v = wishes.dim[row.dataset.light];
    if (v !== undefined && document.activeElement !== dim && document.activeElement !== on) {
      dim.value = v;
      on.checked = v > 0;
      row.querySelector('output').textContent = String(+v.toFixed(2));
    }
  }
}

/** Values that a slider reaches. */
function reach(v, byDefault) {
  const m = Math.max(Math.abs(v), Math.abs(byDefault || 0));
  return v < 0 || byDefault < 0 ? [-2 * m || -1, 2 * m || 1] : [0, m > 1 ? 2 * m : 1];
}

const hex = (v) => Math.round(Math.min(Math.max(v, 0), 1) * 255).toString(16).padStart(2, '0');

function floatRow(p, value, send) {
  const id = `p${++ids}`, [min, max] = reach(value[0], p.default && p.default[0] !== undefined ? p.default[0] : p.default);
  const slider = el('input', { type: 'range', id, min, max, step: (max - min) / 500, value: value[0] });
  const number = el('input', { type: 'number', step: 'any', value: +value[0].toPrecision(6) });
  number.setAttribute('aria-label', `${p.name}, number`);
  slider.addEventListener('input', () => { number.value = +(+slider.value).toPrecision(4); send([+slider.value]); });
  number.addEventListener('change', () => {
    if (number.value === '' || !Number.isFinite(+number.value)) return;
    slider.value = number.value;
    send([+number.value]);
  });
  return el('div', { className: 'param' }, el('label', { htmlFor: id, textContent: p.name, title: p.name }), slider, number);
}

function colorRow(p, value, send) {
  const id = `p${++ids}`;
  const swatch = el('input', { type: 'color', id, value: `#${value.map(hex).join('')}` });
  const numbers = value.map((v, k) => {
    const n = el('input', { type: 'number', step: 'any', value: +v.toPrecision(4) });
    n.setAttribute('aria-label', `${p.name} ${'rgb'[k]}`);
    return n;
  });
  swatch.addEventListener('input', () => {
    const v = [1, 3, 5].map((i) => parseInt(swatch.value.slice(i, i + 2), 16) / 255);
    numbers.forEach((n, k) => { n.value = +v[k].toPrecision(4); });
    send(v);
  });
  for (const n of numbers)
    n.addEventListener('change', () => {
      const v = numbers.map((x) => +x.value);
      if (!v.every(Number.isFinite)) return;
      swatch.value = `#${v.map(hex).join('')}`;
      send(v);
    });
  return el('div', { className: 'param' }, el('label', { htmlFor: id, textContent: p.name, title: p.name }), el('div', { className: 'wide' }, swatch, ...numbers));
}

function textRow(p, value, send) {
  const id = `p${++ids}`, input = el('input', { id, value: value[0] ?? '', spellcheck: false });
  input.addEventListener('change', () => send([input.value]));
  const wide = el('div', { className: 'wide' }, input);
  wide.style.display = 'block';
  return el('div', { className: 'param' }, el('label', { htmlFor: id, textContent: p.name, title: p.name }), wide);
}

/** Points and vectors: three numbers, each with room for its sign and digits. */
function vectorRow(p, value, send) {
  const id = `p${++ids}`;
  const numbers = value.map((v, k) => {
    const n = el('input', { type: 'number', step: 'any', value: +v.toPrecision(6) });
    n.setAttribute('aria-label', `${p.name} ${'xyz'[k]}`);
    return n;
  });
  numbers[0].id = id;
  for (const n of numbers)
    n.addEventListener('change', () => {
      const v = numbers.map((x) => +x.value);
      if (numbers.every((x) => x.value !== '') && v.every(Number.isFinite)) send(v);
    });
  return el('div', { className: 'param' }, el('label', { htmlFor: id, textContent: p.name, title: p.name }), el('div', { className: 'wide three' }, ...numbers));
}

export function showShaders(box, shaders, send, copy) {
  const open = new Set([...box.querySelectorAll('details[open]')].map((d) => d.dataset.key));
  box.replaceChildren();
  shaders.forEach((s, number) => {
    const key = `${number} ${s.name}`;
    const d = el('details', { className: 'shader', open: open.has(key) || shaders.length === 1 },
      el('summary', {}, el('b', { textContent: s.name }), ` ${s.role === 'coshader' ? 'co-shader' : s.role}${s.handle ? ` ${s.handle}` : ''}${s.primitives > 1 ? ` × ${s.primitives}` : ''}`),
      el('p', { className: 'quiet place', textContent: placeText(s.place) }));
    const button = el('button', { type: 'button', textContent: 'Copy RIB', title: 'The request of this shader, with what was changed here' });
    button.addEventListener('click', () => copy(number));
    d.append(el('p', { className: 'row' }, button));
    d.dataset.key = key;
    d.dataset.shader = number;
    const parameters = s.about && s.about.parameters ? s.about.parameters : [];
    for (const p of parameters) {
      if (p.output) continue;
      const byDefault = p.default === undefined || p.default === null ? undefined : [p.default].flat();
      const value = s.values[p.name] || byDefault;
      if (!value) continue;
      const push = (v) => send({ shader: number, name: p.name, type: p.type, value: v });
      let row = null;
      if (p.type === 'float' && value.length === 1) row = floatRow(p, value, push);
      else if (/^(color|point|vector|normal)$/.test(p.type) && value.length === 3) row = p.type === 'color' ? colorRow(p, value, push) : vectorRow(p, value, push);
      else if (p.type === 'string' && value.length === 1) row = textRow(p, value, push);
      if (!row) continue;
      row.dataset.parameter = p.name;
      d.append(row);
    }
    if (!parameters.length) d.append(el('p', { className: 'quiet', textContent: 'Nothing is known of it.' }));
    box.append(d);
  });
  if (!shaders.length) box.append(el('p', { className: 'quiet', textContent: 'The scene names no shaders.' }));
}
