/* PxrLMMetal: a metal by index of refraction and extinction, of RIS. Names and defaults are those of Pixar's documentation.
     lmlayer  a layer on top (PxrLMLayer)
   Ball: Surface "ris/PxrLMMetal" */
#include "lmlayer.h"
surface PxrLMMetal(varying color eta = color(4.369684, 2.916713, 1.654698), kappa = color(5.20643, 4.231366, 3.754969), specularColor = 1;
                   varying float roughness = .1, anisotropy = 0; varying normal bumpNormal = 0; varying float presence = 1, inputAOV = 0;
                   LM_IN(lmlayer))
{
    normal n;
    risSide(normal 0, bumpNormal, n);
    float ax, ay;
    vector V = -normalize(I);
    layerWidths(roughness * roughness, anisotropy, ax, ay);
    color light = specularColor * layerReflectMetal(n, V, layerAlong(anisotropy, n), ax, ay, eta, kappa, 1);
    LM_COVER(light, n, V)
    Oi = presence;
    Ci = presence * light;
}
