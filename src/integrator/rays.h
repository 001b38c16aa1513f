// Rays and light between stages: shadow rays, contributions to targets.
#pragma once
#include "base/exactsum.h"
#include "integrator/names.h"
#include "shading/scheduler.h"
#include "world/impl.h"

namespace alpenglow::integrator {

using shading::AccumulatorId;
using shading::FreeFlight;
using shading::PathRay;
using shading::PathSample;
using shading::RayExtra;
using shading::RayKind;
using shading::Sched;
using shading::ShadePoint;

/// Kinds of the rays that most vertices send.
inline constexpr RayKind kDiffuseKind{RayType::Diffuse, false, {}, 0}, kSpecularKind{RayType::Specular, false, {}, 0};
inline constexpr RayKind kShadowKind{RayType::Transmission, false, {}, 0};

/// A visibility query: adds contribution * transmittance to the target.
struct ShadowRay {
    Vec3 origin, dir; ///< camera space; dir: unit
    float distance;   ///< where the ray ends
    Color contribution;
    AccumulatorId target;
    float time;                            ///< of the shutter, 0 to 1
    const PathRay* ray = nullptr;          ///< that hit the vertex; null: none
    bool areaLight = false;                ///< of a trace() that returns "arealight" sums
    const RayKind* kind = &kShadowKind;    ///< whose visibility attributes apply
    const shading::Media* media = nullptr; ///< at its origin
    int32_t share = -1;                    ///< RayExtra::share
    int32_t more = -1;                     ///< ShadowRays::more: further light along this ray; -1: none
    uint16_t path = 0;                     ///< PathRay::path after its vertex
    int32_t light = 0;                     ///< symbol of the light at its other end (LightPathStates)
    int32_t hemisphere =
        -1; ///< OcclusionCalls::hemispheres: of an occlusion(), which takes the mean of the channels; -1: another
};

/// Directions that a call cannot use (beyond the plane of "axis") are redrawn so often; then the ray is dropped.
inline constexpr int kDrawTries = 64;

/// The last event of a light path, seen from the camera.
enum class LightEvent : uint8_t {
    Surface, ///< Ci of a shader, without requests
    Output,  ///< an output of a shader, without requests
    Sampled, ///< a light, sampled at a vertex
    Met,     ///< an emitter that a ray hit
    Sky,     ///< a sky, or ambient light
    Map,     ///< the environment map of a trace()
    Photons  ///< photons, i.e. light via mirrors and glass
};
struct Contribution {
    /// Light for a target, as Accumulator::add() takes it.
    AccumulatorId target = shading::kNoAccumulator;
    Color light;                            ///< with the throughput of the path
    LightEvent event = LightEvent::Surface; ///< what made it
    const PathRay* path = nullptr;          ///< the ray up to its last vertex; may be null
    int32_t share = -1;                     ///< Accumulator::aovSplits
    const ShaderInstance* of = nullptr;     ///< shader that made the light; null: unknown
    uint16_t end = 0;                       ///< PathRay::path after the light event: selects the light path outputs; 0: none
};

/// An occlusion() whose rays are among the shadow rays.
struct HemisphereRays {
    const TraceSite* site = nullptr;        ///< the call
    float share = 1;                        ///< weight of one of its rays
    shading::Fade fade;                     ///< attenuates occlusion by distant surfaces
    float spread = 0;                       ///< of the rays, for the environment map
    FlippedNormals::Tally* tally = nullptr; ///< counts normals that face away; null: it does not
    /// Counts an unoccluded ray.
    void open(const Color& transmitted) const {
        if (tally && transmitted != Color(0)) FlippedNormals::Tally::set(tally->open);
    }
};

/// A shadow ray as the acceleration structure expects it.
accel::Ray rayOf(const ShadowRay&);

/// The segment from a to b for a shadow ray. If an end is `at`, a shaded point on the surface `s` (may be null), that surface
/// does not occlude the ray.
struct ShadowSegment {
    Vec3 origin, dir;   ///< camera space; dir: unit
    float distance = 0; ///< of the other end
};
/// From a to b, as above.
ShadowSegment segmentBetween(const Vec3& a, const Vec3& b, const Vec3& at, const geometry::SurfacePoint* s);

/// Number of float rows of all arguments of a call.
int rowsOfArguments(const SiteInfo&);

/// A point on a disk with this centre and radius that faces direction w (unit): LightValue::shadowRadius.
Vec3 onShadowDisk(const Vec3& centre, const Vec3& w, float radius, Vec2 random);

/// Further light along a ShadowRay, and the next one along it.
struct MoreLight {
    /// As the members of ShadowRay of these names; more: -1: the last one.
    Color contribution;
    AccumulatorId target;
    int32_t share;
    bool areaLight;
    uint16_t path;
    int32_t more;
};

/// Additional results of a trace(). Sums are exact, so their order does not matter.
struct TraceSums {
    enum Part { Blocked, Open, Environment, UnshadowedEnvironment, AreaLight, UnshadowedAreaLight, Count }; // Open: directions
    ExactSum sum[Count][3];                                                                                 ///< by channel
    /// Adds a colour; components that are not finite are left out.
    void add(Part p, const Color& c) {
        for (int k = 0; k < 3; ++k)
            if (std::isfinite(c[k]) && c[k] != 0) sum[p][k].add(c[k]);
    }
    /// The sum, by channel.
    Color value(Part p) const { return {sum[p][0].toFloat(), sum[p][1].toFloat(), sum[p][2].toFloat()}; }
};

/// A surface hit by a shadow ray whose opacity is computed by a shader.
struct OpacityQuery {
    int binding; ///< index in WorldImpl::bindings()
    accel::Hit hit;
    const ShadowRay* ray;
    const BoundKernel* kernel; ///< computes its Oi
};

/// The part of a contribution that an output also receives, and the next output for the same light.
struct AovSplit {
    AccumulatorId target; ///< of the output
    Color ratio;          ///< the output's part of the light, by channel
    int32_t next;
};

/// Shadow rays traced together, about. Many samples at many points would not fit into memory at once.
inline constexpr size_t kShadowsAtOnce = size_t(1) << 16;

/// The mean of the channels; whether all are finite.
inline float mean(const Color& c) { return (c.x + c.y + c.z) / 3; }
inline bool isFinite(const Color& c) { return std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z); }

} // namespace alpenglow::integrator
