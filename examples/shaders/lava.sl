/* lava: a cracked crust over a melt that glows by its own heat. The glow does not need a light.
     scale    cracks in a unit of shader space
     heat     temperature at the bottom of the cracks, kelvin
     glow     brightness */
#include "noises.h"

/* Colour of a black body between 800 and 2500 K, largest channel 1; a fit. */
color blackbody(float kelvin)
{
    float x = clamp((kelvin - 800) / 1700, 0, 1);
    return color(min(1, .35 + 2.2 * x), .75 * pow(x, 1.3), .35 * pow(x, 3));
}

surface lava(float scale = 2.6, heat = 1900, glow = 2.5, Ka = 1, Kd = .7, relief = .06;)
{
    point Q = transform("shader", P) * scale;
    float width = filterwidthp(Q);
    float f1, f2;
    point a, b;
    Q += .5 * vfBm(Q, width, 4, 2, .5);
    voronoi_f1f2_3d(Q, 1, f1, a, f2, b);
    float crack = 1 - smoothstep(.02, .22, f2 - f1);
    float ember = smoothstep(.1, .6, fBm(Q * 3, width * 3, 5, 2, .6));
    float hot = clamp(crack + .35 * ember * ember, 0, 1);
    float height = (1 - crack) * (.6 + .4 * fBm(Q * 5, width * 5, 4, 2, .5));
    normal Nf = faceforward(normalize(calculatenormal(P + relief * height * normalize(N))), I);
    color crust = color(.05, .045, .045) * (1 + fBm(Q * 9, width * 9, 3, 2, .5));
    Oi = Os;
    Ci = Os * (crust * (Ka * ambient() + Kd * diffuse(Nf)) + glow * pow(hot, 1.5) * blackbody(mix(800, heat, hot)));
}
