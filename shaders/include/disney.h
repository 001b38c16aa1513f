/* Parts of Burley's principled reflections (2012, 2015), for ris/PxrDisney and ris/PxrDisneyBsdf. */
#ifndef DISNEY_H
#define DISNEY_H
#include "layers.h"
/* Hue and saturation of a colour, its luminance taken away. */
color disneyTint(color base)
{
    float l = .3 * comp(base, 0) + .6 * comp(base, 1) + .1 * comp(base, 2);
    return (l > 0) ? base / l : color 1;
}
/* What the sheen sheen * (1 - L.H)^5 gives back in a white furnace, seen from c; within .0003. */
float disneySheen(float sheen, c)
{
    float x = 1 - c, x2 = x * x;
    return sheen * x * (.0117 + x2 * (.0796 + x2 * (-.0124 + x2 * .0098)));
}
/* What the sheen gives back, with its tint, at most everything: a tint has parts above 1. The rest is for what lies below. */
color disneyCloth(float sheen; color tint; float c)
{
    return clamp(disneySheen(sheen, c) * tint, color 0, color 1);
}
/* The highlight, of reflectance `shine` straight on and 1 at the rim. kept: what of light goes on below. */
color disneySpecular(color shine; float roughness, anisotropic; normal n; vector V; output color kept)
{
    extern point P;
    float ax, ay;
    layerWidths(roughness * roughness, anisotropic, ax, ay);
    float a = sqrt(ax * ay), c = n . V;
    color light, whole = layerSchlick(layerCosine(c, a), shine, color 1, 5);
    if (max(comp(shine, 0), max(comp(shine, 1), comp(shine, 2))) <= 0) whole = 0; /* specular 0: no highlight at all */
    kept = 1 - whole * layerAlbedo(c, a);
    if (max(ax, ay) < LAYER_SMOOTH)
        light = whole * trace(P, 2 * c * n - V, "samplelights", 1);
    else
        light = whole * trace(P, n, "distribution", "ggx", "wo", V, "udir", layerAlong(anisotropic, n), "roughness", ax,
                              "roughnessv", ay, "samplelights", 1);
    return light;
}
/* A coat of index 1.5, a quarter as strong as a whole one. */
color disneyCoat(float clearcoat, gloss; normal n; vector V; output color kept)
{
    extern point P;
    float a = mix(.1, .001, gloss), c = n . V, w = .25 * clearcoat * comp(layerSchlick(layerCosine(c, a), color .04, color 1, 5), 0);
    color light;
    kept = 1 - w * layerAlbedo(c, a);
    if (a < LAYER_SMOOTH)
        light = w * trace(P, 2 * c * n - V, "samplelights", 1);
    else
        light = w * trace(P, n, "distribution", "ggx", "wo", V, "roughness", a, "samplelights", 1);
    return light;
}
#endif
