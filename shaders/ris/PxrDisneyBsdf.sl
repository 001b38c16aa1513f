/* PxrDisneyBsdf: Burley's principled surface with transmission, "Extending the Disney BRDF to a BSDF" (2015), of RIS. Names are
   those of Pixar's documentation.
     specTrans: part of the light below the highlight that comes through, with the square root of baseColor at each surface
     thin: a sheet; diffTrans (0 to 2) of it lets diffuse light through. flatness is not read
     scatterDistance (scene units) above 0: light walks below the surface by baseColor
   Unlike there: as in PxrDisney.
   Ball: Surface "ris/PxrDisneyBsdf" "color baseColor" [.9 .9 .9] "float specTrans" 1 "float roughness" .2 */
#include "rislobes.h"
#include "disney.h"
surface PxrDisneyBsdf(varying color baseColor = .5, emitColor = 0; varying float metallic = 0, roughness = .25, anisotropic = 0;
                      varying float specularTint = 0, ior = 1.5, sheen = 0, sheenTint = .5, clearcoat = 0, clearcoatGloss = 1;
                      varying float specTrans = 0, flatness = 0, diffTrans = 0; varying color scatterDistance = 0;
                      float thin = 0; varying normal bumpNormal = 0; varying float presence = 1;)
{
    normal n;
    float front = risSide(normal 0, bumpNormal, n), r0 = (ior - 1) / (ior + 1);
    vector V = -normalize(I);
    color black = 0, light = 0, kept = 1, coated = 1, tint = disneyTint(baseColor);
    color shine = mix(r0 * r0 * mix(color 1, tint, specularTint), baseColor, metallic);
    float through = specTrans * (1 - metallic), ax, ay, rays = layerSamples(16);
    if (through < 1) light = (1 - through) * disneySpecular(shine, roughness, anisotropic, n, V, kept);
    if (clearcoat > 0) light += disneyCoat(clearcoat, clearcoatGloss, n, V, coated);
    if (through > 0) {
        color white = 1, tint = layerRoot(max(baseColor, black)), glass;
        layerWidths(roughness * roughness, anisotropic, ax, ay);
        if (thin == 1) glass = layerSheet(n, V, layerTangent(n, dPdu, 0), ax, ay, ior, rays, white, tint);
        else glass = layerGlass(n, front, V, layerTangent(n, dPdu, 0), ax, ay, ior, rays, white, tint);
        light += through * coated * glass;
    }
    if (metallic < 1 && through < 1) {
        color diffusing = (1 - metallic) * (1 - specTrans) * kept * coated;
        color cloth = disneySheen(sheen, n . V) * mix(color 1, tint, sheenTint);
        float half = (thin == 1) ? clamp(diffTrans / 2, 0, 1) : 0;
        if (scatterDistance != black && thin != 1)
            light += diffusing * (risSubsurface(baseColor, scatterDistance, 0, 1) + cloth * diffuse(n));
        else {
            light += diffusing * ((1 - half) * baseColor + cloth) * diffuse(n);
            if (half > 0) light += diffusing * half * baseColor * diffuse(-n);
        }
    }
    Oi = presence;
    Ci = presence * (light + emitColor);
}
