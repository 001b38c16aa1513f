#include "world/causticseeds.h"

namespace alpenglow::world {

namespace {
constexpr size_t kSeedsSplit = 32; ///< a cell with more seeds is divided
constexpr size_t kSeedsEnough = 4; ///< a cell with fewer uses the seeds of its parent
} // namespace

CausticSeeds::CausticSeeds(std::vector<CausticSeed> seeds, float brightness, float gain)
    : perBrightness_(1 / brightness), gain_(gain), seeds_(std::move(seeds)) {
    std::vector<SurfaceTree::Point> points;
    double power = 0;
    for (const CausticSeed& s : seeds_) {
        points.push_back({s.P, s.side});
        power += s.power;
    }
    const float least = float(.5 * power / double(seeds_.size())); // what an empty cell may have missed
    tree_.build(points, kSeedsSplit, 1, [&](const SurfaceTree::Leaf& l) {
        const auto powerOf = [&](std::span<const uint32_t> ids) {
            float sum = 0;
            for (const uint32_t i : ids) sum += seeds_[i].power;
            return std::max(sum, least);
        };
        // Edges of caustics run through cells: a part of what lights the cells around counts.
        constexpr float kPart = .5f;
        const float irradiance = std::max(powerOf(l.points), kPart / 4 * powerOf(l.around)) / (l.size * l.size);
        if (l.ofAround < 0) { // the seeds of the parent, once for all of its cells
            l.ofAround = int32_t(around_.size());
            const auto from = l.around.empty() ? l.points : l.around;
            around_.push_back({uint32_t(order_.size()), uint32_t(from.size())});
            order_.insert(order_.end(), from.begin(), from.end());
        }
        const Range around = around_[size_t(l.ofAround)];
        if (l.points.size() < kSeedsEnough) {
            cells_.push_back({around, around, irradiance});
        } else {
            cells_.push_back({{uint32_t(order_.size()), uint32_t(l.points.size())}, around, irradiance});
            order_.insert(order_.end(), l.points.begin(), l.points.end());
        }
        return int32_t(cells_.size()) - 1;
    });
    anywhere_.own = anywhere_.around = {uint32_t(order_.size()), uint32_t(seeds_.size())};
    const float size = tree_.edge() / 32;
    anywhere_.irradiance = least / (size * size);
    for (uint32_t i = 0; i < seeds_.size(); ++i) order_.push_back(i);
}

} // namespace alpenglow::world
