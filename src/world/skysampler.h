// Samples a sky in proportion to its radiance. Where a small part of the directions is very bright, such as a sun, that part is a
// stratum of its own: of the (0,2)-sequence of a pixel's light samples, exactly a fixed share goes there, and fills it evenly.
#pragma once
#include "world/skytable.h"
#include <memory>

namespace alpenglow::world {

/// Samples the directions of one sky.
class SkySampler {
public:
    /// As for SkyTable.
    SkySampler(int width, int height, std::vector<float> weights, std::vector<SkyTable::Refined> refined = {});
    /// SkyTable::integral() and concentration() of the complete sky.
    double integral() const { return integral_; }
    double concentration() const { return concentration_; }
    /// Samples a unit direction and its density per steradian, which equals pdf(w) exactly; returns false if integral() is 0.
    bool sample(Vec2 u, Vec3& w, float& density) const;
    /// Density of sample() per steradian for a unit direction.
    float pdf(const Vec3& w) const;
    /// Samples a direction where the sky is more than kBright times as bright as on average, in proportion to its radiance, and
    /// its density per steradian. Returns false where there is none for u.
    bool sampleBright(Vec2 u, Vec3& w, float& density) const;
    static constexpr float kBright = 8;
    /// Probability of bright directions in sample(); 0: they are no stratum of their own.
    float brightChance() const { return brightChance_; }

private:
    std::unique_ptr<const SkyTable> bright_, rest_; ///< rest_: without bright_, or the complete sky
    double integral_ = 0, concentration_ = 1;
    float brightChance_ = 0;
};

} // namespace alpenglow::world
