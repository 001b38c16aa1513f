/* LamaConductor: a metal, of RIS. Names and defaults are those of Pixar's documentation. A node of others, too: lama.h.
     fresnelMode 0: IOR and extinction, over exteriorIOR where overrideExteriorIOR is 1; 1: reflectivity straight on and edgeColor at
     the rim
     tailMix: the part of a second lobe, whose roughness is tailLength of the way to 1
   Not here: iridescence, anisotropyDirection, edgeColorMode (which the documentation does not describe). */
#include "lama.h"
surface LamaConductor(varying color tint = 1; float fresnelMode = 0; varying color IOR = color(.18, .42, 1.37);
                      varying color extinction = color(3.42, 2.35, 1.77), reflectivity = color(.945, .7772, .3737);
                      varying color edgeColor = color(.9979, .9813, .7523); varying float roughness = .1, anisotropy = 0;
                      varying vector anisotropyDirection = 0; varying float anisotropyRotation = 0, tailMix = 0, tailLength = .5; float edgeColorMode = 0;
                      varying normal conductorNormal = 0, normal_ = 0; LAMA_OUT)
{
    normal none = 0;
    bxdf_out_metal = tint;
    bxdf_out_metalIor = IOR / LAMA_OUTSIDE;
    bxdf_out_metalK = extinction / LAMA_OUTSIDE;
    if (fresnelMode == 1) layerMetal(reflectivity, edgeColor, bxdf_out_metalIor, bxdf_out_metalK);
    bxdf_out_metalRough = roughness;
    bxdf_out_metalAniso = anisotropy;
    bxdf_out_metalTail = clamp(tailMix, 0, 1);
    bxdf_out_metalTailRough = lamaTail(roughness, tailLength);
    bxdf_out_bump = (conductorNormal != none) ? conductorNormal : normal_;
    LAMA_SURFACE(1)
}
