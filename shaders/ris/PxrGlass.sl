/* PxrGlass: glass, of RIS before PxrSurface had it. Names are those of Pixar's documentation.
     absorptionColor with absorptionGain above 0: what is left of light after 1 / absorptionGain scene units inside
   Ball: Surface "ris/PxrGlass" "color reflectionColor" [1 1 1] "color transmissionColor" [1 1 1] */
#include "rislobes.h"
surface PxrGlass(varying float ior = 1.5, roughness = 0, anisotropic = 0, reflectionGain = 1, transmissionGain = 1;
                 varying color reflectionColor = .5, transmissionColor = .8, absorptionColor = 1; varying float absorptionGain = 0;
                 float thin = 0; varying normal bumpNormal = 0; varying float presence = 1, inputAOV = 0;)
{
    normal n;
    float front = risSide(normal 0, bumpNormal, n), ax, ay;
    vector V = -normalize(I), along = layerAlong(anisotropic, n);
    color light, inside = 1, mirror = reflectionGain * reflectionColor, through = transmissionGain * transmissionColor;
    layerWidths(roughness * roughness, anisotropic, ax, ay);
    if (thin == 1) light = layerSheet(n, V, along, ax, ay, ior, 1, mirror, through);
    else light = layerGlass(n, front, V, along, ax, ay, ior, 1, mirror, through);
    if (absorptionGain > 0 && front == 0) inside = layerPower(clamp(absorptionColor, color 1e-4, color 1), absorptionGain * length(I));
    Oi = presence;
    Ci = presence * inside * light;
}
