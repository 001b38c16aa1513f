// Builds cells and lobes from photons, and evaluates and samples them.
#include "world/causticguide.h"
#include <algorithm>

namespace alpenglow::world {

namespace {

constexpr size_t kSplit = 40; ///< a cell with more photons is divided
constexpr size_t kEnough = 8; ///< a cell with fewer photons uses the lobes of its parent

} // namespace

struct CausticGuide::Builder {
    CausticGuide& guide;
    std::span<const GuidePhoton> photons;
    float least; ///< half of a photon's mean power: what an empty cell may have missed

    using Ids = std::span<const uint32_t>;
    int32_t fit(Ids);
    int32_t cellOf(const SurfaceTree::Leaf&);
};

/// Fits lobes to these photons; returns their index.
int32_t CausticGuide::Builder::fit(Ids ids) {
    std::vector<AimedLobes::Target> targets;
    for (const uint32_t i : ids) targets.push_back({photons[i].P, photons[i].mirror, photons[i].power});
    guide.lobes_.push_back(AimedLobes::fit(targets, guide.tree_.edge()));
    guide.lobeCount_ += size_t(guide.lobes_.back().count());
    return int32_t(guide.lobes_.size()) - 1;
}

/// A cell for these photons; if they are few, with the lobes of the parent.
int32_t CausticGuide::Builder::cellOf(const SurfaceTree::Leaf& l) {
    float power = 0;
    for (const uint32_t i : l.points) power += photons[i].power;
    const bool own = l.points.size() >= kEnough || l.around.empty();
    if (!own && l.ofAround < 0) l.ofAround = fit(l.around);
    guide.cells_.push_back({own ? fit(l.points) : l.ofAround, std::max(power, least) / (l.size * l.size)});
    guide.mostIrradiance_ = std::max(guide.mostIrradiance_, guide.cells_.back().irradiance);
    return int32_t(guide.cells_.size()) - 1;
}

CausticGuide::CausticGuide(std::span<const GuidePhoton> photons, float brightness) : perBrightness_(1 / brightness) {
    std::vector<SurfaceTree::Point> points;
    double power = 0;
    for (const GuidePhoton& p : photons) {
        points.push_back({p.P, p.side});
        power += p.power;
    }
    Builder b{*this, photons, float(.5 * power / double(photons.size()))};
    tree_.build(points, kSplit, kEnough, [&](const SurfaceTree::Leaf& l) { return b.cellOf(l); });
}

} // namespace alpenglow::world
