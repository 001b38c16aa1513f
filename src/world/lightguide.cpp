#include "world/lightguide.h"
#include <algorithm>

namespace alpenglow::world {

namespace {

constexpr size_t kSplitSeen = 160; ///< a cell with more samples is divided
constexpr size_t kEnoughSeen = 40; ///< a cell with fewer samples uses the bins of its parent
constexpr double kOfParent = 80;   ///< the bins of a cell's parent count as so many samples
constexpr double kMostOfMean = 8;  ///< a sample of more than so many times the mean weight of its cell has that weight
/// The share is the one with the least second moment, if that is so much less than without: the guide does not know of light that
/// none of its samples found, and a look-up takes time.
constexpr float kShares[] = {.5f, .75f, .9f};
constexpr size_t kMany = 2000; ///< with fewer samples cells are large, and the guide may be far off for some of their points
constexpr double kMostMoment = .8;
constexpr double kMostAlone = .6;  ///< likewise where each light sample is a ray more, which alone would halve it
constexpr double kMostFound = .25; ///< and where more rays of lobes than this find the light, they do so well enough
constexpr double kLobe = .5 / kPi; ///< mean density of a diffuse lobe, whose rays see the light as well (balance heuristic)

} // namespace

/// Weights of some samples; single large ones (of rays that had little chance) say nothing of the others.
static float weightOf(const SeenLight& s, double mean) { return std::min(s.weight, float(kMostOfMean * mean)); }

static double meanWeight(std::span<const SeenLight> seen, std::span<const uint32_t> ids) {
    double sum = 0;
    for (const uint32_t i : ids) sum += double(seen[i].weight);
    return sum / double(std::max<size_t>(ids.size(), 1));
}

/// Adds every `step`th sample to bins, which sum to `most` then.
void LightGuide::count(std::span<const SeenLight> seen, Ids ids, size_t step, double most, double* bins) const {
    const double mean = meanWeight(seen, ids);
    double sum = 0;
    for (size_t i = 0; i < ids.size(); i += step) sum += double(weightOf(seen[ids[i]], mean));
    for (size_t i = 0; i < ids.size() && sum > 0; i += step) {
        const SeenLight& s = seen[ids[i]];
        int bin;
        float density;
        if (domain_.find(s.P, s.w, bin, density)) bins[bin] += most / sum * double(weightOf(s, mean));
    }
}

/// A cell of every `step`th sample.
LightGuide::Cell LightGuide::fit(std::span<const SeenLight> seen, Ids ids, Ids around, size_t step) const {
    Cell c{};
    double of[LightDomain::kMostBins] = {}, sum = 0, until = 0;
    count(seen, ids, step, double(ids.size() / step), of);
    count(seen, around, step, kOfParent / double(step), of);
    for (int b = 0; b < domain_.bins(); ++b) sum += of[b];
    for (int b = 0; b < domain_.bins(); ++b) c.until[b] = sum > 0 ? float((until += of[b]) / sum) : 0;
    if (sum > 0) c.until[domain_.bins() - 1] = 1;
    return c;
}

/// The share of samples that should follow the bins of one half of the samples, judged by the other half, so that few samples do
/// not praise themselves: the one with the least integral of the squared radiance over the density of light samples.
float LightGuide::shareOf(std::span<const SeenLight> seen, Ids ids, Ids around) const {
    const Cell half = fit(seen, ids, around, 2);
    const double mean = meanWeight(seen, ids);
    double own = 0, mixed[std::size(kShares)] = {};
    for (size_t i = 1; i < ids.size(); i += 2) {
        const SeenLight& s = seen[ids[i]];
        const float guide = density(half, s.P, s.w);
        const double square = double(weightOf(s, mean)) * double(s.radiance);
        if (alone_) { // rays of lobes have seen it; a light sample adds its density (balance heuristic)
            const double lobe = double(s.radiance / s.weight);
            own += square / lobe;
            mixed[0] += square / (lobe + double(guide));
            continue;
        }
        own += square / (double(s.pdf) + kLobe);
        for (size_t k = 0; k < std::size(kShares); ++k)
            mixed[k] += square / (double((1 - kShares[k]) * s.pdf + kShares[k] * guide) + kLobe);
    }
    if (alone_) return mixed[0] < kMostAlone * own ? 1 : 0;
    if (seen.size() < kMany) return mixed[0] < kMostMoment * own ? kShares[0] : 0;
    const size_t best = size_t(std::min_element(mixed, std::end(mixed)) - mixed);
    return mixed[best] < kMostMoment * own ? kShares[best] : 0;
}

int32_t LightGuide::add(std::span<const SeenLight> seen, Ids ids, Ids around) {
    Cell c = fit(seen, ids, around, 1);
    c.share = shareOf(seen, ids, around);
    cells_.push_back(c);
    return int32_t(cells_.size()) - 1;
}

LightGuide::LightGuide(const LightDomain& domain, std::span<const SeenLight> seen, bool alone) : alone_(alone), domain_(domain) {
    std::vector<SurfaceTree::Point> points;
    for (const SeenLight& s : seen) points.push_back({s.P, kSide});
    tree_.build(points, kSplitSeen, kEnoughSeen, [&](const SurfaceTree::Leaf& l) {
        if (l.points.size() >= kEnoughSeen || l.around.empty()) return add(seen, l.points, l.around);
        if (l.ofAround < 0) l.ofAround = add(seen, l.around, {});
        return l.ofAround;
    });
}

LightGuide::LightGuide(const LightDomain& domain, std::span<const SeenLight> seen) : LightGuide(domain, seen, false) {}

LightGuide::LightGuide(const LightDomain& domain, std::span<const SeenLight> seen, std::span<const Vec3> blocked)
    : LightGuide(domain, seen, true) {
    std::vector<double> found(cells_.size()), all(cells_.size());
    const auto count = [&](const Vec3& P, bool free) {
        const int32_t i = tree_.find(P, kSide);
        if (i < 0) return;
        found[size_t(i)] += free;
        all[size_t(i)] += 1;
    };
    for (const SeenLight& s : seen) count(s.P, true);
    for (const Vec3& P : blocked) count(P, false);
    for (size_t i = 0; i < cells_.size(); ++i)
        if (!(found[i] < kMostFound * all[i])) cells_[i].share = 0;
}

size_t LightGuide::used() const {
    return size_t(std::count_if(cells_.begin(), cells_.end(), [](const Cell& c) { return c.share > 0; }));
}

float LightGuide::density(const Cell& c, const Vec3& P, const Vec3& w) const {
    int bin;
    float within;
    if (!domain_.find(P, w, bin, within)) return 0;
    return (c.until[bin] - (bin > 0 ? c.until[bin - 1] : 0)) * within;
}

Vec3 LightGuide::draw(const Cell& c, const Vec3& P, Vec2 u) const {
    const float* const found = std::upper_bound(c.until, c.until + domain_.bins() - 1, u.x);
    const int bin = int(found - c.until);
    const float before = bin > 0 ? c.until[bin - 1] : 0, share = c.until[bin] - before;
    const float within = share > 0 ? std::clamp((u.x - before) / share, 0.f, 1 - 0x1p-24f) : .5f;
    return domain_.direction(P, bin, {within, u.y});
}

} // namespace alpenglow::world
