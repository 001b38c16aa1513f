/* smoke: drifting smoke between the eye and what is behind: a fractal, marched.
     density   how thick
     scale     billows in a unit of "world"
   Ball: Atmosphere "smoke" "float density" .8 "float scale" 1.6 */
#include "noises.h"

volume smoke(float density = .3, scale = 1, steps = 16, nearest = 2; color tint = color(.55, .53, .5);)
{
    float far = length(I), from = min(nearest, far), step = (far - from) / steps, i, seen = 1, offset = random();
    vector In = normalize(I);
    for (i = 0; i < steps; i += 1) {
        point Q = transform("world", P - I + (from + (i + offset) * step) * In) * scale;
        seen *= exp(-density * step * max(0, .1 + 1.5 * fBm(Q, .01, 5, 2, .5)));
    }
    Ci = mix(tint, Ci, seen);
    Oi = mix(color(1), Oi, seen);
}
