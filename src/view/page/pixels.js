// From half floats to what is seen.

/** Numbers of all 65536 half floats. */
export const halfValues = (() => {
  const v = new Float32Array(65536);
  for (let h = 0; h < 65536; ++h) {
    const sign = h & 0x8000 ? -1 : 1, e = h >> 10 & 31, m = h & 1023;
    v[h] = sign * (e === 0 ? m * 2 ** -24 : e === 31 ? (m ? NaN : Infinity) : (1 + m / 1024) * 2 ** (e - 15));
  }
  return v;
})();

export function encode(v, curve) {
  v *= curve.gain;
  if (!(v > 0)) return 0;
  if (curve.srgb) v = v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055;
  else if (curve.gamma !== 1) v = v ** (1 / curve.gamma);
  return v >= 1 ? 255 : Math.round(v * 255);
}

/** Codes 0 .. 255 of all half floats. */
export function table(curve) {
  const t = new Uint8Array(65536);
  for (let h = 0; h < 0x7c01; ++h) t[h] = encode(halfValues[h], curve); // negative ones and NaN stay 0
  return t;
}

/** Black, violet, red, yellow, white: ascending in lightness, for those who see no colours too. */
export function heat(x) {
  const stops = [[0, 0, 4], [87, 16, 110], [188, 55, 84], [249, 142, 9], [252, 255, 164]];
  const at = Math.min(Math.max(x, 0), 0.9999) * 4, i = Math.floor(at), f = at - i;
  return stops[i].map((c, k) => Math.round(c + f * (stops[i + 1][k] - c)));
}

/** How a plane is shown: "colour", "signed" (-1 .. 1), "range" (grey between two numbers), "heat". */
export function kindOf(plane, channels) {
  if (plane === 'noise' || plane === 'variance' || plane === 'samples') return 'heat';
  if (plane === 'picture' || plane.startsWith('light:') || plane.startsWith('lpe:')) return 'colour';
  if (channels.length === 1) return 'range';
  return /^(N|Ng|normal|I|dPd[uv])$/.test(plane) ? 'signed' : 'colour';
}

/** Least and greatest finite value of the first channel; the top per cent of a heat map is cut. */
export function rangeOf(half, kind) {
  let low = Infinity, high = -Infinity;
  for (let i = 0; i < half.length; i += 4) {
    const v = halfValues[half[i]];
    if (v < low && v > -Infinity) low = v;
    if (v > high && v < Infinity) high = v;
  }
  if (!(low <= high)) return [0, 1];
  if (kind === 'heat') {
    const bins = new Uint32Array(1024), scale = high > 0 ? 1023 / high : 0;
    let n = 0;
    for (let i = 0; i < half.length; i += 4) {
      const v = halfValues[half[i]];
      if (v >= 0 && v <= high) { ++bins[v * scale | 0]; ++n; }
    }
    let sum = 0, b = 0;
    while (b < 1023 && (sum += bins[b]) < 0.99 * n) ++b;
    return [0, Math.max((b + 1) / (scale || 1), 1e-6)];
  }
  return [low, high];
}

/** Paints half floats into an ImageData of the same size. */
export function paint(image, half, kind, curve, range) {
  const out = new Uint32Array(image.data.buffer), n = out.length;
  if (kind === 'colour') {
    const t = table(curve);
    for (let i = 0, j = 0; i < n; ++i, j += 4) out[i] = 0xff000000 | t[half[j + 2]] << 16 | t[half[j + 1]] << 8 | t[half[j]];
    return;
  }
  const codes = new Uint32Array(65536);
  const [low, high] = kind === 'signed' ? [-1, 1] : range, scale = 1 / Math.max(high - low, 1e-30);
  for (let h = 0; h < 65536; ++h) {
    const x = (halfValues[h] - low) * scale, y = Number.isNaN(x) ? 0 : Math.min(Math.max(x, 0), 1);
    if (kind === 'heat') { const [r, g, b] = heat(y); codes[h] = r | g << 8 | b << 16; }
    else codes[h] = Math.round(y * 255);
  }
  if (kind === 'heat') for (let i = 0, j = 0; i < n; ++i, j += 4) out[i] = 0xff000000 | codes[half[j]];
  else if (kind === 'range') for (let i = 0, j = 0; i < n; ++i, j += 4) out[i] = 0xff000000 | codes[half[j]] * 0x10101;
  else for (let i = 0, j = 0; i < n; ++i, j += 4) out[i] = 0xff000000 | codes[half[j + 2]] << 16 | codes[half[j + 1]] << 8 | codes[half[j]];
}

/** |a - b| times a factor, on the same curve. */
export function paintDifference(image, a, b, factor, curve) {
  const out = new Uint32Array(image.data.buffer), n = out.length, fine = new Uint8Array(4097);
  for (let i = 0; i <= 4096; ++i) fine[i] = encode(i / 4096, { ...curve, gain: 1 });
  const scale = factor * curve.gain * 4096;
  const code = (p, q) => {
    const d = Math.abs(halfValues[p] - halfValues[q]) * scale;
    return fine[d < 4096 ? d | 0 : d >= 4096 ? 4096 : 0];
  };
  for (let i = 0, j = 0; i < n; ++i, j += 4)
    out[i] = 0xff000000 | code(a[j + 2], b[j + 2]) << 16 | code(a[j + 1], b[j + 1]) << 8 | code(a[j], b[j]);
}
