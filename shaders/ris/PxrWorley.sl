/* PxrWorley: distances to scattered points, of RIS, after S. Worley (1996): c1 times that to the nearest plus c2 times that to the second, of the manifold or
   of the place in object space. distancemetric 0 Euclid, 1 squares, 2 Manhattan, 3 Chebyshev. Not done: shape, minkExp, the pseudo random cells of id. */
#include "rispattern.h"
surface PxrWorley(varying float surfacePosition = 0, frequency = 5, jitter = .75, c1 = 1, c2 = 0, clamp_ = 1, invert = 0; float distancemetric = 0; RIS_MANIFOLD; RIS_RGB; output varying float resultF = 0) {
    RIS_PLACE(q0);
    point q = q0 * frequency, cell = point(floor(xcomp(q)), floor(ycomp(q)), floor(zcomp(q)));
    float f1 = 1e3, f2 = 1e3, i, j, k;
    for (i = -1; i <= 1; i += 1)
        for (j = -1; j <= 1; j += 1)
            for (k = -1; k <= 1; k += 1) {
                point at = cell + vector(i + .5, j + .5, k + .5);
                vector d = at + jitter * (vector cellnoise(at) - vector(.5, .5, .5)) - q;
                float m = (distancemetric == 2) ? abs(xcomp(d)) + abs(ycomp(d)) + abs(zcomp(d))
                          : (distancemetric == 3) ? max(abs(xcomp(d)), abs(ycomp(d)), abs(zcomp(d)))
                          : (distancemetric == 1) ? d . d : length(d);
                if (m < f1) { f2 = f1; f1 = m; } else if (m < f2) f2 = m;
            }
    resultF = c1 * f1 + c2 * f2;
    if (clamp_ != 0) resultF = clamp(resultF, 0, 1);
    if (invert != 0) resultF = 1 - resultF;
    resultRGB = resultF;
    RIS_CHANNELS
}
