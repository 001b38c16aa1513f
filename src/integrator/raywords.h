// Tasks and rays as words: maps members of PathRay to rows of a RayBlock.
#pragma once
#include "integrator/rays.h"
#include "lanes/blocks.h"
#include <cstddef>

namespace alpenglow::integrator {

/// Four-byte words of a ray, and of a task.
inline constexpr int kRayWords = int(sizeof(PathRay) / 4), kTaskWords = RayBlock::kWords;
static_assert(sizeof(Sched::Task) == 4 * kTaskWords && sizeof(RayBlock) == kTaskWords * sizeof(Row));

/// The row where a member of a task begins.
constexpr size_t rowAt(size_t offset) { return offset / 4 * sizeof(Row); }
#define ALPENGLOW_TASK_ROW(row, member) static_assert(offsetof(RayBlock, row) == rowAt(offsetof(Sched::Task, member)))
#define ALPENGLOW_RAY_ROW(row, member)                                                                                           \
    static_assert(offsetof(RayBlock, row) == rowAt(offsetof(Sched::Task, payload) + offsetof(PathRay, member)))
ALPENGLOW_TASK_ROW(depth, depth);
ALPENGLOW_TASK_ROW(target, target);
ALPENGLOW_TASK_ROW(origin, payload);
ALPENGLOW_RAY_ROW(direction, dir);
ALPENGLOW_RAY_ROW(maxDistance, maxDistance);
ALPENGLOW_RAY_ROW(weight, weight);
ALPENGLOW_RAY_ROW(sample, sample);
ALPENGLOW_RAY_ROW(kind, kind);
ALPENGLOW_RAY_ROW(media, media);
ALPENGLOW_RAY_ROW(vertex, vertex);
ALPENGLOW_RAY_ROW(bounces, bounces);
ALPENGLOW_RAY_ROW(specular, specularBounces);
ALPENGLOW_RAY_ROW(path, path);
ALPENGLOW_RAY_ROW(flags, asked);
ALPENGLOW_RAY_ROW(pdf, lobePdf);
ALPENGLOW_RAY_ROW(lobeOrigin, lobeOrigin);
ALPENGLOW_RAY_ROW(binding, lobeBinding);
ALPENGLOW_RAY_ROW(width, footprint);
ALPENGLOW_RAY_ROW(extra, extra);
ALPENGLOW_RAY_ROW(importance, importance);
static_assert(offsetof(PathRay, diffuseBounces) == offsetof(PathRay, bounces) + 2 &&
              offsetof(PathRay, layers) == offsetof(PathRay, specularBounces) + 2 &&
              offsetof(PathRay, trail) == offsetof(PathRay, asked) + 3);
#undef ALPENGLOW_TASK_ROW
#undef ALPENGLOW_RAY_ROW

/// Parts of RayBlock::flags.
inline constexpr uint32_t kAskedBits = 0xffff, kFirstBit = 1u << 16;

} // namespace alpenglow::integrator
