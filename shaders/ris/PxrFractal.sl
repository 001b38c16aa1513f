/* PxrFractal: a sum of noises, of RIS: layers of them, each lacunarity times finer and weaker by lacunarity^dimension; erosion takes the
   valleys of each, reverse turns the sum round, variation moves it. Of a manifold, or of the place in object space (surfacePosition is that in
   other versions). The noise is that of this program, not Pixar's: the same kind of picture, not the same picture. */
#include "rispattern.h"
surface PxrFractal(varying float surfacePosition = 0, layers = 6, frequency = 1, lacunarity = 2, dimension = 1, erosion = 0, variation = 0, reverse_ = 0, turbulent = 0;
                   RIS_MANIFOLD; RIS_RGB; output varying float resultF = 0) {
    RIS_PLACE(q);
    q = q * frequency + vector(variation * 17.3, variation * 5.1, variation * -9.7);
    float weight = 1, total = 0, sum = 0, size = 1, i;
    for (i = 0; i < layers; i += 1) {
        float n = 2 * float noise(q * size) - 1;
        if (erosion > 0) n = mix(n, 1 - 2 * abs(n), erosion);
        if (turbulent != 0) n = abs(n);
        sum += weight * n;
        total += weight;
        weight *= pow(lacunarity, -dimension);
        size *= lacunarity;
    }
    resultF = clamp(.5 + .5 * sum / max(total, 1e-6) * 1.4, 0, 1);
    if (reverse_ != 0) resultF = 1 - resultF;
    resultRGB = resultF;
    RIS_CHANNELS
}
