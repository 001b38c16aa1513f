// Camera rays and their results.
#pragma once
#include "base/vec.h"
#include "integrator/names.h"
#include <cstddef>
#include <cstdint>
#include <vector>

namespace alpenglow::shading {
struct GridPoint; // shading/gridpoint.h
}

namespace alpenglow::scene {
struct Attributes; // scene/primitive.h
}

namespace alpenglow::integrator {

/// Segments of rays in a medium that scatters.
struct MediumSegments {
    uint64_t all = 0, lost = 0; ///< lost: no surface ends them, so the medium has no end there
};

/// Counts of one integrator thread; the renderer adds them up.
struct Counters {
    uint64_t camera = 0, diffuse = 0, specular = 0, transmission = 0, shadow = 0; ///< rays, by type
    uint64_t reflected = 0, refracted = 0; ///< specular rays that stay on their side of a surface, and those that cross it
    uint64_t totalReflected = 0;           ///< specular rays with "label" "totalreflection"
    uint64_t ignored = 0;                  ///< rays of trace() that were not sent because their "weight" is 0
    uint64_t tests = 0, hits = 0;          ///< intersection queries, and those with a hit
    /// Shaded points; runs of kernels; lanes with a point, and lanes that ran.
    uint64_t points = 0, batches = 0, lanesUsed = 0, lanesRun = 0;
    uint64_t inRows = 0; ///< of `points`, those whose requests were read in rows; for waiting kernels, their calls
    /// Values that are not finite; rays dropped for lack of frame memory; paths that limits::kPathDepth ended.
    uint64_t nonFinite = 0, overLimit = 0, depthCap = 0;
    uint64_t depthSum = 0, paths = 0; ///< bounces of all paths, and their number
    uint64_t guided = 0;              ///< rays aimed by the caustic guide; also counted in the other counters
    uint64_t guidedLit = 0;           ///< those that found light
    uint64_t guidedLight = 0;         ///< sum of the luminance they brought, in units of kLightUnit: exact in any order
    static constexpr double kLightUnit = 0x1p-20;         ///< unit of guidedLight
    uint64_t searches = 0, searchesFound = 0, probes = 0; ///< of SpecularSearch
    uint64_t records = 0, interpolated = 0;               ///< irradiance records made, and lookups interpolated from them
    int depthMax = 0;                                     ///< bounces of the longest path
    size_t peakFrameBytes = 0;         ///< largest size of suspended kernel frames at one time, over all threads
    size_t threadBytes = 0;            ///< most memory of rays, points, columns and frames of one thread
    std::vector<MediumSegments> media; ///< by WorldImpl::media(); may be shorter
    /// By WorldImpl::lights(), may be shorter: runs of the light's kernel. Counted only if a shader of the world bakes.
    std::vector<uint64_t> lightRuns;
    void operator+=(const Counters&); ///< Adds sums; keeps the larger of maxima.
};

/// A camera ray: raster position and sample number. Camera space.
struct CameraRay {
    Vec3 origin, direction;      ///< direction unit
    float width = 0, spread = 0; ///< half width of the pixel footprint at the origin, and its growth per unit of distance
    float time = 0, shutter = 0; ///< in the units of Shutter, and as a fraction of the open shutter
    float cosine = 1;            ///< direction.z: depth = distance * cosine
    float start = 0;             ///< distance from the eye to the origin (near plane)
    int px = 0, py = 0;          ///< pixel
    uint32_t sample = 0;         ///< sample number in the pixel: the key of all random numbers
    /// For irradiance caching only: records are made where shaders at the hit request hemispheres. See World::interpolates().
    bool records = false;
    /// For deep shadow maps only: computes SampleResult::transmittance alone. Equal for all rays of a call.
    bool depths = false;
    /// For depth only: computes SampleResult::z alone, given integrator::depthsNeedNoShaders(). Equal for all rays of a call.
    bool depthOnly = false;
    /// A given hit, which must outlive the call; other geometry is ignored. Null: the ray is intersected.
    const shading::GridPoint* grid = nullptr;
};

/// Transmittance behind a surface at depth z (camera space), by channel, 0 to 1.
struct DepthStep {
    float z;
    Color transmittance;                        ///< by channel
    const scene::Attributes* surface = nullptr; ///< of the surface that the light meets there; null: a medium. Lives as the world
};

/// What a camera ray found.
struct SampleResult {
    Color color{0}, opacity{0};       ///< premultiplied; color includes light from behind
    float z = 1e38f, zSecond = 1e38f; ///< camera depth of the first and second surface; 1e38 = none
    std::vector<float> aovs;          ///< flattened in the order of Settings::outputs
    std::vector<DepthStep>
        transmittance;        ///< for rays with `depths`: transmittance behind each surface, in order; 1 before the first
    std::vector<Color> parts; ///< of `color`, by Settings::lightPaths; empty: none requested
    Color albedo{0};          ///< with Settings::firstSeen: albedo of the lobes at the surfaces seen first
    Vec3 normal{0.f};         ///< their unit normals, camera space, weighted by coverage
    Color behind{0};          ///< for rays with a given hit: transparency there; the ray does not continue
};

} // namespace alpenglow::integrator
