/* skin: light goes in and comes out elsewhere, so shadows have soft and red edges. Here without tracing
   the way inside (translucent.sl traces it): the terminator is wrapped around, red further than blue. Freckles, pores and a film of oil lie over it.
     base, blood    colours of the skin and of what shines through
     wrap           how far light wraps around, for red; green and blue get less
     freckles       how many
     oil            strength of the film, stronger where you look along the skin */
#include "noises.h"

surface skin(
    color base = color(.8, .52, .4), blood = color(.7, .12, .06);
    float wrap = .5, freckles = .5, pores = .012, oil = .5, Ka = 1, Kd = .9;)
{
    point Q = transform("shader", P);
    float width = filterwidthp(Q);
    float pore = fBm(Q * 60, width * 60, 3, 2, .6);
    normal Nn = normalize(N);
    normal Nf = faceforward(normalize(calculatenormal(P + pores * pore * Nn)), I);
    normal smooth = faceforward(Nn, I);
    vector V = -normalize(I);

    float spots = smoothstep(.62, .72, noise(Q * 14)) * smoothstep(1 - freckles, 1.2 - freckles, noise(Q * 3 + 9));
    color C = base * (1 + .12 * fBm(Q * 4, width * 4, 4, 2, .5));
    C = mix(C, C * color(.62, .42, .32), spots);

    color sum = 0;
    color reach = wrap * color(1, .45, .25);
    illuminance(P, smooth, PI) {
        float nondiffuse = 0, nonspecular = 0, i;
        vector l = normalize(L);
        vector h = normalize(l + V);
        lightsource("__nondiffuse", nondiffuse);
        lightsource("__nonspecular", nonspecular);
        float cosine = mix(smooth . l, Nf . l, .6);
        color lit = 0;
        for (i = 0; i < 3; i += 1) {
            float w = comp(reach, i);
            setcomp(lit, i, max(0, (cosine + w) / ((1 + w) * (1 + w))));
        }
        /* Near the terminator more of what comes out has been deep inside. */
        float edge = smoothstep(-.5, .15, cosine) - smoothstep(.15, .7, cosine);
        sum += Cl * (1 - nondiffuse) * Kd * lit * mix(C, blood, .35 * edge);
        float film = .04 + .6 * pow(1 - max(0, V . h), 5);
        sum += Cl * (1 - nonspecular) * oil * film * (8 * pow(max(0, Nf . h), 40) + 3 * pow(max(0, smooth . h), 12)) * max(0, smooth . l);
    }
    Oi = Os;
    Ci = Os * Cs * (Ka * C * ambient() + sum);
}
