// A shaded point as the stages of gather.h see it: lobes that light shall be gathered over, and what lights are told about the
// point.
#pragma once
#include "answers/kernelrun.h"
#include "integrator/beside.h"
#include "integrator/rays.h"
#include "world/below.h"

namespace alpenglow::transport {

/// What lights are told about a surface that they light: because it samples them or because one of its rays meets them.
struct LitValues {
    int binding = -1;
    std::vector<std::pair<const SiteInfo::Output*, std::vector<float>>>
        outputs;                                       ///< those that are not here are as the surface was given them
    std::shared_ptr<const struct KernelRun> displaced; ///< KernelRun::displaced of the surface, and the point there
    int point = -1;
    bool output(const std::string& name, std::vector<float>& v) const;
};

/// A walk that chance has chosen: from `point` of the batch, with what it would bring to the target.
struct WalkAsked {
    int point = 0;
    int32_t below = -1;
    Color weight;
    TargetId target = shading::kNoTarget;
    uint32_t vertex = 0; ///< of its random numbers
    int32_t share = -1;  ///< Accumulator::shares
    float indirect = 1;  ///< LobeVertex::indirect where it comes out
};

/// An ambient() at a point of the batch.
struct AmbientAsked {
    int point = 0;
    Vec3 way;     ///< the shading normal; then the unit direction of its shadow ray
    Color weight; ///< as of ShadowRay::contribution
    TargetId target = shading::kNoTarget;
    bool owns = false; ///< LobeVertex::ownsTarget
    int lit = -1;      ///< of LitSurfaces::values
};

/// A lobe at a point that light shall be gathered over.
struct LobeVertex {
    int point = 0;
    const LobeKind* kind = nullptr;
    LobeColumns::Place place; ///< in Requests::rows
    Color weight;             ///< of the request alone, before the ray's throughput
    TargetId target = shading::kNoTarget;
    const RayKind* rays = &kDiffuseKind;
    bool lights = true;       ///< estimate lights here
    bool deltaLights = true;  ///< point, spot and distant ones too (not trace() without "samplelights")
    bool lobeOfShader = true; ///< a lighting shadeop: counts for the energy rule and may be chosen among
    uint32_t site = 0, occurrence = 0;
    uint32_t before = 0; ///< rays that the same waiting kernel has asked for at this point before
    float maxDistance = 1e38f;
    int samples = 1;
    bool ownsTarget = false; ///< a suspended request: the target also gets distance and transmission
    bool followed = true;    ///< its ray may be sent
    bool delta = false;      ///< kind->isDelta(params)
    bool narrow = false;     ///< no delta, but photons follow it as if it were one
    bool elsewhere = false;  ///< trace() from a point that is not that of the surface: `from`
    Vec3 from;
    float bias = -1;      ///< < 0: the hit's own error bound
    float base = 0;       ///< "samplebase": rays start on this part of the footprint
    int lit = -1;         ///< of LitSurfaces::values
    int32_t share = -1;   ///< Accumulator::shares: outputs that hold this request too; -1: none
    float importance = 1; ///< its "weight", for rayinfo()
    Color tint{1};        ///< of the environment map
    const TraceSite* trace = nullptr;
    shading::Fade fade;      ///< of what its rays meet
    int32_t below = -1;      ///< SubsurfaceWalks::below: of a subsurface(), whose rays walk there; -1: another
    bool directOnly = false; ///< light is sampled, no ray is sent
    float indirect = 1;      ///< factor of its rays
    float albedo = 0;        ///< kind->albedo(params)
    uint8_t guide = 0;       ///< GuideRays::Aim::trail() of its own ray
    float chosen = 1;        ///< probability that the indirect ray of this lobe is followed
    bool last = false;       ///< its ray would go too deep: light that only rays find is looked for in its place
    Beside beside;           ///< a light that its rays may pass in a medium
};

/// n or -n: the one on the side of the surface at p that a ray in direction dir comes from.
inline Vec3 onSeenSide(const Vec3& n, const ShadePoint& p, const Vec3& dir) {
    return (dot(n, p.surface.n) > 0) == (dot(dir, p.surface.n) < 0) ? n : -n;
}

} // namespace alpenglow::transport
