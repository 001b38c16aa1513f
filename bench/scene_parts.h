// Which part of the renderer a symbol of a profile belongs to.
#pragma once
#include <array>
#include <string>

namespace alpenglow::bench {

enum Part { kTraversal, kPoints, kRequests, kLights, kLobes, kTextures, kKernels, kSampling, kFilm, kMemory, kOther, kParts };
inline constexpr std::array<const char*, kParts> kPartNames{"traversal", "points",  "requests", "lights", "lobes", "textures",
                                                            "kernels",   "sampler", "film",     "memory", "other"};

/// By a mangled name as Profile::bySymbol() gives it. traversal: src/accel, Embree, exact hits of quadrics. points: src/geometry.
/// requests: the engine, its queues, shading/. lights: light samples, loops over lights, emitters, shadows. sampler: random
/// numbers, filter, camera. memory: the C and C++ libraries, their sines too. other: base/, reading and writing of files
/// (OpenEXR, zlib).
Part partOfSymbol(const std::string& mangled);

/// The stages of the integrator, as docs/architecture.md counts them.
enum Stage {
    kQueues,
    kSearch,
    kSurfaces,
    kShade,
    kChoose,
    kLightSamples,
    kShadows,
    kNumbers,
    kAccumulate,
    kCamera,
    kSystem,
    kElsewhere,
    kStages
};
inline constexpr std::array<const char*, kStages> kStageNames{"queues",     "search",          "surfaces", "kernels",
                                                              "lobes",      "light samples",   "shadows",  "numbers",
                                                              "accumulate", "camera and film", "system",   "elsewhere"};
/// The stage that a symbol works for; elsewhere: what goes point by point, and what is shared.
Stage stageOfSymbol(const std::string& mangled);

} // namespace alpenglow::bench
