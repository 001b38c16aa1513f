/* PxrDiffuse: an ideal diffuse surface, of RIS. Parameters and defaults are those of Pixar's documentation.
     transmissionBehavior: light through a thin surface; 0: of diffuseColor, 1: of transmissionColor, 2: none
   Ball: Surface "ris/PxrDiffuse" "color diffuseColor" [.8 .6 .3] */
#include "rislobes.h"
surface PxrDiffuse(varying color diffuseColor = .5; float transmissionBehavior = 2; varying color transmissionColor = 0;
                   varying float presence = 1; varying normal bumpNormal = 0;)
{
    normal n;
    risSide(normal 0, bumpNormal, n);
    color light = diffuseColor * diffuse(n);
    if (transmissionBehavior == 0) light += diffuseColor * diffuse(-n);
    if (transmissionBehavior == 1) light += transmissionColor * diffuse(-n);
    Oi = presence;
    Ci = presence * light;
}
