// What camera rays show beside light: opacity, depth of the first two surfaces, outputs of shaders, albedo and normal seen first.
#pragma once
#include "integrator/batchcontext.h"
#include "integrator/context.h"

namespace alpenglow::transport {

class Accumulator;
struct StageSet;

class CameraOutputs final : Stage {
public:
    explicit CameraOutputs(const StageSet&);
    /// Of a surface that a camera ray has met: adds its opacity, and notes its camera-space depth.
    void see(const PathRay&, const Color& opacity, float z, bool matte);
    /// The unit normal of a point, weighed with what is seen of it (Settings::firstSeen).
    void seeNormal(const PathRay&, const ShadePoint&, const Color& opacity);
    /// Before add(): finds the outputs that displays want among those of the kernel that has run.
    void begin(const BatchContext&);
    /// Adds the outputs of a point.
    void add(const BatchContext&, int point);

private:
    bool givenByOthers(const BatchContext&, size_t output, int point);
    std::vector<std::vector<int>> wantedAt_; ///< by AOV: the kernel's outputs, for arrays one an element
    /// By AOV: a surface that makes the names of its outputs when it runs gives it at some points, and zero at others. Empty: not
    /// asked yet.
    std::vector<char> perhaps_;
    Accumulator& accumulator_;
};

} // namespace alpenglow::transport
