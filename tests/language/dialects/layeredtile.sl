/* crosses and discs on tiles, layer by layer */
#include "rmannotes.sl"

surface layeredtile(float Ka = 1, Kd = 1, freq = 4, fuzz = 0.05, width = .3; color crosscolor = color (1,1,0), disccolor = color (0,0,1))
{
  color surface_color, layer_color;
  color surface_opac, layer_opac;
  float ss, tt, row, col, d;
  point center, here;
  point Nf = faceforward(normalize(N), I);

  /* background (layer 0) */
  surface_color = Cs;
  surface_opac = Os;

  col = whichtile(s, freq); row = whichtile(t, freq);
  ss = repeat(s, freq);
  tt = repeat(t, freq);
  if (odd(row)) { ss = mod(ss + 0.5, 1); }

  /* layer 1 */
  layer_color = crosscolor;
  layer_opac = pulse(.5 - width/2, .5 + width/2, fuzz, ss);
  layer_opac = union(layer_opac, pulse(.5 - width/2, .5 + width/2, fuzz, tt));
  surface_color = blend(surface_color, layer_color, layer_opac);

  /* layer 2 */
  center = (0.5, 0.5, 0);
  here = (ss, tt, 0);
  d = distance(center, here) + 0.02 * snoise(row * 100 + col);
  layer_color = disccolor;
  layer_opac = 1 - smoothstep(.3 - fuzz, .3, d);
  surface_color = blend(surface_color, layer_color, layer_opac);

  Oi = surface_opac;
  Ci = Oi * surface_color * (Ka * ambient() + Kd * diffuse(Nf));
}
