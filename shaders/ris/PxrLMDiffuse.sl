/* PxrLMDiffuse: a diffuse surface of the layered materials of PRMan 19 and 20, which may be rough and let light through, of RIS. Names and
   defaults are those of Pixar's documentation.
     translucence: the part of the light that comes through, tinted by the mean of both colours; the rest is reflected
   lmlayer: a layer on top (PxrLMLayer). transmissionColor adds light from behind, and is no parameter of Pixar's.
   Ball: Surface "ris/PxrLMDiffuse" "color frontColor" [.8 .4 .2] */
#include "lmlayer.h"
surface PxrLMDiffuse(varying color frontColor = .5, backColor = .5, transmissionColor = 0; varying float roughness = 0;
                     varying color sheen = 0; varying float translucence = 0; varying color incandescence = 0;
                     varying normal bumpNormal = 0; varying float presence = 1, inputAOV = 0; LM_IN(lmlayer))
{
    normal n;
    float front = risSide(normal 0, bumpNormal, n);
    vector V = -normalize(I);
    color mine = (front == 0) ? backColor : frontColor, none = 0;
    color light = (1 - translucence) * mine * layerDiffuse(n, V, roughness, 1);
    color through = transmissionColor + translucence * .5 * (frontColor + backColor);
    if (through != none) light += through * diffuse(-n);
    if (sheen != none) light += sheen * layerSheen(n . V, .3) * diffuse(n);
    light += incandescence;
    LM_COVER(light, n, V)
    Oi = presence;
    Ci = presence * light;
}
