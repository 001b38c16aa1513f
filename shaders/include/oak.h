/* Oak: rings about the z axis, and grain along it. */
#ifndef OAK_H
#define OAK_H
#include "noises.h"
#include "patterns.h"

/* 0 to 1 between light and dark wood at Pshad, filtered over dPshad. Rings are bent by noise, by a trunk that wanders along z and by one
   that is not round; ringy and grainy say how much each counts. */
float oaktexture(point Pshad; float dPshad; float ringfreq, ringunevenness, grainfreq; float ringnoise, ringnoisefreq;
                 float trunkwobble, trunkwobblefreq; float angularwobble, angularwobblefreq; float ringy, grainy)
{
    point at = Pshad + ringnoise * vfBm(Pshad * ringnoisefreq, dPshad * ringnoisefreq, 2, 4, 0.5);
    at += trunkwobble * (2 * vector noise(zcomp(Pshad) * trunkwobblefreq) - 1) * vector(1, 1, 0);
    float radius = sqrt(xcomp(at) * xcomp(at) + ycomp(at) * ycomp(at)) * ringfreq;
    radius += angularwobble * smoothstep(0, 5, radius) * (2 * float noise(angularwobblefreq * at * vector(1, 1, 0.1)) - 1);
    radius += ringunevenness * (2 * float noise(radius) - 1);
    float inring = smoothpulsetrain(0.1, 0.55, 0.7, 0.95, 1, radius);

    point along = Pshad * grainfreq * vector(1, 1, 0.05);
    float width = filterwidthp(along), grain = 0, amp = 1;
    uniform float octave;
    for (octave = 0; octave < 2; octave += 1) {
        float crest = 1 - smoothstep(0.2, 0.6, width), strength = max(0, 0.3 - noise(along) * crest);
        grain += amp * (strength * strength + inring * strength * 0.5);
        along *= 2;
        width *= 2;
        amp *= 0.5;
    }
    return mix(inring * ringy, 1, clamp(grain * grainy, 0, 1));
}
#endif
