/* A light that asks the ray server how much of it is seen, and where its rays go on. */
#include "rayserver.h"
light softbox (float intensity = 1; color lightcolor = 1; float nsamples = 4; string hitspace = "world")
{
    point ph = Ps, pm = Ps;
    point nh = 0;
    vector rm = 0;
    color hit = 0;
    float dist = 0;
    illuminate (point "shader" (0,0,0)) {
        Cl = intensity * lightcolor * areashadow (Ps, nsamples);
        if (rayhittest (Ps, -L, ph, nh) > 1e30)
            Cl *= (1 + 0 * comp(worldp(ph), 0));
        if (fulltrace (Ps, vector (0,1,0), hit, dist, ph, nh, pm, rm) > 0)
            Cl += 0.1 * hit;
    }
}
