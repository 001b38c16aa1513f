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
        float sum = 0;
        for (const uint32_t i : l.points) sum += seeds_[i].power;
        const float irradiance = std::max(sum, least) / (l.size * l.size);
        const bool own = l.points.size() >= kSeedsEnough || l.around.empty();
        if (!own && l.ofAround >= 0) { // the seeds of the parent are in the order already
            const Cell& around = cells_[size_t(l.ofAround)];
            cells_.push_back({around.first, around.count, irradiance});
        } else {
            const auto from = own ? l.points : l.around;
            cells_.push_back({uint32_t(order_.size()), uint32_t(from.size()), irradiance});
            order_.insert(order_.end(), from.begin(), from.end());
            if (!own) l.ofAround = int32_t(cells_.size()) - 1;
        }
        return int32_t(cells_.size()) - 1;
    });
    anywhere_.first = uint32_t(order_.size());
    anywhere_.count = uint32_t(seeds_.size());
    const float size = tree_.edge() / 32;
    anywhere_.irradiance = least / (size * size);
    for (uint32_t i = 0; i < seeds_.size(); ++i) order_.push_back(i);
}

} // namespace alpenglow::world
