// Figures of a render: `--stats FILE.json` and the table at the end.
#pragma once
#include "render/noise.h"
#include <cstdint>
#include <map>
#include <string>

namespace alpenglow::render {

/// Field names are the keys of the JSON object, which must stay as they are.
struct RenderStats {
    int width = 0, height = 0;          ///< of the picture, pixels
    uint64_t spp = 0;                   ///< samples per pixel, on average
    uint64_t sppLeast = 0, sppMost = 0; ///< of the pixels with the fewest and the most
    double renderSec = 0, cpuSec = 0;   ///< wall and processor time of rendering
    uint64_t totalRays = 0;             ///< primary, reflected, refracted, internally reflected, sub-sampled and shadow rays
    NoiseFigures noise;                 ///< 0 where it was not measured
    std::string curve;                  ///< of the pictures (curve.h); "" = unknown
    int threads = 0;                    ///< that rendered
    uint64_t peakMemoryBytes = 0;       ///< of the process
    uint64_t threadBytes = 0;           ///< integrator::Counters::threadBytes
    double parseSec = 0, compileSec = 0, buildSec = 0; ///< seconds
    uint64_t nonFinite = 0;                            ///< samples dropped
    uint64_t saturated = 0;                            ///< values clamped by the exact sums
    std::map<std::string, uint64_t> rays; ///< by type; camera, diffuse, specular, transmission, shadow are written even if 0
    /// Counts of classic ray tracers. primary: camera rays without subsampledRays; reflected, refracted: specular rays that stay
    /// on their side of a surface, and those that cross it; totalReflected: those labelled so by shaders. ignored: rays of weight
    /// 0, which were not sent. tests, hits: intersection queries, and those with a hit.
    struct Classic {
        /// Counts.
        uint64_t primary = 0, reflected = 0, refracted = 0, totalReflected = 0, ignored = 0, subsampledPixels = 0,
                 subsampledRays = 0, tests = 0, hits = 0;
    } classic;
    struct Shading {
        uint64_t points = 0, batches = 0; ///< shaded points; runs of kernels
        double laneOccupancy = 0;         ///< active lanes / lanes, 0..1
        /// Kernels by kind, all, and those from the cache.
        int affineKernels = 0, suspendingKernels = 0, kernels = 0, cacheHits = 0;
    } shading;
    /// The caustic guide under path (docs/light.md): photons that it was built from, cells and lobes, and guide rays, which also
    /// count in `rays`.
    struct Guide {
        uint64_t photons = 0, cells = 0, lobes = 0, rays = 0;
        uint64_t lit = 0;   ///< rays that found light
        uint64_t light = 0; ///< integrator::Counters::guidedLight
    } guide;
    /// Searches under path for light of point, spot and distant lights by mirrors and glass (docs/light.md): photons where they
    /// begin, searches, those that found a path, probes sent.
    struct Specular {
        uint64_t seeds = 0, searches = 0, found = 0, probes = 0; ///< numbers
    } specular;
    /// The guides of light samples under path (docs/light.md): light samples that they were built from, lights that have one,
    /// their cells, and cells where samples follow them.
    struct LightGuide {
        uint64_t samples = 0, lights = 0, cells = 0, used = 0; ///< counts
    } lightGuide;
    struct Depth {
        int maximum = 0;    ///< bounces of the longest path
        double average = 0; ///< bounces of a path
    } depth;
    int errors = 0, warnings = 0;
    /// Sums for shading.laneOccupancy and depth.average, which finalise() computes; not written.
    double lanesUsed = 0, lanesRun = 0, depthSum = 0, paths = 0;
    void finalise() {
        shading.laneOccupancy = lanesRun > 0 ? lanesUsed / lanesRun : 0;
        depth.average = paths > 0 ? depthSum / paths : 0;
    }
};

/// One JSON object with the keys above, raysPerMS and efficiency, and a newline. Numbers that are not finite become 0.
std::string toJson(const RenderStats&);
/// The table printed at the end of a render, one figure a line, ending with a newline.
std::string toTable(const RenderStats&);

/// Largest resident size of this process so far, bytes; 0 if the system does not tell.
uint64_t peakMemoryBytes();
/// Processor time of all threads of this process so far, seconds.
double processCpuSeconds();

} // namespace alpenglow::render
