/* PxrLMDiffuse: a diffuse surface that may be rough and let light through, of RIS. Names are those of Pixar's documentation.
   Ball: Surface "ris/PxrLMDiffuse" "color frontColor" [.8 .4 .2] */
#include "rislobes.h"
surface PxrLMDiffuse(varying color frontColor = .5, backColor = -1, transmissionColor = 0; varying float roughness = 0;
                     varying normal bumpNormal = 0; varying float presence = 1;)
{
    normal n;
    float front = risSide(normal 0, bumpNormal, n);
    color mine = (front == 0 && comp(backColor, 0) >= 0) ? backColor : frontColor, none = 0;
    color light = mine * layerDiffuse(n, -normalize(I), roughness, layerSamples(16));
    if (transmissionColor != none) light += transmissionColor * diffuse(-n);
    Oi = presence;
    Ci = presence * light;
}
