/* granite: grains of several minerals, each a Voronoi cell with its own colour, cut and polished. Flakes of mica glitter one by one.
     scale     grains in a unit of shader space
     minerals  their colours
     shares    how much there is of each */
#include "noises.h"

surface granite(
    float scale = 22, Ka = 1, Kd = .8, Ks = .35, roughness = .04;
    color minerals[4] = {color(.72, .55, .48), color(.8, .78, .74), color(.42, .41, .4), color(.07, .07, .08)};
    float shares[4] = {.35, .3, .22, .13};)
{
    point Q = transform("shader", P) * scale;
    float f1, f2;
    point pos1, pos2;
    Q += .25 * (vector noise(Q * 2.5) - .5);
    voronoi_f1f2_3d(Q, .9, f1, pos1, f2, pos2);
    float pick = cellnoise(pos1 * 7), sum = 0, i;
    color C = minerals[3];
    for (i = 0; i < arraylength(shares); i += 1) {
        sum += shares[i];
        if (pick < sum) {
            C = minerals[i];
            break;
        }
    }
    C *= .8 + .4 * float noise(Q * 4);
    C *= .75 + .25 * smoothstep(0, .15, f2 - f1);
    float width = sqrt(area(Q));
    C = mix(C, color(.58, .5, .47), smoothstep(.8, 2.5, width));
    normal Nf = faceforward(normalize(N), I);
    vector V = -normalize(I);
    normal Nflake = normalize(Nf + .35 * (vector cellnoise(pos1 * 13) - .5));
    float mica = pick > .87 ? 1 : 0;
    Oi = Os;
    Ci = Os * (Cs * C * (Ka * ambient() + Kd * diffuse(Nf)) + Ks * specular(Nf, V, roughness) + 1.2 * mica * specular(Nflake, V, .02));
}
