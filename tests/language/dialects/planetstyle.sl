/* a planet by sums of noise */
float snoise(point p) { return noise(p) * 2 - 1; }
float fractal(point p; float lo, hi; float octaves) {
  float f, amp = 1, sum = 0; point q = p;
  for (f = lo; f < hi; f = f * 2) { sum += amp * snoise(q * f); amp *= .5; }
  return sum;
}
point vnoise(point p) { return 2 * point noise(p) - point(1,1,1); }
color planet(float h) {
  color c;
  if (h < 0) c = color spline((h+1), color(0,0,.1), color(0,0,.1), color(0,.1,.3), color(0,.2,.5), color(0,.2,.5));
  else if (h < .1) c = color (.7,.6,.3);
  else c = color spline(h, color(.1,.4,.1), color(.1,.4,.1), color(.4,.3,.2), color(1,1,1), color(1,1,1));
  return c;
}
surface planetstyle(float octaves = 8, offset = 0, sealevel = 0, spectral_exp = .5, lacunarity = 2; float Ka = .1, Kd=.9, bump_scale=.1)
{
  point PP = transform("shader", P), PtN; float chaos, lat; normal n = N; float latitude;
  chaos = fractal(PP, 1, pow(2, octaves), octaves) - offset;
  lat = abs(zcomp(normalize(PP)));
  if (chaos > sealevel) { n = calculatenormal(P + bump_scale * chaos * normalize(N)); }
  color Ct = planet(chaos);
  PtN = vnoise(PP);
  Oi = Os; Ci = Os * Ct * (Ka * ambient() + Kd * diffuse(faceforward(normalize(n), I))) + 0*length(PtN);
  if (lat > .8 + chaos*.1) Ci = mix(Ci, color(1), .5);
}
