#include "rayserver.h"
/* tracing for the renderers that could, with the names of the day */
surface oldbmrt(float Ka = 1, Kd = .6, Kr = .3, samples = 4, maxdepth = 2, blur = .1;)
{
    point Nf = faceforward(normalize(N), I), R = reflect(normalize(I), Nf);
    color env = 0, occ = visibility(P, P + 10 * R);
    uniform float k;
    vector uoff = blur * normalize(vector (zcomp(R) - ycomp(R), xcomp(R) - zcomp(R), ycomp(R) - xcomp(R)));
    if (raylevel() < maxdepth && isshadowray() == 0)
        for (k = 0; k < samples; k += 1) {
            point dir = R + (random() - .5) * uoff;
            env += trace(P, dir);
        }
    Oi = Os;
    Ci = Os * (Cs * (Ka * ambient() + Kd * diffuse(Nf)) + Kr * env / samples + 0 * occ);
}
