// What is followed from the camera, and what comes of it.
#pragma once
#include "base/vec.h"
#include <cstddef>
#include <cstdint>
#include <vector>

namespace alpenglow::shading {
struct GridPoint; // shading/gridpoint.h
}

namespace alpenglow::transport {

/// Counts of one integrator thread; added up by the renderer.
struct Counters {
    uint64_t camera = 0, diffuse = 0, specular = 0, transmission = 0, shadow = 0;
    uint64_t reflected = 0, refracted = 0; ///< of specular rays, those that stay on their side of a surface, and the others
    uint64_t totalReflected = 0;           ///< and those that their shader calls so ("label" "totalreflection")
    uint64_t ignored = 0;                  ///< rays of trace() that were not sent, for their "weight" is 0
    uint64_t tests = 0, hits = 0;          ///< how often rays were followed to the next surface, and met one
    uint64_t points = 0, batches = 0, lanesUsed = 0, lanesRun = 0;
    uint64_t inBlocks = 0; ///< of `points`, those whose light was followed 16 at a time; of kernels that wait, their calls
    uint64_t nonFinite = 0, overLimit = 0, depthCap = 0;
    uint64_t depthSum = 0, paths = 0;
    uint64_t guided = 0;                    ///< rays that the caustic guide aimed, which are among the others, too
    uint64_t records = 0, interpolated = 0; ///< light of hemispheres: found for records, and read from those
    int depthMax = 0;
    size_t peakFrameBytes = 0; ///< suspended kernel frames at one time, the largest of all threads
    void operator+=(const Counters&);
};

/// One camera ray: a position on the raster and its sample number. Camera space.
struct CameraRay {
    Vec3 origin, direction;      ///< direction unit
    float width = 0, spread = 0; ///< half width of a pixel's footprint at the origin, and its growth per unit of distance
    float time = 0, shutter = 0; ///< in the units of Shutter, and as part of the time that it is open
    float cosine = 1;            ///< direction.z: depth = distance * cosine
    float start = 0;             ///< the way from the eye to the origin, where that is the near plane
    int px = 0, py = 0;          ///< pixel, and
    uint32_t sample = 0;         ///< sample number: the key of all random numbers
    /// Not for the picture: hemispheres that shaders want interpolated are measured at what it meets. See World::interpolates().
    bool records = false;
    /// Not for the picture either: only SampleResult::left is asked for. All rays of a call alike.
    bool depths = false;
    /// Nor here: only SampleResult::z is asked for, and transport::depthsNeedNoShaders(). All rays of a call alike.
    bool depthOnly = false;
    /// Not for the picture either: the ray meets this point, which outlives the call. Null: it meets what is there.
    const shading::GridPoint* grid = nullptr;
};

/// Light from the eye that is left behind a surface at this depth (camera-space z), channel by channel, 0 to 1.
struct DepthStep {
    float z;
    Color left;
};

struct SampleResult {
    Color color{0}, opacity{0};       ///< premultiplied; color includes light seen through
    float z = 1e38f, zSecond = 1e38f; ///< camera depth of the first and second surface; 1e38 = none
    std::vector<float> aovs;          ///< flattened in the order of Settings::outputs
    std::vector<DepthStep> left; ///< of a ray that asks for it: behind each surface, in order; before the first all of it is left
    std::vector<Color> parts;    ///< of `color`, by Settings::lightPaths; empty: none are asked for
    Color albedo{0};             ///< with Settings::firstSeen: what the lobes of the surfaces seen give back of even light
    Vec3 normal{0.f};            ///< and their unit normals, camera space, by coverage
    Color behind{0}; ///< of a ray with a grid point: what comes through it of the light behind; nothing is followed there
};

} // namespace alpenglow::transport
