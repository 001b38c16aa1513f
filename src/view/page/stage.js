// The picture on the stage: what has come, what is kept for comparison, moving and zooming, and the three tools.
import { halfValues, paint, paintDifference, rangeOf, kindOf } from './pixels.js';

const make = (w, h) => Object.assign(document.createElement('canvas'), { width: w, height: h });

export class Stage {
  /** hooks: camera(change), crop(window or null), hover(x, y), changed() */
  constructor(canvas, wipeBar, hooks) {
    Object.assign(this, { canvas, wipeBar, hooks });
    this.curve = { gain: 1, gamma: 2.2, srgb: false };
    this.range = null; // null: by itself
    this.zoom = 0;     // 0: the whole picture fits
    this.centre = [0.5, 0.5];
    this.tool = 'pan';
    this.crop = null;
    this.compare = ''; // 'wipe', 'difference'
    this.wipe = 0.5;
    this.difference = 1;
    this.kept = null;
    this.part = null;  // what came last
    this.whole = null; // {width, height, half, kind}: the picture in full resolution
    this.base = make(1, 1);
    this.keptBase = null;
    this.pointers = new Map();
    this.listen();
    new ResizeObserver(() => this.redraw()).observe(canvas);
  }

  /** A picture that has come: half floats of a window of it, w x h of steps. */
  take(p, half) {
    const kind = kindOf(p.plane, p.channels);
    if (!this.whole || this.whole.width !== p.width || this.whole.height !== p.height || this.whole.plane !== p.plane) {
      this.whole = { width: p.width, height: p.height, plane: p.plane, kind, half: new Uint16Array(p.width * p.height * 4) };
      this.base = make(p.width, p.height);
      const g = this.base.getContext('2d');
      g.fillStyle = '#000';
      g.fillRect(0, 0, p.width, p.height);
      if (this.kept && (this.kept.width !== p.width || this.kept.height !== p.height)) this.compare = '';
    }
    this.part = { ...p, half, kind };
    const to = this.whole.half, W = p.width, H = p.height;
    if (p.stepX === 1 && p.stepY === 1) {
      for (let y = 0; y < p.h; ++y)
        to.set(half.subarray(y * p.w * 4, (y + 1) * p.w * 4), ((y + p.y0) * W + p.x0) * 4);
    } else { // coarse: each of its pixels stands for several
      for (let y = Math.floor(p.y0 * p.stepY); y < Math.min(H, (p.y0 + p.h) * p.stepY); ++y) {
        const row = Math.min(p.h - 1, Math.max(0, Math.floor((y + 0.5) / p.stepY) - p.y0)) * p.w;
        for (let x = Math.floor(p.x0 * p.stepX); x < Math.min(W, (p.x0 + p.w) * p.stepX); ++x) {
          const s = (row + Math.min(p.w - 1, Math.max(0, Math.floor((x + 0.5) / p.stepX) - p.x0))) * 4, d = (y * W + x) * 4;
          to[d] = half[s]; to[d + 1] = half[s + 1]; to[d + 2] = half[s + 2]; to[d + 3] = half[s + 3];
        }
      }
    }
    this.tone(true);
  }

  /** Numbers to codes; `part`: only what came last. */
  tone(part) {
    const w = this.whole, p = this.part;
    if (!w) return;
    const range = this.range || (w.kind === 'range' || w.kind === 'heat' ? rangeOf(w.half, w.kind) : [0, 1]);
    this.shownRange = range;
    const g = this.base.getContext('2d');
    const onlyPart = part && (w.kind === 'colour' || w.kind === 'signed');
    if (onlyPart || p.stepX !== 1) {
      const tile = make(p.w, p.h), image = new ImageData(p.w, p.h);
      paint(image, p.half, w.kind, this.curve, range);
      tile.getContext('2d').putImageData(image, 0, 0);
      g.imageSmoothingEnabled = p.stepX !== 1;
      g.drawImage(tile, p.x0 * p.stepX, p.y0 * p.stepY, p.w * p.stepX, p.h * p.stepY);
    } else {
      const image = new ImageData(w.width, w.height);
      paint(image, w.half, w.kind, this.curve, range);
      g.putImageData(image, 0, 0);
    }
    if (!part && this.kept) this.toneKept();
    if (this.compare === 'difference') this.toneDifference();
    this.redraw();
  }

