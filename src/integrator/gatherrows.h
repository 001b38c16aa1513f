// Rows of a gather(): the values of its outputs for each ray, with or without running a shader.
#pragma once
#include "integrator/batchcontext.h"
#include "integrator/rays.h"
#include "services/services.h"
#include "world/gathersite.h"

namespace alpenglow::integrator {

struct StageSet;

/// Writes a value of a gather output and sets its presence row, the one before it, to 1. Does nothing if the types differ.
void putGathered(float* row, const GatherSite::Output&, std::initializer_list<float>);
void putGathered(float* row, const GatherSite::Output&, const Vec3&);
void putGathered(float* row, const GatherSite::Output&, const ShaderValue&); ///< of any type that converts to the variable's
/// Write "ray:..." values, and those of the hit, to a ray's row. Camera space, unit direction.
void writeRayValues(const GatherSite&, float* row, const Vec3& origin, const Vec3& dir, float distance);
void writeHitValues(const WorldImpl&, const GatherSite&, float* row, const accel::Hit&, const Vec3& dir);
/// Finds the first surface at which the accumulated opacity reaches the threshold, by channel, 0 to 1; the first one at all
/// for a threshold of 0. `as`: the ray as a shadow ray. False: there is none.
bool firstOpaque(const StageSet&, accel::Ray, const ShadowRay& as, const Color& threshold, accel::Hit&);
/// Writes the result of a ray that was traced.
void endGatherRay(const GatherSite&, const shading::TargetValue&, float* row);

} // namespace alpenglow::integrator
