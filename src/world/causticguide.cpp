// Builds cells and lobes from photons, and evaluates and samples them.
#include "world/causticguide.h"
#include "bsdf/sampling.h"
#include <algorithm>
#include <climits>
#include <cstring>
#include <numeric>

namespace alpenglow::world {

namespace {

constexpr int32_t kNone = INT32_MIN;
constexpr size_t kSplit = 40;        ///< a cell with more photons is divided
constexpr size_t kEnough = 8;        ///< a cell with fewer photons uses the lobes of its parent
constexpr size_t kPhotonsOfLobe = 3; ///< minimum
constexpr size_t kFitted = 1024;     ///< maximum number of photons for a fit
/// Smallest radius of a lobe in radians, seen from the centre of its cell, because photons are few
constexpr float kLeastAngle = .02f;
constexpr float kWiden = 1.5f; ///< size of lobes relative to the spread of their photons
constexpr float kMostKappa = 1e5f, kLeastKappa = .05f;

float square(const Vec3& v) { return dot(v, v); }
Vec3 towards(const Vec3& from, const Vec3& to) {
    const Vec3 d = to - from;
    const float l = length(d);
    return l > 0 ? d * (1 / l) : Vec3(0, 0, 1);
}

using Eight = float __attribute__((vector_size(32)));
using EightInts = int32_t __attribute__((vector_size(32)));
static_assert(CausticGuide::kMostLobes == 8);
Eight load(const float* at) {
    Eight v;
    std::memcpy(&v, at, sizeof v);
    return v;
}
Eight most(Eight a, Eight b) { return a > b ? a : b; }

/// Concentration of a lobe (Lobes) at this squared distance of its aim.
template <class F> F kappaOf(F far2, F perRadius2) {
    const F k = far2 * perRadius2;
    return k < kLeastKappa ? F{} + kLeastKappa : k > kMostKappa ? F{} + kMostKappa : k;
}

} // namespace

struct CausticGuide::Builder {
    CausticGuide& guide;
    std::span<const GuidePhoton> photons;
    std::vector<Place> places; ///< by photon
    float side;                ///< of the cube
    float least;               ///< half of a photon's mean power: what an empty cell may have missed

    using Ids = std::span<uint32_t>;
    struct Parent {
        Ids ids;
        int32_t lobes = -1; ///< -1: not yet fitted
    };

