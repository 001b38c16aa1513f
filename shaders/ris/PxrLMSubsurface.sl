/* PxrLMSubsurface: skin and wax of the layered materials of PRMan 19 and 20, of RIS: light that walks below the surface over three
   distances. Names and defaults are those of Pixar's documentation. Each range has the albedo color times weight; lengths are mean free
   paths of diffusion, in millimetres, times unitLength in scene units.
   Not here: how the walk is limited and what it meets (indirectAtSss and the like), infinite depth. The refraction index below the surface
   is 1, so that albedos add up to that of the whole.
   Ball: Surface "ris/PxrLMSubsurface" "unitLength" .02 */
#include "lmlayer.h"
surface PxrLMSubsurface(varying color nearColor = 1; varying float nearWeight = .13, nearLength = .8;
                        varying color midColor = color(1, 1, .3); varying float midWeight = .27, midLength = 2.5;
                        varying color farColor = color(1, 0, 0); varying float farWeight = .4, farLength = 5;
                        float unitLength = .1, indirectAtSss = 0; varying color incandescence = 0; varying normal bumpNormal = 0;
                        varying float presence = 1, inputAOV = 0; LM_IN(lmlayer))
{
    normal n;
    risSide(normal 0, bumpNormal, n);
    vector V = -normalize(I);
    color one = 1, light = incandescence;
    if (nearWeight > 0) light += nearWeight * risSubsurface(nearColor, one * (nearLength * unitLength), 0, 1);
    if (midWeight > 0) light += midWeight * risSubsurface(midColor, one * (midLength * unitLength), 0, 1);
    if (farWeight > 0) light += farWeight * risSubsurface(farColor, one * (farLength * unitLength), 0, 1);
    LM_COVER(light, n, V)
    Oi = presence;
    Ci = presence * light;
}
