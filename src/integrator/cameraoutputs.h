// Outputs of camera rays other than light: opacity, depth of the first two surfaces, shader outputs, albedo and normal of what is
// seen first.
#pragma once
#include "integrator/batchcontext.h"
#include "integrator/context.h"

namespace alpenglow::integrator {

class Accumulator;
struct StageSet;

/// Fills what a SampleResult has besides light.
class CameraOutputs final : Stage {
public:
    explicit CameraOutputs(const StageSet&);
    /// Of a surface that a camera ray has met: adds its opacity, and notes its camera-space depth.
    void see(const PathRay&, const Color& opacity, float z, bool matte);
    /// Adds the unit normal of a point, weighted by its visibility (Settings::firstSeen).
    void seeNormal(const PathRay&, const ShadePoint&, const Color& opacity);
    /// Call before add(): finds the requested outputs among those of the kernel that has run.
    void begin(const BatchContext&);
    /// Adds the outputs of a point.
    void add(const BatchContext&, int point);

private:
    bool givenByOthers(const BatchContext&, size_t output, int point);
    std::vector<std::vector<int>> wantedAt_; ///< by AOV: outputs of the kernel; one per element for arrays
    /// By AOV: the surface defines its outputs at run time, so it may write this one at some points; it is zero at others. Empty:
    /// not yet determined.
    std::vector<char> perhaps_;
    Accumulator& accumulator_;
};

} // namespace alpenglow::integrator
