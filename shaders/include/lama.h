/* Lama: materials of RIS that are put together from others. A node describes its lobes by outputs bxdf_out_*, which a node that takes
   it has as parameters material1_* and the like; the node that stands as the surface gathers the light of them all. So each node is a
   surface of its own, too. Weights are colours; what shapes a lobe is the mean of both sides by their weights. */
#ifndef LAMA_H
#define LAMA_H
#include "rislobes.h"
#define LAMA_IN(M) \
    varying color M##_diffuse = 0; varying float M##_diffuseRough = 0; \
    varying color M##_metal = 0, M##_metalIor = 1, M##_metalK = 0; varying float M##_metalRough = .1, M##_metalAniso = 0; \
    varying float M##_metalTail = 0, M##_metalTailRough = .1, M##_glassTail = 0, M##_glassTailRough = .1; \
    varying color M##_mirror = 0, M##_through = 0; varying float M##_glassIor = 1.5, M##_glassRough = .1, M##_glassAniso = 0; \
    varying color M##_sheen = 0; varying float M##_sheenRough = .1; \
    varying color M##_sss = 0, M##_sssRadius = 1; varying color M##_translucent = 0, M##_glow = 0; varying normal M##_bump = 0;
/* What the nodes of Pixar's documentation have besides and no light here depends on. */
#define LAMA_OUT \
    varying color shadowColor = 0; varying float energyCompensation = 1, surfaceMollification = 1, motionMollification = 0; \
    float bumpShadowing = 1, overrideExteriorIOR = 0; varying float exteriorIOR = 1; string lobeName = "", matte = ""; \
    output varying color bxdf_out_diffuse = 0; output varying float bxdf_out_diffuseRough = 0; \
    output varying color bxdf_out_metal = 0; output varying color bxdf_out_metalIor = 1; output varying color bxdf_out_metalK = 0; \
    output varying float bxdf_out_metalRough = .1; output varying float bxdf_out_metalAniso = 0; \
    output varying float bxdf_out_metalTail = 0; output varying float bxdf_out_metalTailRough = .1; \
    output varying float bxdf_out_glassTail = 0; output varying float bxdf_out_glassTailRough = .1; \
    output varying color bxdf_out_mirror = 0; output varying color bxdf_out_through = 0; \
    output varying float bxdf_out_glassIor = 1.5; output varying float bxdf_out_glassRough = .1; \
    output varying float bxdf_out_glassAniso = 0; output varying color bxdf_out_sheen = 0; \
    output varying float bxdf_out_sheenRough = .1; output varying color bxdf_out_sss = 0; \
    output varying color bxdf_out_sssRadius = 1; output varying color bxdf_out_translucent = 0; \
    output varying color bxdf_out_glow = 0; output varying normal bxdf_out_bump = 0;
