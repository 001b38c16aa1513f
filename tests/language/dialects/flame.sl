float fBm_(point p; uniform float octaves, lacunarity, gain) {
  varying float sum = 0, amp = 1; varying point pp = p; uniform float i;
  for (i = 0; i < octaves; i += 1) { sum += amp * (float noise(pp)*2-1); amp *= gain; pp *= lacunarity; }
  return sum; }
surface flame(float distortion = 0.5, chaosscale = 1.2, chaosoffset = 0, octaves = 7, flameheight = 1, flameamplitude = .5)
{
  color c; float chaos, cmap; point PQ = point(s*chaosscale, t*chaosscale + time, chaosoffset);
  chaos = fBm_(PQ, octaves, 2, .5);
  cmap = 0.85*chaos + 0.8 * (flameamplitude - flameheight*(1-t)) ;
  c = color spline(cmap,
     color(0,0,0),color(0,0,0),color(27,0,0)/255,color(54,0,0)/255,color(81,0,0)/255,
     color(109,0,0)/255, color(136,0,0)/255,color(163,0,0)/255,color(190,0,0)/255,color(217,0,0)/255,
     color(244,0,0)/255,color(255,17,0)/255,color(255,44,0)/255,color(255,71,0)/255,color(255,99,0)/255,
     color(255,126,0)/255,color(255,153,0)/255,color(255,180,0)/255,color(255,207,0)/255,color(255,234,0)/255,
     color(255,255,7)/255,color(255,255,38)/255,color(255,255,69)/255,color(255,255,101)/255,color(255,255,132)/255,
     color(255,255,163)/255,color(255,255,194)/255,color(255,255,225)/255,color(255,255,255)/255, color(255,255,255)/255);
  Ci = c; Oi = luminance_(c); Ci *= Os;
}
color luminance_(color c) { return color(.3*comp(c,0)+.59*comp(c,1)+.11*comp(c,2)); }
