// What the renderer knows about a point that a shader is going to run at, and about the ray that found it. Camera space
// ("current").
#pragma once
#include "accel/accel.h"
#include "base/limits.h"
#include "base/sampler.h"
#include "geometry/shape.h"
#include "scene/primitive.h"
#include "shading/scheduler.h"
#include <algorithm>

namespace alpenglow::shading {

enum class RayType : uint8_t { Camera, Diffuse, Specular, Transmission };
const char* toString(RayType);

/// What is taken of the surfaces that a ray meets: what their shaders say, or what the primitives say (Color and Opacity).
enum class HitMode : uint8_t { Default, Primitive, Shader };

/// Whom a ray may meet, as its call says ("subset", "hitsides", "hitmode").
struct RaySet {
    const uint8_t* only = nullptr; ///< by shape: 0 is passed through; null: all. Of the world, which outlives the ray
    accel::Sides sides = accel::Sides::Front;
    HitMode mode = HitMode::Default;
};

/// The volumes that a ray is inside of: numbers of the media of the world, -1 for one where nothing is. The last one counts: of
/// those of the highest priority the one that was entered last.
struct Media {
    int16_t in[limits::kMedia] = {};
    float priority[limits::kMedia] = {}; ///< ascending
    int8_t count = 0;
    bool lost = false; ///< one more was entered than are known
    int top() const { return count ? in[count - 1] : -1; }
    float topPriority() const { return count ? priority[count - 1] : 0; }
    bool has(int medium) const { return std::find(in, in + count, medium) != in + count; }
    void push(int medium, float priority = 0);
    /// Leaves the innermost volume of that medium; none where the ray is in no such volume.
    void leave(int medium);
    bool operator==(const Media& o) const { return count == o.count && lost == o.lost && std::equal(in, in + count, o.in); }
};

/// What a ray is, beside where it goes: few are different, so each is kept once (RayStore::kindOf) and rays point at it.
struct RayKind {
    RayType type = RayType::Camera;
    bool fromTrace = false; ///< drawn by trace(), not by a lighting shadeop
    RaySet set;
    int32_t label = 0;           ///< interned label of the trace() that sent it
    bool gathersPhotons = false; ///< of indirectdiffuse(): what it meets gives what its photon map says, where it has one
    bool asksLights = false;     ///< its trace() samples area lights: it sees them under every hider
    bool indirectOnly = false;   ///< of indirectdiffuse() beside direct light: what loops over lights find is counted there
    bool operator==(const RayKind& o) const {
        return type == o.type && fromTrace == o.fromTrace && gathersPhotons == o.gathersPhotons && asksLights == o.asksLights &&
               indirectOnly == o.indirectOnly && set.only == o.set.only && set.sides == o.set.sides && set.mode == o.set.mode &&
               label == o.label;
    }
};
/// Of camera rays, and of rays that nothing is known of.
inline constexpr RayKind kCameraKind{};

struct GridPoint; // shading/gridpoint.h
/// What all rays of one camera sample have in common.
struct PathSample {
    int px = 0, py = 0; ///< pixel and number of the sample: the key of its random numbers (design decision 10)
    uint32_t sample = 0;
    int path = -1;        ///< index in the call of Integrator::trace()
    float time = 0;       ///< as the shader sees it
    float shutter = 0;    ///< the same as part of the time that the shutter is open
    float level = 0.5f;   ///< for what fades between levels of detail
    bool records = false; ///< of a pass that finds the light that others interpolate (CameraRay::records)
    render::SampleNumbers numbers{render::Sampler(0, 0, 0), 0};
    const GridPoint* grid = nullptr; ///< not of the picture: this point is shaded, whatever lies before it (CameraRay::grid)
};

/// How much of a surface counts that a ray meets far away ("falloff", rsl.md table 6.11).
struct Fade {
    float strength = 0, reach = 1e38f; ///< per unit of distance, or an exponent; the "maxdist" of that
    bool polynomial = false;
    bool fades() const { return strength > 0; }
    /// 1 at the point itself, down to 0.
    float at(double distance) const;
    bool operator==(const Fade&) const = default;
};

/// The way of a ray through a medium that scatters, and the point that was chosen on it.
struct FreeFlight {
    Vec3 origin, dir;
    float length = 0, t = 0;
    int medium = -1;   ///< of the world; -1: there is no such way
    bool thin = false; ///< so little is lost along it that how far light comes matters less than how near lights are
    Color extinction{0};
    double chance[3] = {}; ///< of the densities of the channels, with what makes them densities
    /// What is left of light after so long a way, channel by channel.
    Vec3d leftAt(float at) const;
    /// With which points are chosen, a unit of length; where so much is left.
    double density(const Vec3d& left) const;
    double density(float at) const { return density(leftAt(at)); }
    bool operator==(const FreeFlight&) const = default;
};

/// What few rays carry. Where a ray has none, it is as here.
struct RayExtra {
    Fade fade;
    float way = 0;        ///< of what fades: how far the ray has come before, behind surfaces
    float kept = 1;       ///< and what its weight has of `whole`
    Color whole{0};       ///< its weight without `kept` and `indirect`
    Color environment{0}; ///< of trace() with a map: the light where nothing is
    Color part{0};        ///< of a target with sums: the share of all rays that were asked for, of those and what goes on behind
    int32_t share = -1;   ///< Accumulator::shares: which outputs have a part of what it adds to its target; -1: none
    int32_t lit = -1;     ///< what lights are told about the surface that sent it, where lights ask; -1: nothing
    float indirect = 1; ///< factor of what surfaces send it, not of lights: of a lobe that would give back more than it receives
    FreeFlight flown;   ///< on which it was scattered, where it begins
    bool operator==(const RayExtra&) const = default;
};

/// How wide a ray is, as a cone (design decision 7).
struct Footprint {
    float width = 0, spread = 0; ///< half width, and its growth with distance
    float at(float way) const { return width + spread * way; }
    /// The same, seen from so far on.
    Footprint after(float way) const { return {at(way), spread}; }
};

/// What a path has gone through, as far as photons are concerned (PathRay::trail).
enum Trail : uint8_t {
    kTrailSpread = 1,  ///< a lobe that spreads light, at whose point photons are gathered or come to rest
    kTrailMirrored = 2 ///< behind the last of these: single directions alone, which photons can come along
};

/// A ray on its way, with what its hit needs: who pays for what it finds, which random numbers it may use, how it was made.
/// Small, since each is written and read several times.
struct PathRay {
    Vec3 origin, dir; ///< dir: unit
    float maxDistance = 1e38f;
    Color weight{1}; ///< throughput since its target
    const PathSample* sample = nullptr;
    const RayKind* kind = &kCameraKind;
    const Media* media = nullptr; ///< where it is; null: in no volume
    uint32_t vertex = 0;          ///< of its random numbers: hash of the path of call sites that led here; 0 = camera
    int16_t bounces = 0, diffuseBounces = 0, specularBounces = 0;
    int16_t layers = 0;      ///< transparent surfaces passed so far, since the camera; no bounces
    uint16_t path = 0;       ///< scene::LightPaths::State up to here; 0: what it brings is in no output by light path
    int16_t scattered = 0;   ///< of `bounces`, and of `diffuseBounces`, those that were in a medium
    uint16_t asked = 1;      ///< the most rays that a waiting kernel on the way was known to ask for at one point
    bool first : 1 = true;   ///< one of those that its target asked for: writes distance and transmission
    bool counts : 1 = false; ///< its hit writes opacity, depth and AOVs of its camera sample
    bool quiet : 1 = false;  ///< of a gather that wants no light of it: only shaders run that its hit's outputs need
    bool parted : 1 = false; ///< passed a volume on its way, so that volumes have what lies before `origin`
    bool passed : 1 = false; ///< no camera ray, and went through a surface: it began at lobeOrigin
    uint8_t trail = 0;       ///< Trail, as bits
    /// Density per steradian with which this direction was drawn, times the probability of drawing it at all; < 0: light sampling
    /// cannot have produced this direction, so emission counts in full (pathtracer.md 3).
    float lobePdf = -1;
    Vec3 lobeOrigin;      ///< the point whose lobe drew dir: lobePdf and the lights' densities are seen from there
    int lobeBinding = -1; ///< binding of that point, whose list says which lights may light it; -1: every emitter counts
    Footprint footprint;  ///< at the origin
    int32_t extra = -1;   ///< RayStore::extraOf(); -1: none
    float importance = 1; ///< product of the weights that shaders gave to the calls on its way; for rayinfo("weight")
    RayType type() const { return kind->type; }
    bool camera() const { return kind->type == RayType::Camera; }
    float time() const { return sample ? sample->time : 0; }
    float shutter() const { return sample ? sample->shutter : 0; }
    /// The volume that it is in, by number; -1: none.
    int medium() const { return media ? media->top() : -1; }
    /// Camera: the way from the eye to the origin, before the near plane and through what was met. No lobe has drawn such a ray.
    float start() const { return camera() ? lobeOrigin.x : 0; }
    void setStart(float way) { lobeOrigin = Vec3(way, 0, 0); }
    /// Where it began, before all that it passed through: the eye of a camera ray.
    Vec3 begin() const {
        if (!camera()) return passed ? lobeOrigin : origin;
        const float s = start();
        const Vec3 e = origin - dir * s;
        return length(e) <= 1e-6f * s ? Vec3(0, 0, 0) : e;
    }
    /// Goes on at a point ahead, behind what it went through; the eye, or where it began, has not moved.
    void goOnAt(const Vec3& at) {
        if (camera()) {
            setStart(start() + dot(at - origin, dir));
        } else if (!passed) {
            if (lobePdf < 0 && lobeBinding < 0) lobeOrigin = origin; // nobody asks for the point of its lobe
            passed = true;
        }
        origin = at;
    }
    /// Where the way begins that a volume shader is to run over.
    Vec3 volumeBegin() const { return parted ? origin : begin(); }
};
static_assert(sizeof(PathRay) <= 120);

using Sched = Scheduler<PathRay>;

/// A point with everything that predefined variables are read from.
struct ShadePoint {
    const geometry::Shape* shape = nullptr; ///< null for imagers and for lights without geometry
    geometry::SurfacePoint surface;
    Vec3 P, N;                 ///< after displacement; N unit only if the surface's is
    Vec3 I, E;                 ///< incident vector with its length, and the ray's origin
    float du = 1, dv = 1;      ///< largest footprint over x and y (design decision 7)
    float time = 0, dtime = 0; ///< and the time covered from there on
    float shutter = 0;         ///< 0 to 1: where all that moves stands
    Vec3 dPdtime{0.f};
    Color Ci{0}, Oi{0}; ///< volumes and imagers: on entry
    float alpha = 0;
    Vec3 Ps, Ns;                                 ///< lights: the point being lit and its normal
    Vec3 viewI;                                  ///< lights: the incident vector at the lit point
    const geometry::SurfacePoint* lit = nullptr; ///< lights: the surface at Ps; null when there is none or it is not known
    const PathRay* ray = nullptr;
};

/// du and dv at a point of a surface, from the footprint of a ray that comes from `distance` away in direction `dir`, unit.
Vec2 footprintAt(const geometry::SurfacePoint&, const Footprint&, const Vec3& dir, float distance, float shadingRate);
/// The same, into a point.
inline void setFootprint(ShadePoint& p, const Footprint& f, const Vec3& dir, float distance, float shadingRate) {
    const Vec2 size = footprintAt(p.surface, f, dir, distance, shadingRate);
    p.du = size.x, p.dv = size.y;
}

} // namespace alpenglow::shading