  toneKept() {
    const k = this.kept, image = new ImageData(k.width, k.height);
    paint(image, k.half, k.kind, this.curve, this.shownRange || [0, 1]);
    this.keptBase = make(k.width, k.height);
    this.keptBase.getContext('2d').putImageData(image, 0, 0);
  }

  toneDifference() {
    const w = this.whole, k = this.kept;
    if (!w || !k || k.width !== w.width || k.height !== w.height) return;
    const image = new ImageData(w.width, w.height);
    paintDifference(image, w.half, k.half, this.difference, this.curve);
    this.differenceBase = make(w.width, w.height);
    this.differenceBase.getContext('2d').putImageData(image, 0, 0);
  }

  keep() {
    if (!this.whole) return false;
    this.kept = { ...this.whole, half: this.whole.half.slice() };
    this.toneKept();
    return true;
  }

  setCompare(mode) {
    const fits = this.kept && this.whole && this.kept.width === this.whole.width && this.kept.height === this.whole.height;
    this.compare = fits ? mode : '';
    if (this.compare === 'difference') this.toneDifference();
    this.redraw();
    return this.compare;
  }

  // --- where things are ---
  fitZoom() {
    const w = this.whole, c = this.canvas;
    return w ? Math.min(c.clientWidth / w.width, c.clientHeight / w.height) || 1 : 1;
  }
  scale() { return this.zoom || this.fitZoom(); }
  origin() {
    const c = this.canvas, s = this.scale(), w = this.whole;
    return [c.clientWidth / 2 - this.centre[0] * w.width * s, c.clientHeight / 2 - this.centre[1] * w.height * s];
  }
  pixelAt(x, y) {
    if (!this.whole) return null;
    const [ox, oy] = this.origin(), s = this.scale();
    return [(x - ox) / s, (y - oy) / s];
  }
  fit() { this.zoom = 0; this.centre = [0.5, 0.5]; this.redraw(); }
  zoomBy(factor, x = this.canvas.clientWidth / 2, y = this.canvas.clientHeight / 2) {
    const at = this.pixelAt(x, y);
    if (!at) return;
    const w = this.whole;
    this.zoom = Math.min(Math.max(this.scale() * factor, Math.min(0.05, this.fitZoom())), 256);
    this.centre = [(at[0] - (x - this.canvas.clientWidth / 2) / this.zoom) / w.width, (at[1] - (y - this.canvas.clientHeight / 2) / this.zoom) / w.height];
    this.redraw();
  }
  moveBy(dx, dy) {
    if (!this.whole) return;
    const s = this.scale();
    if (!this.zoom) this.zoom = s;
    this.centre[0] = Math.min(Math.max(this.centre[0] - dx / s / this.whole.width, 0), 1);
    this.centre[1] = Math.min(Math.max(this.centre[1] - dy / s / this.whole.height, 0), 1);
    this.redraw();
  }

