// What the bounces of some paths bring and cost, counted while they are traced, and the roulette that follows from it.
#pragma once
#include "base/vec.h"
#include "bsdf/roulettefactors.h"
#include "integrator/names.h"
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace alpenglow::world {
class World;
} // namespace alpenglow::world

namespace alpenglow::integrator {

/// Counts of one call of Integrator::trace(). Sums of integers, so that they do not depend on the order of rays.
struct BounceTally {
    static constexpr int kBounces = RouletteFactors::kBounces;
    static constexpr double kUnit = 1 << 20;
    using Light = std::array<int64_t, kBounces>;
    std::vector<Light> light;              ///< by camera ray and bounces of the ray that brought it: luminance in 1 / kUnit
    std::array<uint64_t, kBounces> rays{}; ///< by bounces; those that meet a surface count kHit times
    std::array<int64_t, kBounces> roots{}; ///< sum of the square roots of the largest channel of their throughputs, in 1 / kUnit
    std::array<uint64_t, kBounces> traced{};
    /// Cost of a ray that meets a surface, in rays that do not: it is shaded, and lights are sampled there.
    static constexpr uint64_t kHit = 3;

    void begin(size_t samples);
    /// Adds light that a path brings with its ray after so many bounces. Values that are not finite count as 0.
    void add(size_t sample, int bounces, const Color& light);
    void ray(int bounces, const Color& throughput, bool hit);
};

/// The roulette of a frame whose pilot paths come in pairs of two samples of a pixel. brightness: by pair, of the picture
/// around it, > 0. The usual roulette unless the tally says that ending paths earlier brings a smaller error in the same time.
RouletteFactors rouletteBy(const BounceTally&, std::span<const double> brightness);

/// Whether paths of this world play the roulette that a pilot can choose.
bool mayLearnRoulette(const World&);
/// The roulette of all paths from now on. Call while no thread traces.
void setRoulette(const World&, const RouletteFactors&);

} // namespace alpenglow::integrator
