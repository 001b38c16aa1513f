/* LamaDielectric: glass, plastic's surface, of RIS. Names and defaults are those of Pixar's documentation. A node of others, too:
   lama.h. As the top of LamaLayer what comes through is the node below.
     fresnelMode 0: reflectivity straight on; 1: IOR, over exteriorIOR where overrideExteriorIOR is 1
     tailMix: the part of a second lobe, whose roughness is tailLength of the way to 1
   Not here: absorption and scattering inside (Interior "medium"), dispersion, iridescence, anisotropyDirection. */
#include "lama.h"
surface LamaDielectric(float fresnelMode = 0; varying float IOR = 1.5; varying float reflectivity = .04;
                       varying color reflectionTint = 1, transmissionTint = 1; varying float roughness = .1, anisotropy = 0;
                       varying vector anisotropyDirection = 0; varying float anisotropyRotation = 0, tailMix = 0, tailLength = .5;
                       varying color absorptionColor = 1; varying float absorptionRadius = 1;
                       varying normal dielectricNormal = 0, normal_ = 0; LAMA_OUT)
{
    normal none = 0;
    float root = sqrt(clamp(reflectivity, 0, .99));
    bxdf_out_mirror = reflectionTint;
    bxdf_out_through = transmissionTint;
    bxdf_out_glassIor = (fresnelMode == 0) ? (1 + root) / (1 - root) : IOR / LAMA_OUTSIDE;
    bxdf_out_glassRough = roughness;
    bxdf_out_glassAniso = anisotropy;
    bxdf_out_glassTail = clamp(tailMix, 0, 1);
    bxdf_out_glassTailRough = lamaTail(roughness, tailLength);
    bxdf_out_bump = (dielectricNormal != none) ? dielectricNormal : normal_;
    LAMA_SURFACE(1)
}
