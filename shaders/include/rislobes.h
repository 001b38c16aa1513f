/* What the materials of RIS (ris/) have in common, beside layers.h: reflections by face and edge colours or by refraction indices,
   and normals of (0, 0, 0), which mean that none is given. */
#ifndef RISLOBES_H
#define RISLOBES_H
#include "layers.h"
/* The normal `given`, that of the material, or N, turned to the viewer. 1 from outside. */
float risSide(normal given, ofAll; output normal n)
{
    extern normal N;
    normal none = 0, use = N;
    if (ofAll != none) use = ofAll;
    if (given != none) use = given;
    return layerSide(use, n);
}
/* The direction `given` (0: along u), in the plane of the surface. */
vector risAlong(vector given; normal n)
{
    extern vector dPdu;
    vector none = 0;
    return layerTangent(n, (given == none) ? dPdu : given, 0);
}
/* A reflection. mode 0: from face to edge by Schlick's curve of the given exponent; else the edge colour times Fresnel's law for
   index and extinction. model 0: facets of Beckmann, else of Trowbridge and Reitz; a mirror below LAYER_SMOOTH. Nothing is given
   back of what facets lose. albedo: what it reflects in all. */
color risSpecular(float mode, model; color face, edge; float shape; color ior, extinction; float roughness, anisotropy;
                  normal n; vector V, along; output color albedo)
{
    extern point P;
    float ax, ay;
    layerWidths(roughness * roughness, anisotropy, ax, ay);
    float a = sqrt(ax * ay), c = n . V, at = layerCosine(c, a);
    color light = 0, none = 0, pair[2] = {none, none}, weight = edge, whole;
    if (mode == 0) {
        weight = layerSchlick(at, face, edge, shape);
        whole = weight;
    } else {
        whole = edge * layerConductor(at, ior, extinction);
        pair[0] = ior;
        pair[1] = extinction;
    }
    albedo = whole * layerAlbedo(c, a);
    if (whole != none) {
        float rays = layerSamples(16);
        if (max(ax, ay) < LAYER_SMOOTH)
            light = whole * trace(P, 2 * c * n - V, "samplelights", 1);
        else if (model == 0)
            light = weight * trace(P, n, "distribution", "beckmann", "wo", V, "udir", along, "roughness", ax, "roughnessv", ay,
                                   "eta", pair, "samples", rays, "samplelights", 1);
        else
            light = weight * trace(P, n, "distribution", "ggx", "wo", V, "udir", along, "roughness", ax, "roughnessv", ay,
                                   "eta", pair, "samples", rays, "samplelights", 1);
    }
    return light;
}
/* Light that walked below the surface. mfp: mean free path of diffusion, in current space. */
color risSubsurface(color tint, mfp; float g, ior)
{
    extern point P;
    color least = 1e-6, zero = 0;
    return subsurface(P, "reflectance", clamp(tint, zero, color .999), "diffusemeanfreepath", max(mfp, least), "ior", ior, "scale", 1,
                      "anisotropy", g);
}
#endif
