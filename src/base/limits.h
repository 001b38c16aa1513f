// Every limit that bounds what a stranger's file may cost, by name (reliability.md). Each has a test.
#pragma once
#include <cstddef>

namespace alpenglow::limits {

inline constexpr int kArchiveDepth = 64;
inline constexpr int kStackDepth = 4096;                       ///< attribute, transform, motion stacks
inline constexpr size_t kStringBytes = 16u << 20;
inline constexpr size_t kTokenBytes = 64u << 10;
inline constexpr int kImageSide = 65536;
inline constexpr size_t kMicroQuads = 100'000'000;             ///< per primitive
inline constexpr float kDisplacementBound = 1e6f;
inline constexpr int kPathDepth = 10'000;                      ///< hard cap, counted when hit: it is a bias
inline constexpr int kShaderNesting = 1024;
inline constexpr size_t kFrameBytesPerThread = 64u << 20;      ///< suspended kernel frames (design decision 2)
inline constexpr int kSliceRays = 4096;                        ///< children of one suspension, per slice
inline constexpr int kExpressionDepth = 256;                   ///< nesting of RSL expressions and statements
inline constexpr size_t kInlinedInstructions = 400'000;        ///< IR of one kernel after inlining

} // namespace alpenglow::limits
