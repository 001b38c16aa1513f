// Settings of a frame: from the command line and the hider.
#pragma once
#include "base/file.h"
#include "base/readlog.h"
#include "base/stopflag.h"
#include "scene/lightpaths.h"
#include "world/names.h"
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace alpenglow::world {

/// How a frame is rendered: RenderMan's hiders, or the path tracer.
enum class Hider { Hidden, Raytrace, Path };

/// Sampling of points on a ray segment in a medium that is lit by lights with positions (tests: all have the same mean).
enum class MediumSampling : uint8_t { Both, Distance, Equiangular };

/// What a world is built for, beyond the frame.
struct Settings {
    Hider hider = Hider::Hidden;         ///< the frame's own is looked at by render
    uint64_t seed = 0;                   ///< of all random numbers
    int lanes = 16;                      ///< 4, 8, 16
    int maxDepth = -1;                   ///< bounces; -1: Option "trace" "maxdepth", else 32 under path and 4 otherwise
    float sampleClamp = 0;               ///< 0 = off (docs/design/slproject.md)
    bool direct = true, indirect = true; ///< --no-direct, --no-indirect: the latter ends diffuse bounces only
    bool unbiased = false;               ///< disables the energy rule
    bool localRoulette = false;          ///< SLProject's rule (--preset slproject) instead of throughput
    bool roulette = true;                ///< paths end at random after some bounces
    bool suspend = false;                ///< suspends kernels also where affine ones exist (tests)
    bool mixedOnly = false;              ///< uses build V everywhere (tests: same bits as S)
    bool bsdfOnly = false;               ///< no light sampling, emission counts in full (tests, T6)
    bool lightOnly = false;              ///< light sampling only: emission hit by lobe rays does not count (tests, T6)
    bool rowRequests = true;             ///< requests of kernels are read in rows where they can be (tests: same bits one by one)
    /// hidden, raytrace: camera samples take colours from micropolygons that are shaded once for all samples; false: each sample
    /// is shaded at its own hit.
    bool micropolygons = false;
    bool evenLights = false; ///< many lights: all have the same probability (tests, measurements)
    /// Total size of the lists of lights that surfaces have of their own; surfaces behind these share one list (tests: 0).
    size_t listedLights = 4'000'000;
    int deferredAtOnce = 1; ///< deferred procedurals along its way that a ray asks for, nearest first (deferred.h)
    MediumSampling mediumSampling = MediumSampling::Both; ///< Both; others for tests
    std::vector<std::string> shaderPaths, texturePaths;   ///< folders, in order
    ReadPolicy read{};                                    ///< restricts where map names may lead
    std::shared_ptr<ReadLog> reads;                       ///< records every shader and map that is read or missing; may be null
    bool allowExec = false;                               ///< shaders may load plug-ins
    std::vector<std::string> pluginPaths;                 ///< search path of plug-ins
    std::string dialect;        ///< dialect that defines the macros of shaders: rsl::FrontOptions::dialect
    std::string cacheDirectory; ///< "" = default
    std::vector<std::string>
        outputs; ///< AOVs, in order: output parameters of shaders ("list[1]": an element) or predefined variables
    /// Polled while the world is built (dicing, displacement); if set, build() stops. May be null
    const StopFlag* stop = nullptr;
    std::shared_ptr<const scene::LightPaths> lightPaths; ///< light path outputs, under path; null: none
    bool firstSeen = false;                              ///< SampleResult::albedo and normal are requested, under path
    std::vector<int> outputWidths; ///< floats of each AOV if a display declares it; 0 or missing: the shaders decide
};

} // namespace alpenglow::world