  // --- drawing ---
  redraw() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => { this.waiting = false; this.draw(); });
  }
  draw() {
    const c = this.canvas, dpr = devicePixelRatio || 1, W = Math.round(c.clientWidth * dpr), H = Math.round(c.clientHeight * dpr);
    if (c.width !== W || c.height !== H) { c.width = W; c.height = H; }
    const g = c.getContext('2d');
    g.setTransform(1, 0, 0, 1, 0, 0);
    g.clearRect(0, 0, W, H);
    const w = this.whole;
    if (!w) return;
    const s = this.scale(), [ox, oy] = this.origin();
    g.setTransform(dpr, 0, 0, dpr, 0, 0);
    g.imageSmoothingEnabled = s * dpr < 1;
    g.imageSmoothingQuality = 'high';
    const picture = this.compare === 'difference' && this.differenceBase ? this.differenceBase : this.base;
    g.drawImage(picture, ox, oy, w.width * s, w.height * s);
    const bar = ox + this.wipe * w.width * s;
    this.wipeBar.hidden = this.compare !== 'wipe';
    if (this.compare === 'wipe' && this.keptBase) {
      g.save();
      g.beginPath();
      g.rect(ox, oy, this.wipe * w.width * s, w.height * s);
      g.clip();
      g.drawImage(this.keptBase, ox, oy, w.width * s, w.height * s);
      g.restore();
      this.wipeBar.style.left = `${bar}px`;
      this.wipeBar.setAttribute('aria-valuenow', String(Math.round(this.wipe * 100)));
    }
    if (s >= 44) this.drawNumbers(g, s, ox, oy);
    const crop = this.dragCrop || this.crop;
    if (crop) {
      const r = [ox + crop[0] * w.width * s, oy + crop[2] * w.height * s, (crop[1] - crop[0]) * w.width * s, (crop[3] - crop[2]) * w.height * s];
      g.lineWidth = 1;
      g.strokeStyle = '#000';
      g.strokeRect(...r);
      g.strokeStyle = '#fff';
      g.setLineDash([5, 5]);
      g.strokeRect(...r);
      g.setLineDash([]);
    }
    this.hooks.changed();
  }
  /** Zoomed in far enough, pixels say what is in them. */
  drawNumbers(g, s, ox, oy) {
    const w = this.whole, c = this.canvas;
    const x0 = Math.max(0, Math.floor(-ox / s)), x1 = Math.min(w.width, Math.ceil((c.clientWidth - ox) / s));
    const y0 = Math.max(0, Math.floor(-oy / s)), y1 = Math.min(w.height, Math.ceil((c.clientHeight - oy) / s));
    g.font = `${Math.min(13, s / 5.2)}px ui-monospace, "DejaVu Sans Mono", monospace`;
    g.textAlign = 'center';
    if (x1 <= x0 || y1 <= y0) return;
    const codes = this.base.getContext('2d').getImageData(x0, y0, x1 - x0, y1 - y0).data;
    const grey = w.kind === 'range' || w.kind === 'heat';
    for (let y = y0; y < y1; ++y)
      for (let x = x0; x < x1; ++x) {
        const at = (y * w.width + x) * 4, list = grey ? [0] : [0, 1, 2];
        const p = ((y - y0) * (x1 - x0) + x - x0) * 4;
        g.fillStyle = 0.3 * codes[p] + 0.6 * codes[p + 1] + 0.1 * codes[p + 2] > 110 ? '#000' : '#fff';
        list.forEach((k, i) => {
          const v = halfValues[w.half[at + k]];
          g.fillText(Math.abs(v) >= 100 || (v !== 0 && Math.abs(v) < 0.001) ? v.toExponential(1) : v.toFixed(3), ox + (x + 0.5) * s,
            oy + (y + 0.5) * s + (i - (list.length - 1) / 2) * s / 4.2 + s / 16);
        });
      }
  }

  // --- mouse, fingers, pen ---
  listen() {
    const c = this.canvas;
    const place = (e) => { const r = c.getBoundingClientRect(); return [e.clientX - r.left, e.clientY - r.top]; };
    c.addEventListener('pointerdown', (e) => {
      c.setPointerCapture(e.pointerId);
      c.focus({ preventScroll: true });
      this.pointers.set(e.pointerId, place(e));
      if (this.pointers.size === 2) { this.begun = null; this.dragCrop = null; return; }
      const at = this.pixelAt(...place(e));
      this.begun = { tool: e.button === 1 ? 'pan' : this.tool, at, second: e.button === 2 || e.shiftKey, moved: false };
      if (this.begun.tool === 'camera') this.hooks.camera({ drag: true });
      e.preventDefault();
    });
    c.addEventListener('pointermove', (e) => {
      const now = place(e), was = this.pointers.get(e.pointerId);
      if (!was) { this.hooks.hover(this.pixelAt(...now)); return; }
      if (this.pointers.size === 2) { // a pinch
        const other = [...this.pointers].find(([id]) => id !== e.pointerId)[1];
        const far = (a) => Math.hypot(a[0] - other[0], a[1] - other[1]);
        const factor = far(now) / Math.max(far(was), 1);
        if (this.tool === 'camera') this.hooks.camera({ dolly: factor, drag: true });
        else { this.zoomBy(factor, (now[0] + other[0]) / 2, (now[1] + other[1]) / 2); this.moveBy((now[0] - was[0]) / 2, (now[1] - was[1]) / 2); }
        this.pointers.set(e.pointerId, now);
        return;
      }
      this.pointers.set(e.pointerId, now);
      if (!this.begun) return;
      const dx = now[0] - was[0], dy = now[1] - was[1];
      if (dx || dy) this.begun.moved = true;
      if (this.begun.tool === 'pan') this.moveBy(dx, dy);
      else if (this.begun.tool === 'camera') {
        const size = this.scale() * (this.whole ? this.whole.height : 1);
        this.hooks.camera(this.begun.second ? { pan: [dx / size, -dy / size], drag: true } : { orbit: [dx * 0.4, dy * 0.4], drag: true });
      } else if (this.begun.at && this.whole) {
        const at = this.pixelAt(...now), w = this.whole, b = this.begun.at;
        const clip = (v, most) => Math.min(Math.max(Math.round(v), 0), most) / most;
        this.dragCrop = [clip(Math.min(at[0], b[0]), w.width), clip(Math.max(at[0], b[0]), w.width),
          clip(Math.min(at[1], b[1]), w.height), clip(Math.max(at[1], b[1]), w.height)];
        this.redraw();
      }
    });
    const up = (e) => {
      this.pointers.delete(e.pointerId);
      const b = this.begun;
      if (!b || this.pointers.size) return;
      this.begun = null;
      if (b.tool === 'camera') this.hooks.camera({ settle: true });
      if (b.tool === 'crop') {
        const d = this.dragCrop;
        this.dragCrop = null;
        if (d && d[1] > d[0] && d[3] > d[2]) this.hooks.crop(d);
        else if (!b.moved) this.hooks.crop(null);
        this.redraw();
      }
    };
    c.addEventListener('pointerup', up);
    c.addEventListener('pointercancel', up);
    c.addEventListener('pointerleave', () => { if (!this.pointers.size) this.hooks.hover(null); });
    c.addEventListener('contextmenu', (e) => e.preventDefault());
    c.addEventListener('wheel', (e) => {
      e.preventDefault();
      const factor = 2 ** (-e.deltaY * (e.deltaMode === 1 ? 16 : 1) / 400);
      if (this.tool === 'camera') this.hooks.wheelCamera(factor);
      else this.zoomBy(factor, ...place(e));
    }, { passive: false });
    const wipeTo = (e) => {
      if (!this.whole) return;
      const [ox] = this.origin(), r = c.getBoundingClientRect();
      this.wipe = Math.min(Math.max((e.clientX - r.left - ox) / (this.whole.width * this.scale()), 0), 1);
      this.redraw();
    };
    this.wipeBar.addEventListener('pointerdown', (e) => this.wipeBar.setPointerCapture(e.pointerId));
    this.wipeBar.addEventListener('pointermove', (e) => { if (this.wipeBar.hasPointerCapture(e.pointerId)) wipeTo(e); });
    this.wipeBar.addEventListener('keydown', (e) => {
      const step = { ArrowLeft: -0.02, ArrowRight: 0.02 }[e.key];
      if (!step) return;
      e.preventDefault();
      e.stopPropagation();
      this.wipe = Math.min(Math.max(this.wipe + step, 0), 1);
      this.redraw();
    });
  }
}