/* The roughness of a tail: length 1 is as rough as can be, 0 as the lobe itself, below 0 less rough. */
float lamaTail(float rough, tailLength) { return (tailLength >= 0) ? mix(rough, 1, min(tailLength, 1)) : rough * max(1 + tailLength, 0); }
/* The index of what is outside. */
#define LAMA_OUTSIDE ((overrideExteriorIOR != 0) ? max(exteriorIOR, 1e-3) : 1)
float lamaShare(color a, b)
{
    float x = comp(a, 0) + comp(a, 1) + comp(a, 2), y = comp(b, 0) + comp(b, 1) + comp(b, 2);
    return (x + y > 0) ? y / (x + y) : 0;
}
/* A of weight wa and B of weight wb. */
#define LAMA_ADD(A, wa, B, wb) \
    color a_, b_; \
    a_ = wa * A##_diffuse; b_ = wb * B##_diffuse; bxdf_out_diffuse = a_ + b_; \
    bxdf_out_diffuseRough = mix(A##_diffuseRough, B##_diffuseRough, lamaShare(a_, b_)); \
    a_ = wa * A##_metal; b_ = wb * B##_metal; bxdf_out_metal = a_ + b_; \
    bxdf_out_metalIor = mix(A##_metalIor, B##_metalIor, lamaShare(a_, b_)); \
    bxdf_out_metalK = mix(A##_metalK, B##_metalK, lamaShare(a_, b_)); \
    bxdf_out_metalRough = mix(A##_metalRough, B##_metalRough, lamaShare(a_, b_)); \
    bxdf_out_metalAniso = mix(A##_metalAniso, B##_metalAniso, lamaShare(a_, b_)); \
    bxdf_out_metalTail = mix(A##_metalTail, B##_metalTail, lamaShare(a_, b_)); \
    bxdf_out_metalTailRough = mix(A##_metalTailRough, B##_metalTailRough, lamaShare(a_, b_)); \
    a_ = wa * (A##_mirror + A##_through); b_ = wb * (B##_mirror + B##_through); \
    bxdf_out_mirror = wa * A##_mirror + wb * B##_mirror; bxdf_out_through = wa * A##_through + wb * B##_through; \
    bxdf_out_glassIor = mix(A##_glassIor, B##_glassIor, lamaShare(a_, b_)); \
    bxdf_out_glassRough = mix(A##_glassRough, B##_glassRough, lamaShare(a_, b_)); \
    bxdf_out_glassAniso = mix(A##_glassAniso, B##_glassAniso, lamaShare(a_, b_)); \
    bxdf_out_glassTail = mix(A##_glassTail, B##_glassTail, lamaShare(a_, b_)); \
    bxdf_out_glassTailRough = mix(A##_glassTailRough, B##_glassTailRough, lamaShare(a_, b_)); \
    a_ = wa * A##_sheen; b_ = wb * B##_sheen; bxdf_out_sheen = a_ + b_; \
    bxdf_out_sheenRough = mix(A##_sheenRough, B##_sheenRough, lamaShare(a_, b_)); \
    a_ = wa * A##_sss; b_ = wb * B##_sss; bxdf_out_sss = a_ + b_; \
    bxdf_out_sssRadius = mix(A##_sssRadius, B##_sssRadius, lamaShare(a_, b_)); \
    bxdf_out_translucent = wa * A##_translucent + wb * B##_translucent; bxdf_out_glow = wa * A##_glow + wb * B##_glow; \
    bxdf_out_bump = (A##_bump == normal 0) ? B##_bump : A##_bump;
#define LAMA_COPY(A) LAMA_ADD(A, 1, A, 0)
/* What the lobes of a node give back in all, without what comes through: what a node below it loses. */
color lamaAlbedo(float c; color diffusing, metal, metalIor, metalK; float metalRough; color mirror; float glassIor, glassRough;
                 color sheen; float sheenRough; color sss)
{
    float ma = metalRough * metalRough, ga = glassRough * glassRough;
    return diffusing + sss + metal * layerConductor(layerCosine(c, ma), metalIor, metalK) +
        mirror * layerAlbedo(c, ga) * layerDielectric(layerCosine(c, ga), glassIor) + sheen * layerSheen(c, clamp(sheenRough, .1, 1));
}
#define LAMA_ALBEDO(A, c) \
    lamaAlbedo(c, A##_diffuse + A##_translucent, A##_metal, A##_metalIor, A##_metalK, A##_metalRough, A##_mirror, A##_glassIor, \
               A##_glassRough, A##_sheen, A##_sheenRough, A##_sss)
/* The light of a node's lobes. */
color lamaLight(color diffusing; float diffuseRough; color metal, metalIor, metalK; float metalRough, metalAniso, metalTail, metalTailRough;
                color mirror, through; float glassIor, glassRough, glassAniso, glassTail, glassTailRough; color sheen; float sheenRough; color sss, sssRadius, translucent, glow;
                normal bump)
{
    extern vector I;
    normal n;
    float front = risSide(normal 0, bump, n), ax, ay;
    vector V = -normalize(I), along = layerAlong(max(metalAniso, glassAniso), n);
    color light = glow, none = 0;
    color around = diffusing + sheen * layerSheen(n . V, clamp(sheenRough, .1, 1));
    if (around != none) light += around * layerDiffuse(n, V, diffuseRough, 1);
    if (translucent != none) light += translucent * diffuse(-n);
    if (metal != none) {
        layerWidths(metalRough * metalRough, metalAniso, ax, ay);
        light += (1 - metalTail) * metal * layerReflectMetal(n, V, along, ax, ay, metalIor, metalK, 1);
        if (metalTail > 0) {
            layerWidths(metalTailRough * metalTailRough, metalAniso, ax, ay);
            light += metalTail * metal * layerReflectMetal(n, V, along, ax, ay, metalIor, metalK, 1);
        }
    }
    if (through != none) {
        layerWidths(glassRough * glassRough, glassAniso, ax, ay);
        light += (1 - glassTail) * layerGlass(n, front, V, along, ax, ay, glassIor, 1, mirror, through);
        if (glassTail > 0) {
            layerWidths(glassTailRough * glassTailRough, glassAniso, ax, ay);
            light += glassTail * layerGlass(n, front, V, along, ax, ay, glassIor, 1, mirror, through);
        }
    } else if (mirror != none) {
        layerWidths(glassRough * glassRough, glassAniso, ax, ay);
        light += (1 - glassTail) * mirror * layerReflect(n, V, along, ax, ay, glassIor, 1);
        if (glassTail > 0) {
            layerWidths(glassTailRough * glassTailRough, glassAniso, ax, ay);
            light += glassTail * mirror * layerReflect(n, V, along, ax, ay, glassIor, 1);
        }
    }
    if (sss != none) { /* the weight is the largest channel, the rest is what the walk is to give back */
        float most = max(comp(sss, 0), comp(sss, 1), comp(sss, 2));
        light += max(most, 1) * risSubsurface(sss / max(most, 1), sssRadius, 0, 1);
    }
    return light;
}
#define LAMA_SURFACE(presence) \
    Oi = presence; \
    Ci = presence * lamaLight(bxdf_out_diffuse, bxdf_out_diffuseRough, bxdf_out_metal, bxdf_out_metalIor, bxdf_out_metalK, \
                              bxdf_out_metalRough, bxdf_out_metalAniso, bxdf_out_metalTail, bxdf_out_metalTailRough, \
                              bxdf_out_mirror, bxdf_out_through, bxdf_out_glassIor, bxdf_out_glassRough, bxdf_out_glassAniso, \
                              bxdf_out_glassTail, bxdf_out_glassTailRough, bxdf_out_sheen, bxdf_out_sheenRough, bxdf_out_sss, \
                              bxdf_out_sssRadius, bxdf_out_translucent, bxdf_out_glow, bxdf_out_bump);
#endif
