/* PxrLMMetal: a metal by index of refraction and extinction, of RIS. Names are those of Pixar's documentation.
   Ball: Surface "ris/PxrLMMetal" */
#include "rislobes.h"
surface PxrLMMetal(varying color eta = color(.2, .92, 1.1), kappa = color(3.9, 2.45, 2.14), specularColor = 1;
                   varying float roughness = .3, anisotropy = 0; varying normal bumpNormal = 0; varying float presence = 1;)
{
    normal n;
    risSide(normal 0, bumpNormal, n);
    float ax, ay;
    layerWidths(roughness * roughness, anisotropy, ax, ay);
    Oi = presence;
    Ci = presence * specularColor *
        layerReflectMetal(n, -normalize(I), layerTangent(n, dPdu, 0), ax, ay, eta, kappa, layerSamples(16));
}
