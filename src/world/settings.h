// How a frame is to be followed: what the command line and the hider say.
#pragma once
#include "base/file.h"
#include "base/readlog.h"
#include "base/stopflag.h"
#include "scene/lightpaths.h"
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace alpenglow::transport {

/// Attribute of a primitive that fades between levels of detail: two numbers. Only samples see it whose own number, from 0 to 1,
/// is at least the first and below the second.
inline constexpr const char* kLevelAttribute = "detail:__level";

enum class Hider { Hidden, Raytrace, Path };

/// How points are chosen on the way of a ray through a medium where lights with a place light it (tests: all have the same mean).
enum class MediumSampling : uint8_t { Both, Distance, Equiangular };

struct Settings {
    Hider hider = Hider::Hidden;
    uint64_t seed = 0;
    int lanes = 16;                      ///< 4, 8, 16
    int maxDepth = -1;                   ///< bounces; -1: Option "trace" "maxdepth", else 32 under path and 4 otherwise
    float sampleClamp = 0;               ///< 0 = off (docs/design/slproject.md)
    bool direct = true, indirect = true; ///< --no-direct, --no-indirect: the latter stops diffuse continuation only
    bool unbiased = false;               ///< no scaling of indirect weights above 1
    bool localRoulette = false;          ///< SLProject's rule (--preset slproject) instead of throughput
    bool roulette = true;
    bool suspend = false;   ///< force suspending kernels where affine ones exist (tests)
    bool mixedOnly = false; ///< build V everywhere (tests: it has the same bits as S)
    bool bsdfOnly = false;  ///< no light sampling, emission counts in full (tests, T6)
    bool lightOnly = false; ///< light sampling only: emission met by lobe sampling does not count (tests, T6)
    bool blocks = true;     ///< vertices of lobes alone are followed 16 at a time (tests: one by one they have the same bits)
    /// hidden, raytrace: camera samples take the colours of micropolygons, which are shaded once for all samples that see them;
    /// false: each sample is shaded where it lies.
    bool micropolygons = false;
    bool evenLights = false; ///< many lights: each is as likely to be sampled as any other (tests, measurements)
    MediumSampling mediumSampling = MediumSampling::Both;
    std::vector<std::string> shaderPaths, texturePaths;
    ReadPolicy read{};                    ///< where the names of maps may lead
    std::shared_ptr<ReadLog> reads;       ///< gets every shader and map that is read or missed; may be null
    bool allowExec = false;               ///< shaders may load plug-ins
    std::vector<std::string> pluginPaths; ///< where those are looked for
    std::string dialect;                  ///< whose macros the shaders see: rsl::FrontOptions::dialect
    std::string cacheDirectory;           ///< "" = default
    std::vector<std::string>
        outputs; ///< AOVs: names of output shader parameters ("list[1]": an element) or predefined variables, in order
    const StopFlag* stop = nullptr; ///< polled while the world is made (dicing, displacement); set: build() gives up. May be null
    std::shared_ptr<const scene::LightPaths> lightPaths; ///< outputs by light path, under path; null: none
    bool firstSeen = false;                              ///< SampleResult::albedo and normal are asked for, under path
    std::vector<int> outputWidths; ///< floats of each where a display declares it; 0 or missing: the shaders decide
};

} // namespace alpenglow::transport
