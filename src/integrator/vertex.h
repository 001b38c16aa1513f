// What calls request at a shaded point: lobes, walks, ambient light; and the values that lights query.
#pragma once
#include "integrator/lightdirected.h"
#include "integrator/rays.h"
#include "services/kernelrun.h"
#include "world/subsurfacemedium.h"

namespace alpenglow::integrator {

/// Values of a lit surface for lights that query them, whether the light is sampled or hit by a ray.
struct LitValues {
    int binding = -1;                                                            ///< index in WorldImpl::bindings(); -1: none
    std::vector<std::pair<const SiteInfo::Output*, std::vector<float>>> outputs; ///< missing ones have their parameter values
    std::shared_ptr<const struct KernelRun> displaced; ///< KernelRun::displaced of the surface; point: index there
    int point = -1;                                    ///< index in the batch
    Vec3 N, I;                                         ///< of the lit point
    /// An output of the surface's shader; false: it has no such output.
    bool output(const std::string& name, std::vector<float>& v) const;
};

/// A subsurface walk that was selected: from `point` of the batch, with its throughput to the target.
struct WalkAsked {
    int point = 0;
    int32_t subsurface = -1; ///< index in SubsurfaceWalks::media
    Color weight;            ///< by channel
    AccumulatorId target = shading::kNoAccumulator;
    uint32_t vertex = 0; ///< random number key
    int32_t share = -1;  ///< Accumulator::aovSplits
    float indirect = 1;  ///< LobeVertex::indirect at the exit
};

/// An ambient() call at a point of the batch.
struct AmbientAsked {
    int point = 0;
    Vec3 way;                                       ///< the shading normal; then the unit direction of its shadow ray
    Color weight;                                   ///< as ShadowRay::contribution
    AccumulatorId target = shading::kNoAccumulator; ///< receives the light
    bool owns = false;                              ///< LobeVertex::ownsTarget
    int lit = -1;                                   ///< index in LitSurfaces::values
};

/// A lobe that a call requests at a point.
struct LobeVertex {
    int point = 0;
    const LobeKind* kind = nullptr;                 ///< which lobe
    BsdfBatch::Place place;                         ///< in Requests::rows
    Color weight;                                   ///< of the request, without the ray's throughput
    AccumulatorId target = shading::kNoAccumulator; ///< receives the light
    const RayKind* rays = &kDiffuseKind;            ///< of the rays that the lobe sends
    bool lights = true;                             ///< samples lights, if it is no delta
    bool lobeOfShader = true;                       ///< of a lighting shadeop: subject to the energy rule and to lobe selection
    uint32_t site = 0, occurrence = 0;              ///< random number keys: call site, and earlier calls of it at this vertex
    uint32_t before = 0;                            ///< rays that the same waiting kernel has requested at this point before
    float maxDistance = 1e38f;                      ///< of the call
    int samples = 1;                                ///< rays of the call, or light samples
    bool ownsTarget = false;                        ///< a suspended request: the target also receives distance and transmission
    bool ownOrigin = false;                         ///< trace() from another position than the surface point: `from`
    Vec3 from;                                      ///< camera space
    float bias = -1;                                ///< < 0: the error bound of the hit
    float base = 0;                                 ///< "samplebase": rays start within this part of the footprint
    int lit = -1;                                   ///< index in LitSurfaces::values
    int32_t share = -1;                             ///< Accumulator::aovSplits: outputs that include this request; -1: none
    float importance = 1;                           ///< "weight", for rayinfo()
    Color tint{1};                                  ///< of the environment map
    const TraceSite* trace = nullptr;               ///< null: no trace()
    shading::Fade fade;                             ///< attenuation of distant hits
    int32_t subsurface = -1; ///< SubsurfaceWalks::media, for a subsurface() whose rays walk; -1: other lobes
    float indirect = 1;      ///< factor of its rays
};

/// n or -n: on the side of the surface at p from which a ray in direction dir arrives.
inline Vec3 onSeenSide(const Vec3& n, const ShadePoint& p, const Vec3& dir) {
    return (dot(n, p.surface.n) > 0) == (dot(dir, p.surface.n) < 0) ? n : -n;
}

} // namespace alpenglow::integrator
