#include <patterns.h>
#include "noises.h"
float voronoi_(point Q; output float f1, f2; output point c1;)
{
    float i, j, k; point cell = point(floor(xcomp(Q)) + .5, floor(ycomp(Q)) + .5, floor(zcomp(Q)) + .5);
    f1 = f2 = 1000;
    for (i = -1; i <= 1; i += 1) for (j = -1; j <= 1; j += 1) for (k = -1; k <= 1; k += 1) {
        point test = cell + vector(i,j,k);
        point pos = test + (vector cellnoise(test) - .5);
        vector off = pos - Q;
        float d = off . off;
        if (d < f1) { f2 = f1; f1 = d; c1 = pos; }
        else if (d < f2) f2 = d;
    }
    f1 = sqrt(f1); f2 = sqrt(f2);
    return f2 - f1;
}
surface fieldstones(float freq = 4, gap = .08, Kd = .8; color mortar = color(.4,.4,.38);)
{
    float a, b, edge; point c;
    point Q = freq * transform("shader", P);
    edge = voronoi_(Q, a, b, c);
    float w = filterwidthp(Q);
    float in = smoothstep(gap - w, gap + w, edge);
    color stone = color cellnoise(c) * .3 + .4;
    stone *= .8 + .2 * snoise(Q * 5);
    Ci = mix(mortar, stone, in) * (ambient() + Kd * diffuse(faceforward(normalize(N), I)));
    Oi = Os;
}
