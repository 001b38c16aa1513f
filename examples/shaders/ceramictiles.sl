/* ceramictiles: glazed tiles with an ornament, grout between. Glaze mirrors sharply by Fresnel's law, grout is dull; each tile lies a little
   askew, so that its reflection breaks at the joints.
     tiles         along s; there are half as many along t
     groutwidth    as a part of a tile
     glaze, ornament, grout   colours
     skew          how far tiles lean, radians */
#include "patterns.h"

float petals(float x, y, count)
{
    float angle = atan(y, x), r = sqrt(x * x + y * y);
    return r / (.62 + .28 * cos(count * angle));
}

surface ceramictiles(
    float tiles = 12, groutwidth = .06, skew = .02, Ka = 1, Kd = .8, Kr = 1, ior = 1.5;
    color glaze = color(.86, .87, .82), ornament = color(.06, .16, .42), grout = color(.33, .31, .28);)
{
    float ss = s * tiles, tt = t * tiles / 2;
    float cs = floor(ss), ct = floor(tt), x = ss - cs, y = tt - ct;
    float edge = groutwidth / 2;
    float tile = (filterstep(edge, x) - filterstep(1 - edge, x)) * (filterstep(edge, y) - filterstep(1 - edge, y));
    /* The ornament: a flower, four quarter circles, alternating. */
    float even = mod(cs + ct, 2);
    float flower = 1 - filterstep(.42, petals(x - .5, y - .5, 8));
    float rim = filterstep(.38, distance(point(x, y, 0), point(round(x), round(y), 0))) - filterstep(.46, distance(point(x, y, 0), point(round(x), round(y), 0)));
    float painted = even > .5 ? max(flower, rim) : rim;
    color C = mix(glaze, ornament, painted) * (.94 + .12 * float cellnoise(cs, ct));

    normal Nf = faceforward(normalize(N), I);
    vector V = -normalize(I);
    vector lean = vector cellnoise(cs, ct) - .5;
    normal Nt = normalize(Nf + skew * lean);
    float kr, kt;
    fresnel(-V, Nt, 1 / ior, kr, kt);
    color mirror = trace(P, reflect(-V, Nt));
    color dull = grout * (Ka * ambient() + Kd * diffuse(Nf));
    color glazed = kt * C * (Ka * ambient() + Kd * diffuse(Nt)) + Kr * kr * mirror + .5 * specular(Nt, V, .01);
    Oi = Os;
    Ci = Os * Cs * mix(dull, glazed, tile);
}
