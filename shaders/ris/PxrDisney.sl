/* PxrDisney: the principled reflection of Burley, "Physically Based Shading at Disney" (2012), of RIS. Parameters and defaults are
   those of Pixar's documentation.
     subsurface tints and flattens: the diffuse colour turns to subsurfaceColor (black: baseColor)
   Unlike there: the diffuse part is Lambert's and loses what the highlights and the sheen reflect, so that no more light leaves than
   arrives;
   sheen and highlights have the Fresnel factor of the mean facet; the coat has the facets of the highlight (GTR1 there); both sides
   of the surface are shaded. inputMaterial is not read.
   Ball: Surface "ris/PxrDisney" "color baseColor" [.2 .5 .8] "float clearcoat" 1 */
#include "rislobes.h"
#include "disney.h"
surface PxrDisney(varying color baseColor = color(.2, .5, .8), emitColor = 0; varying float subsurface = 0;
                  varying color subsurfaceColor = 0;
                  varying float metallic = 0, specular = .5, specularTint = 0, roughness = .25, anisotropic = 0, sheen = 0,
                      sheenTint = .5, clearcoat = 0, clearcoatGloss = 1;
                  varying normal bumpNormal = 0; varying float presence = 1, inputAOV = 0;)
{
    normal n;
    risSide(normal 0, bumpNormal, n);
    vector V = -normalize(I);
    color black = 0, below = mix(baseColor, (subsurfaceColor == black) ? baseColor : subsurfaceColor, subsurface);
    color tint = disneyTint(baseColor), shine = mix(specular * .08 * mix(color 1, tint, specularTint), baseColor, metallic);
    color kept, coated;
    color light = disneySpecular(shine, roughness, anisotropic, n, V, kept);
    if (clearcoat > 0) {
        light += disneyCoat(clearcoat, clearcoatGloss, n, V, coated);
        kept = kept * coated;
    }
    if (metallic < 1) {
        color cloth = disneyCloth(sheen, mix(color 1, tint, sheenTint), n . V);
        light += (1 - metallic) * kept * (below * (1 - cloth) + cloth) * diffuse(n);
    }
    Oi = presence;
    Ci = presence * (light + emitColor);
}
