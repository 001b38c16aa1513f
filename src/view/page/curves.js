// Small curves over time.
const kinds = [['Samples', 1, false], ['Rays/ms', 2, false], ['noiseRSE', 3, true], ['Efficiency', 4, false]];
export const short = (v) => !Number.isFinite(v) ? '–' : v === 0 ? '0' : Math.abs(v) >= 1e6 || Math.abs(v) < 1e-3 ? v.toExponential(1) : v.toPrecision(Math.abs(v) >= 1000 ? 4 : 3).replace(/\.0+$/, '');

export class Curves {
  constructor(box) {
    this.points = [];
    this.items = kinds.map(([name, at, log]) => {
      const figure = box.appendChild(document.createElement('figure'));
      const caption = figure.appendChild(document.createElement('figcaption'));
      caption.innerHTML = `<span>${name}${log ? ' (log)' : ''}</span><span></span>`;
      const canvas = figure.appendChild(document.createElement('canvas'));
      canvas.setAttribute('role', 'img');
      return { name, at, log, canvas, value: caption.lastChild };
    });
  }
  draw() {
    const style = getComputedStyle(document.documentElement);
    for (const c of this.items) {
      const w = c.canvas.clientWidth, h = c.canvas.clientHeight, dpr = devicePixelRatio || 1;
      if (!w || !h) continue;
      c.canvas.width = Math.round(w * dpr);
      c.canvas.height = Math.round(h * dpr);
      const g = c.canvas.getContext('2d');
      g.scale(dpr, dpr);
      const list = this.points.filter((p) => !c.log || p[c.at] > 0);
      const last = list.length ? list[list.length - 1][c.at] : NaN;
      c.value.textContent = short(last);
      c.canvas.setAttribute('aria-label', `${c.name} over time, last ${short(last)}`);
      if (!list.length) continue;
      const y = (p) => c.log ? Math.log(p[c.at]) : p[c.at];
      const t1 = Math.max(list[list.length - 1][0], 1e-6);
      let low = c.log ? Infinity : 0, high = -Infinity;
      for (const p of list) { low = Math.min(low, y(p)); high = Math.max(high, y(p)); }
      const span = high - low || 1;
      g.strokeStyle = style.getPropertyValue('--accent');
      g.lineWidth = 1.5;
      g.beginPath();
      for (const p of list) g.lineTo(1 + p[0] / t1 * (w - 4), h - 3 - (y(p) - low) / span * (h - 6));
      g.stroke();
      g.fillStyle = g.strokeStyle;
      g.beginPath();
      g.arc(1 + (w - 4), h - 3 - (y(list[list.length - 1]) - low) / span * (h - 6), 2, 0, 7);
      g.fill();
    }
  }
}
