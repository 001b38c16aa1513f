/* PxrLMGlass: glass of the layered materials of PRMan 19 and 20, of RIS. Names and defaults are those of Pixar's documentation.
     absorption above 0: transmissionColor to that power is left of light after one scene unit inside; not of what is thin
     lmlayer: a layer on top (PxrLMLayer)
   Not here: shadows 1, coloured shadows of what is not thin.
   Ball: Surface "ris/PxrLMGlass" */
#include "lmlayer.h"
surface PxrLMGlass(float thin = 0; varying float eta = 1.5; varying color reflectionColor = 1, refractionColor = .8;
                   varying float roughness = .01, absorption = 0; varying color transmissionColor = .5; float shadows = 0;
                   varying normal bumpNormal = 0; varying float presence = 1, inputAOV = 0; LM_IN(lmlayer))
{
    normal n;
    float front = risSide(normal 0, bumpNormal, n), ax, ay;
    vector V = -normalize(I), along = layerAlong(0, n);
    color light, inside = 1;
    layerWidths(roughness * roughness, 0, ax, ay);
    if (thin == 1) light = layerSheet(n, V, along, ax, ay, eta, 1, reflectionColor, refractionColor);
    else light = layerGlass(n, front, V, along, ax, ay, eta, 1, reflectionColor, refractionColor);
    if (thin != 1 && absorption > 0 && front == 0) inside = layerPower(clamp(transmissionColor, color 1e-4, color 1), absorption * length(I));
    light *= inside;
    LM_COVER(light, n, V)
    Oi = presence;
    Ci = presence * light;
}
