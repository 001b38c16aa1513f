/* clouds: fair-weather clouds for a dome, a globe or a card: fractal sums cut at a coverage, thin at their edges, lit from the side of
   "sun". Where there is no cloud the surface is clear, or shows the sky's colour.
     coverage   0 no cloud, 1 overcast
     scale      clouds in a unit of shader space
     drift      how far they have moved: time
     sky        colour behind; "clear" 1 makes it transparent */
#include "noises.h"

surface clouds(
    float coverage = .5, scale = 2.2, drift = 0, clear = 0, sharpness = .3;
    color sky = color(.16, .36, .75), bright = color(1, 1, 1), shade = color(.5, .55, .65);
    vector sun = vector "world" (.4, .8, -.5);)
{
    point Q = transform("shader", P) * scale + drift * vector(1, 0, 0);
    float width = filterwidthp(Q);
    vector warp = .6 * vfBm(Q * .7, width, 3, 2, .5);
    float thick = .5 + .7 * fBm(Q + warp, width, 7, 2.03, .55);
    float amount = smoothstep(1 - coverage, 1 - coverage + sharpness, thick);
    /* A step toward the sun: is there more or less cloud? */
    float toward = .5 + .7 * fBm(Q + warp + .18 * normalize(vtransform("current", "shader", sun)), width, 5, 2.03, .55);
    float lit = clamp(.55 - 2 * (toward - thick), 0, 1);
    float dense = smoothstep(0, 1, amount) * smoothstep(1 - coverage, 1.35 - coverage, thick);
    color C = mix(shade, bright, clamp(lit + .5 * (1 - dense), 0, 1));
    Oi = Os * (clear > .5 ? color(amount) : color(1));
    Ci = Oi * Cs * (clear > .5 ? C : mix(sky, C, amount));
}
