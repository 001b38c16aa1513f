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

} // namespace alpenglow::bench