    int32_t fit(Ids);
    int32_t cellOf(Ids, int level, Parent&);
    int32_t node(Ids, int level, Parent&);
};

/// Fits lobes to these photons; returns their index.
int32_t CausticGuide::Builder::fit(Ids all) {
    std::vector<uint32_t> ids;
    for (size_t i = 0, step = all.size() / kFitted + 1; i < all.size(); i += step) ids.push_back(all[i]);
    const size_t n = ids.size(), most = std::clamp<size_t>(n / kPhotonsOfLobe, 1, kMostLobes);
    Vec3 middle(0.f);
    for (const uint32_t i : ids) middle += photons[i].P;
    middle = middle * (1 / float(n));
    std::vector<Vec3> w(n);
    for (size_t k = 0; k < n; ++k) w[k] = towards(middle, photons[ids[k]].mirror);
    // Initial centres: farthest point first.
    std::vector<Vec3> axes{w[0]};
    std::vector<float> nearest(n);
    for (size_t k = 0; k < n; ++k) nearest[k] = square(w[k] - axes[0]);
    while (axes.size() < most) {
        const size_t far = size_t(std::max_element(nearest.begin(), nearest.end()) - nearest.begin());
        if (!(nearest[far] > 4 * kLeastAngle * kLeastAngle)) break;
        axes.push_back(w[far]);
        for (size_t k = 0; k < n; ++k) nearest[k] = std::min(nearest[k], square(w[k] - axes.back()));
    }
    // Then each moves to the mean of its nearest photons (Lloyd).
    std::vector<size_t> of(n);
    std::vector<Vec3> aims(axes.size());
    std::vector<float> power(axes.size());
    for (int turn = 0; turn < 4; ++turn) {
        std::fill(aims.begin(), aims.end(), Vec3(0.f));
        std::fill(power.begin(), power.end(), 0.f);
        for (size_t k = 0; k < n; ++k) {
            for (size_t a = of[k] = 0; a < axes.size(); ++a)
                if (square(w[k] - axes[a]) < square(w[k] - axes[of[k]])) of[k] = a;
            aims[of[k]] += photons[ids[k]].mirror * photons[ids[k]].power;
            power[of[k]] += photons[ids[k]].power;
        }
        for (size_t a = 0; a < axes.size(); ++a)
            if (power[a] > 0) axes[a] = towards(middle, aims[a] = aims[a] * (1 / power[a]));
    }
    std::vector<float> spread(axes.size());
    for (size_t k = 0; k < n; ++k) {
        const GuidePhoton& p = photons[ids[k]];
        spread[of[k]] += p.power * square(towards(p.P, p.mirror) - towards(p.P, aims[of[k]]));
    }
    const float whole = std::accumulate(power.begin(), power.end(), 0.f);
    Lobes lobes;
    size_t count = 0;
    for (size_t a = 0; a < axes.size(); ++a) {
        if (!(power[a] > 0)) continue;
        const float angle2 = std::max(spread[a] / power[a] * (kWiden * kWiden), kLeastAngle * kLeastAngle);
        const float far2 = std::max(square(aims[a] - middle), 1e-12f * side * side);
        for (int q = 0; q < 3; ++q) lobes.aim[q][count] = aims[a][q];
        lobes.perRadius2[count] = 2 / (angle2 * far2);
        lobes.share[count++] = power[a] / whole;
    }
    guide.lobeCount_ += count;
    guide.lobes_.push_back(lobes);
    return int32_t(guide.lobes_.size()) - 1;
}

/// A cell for these photons; if they are few, with the lobes of the parent.
int32_t CausticGuide::Builder::cellOf(Ids ids, int level, Parent& around) {
    float power = 0;
    for (const uint32_t i : ids) power += photons[i].power;
    const float size = side / float(1 << level);
    const bool own = ids.size() >= kEnough || around.ids.empty();
    if (!own && around.lobes < 0) around.lobes = fit(around.ids);
    guide.cells_.push_back({own ? fit(ids) : around.lobes, std::max(power, least) / (size * size)});
    guide.mostIrradiance_ = std::max(guide.mostIrradiance_, guide.cells_.back().irradiance);
    return int32_t(guide.cells_.size()) - 1;
}

/// Divides a cell while it holds many photons. Returns an index as in nodes_.
int32_t CausticGuide::Builder::node(Ids ids, int level, Parent& around) {
    if (ids.size() <= kSplit || level >= kLevels) return -1 - cellOf(ids, level, around);
    const int shift = kLevels - 1 - level;
    const auto octant = [&](uint32_t i) {
        const Place& p = places[i];
        return (p.x >> shift & 1) | (p.y >> shift & 1) << 1 | (p.z >> shift & 1) << 2;
    };
    std::stable_sort(ids.begin(), ids.end(), [&](uint32_t a, uint32_t b) { return octant(a) < octant(b); });
    const size_t at = guide.nodes_.size();
    guide.nodes_.resize(at + 8, kNone);
    Parent own{ids};
    size_t first = 0;
    for (uint32_t o = 0; o < 8; ++o) {
        size_t end = first;
        while (end < ids.size() && octant(ids[end]) == o) ++end;
        const int32_t child = node(ids.subspan(first, end - first), level + 1, own);
        guide.nodes_[at + o] = child;
        first = end;
    }
    return int32_t(at / 8);
}

CausticGuide::CausticGuide(std::span<const GuidePhoton> photons, float brightness) : perBrightness_(1 / brightness) {
    std::fill_n(roots_, kSides + 1, kNone);
    if (photons.empty()) return;
    Vec3 low = photons[0].P, high = low;
    double power = 0;
    for (const GuidePhoton& p : photons) {
        for (int k = 0; k < 3; ++k) low[k] = std::min(low[k], p.P[k]), high[k] = std::max(high[k], p.P[k]);
        power += p.power;
    }
    const Vec3 size = high - low;
    const float side = std::max({size.x, size.y, size.z, 1e-6f * maxComponent(absolute(low)), 1e-30f}) * 1.001f;
    corner_ = (low + high) * .5f - Vec3(side * .5f);
    perSize_ = float(1 << kLevels) / side;
    Builder b{*this, photons, std::vector<Place>(photons.size()), side, float(.5 * power / double(photons.size()))};
    std::vector<uint32_t> of[kSides + 1];
    for (size_t i = 0; i < photons.size(); ++i)
        if (placeOf(photons[i].P, b.places[i])) of[photons[i].side].push_back(uint32_t(i));
    for (int s = 1; s <= kSides; ++s) {
        Builder::Parent none;
        if (of[s].size() >= kEnough) roots_[s] = b.node(of[s], 0, none);
    }
}

bool CausticGuide::placeOf(const Vec3& P, Place& to) const {
    const Vec3 at = (P - corner_) * perSize_;
    constexpr float kEnd = float(1 << kLevels);
    const auto within = [&](float x) { return x >= 0 && x < kEnd; };
    if (!(within(at.x) && within(at.y) && within(at.z))) return false;
    to = {uint32_t(at.x), uint32_t(at.y), uint32_t(at.z)};
    return true;
}

const CausticGuide::Cell* CausticGuide::find(const Vec3& P, int side) const {
    Place p;
    int32_t at = roots_[side];
    if (at == kNone || !placeOf(P, p)) return nullptr;
    for (int shift = kLevels - 1; at >= 0; --shift)
        at = nodes_[size_t(at) * 8 + ((p.x >> shift & 1) | (p.y >> shift & 1) << 1 | (p.z >> shift & 1) << 2)];
    return &cells_[size_t(-1 - at)];
}

float CausticGuide::density(const Cell& c, const Vec3& P, const Vec3& w) const {
    const Lobes& l = lobes_[size_t(c.lobes)];
    Eight d[3], far2{}, away{};
    for (int q = 0; q < 3; ++q) {
        d[q] = load(l.aim[q]) - P[q];
        far2 += d[q] * d[q];
    }
    far2 = most(far2, Eight{} + 1e-30f);
    const Eight kappa = kappaOf(far2, load(l.perRadius2)), per = 1.f / __builtin_elementwise_sqrt(far2);
    for (int q = 0; q < 3; ++q) {
        const Eight off = d[q] * per - w[q];
        away += off * off;
    }
    // away / 2 = 1 - cos of the angle between w and the lobe's axis, without cancellation
    const Eight near = 1.f + kappa * (.5f * away), whole = 2.f * kappa / (1.f + 2.f * kappa);
    const Eight f = load(l.share) * kappa / (near * near * whole);
    float sum = 0;
    for (int k = 0; k < kMostLobes; ++k) sum += f[k];
    return sum * float(.5 / kPi);
}

Vec3 CausticGuide::draw(const Cell& c, const Vec3& P, Vec2 u) const {
    const Lobes& l = lobes_[size_t(c.lobes)];
    int k = 0;
    while (k + 1 < kMostLobes && l.share[k + 1] > 0 && u.x >= l.share[k]) u.x -= l.share[k++];
    const Vec3 d = Vec3(l.aim[0][k], l.aim[1][k], l.aim[2][k]) - P;
    const float far2 = std::max(square(d), 1e-30f), kappa = kappaOf(far2, l.perRadius2[k]);
    const float v = std::clamp(u.x / l.share[k], 0.f, 1.f) * (2 * kappa / (1 + 2 * kappa));
    const float away = std::min(v / (kappa * (1 - v)), 2.f); // 1 - cos
    const float s = std::sqrt(std::max(away * (2 - away), 0.f));
    const Vec2 turn = unitCircle(u.y);
    return normalize(Basis(d * (1 / std::sqrt(far2))).toWorld({s * turn.x, s * turn.y, 1 - away}));
}

} // namespace alpenglow::world
