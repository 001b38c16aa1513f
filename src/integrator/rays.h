// Rays and light between the stages: shadow rays, and what reaches a target.
#pragma once
#include "base/exactsum.h"
#include "shading/scheduler.h"
#include "world/impl.h"

namespace alpenglow::transport {

using shading::FreeFlight;
using shading::PathRay;
using shading::PathSample;
using shading::RayExtra;
using shading::RayKind;
using shading::Sched;
using shading::ShadePoint;
using shading::TargetId;

/// Rays that most vertices send.
inline constexpr RayKind kDiffuseKind{RayType::Diffuse, false, {}, 0}, kSpecularKind{RayType::Specular, false, {}, 0};
inline constexpr RayKind kShadowKind{RayType::Transmission, false, {}, 0};

/// A visibility question: adds contribution * transmittance to the target.
struct ShadowRay {
    Vec3 origin, dir;
    float distance;
    Color contribution;
    TargetId target;
    float time;
    const PathRay* ray = nullptr;
    bool areaLight = false;                ///< of a trace() that asks how much area lights give
    const RayKind* kind = &kShadowKind;    ///< whose visibility counts
    const shading::Media* media = nullptr; ///< where it begins
    int32_t share = -1;                    ///< RayExtra::share
    int32_t more = -1;                     ///< ShadowRays::more: what else goes the same way; -1: nothing
    uint16_t path = 0;                     ///< PathRay::path behind its vertex
    int32_t light = 0;                     ///< and the event at its other end (LightPathStates)
    int32_t hemisphere =
        -1; ///< OcclusionCalls::hemispheres: of an occlusion(), which takes the mean of the channels; -1: another
};

/// Directions that a call has no use for (beyond the plane of "axis") are drawn again so often; then the ray is left out.
inline constexpr int kDrawTries = 64;

/// Where light that reaches a target comes from: with the ray that brings it, what a path was at its end.
enum class LightEvent : uint8_t {
    Surface, ///< what a shader gives by itself (Ci)
    Output,  ///< the same of an output
    Sampled, ///< a light, sampled at a vertex
    Met,     ///< an emitter that the ray met
    Sky,     ///< a sky, or ambient light, behind everything
    Map,     ///< the environment map of a trace()
    Photons  ///< photons, which came from lights by way of mirrors and glass
};
struct Deposit {
    TargetId target = shading::kNoTarget;
    Color light;
    LightEvent event = LightEvent::Surface;
    const PathRay* path = nullptr;      ///< that brings it, up to its last vertex; may be null
    int32_t share = -1;                 ///< Accumulator::shares
    const ShaderInstance* of = nullptr; ///< that made it; null: not known
    uint16_t end = 0;                   ///< PathRay::path behind the light: which outputs by light path have it; 0: none
};

/// An occlusion() whose rays are among the shadow rays.
struct HemisphereRays {
    const TraceSite* site = nullptr;
    float share = 1;    ///< of one of its rays
    shading::Fade fade; ///< how much a surface blocks that a ray meets far away
    float spread = 0;   ///< of the rays, for the map
    TurnedAway::Tally* tally = nullptr;
    /// Notes that a ray came through.
    void open(const Color& transmitted) const {
        if (tally && transmitted != Color(0)) TurnedAway::Tally::set(tally->open);
    }
};

/// The way from a to b for a shadow ray; where an end is `at`, a shaded point of the surface `s` (null: none), that surface does
/// not block.
struct Way {
    Vec3 origin, dir;
    float distance = 0;
};
Way wayBetween(const Vec3& a, const Vec3& b, const Vec3& at, const geometry::SurfacePoint* s);

/// Rows of floats of all arguments of a call.
int rowsOfArguments(const SiteInfo&);

/// A point of a disk of this radius about `centre`, which is seen along w (unit): LightValue::shadowRadius.
Vec3 onShadowDisk(const Vec3& centre, const Vec3& w, float radius, Vec2 random);

/// Light beside that of a ShadowRay, and the next of the same.
struct MoreLight {
    Color contribution;
    TargetId target;
    int32_t share;
    bool areaLight;
    uint16_t path;
    int32_t more;
};

/// What a trace() that asks for it is told beside its result. Sums are exact: order does not matter.
struct TraceSums {
    enum Part { Blocked, Open, Environment, UnshadowedEnvironment, AreaLight, UnshadowedAreaLight, Count }; // Open: directions
    ExactSum sum[Count][3];
    void add(Part p, const Color& c) {
        for (int k = 0; k < 3; ++k)
            if (std::isfinite(c[k]) && c[k] != 0) sum[p][k].add(c[k]);
    }
    Color value(Part p) const { return {sum[p][0].toFloat(), sum[p][1].toFloat(), sum[p][2].toFloat()}; }
};

/// A surface that a shadow ray met, whose opacity its shader must tell.
struct OpacityQuery {
    int binding;
    accel::Hit hit;
    const ShadowRay* ray;
    const BoundKernel* kernel;
};

/// A part of what is added to a target that an output has as well, and the next one of the same light.
struct Share {
    TargetId target;
    Color ratio;
    int32_t next;
};

/// Shadow rays that are followed together, about: what many samples of many points ask for does not fit into memory at once.
inline constexpr size_t kShadowsAtOnce = size_t(1) << 16;

inline float mean(const Color& c) { return (c.x + c.y + c.z) / 3; }
inline bool isFinite(const Color& c) { return std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z); }

} // namespace alpenglow::transport
