/* velvet: pile that is bright where you look along it, and against the light. Crushed patches lean their own way.
     sheen       colour of the rim
     crush       size and strength of crushed patches */
#include "noises.h"

surface velvet(color cloth = color(.22, .01, .06), sheen = color(.9, .35, .45); float Ka = 1, Kd = .5, Ks = 1, crushscale = 3, crush = .5;)
{
    point Q = transform("shader", P) * crushscale;
    normal Nf = faceforward(normalize(normalize(N) + crush * vfBm(Q, filterwidthp(Q), 4, 2, .5)), I);
    vector V = -normalize(I);
    color sum = 0;
    illuminance("-nospecular", P, Nf, PI / 2) {
        vector l = normalize(L);
        float back = pow(max(0, l . -V) , 3);                        /* light that comes from behind */
        float rim = pow(1 - max(0, Nf . V), 2.5);
        sum += Cl * (rim * .8 * (Nf . l) + .3 * back) * Ks;
    }
    Oi = Os;
    Ci = Os * (Cs * cloth * (Ka * ambient() + Kd * diffuse(Nf)) + sheen * sum);
}
