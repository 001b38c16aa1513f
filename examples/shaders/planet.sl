/* planet: a globe with seas, coasts, forests, deserts, mountains, ice and a thin air. Heights come from one fractal; the relief is a bump, the sea
   is flat and glitters.
     sealevel   0 all land, 1 all sea
     scale      continents on the globe
     airs       colour of the air at the rim */
#include "noises.h"

surface planet(float sealevel = .52, scale = 1.3, relief = .05, Ka = 1, Kd = .9; color air = color(.35, .55, 1);)
{
    point Q = transform("shader", P);
    float latitude = abs(zcomp(normalize(vector(Q))));
    point M = Q * scale + 3;
    float width = filterwidthp(M);
    float h = .5 + .6 * fBm(M + .4 * vfBm(M, width, 4, 2, .5), width, 9, 2.05, .5);
    float land = smoothstep(sealevel - .004, sealevel + .004, h);
    float height = max(0, (h - sealevel) / (1 - sealevel));
    float moist = .5 + .6 * fBm(M * 1.3 + 11, width * 1.3, 4, 2, .5);
    color ground = spline(clamp(height * 1.1, 0, 1),
        color(.6, .52, .34), color(.6, .52, .34), color(.2, .34, .1), color(.1, .24, .07), color(.24, .26, .14), color(.4, .34, .26), color(.45, .4, .36), color(.9, .9, .92), color(.95, .95, .97));
    ground = mix(color(.66, .5, .3), ground, smoothstep(.3, .55, moist));
    float ice = smoothstep(.93, .96, latitude + .1 * (h - .5) + .08 * height);
    color sea = mix(color(.01, .05, .16), color(.05, .25, .34), smoothstep(sealevel - .12, sealevel, h));
    color C = mix(mix(sea, ground, land), color(.92, .94, .97), ice);
    normal Nn = normalize(N);
    normal Nf = faceforward(normalize(calculatenormal(P + relief * land * height * Nn)), I);
    vector V = -normalize(I);
    float rim = pow(1 - max(0, faceforward(Nn, I) . V), 3);
    color lit = Ka * ambient() + Kd * diffuse(Nf);
    Oi = Os;
    Ci = Os * Cs * (mix(C, air, .6 * rim) * lit + (1 - land) * (1 - ice) * .5 * (1 - rim) * specular(faceforward(Nn, I), V, .05));
}
