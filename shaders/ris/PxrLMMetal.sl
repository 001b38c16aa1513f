/* PxrLMMetal: a metal by index of refraction and extinction, of RIS. Names and defaults are those of Pixar's documentation.
   Ball: Surface "ris/PxrLMMetal" */
#include "rislobes.h"
surface PxrLMMetal(varying color eta = color(4.369684, 2.916713, 1.654698), kappa = color(5.20643, 4.231366, 3.754969), specularColor = 1;
                   varying float roughness = .1, anisotropy = 0; varying normal bumpNormal = 0; varying float presence = 1, inputAOV = 0;)
{
    normal n;
    risSide(normal 0, bumpNormal, n);
    float ax, ay;
    layerWidths(roughness * roughness, anisotropy, ax, ay);
    Oi = presence;
    Ci = presence * specularColor *
        layerReflectMetal(n, -normalize(I), layerAlong(anisotropy, n), ax, ay, eta, kappa, 1);
}
