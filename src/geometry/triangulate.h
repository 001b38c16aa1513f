// Cutting polygons with holes into triangles.
#pragma once
#include "base/limits.h"
#include "base/vec.h"
#include <cstdint>
#include <span>
#include <vector>

namespace alpenglow::geometry {

/// How far triangulate() came.
enum class TriangulationResult { Good, Forced, Nothing };

/// Cuts a polygon into triangles by ear clipping; holes are joined to the outer loop by bridges first.
/// points: all corners, loop after loop; loops: corners in each, the first is the outer one, whatever the others' winding.
/// Appends index triples into `points` to `out`, wound as the outer loop. Convex single loops become fans. Loops of fewer than
/// three corners are skipped. normal: the outer loop's Newell normal (length twice its area).
/// Forced: the loops cross themselves or needed more than `most` tests, some triangles are guesses.
/// Nothing: no area (then nothing is appended).
TriangulationResult triangulate(std::span<const Vec3d> points, std::span<const int> loops, std::vector<uint32_t>& out,
                                Vec3d& normal, size_t most = limits::kTriangulationTests);

} // namespace alpenglow::geometry
