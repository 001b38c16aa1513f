// A point to be shaded, and the ray that found it. Camera space ("current").
#pragma once
#include "accel/accel.h"
#include "base/limits.h"
#include "base/sampler.h"
#include "geometry/shape.h"
#include "scene/primitive.h"
#include "shading/scheduler.h"
#include <algorithm>

namespace alpenglow::shading {

/// What a ray was sent for (rayinfo("type"), Attribute "visibility").
enum class RayType : uint8_t { Camera, Diffuse, Specular, Transmission };
/// As rayinfo("type") names it.
const char* toString(RayType);

/// Source of colour and opacity at hits: shaders, or the primitive's Color and Opacity.
enum class HitMode : uint8_t { Default, Primitive, Shader };

/// What a ray may hit, by its call ("subset", "hitsides", "hitmode").
struct RaySet {
    const uint8_t* only = nullptr;            ///< by shape: 0 is ignored; null: all. Owned by the world, which outlives the ray
    accel::Sides sides = accel::Sides::Front; ///< of one-sided surfaces
    HitMode mode = HitMode::Default;          ///< what gives colour and opacity of hits
};

/// The volumes around a ray: indices of the world's media, -1 for a vacuum. The last one is active: the last entered among those
/// of highest priority.
struct Media {
    int16_t in[limits::kMedia] = {};     ///< the first `count` are used
    float priority[limits::kMedia] = {}; ///< ascending
    int8_t count = 0;                    ///< number of volumes
    bool lost = false;                   ///< more volumes were entered than are tracked
    /// The active medium, or -1.
    int top() const { return count ? in[count - 1] : -1; }
    /// Its priority; 0 in a vacuum.
    float topPriority() const { return count ? priority[count - 1] : 0; }
    /// Whether the ray is in a volume of that medium.
    bool has(int medium) const { return std::find(in, in + count, medium) != in + count; }
    /// Enters a volume. Of more than limits::kMedia the one of least priority is forgotten, and the ray is `lost`.
    void push(int medium, float priority = 0);
    /// Leaves the innermost volume of that medium; no effect if the ray is in none.
    void leave(int medium);
    bool operator==(const Media& o) const { return count == o.count && lost == o.lost && std::equal(in, in + count, o.in); }
};

/// Properties of a ray other than its geometry. Few combinations exist, so each is stored once (RayStore::kindOf) and rays point
/// to it.
struct RayKind {
    RayType type = RayType::Camera; ///< as rayinfo("type") names it
    bool fromTrace = false;         ///< by trace(), not by a lighting shadeop
    RaySet set;                     ///< what it may hit
    int32_t label = 0;              ///< interned label of the trace() that sent it
    bool gathersPhotons = false;    ///< by indirectdiffuse(): hits return the value of their photon map, if they have one
    bool asksLights = false;        ///< its trace() samples area lights: it sees them under every hider
    bool indirectOnly = false;      ///< by indirectdiffuse(), separate from direct light: includes the light of loops at hits
    /// Whether all members are equal.
    bool operator==(const RayKind& o) const {
        return type == o.type && fromTrace == o.fromTrace && gathersPhotons == o.gathersPhotons && asksLights == o.asksLights &&
               indirectOnly == o.indirectOnly && set.only == o.set.only && set.sides == o.set.sides && set.mode == o.set.mode &&
               label == o.label;
    }
};
/// Kind of camera rays, and of unknown rays.
inline constexpr RayKind kCameraKind{};

struct GridPoint; // shading/gridpoint.h
/// Data shared by all rays of a camera sample.
struct PathSample {
    int px = 0, py = 0; ///< pixel; with the sample number, key of the random numbers
    uint32_t sample = 0;
    int path = -1;        ///< index in the call of Integrator::trace()
    float time = 0;       ///< as seen by shaders
    float shutter = 0;    ///< as a fraction of the open shutter
    float level = 0.5f;   ///< random number for transitions between levels of detail
    bool records = false; ///< of an irradiance caching pass (CameraRay::records)
    /// Random numbers of the sample.
    SampleNumbers numbers{Sampler(0, 0, 0), 0};
    const GridPoint* grid = nullptr; ///< given hit, regardless of other geometry (CameraRay::grid)
};

/// Attenuation of hits by distance ("falloff": 3Delight manual, table 6.11).
struct Fade {
    float strength = 0, reach = 1e38f; ///< strength: per unit of distance, or an exponent; reach: "maxdist"
    bool polynomial = false;           ///< factor (1 - d / reach)^strength at distance d; else exp(-strength d)
    /// There is attenuation.
    bool fades() const { return strength > 0; }
    /// 1 at distance 0, falling to 0.
    float at(double distance) const;
    bool operator==(const Fade&) const = default;
};

/// A ray segment in a scattering medium, and the point sampled on it.
struct FreeFlight {
    Vec3 origin, dir;        ///< camera space; dir: unit
    float length = 0, t = 0; ///< of the segment, and distance of the point
    int medium = -1;         ///< of the world; -1: no segment
    bool thin = false;       ///< optically so thin that proximity to lights matters more than attenuation
    Color extinction{0};     ///< per unit of distance, by channel
    double chance[3] = {};   ///< mixture weights of the channels' densities, normalised
    /// Transmittance over a distance, by channel.
    Vec3d transmittanceAt(float at) const;
    /// Density of the sampled point per unit of length, at a point with this transmittance.
    double density(const Vec3d& left) const;
    /// The same at a distance.
    double density(float at) const { return density(transmittanceAt(at)); }
    bool operator==(const FreeFlight&) const = default;
};

/// Rare data of a ray. Rays without it have these defaults.
struct RayExtra {
    Fade fade;            ///< of its hits
    float way = 0;        ///< with falloff: distance that the ray has covered before, behind surfaces
    float kept = 1;       ///< fraction of `whole` in its weight
    Color whole{0};       ///< its weight without `kept` and `indirect`
    Color environment{0}; ///< trace() with a map: light of unoccluded rays
    Color part{0};        ///< for a target with sums: weight among all rays of the request, including continuations
    int32_t share = -1;   ///< Accumulator::aovSplits: outputs that receive a part of its light; -1: none
    int32_t lit = -1;     ///< values of the emitting surface for lights that query them; -1: none
    float indirect = 1;   ///< factor for light of surfaces, not of lights, by the energy rule
    FreeFlight flown;     ///< segment on which it was scattered, at its origin
    bool operator==(const RayExtra&) const = default;
};

/// The width of a ray, as a cone.
struct Footprint {
    float width = 0, spread = 0; ///< half width, and its growth per unit of distance
    /// Half width at a distance.
    float at(float way) const { return width + spread * way; }
    /// The footprint at a distance along the ray.
    Footprint after(float way) const { return {at(way), spread}; }
};

/// History of a path for photons and the caustic guide (PathRay::trail).
enum Trail : uint8_t {
    kTrailSpread = 1,   ///< passed a lobe that is not a delta, where photons are gathered or stored
    kTrailMirrored = 2, ///< after the last of these: delta lobes only, which photons can follow
    /// Unit of three bits: kGuided, or code of the probability (CausticGuide::chanceOf) of a guide ray at the last lobe that is
    /// not a delta; 0: none
    kTrailGuide = 4,
    kTrailSide = 32 ///< unit of three bits: SurfaceTree::sideOf() there
};
inline constexpr int kGuided = 7; ///< in place of the code: this ray was aimed by the guide and carries only light behind mirrors

/// A ray in flight, with the data that its hit needs: receiver of its light, random number key, origin. Kept small, because each
/// ray is written and read several times.
struct PathRay {
    Vec3 origin, dir;                   ///< dir: unit
    float maxDistance = 1e38f;          ///< hits beyond are ignored
    Color weight{1};                    ///< throughput relative to its target
    const PathSample* sample = nullptr; ///< null: of no camera sample
    const RayKind* kind = &kCameraKind; ///< shared; outlives the ray
    const Media* media = nullptr;       ///< null: in no volume
    uint32_t vertex = 0;                ///< random number key: hash of the call sites that led here; 0: camera
    /// At surfaces since the camera: all, by diffuse lobes, by specular lobes.
    int16_t bounces = 0, diffuseBounces = 0, specularBounces = 0;
    int16_t layers = 0;             ///< transparent surfaces passed since the camera; do not count as bounces
    uint16_t path = 0;              ///< scene::LightPaths::State so far; 0: its light is in no light path output
    int16_t scattered = 0;          ///< bounces in media, included in `bounces` and `diffuseBounces`
    uint16_t asked = 1;             ///< largest number of rays that a waiting kernel on the way is known to request at one point
    bool first : 1 = true;          ///< requested directly by its target: writes distance and transmission
    bool counts : 1 = false;        ///< its hit writes opacity, depth and AOVs of its camera sample
    bool quiet : 1 = false;         ///< of a gather() that needs no light: only shaders for its outputs run
    bool crossedMedium : 1 = false; ///< crossed a volume boundary: volumes before `origin` have been applied
    bool passed : 1 = false;        ///< not a camera ray, and has passed a surface: it started at lobeOrigin
    bool shadowDiffers : 1 = false; ///< passed a surface that shadow rays may see differently: Opacity::differs
    uint8_t trail = 0;              ///< Trail, as a bit set
    /// Density of this direction per steradian, times the probability of sampling it at all; < 0: light sampling cannot produce
    /// this direction, so emission counts with weight -lobePdf (docs/design/light-transport.md).
    float lobePdf = -1;
    Vec3 lobeOrigin;      ///< point of the lobe that sampled dir: reference for lobePdf and the densities of lights
    int lobeBinding = -1; ///< binding of that point, whose list has its lights; -1: every emitter counts
    Footprint footprint;  ///< at the origin
    int32_t extra = -1;   ///< RayStore::extraOf(); -1: none
    float importance = 1; ///< product of the "weight" arguments of calls along the path; for rayinfo("weight")
    /// Kind of the ray.
    RayType type() const { return kind->type; }
    /// It is a camera ray.
    bool camera() const { return kind->type == RayType::Camera; }
    /// In the units of the file.
    float time() const { return sample ? sample->time : 0; }
    /// 0 to 1.
    float shutter() const { return sample ? sample->shutter : 0; }
    /// Part of `trail`: kGuided or a code of the caustic guide.
    int guideCode() const { return trail / kTrailGuide & 7; }
    bool guided() const { return guideCode() == kGuided; }
    /// Index of the volume around it; -1: none.
    int medium() const { return media ? media->top() : -1; }
    /// Camera rays: distance from the eye to the origin, over the near plane and surfaces passed. No lobe sampled such a ray.
    float start() const { return camera() ? lobeOrigin.x : 0; }
    /// Sets start(); for camera rays only.
    void setStart(float way) { lobeOrigin = Vec3(way, 0, 0); }
    /// Its origin before all surfaces that it has passed; for camera rays the eye.
    Vec3 begin() const {
        if (!camera()) return passed ? lobeOrigin : origin;
        const float s = start();
        const Vec3 e = origin - dir * s;
        return length(e) <= 1e-6f * s ? Vec3(0, 0, 0) : e;
    }
    /// Continues at a point ahead, behind a surface. The original origin is kept.
    void goOnAt(const Vec3& at) {
        if (camera()) {
            setStart(start() + dot(at - origin, dir));
        } else if (!passed) {
            if (lobePdf < 0 && lobeBinding < 0) lobeOrigin = origin; // nothing uses the point of its lobe
            passed = true;
            shadowDiffers = false; // as copied from the ray that led to its lobe
        }
        origin = at;
    }
    /// Start of the segment for a volume shader.
    Vec3 volumeBegin() const { return crossedMedium ? origin : begin(); }
};
static_assert(sizeof(PathRay) <= 120);

/// The scheduler of the integrator's rays.
using Sched = Scheduler<PathRay>;

/// A point with the data of all predefined variables.
struct ShadePoint {
    const geometry::Shape* shape = nullptr;      ///< null for imagers and for lights without geometry
    geometry::SurfacePoint surface;              ///< camera space
    Vec3 P, N;                                   ///< after displacement; N is unit only if the surface's is
    Vec3 I, E;                                   ///< incident vector with its length, and the origin of the ray
    float du = 1, dv = 1;                        ///< largest footprint over x and y
    float time = 0, dtime = 0;                   ///< time, and length of the interval from there
    float shutter = 0;                           ///< 0 to 1: position of moving geometry
    Vec3 dPdtime{0.f};                           ///< motion of P, camera space per unit of `time`
    Color Ci{0}, Oi{0};                          ///< volumes and imagers: input values
    float alpha = 0;                             ///< imagers: input value
    Vec3 Ps, Ns;                                 ///< lights: the lit point and its normal
    Vec3 viewI;                                  ///< lights: the incident vector at the lit point
    const geometry::SurfacePoint* lit = nullptr; ///< lights: the surface at Ps; null: none or unknown
    const PathRay* ray = nullptr;                ///< the ray that hit; null: none
};

/// du and dv at a surface point, from the footprint of a ray with unit direction `dir` from `distance` away.
Vec2 footprintAt(const geometry::SurfacePoint&, const Footprint&, const Vec3& dir, float distance, float shadingRate);
/// Sets du and dv of a point likewise.
inline void setFootprint(ShadePoint& p, const Footprint& f, const Vec3& dir, float distance, float shadingRate) {
    const Vec2 size = footprintAt(p.surface, f, dir, distance, shadingRate);
    p.du = size.x, p.dv = size.y;
}

} // namespace alpenglow::shading
