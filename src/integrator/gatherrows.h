// Rows of a gather: what its outputs are told of each ray, known without a shader or once one has run.
#pragma once
#include "answers/answers.h"
#include "integrator/batchcontext.h"
#include "world/gathersite.h"

namespace alpenglow::transport {

/// A value of a gather's output: 1 in the row before it says that it is there. Left out where it has another type.
void putGathered(float* row, const GatherSite::Output&, std::initializer_list<float>);
void putGathered(float* row, const GatherSite::Output&, const Vec3&);
void putGathered(float* row, const GatherSite::Output&, const Told&); ///< of any type, where that fits the variable
void tellRay(const GatherSite&, float* row, const Vec3& origin, const Vec3& dir, float distance);
void tellHit(const WorldImpl&, const GatherSite&, float* row, const accel::Hit&, const Vec3& dir);
/// What came back for a ray that was sent.
void endGatherRay(const GatherSite&, const shading::TargetValue&, float* row);

} // namespace alpenglow::transport
