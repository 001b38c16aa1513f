/* PxrDisneyBsdf: Burley's principled surface with transmission, "Extending the Disney BRDF to a BSDF" (2015), of RIS. Names and defaults are
   those of Pixar's node.
     ior with specReflectScale: the highlight of what is no metal. specularTint tints it by baseColor
     specTrans: part of the light below the highlight that comes through, with the square root of baseColor at each surface; after
       transDistance scene units inside transColor is left of it (black: all)
     isThin: a sheet; diffTrans (0 to 2) of it lets diffuse light through
     subsurface: part of the diffuse light that walks below the surface by subsurfaceColor (black: baseColor), as far as
       scatterDistances (scene units); g is its direction
   Unlike there: as in PxrDisney. transmissionBehavior and shadowBumpTerminator are not read.
   Ball: Surface "ris/PxrDisneyBsdf" "color baseColor" [.9 .9 .9] "float specTrans" 1 "float roughness" .2 */
#include "rislobes.h"
#include "disney.h"
surface PxrDisneyBsdf(varying color baseColor = .5, emitColor = 0; varying float metallic = 0, specularTint = 0, roughness = .25, anisotropic = 0;
                      varying float ior = 1.5, specReflectScale = 1, clearcoat = 0, clearcoatGloss = 1, sheen = 0, sheenTint = .5;
                      varying float diffTrans = 0, specTrans = 0; float isThin = 0; varying color transColor = 0; varying float transDistance = 1;
                      varying float subsurface = 0; varying color subsurfaceColor = 0, scatterDistances = 1; varying float g = 0;
                      float transmissionBehavior = 0, shadowBumpTerminator = 1, inputAOV = 0; varying normal bumpNormal = 0; varying float presence = 1;)
{
    normal n;
    float front = risSide(normal 0, bumpNormal, n), r0 = (ior - 1) / (ior + 1);
    vector V = -normalize(I);
    color black = 0, light = 0, kept = 1, coated = 1, tint = disneyTint(baseColor);
    color shine = mix(min(specReflectScale * r0 * r0, 1) * mix(color 1, tint, specularTint), baseColor, metallic);
    float through = specTrans * (1 - metallic), ax, ay;
    if (through < 1) light = (1 - through) * disneySpecular(shine, roughness, anisotropic, n, V, kept);
    if (clearcoat > 0) light += disneyCoat(clearcoat, clearcoatGloss, n, V, coated);
    if (through > 0) {
        color white = 1, root = layerRoot(max(baseColor, black)), glass;
        layerWidths(roughness * roughness, anisotropic, ax, ay);
        if (isThin == 1) glass = layerSheet(n, V, layerAlong(anisotropic, n), ax, ay, ior, 1, white, root);
        else glass = layerGlass(n, front, V, layerAlong(anisotropic, n), ax, ay, ior, 1, white, root);
        if (isThin != 1 && front == 0 && transColor != black)
            glass *= layerPower(clamp(transColor, color 1e-4, color 1), length(I) / max(transDistance, 1e-6));
        light += through * coated * glass;
    }
    if (metallic < 1 && through < 1) {
        color diffusing = (1 - metallic) * (1 - specTrans) * kept * coated;
        color cloth = disneyCloth(sheen, mix(color 1, tint, sheenTint), n . V), under = diffusing * (1 - cloth);
        float half = (isThin == 1) ? clamp(diffTrans / 2, 0, 1) : 0, walks = (isThin == 1) ? 0 : clamp(subsurface, 0, 1);
        if (walks > 0) {
            color inside = (subsurfaceColor == black) ? baseColor : subsurfaceColor;
            light += under * walks * risSubsurface(inside, scatterDistances, g, 1);
        }
        light += (under * (1 - walks) * (1 - half) * baseColor + diffusing * cloth) * diffuse(n);
        if (half > 0) light += under * half * baseColor * diffuse(-n);
    }
    Oi = presence;
    Ci = presence * (light + emitColor);
}
