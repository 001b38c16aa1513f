#include "world/aimedlobes.h"
#include "bsdf/sampling.h"
#include <algorithm>
#include <cstring>
#include <numeric>
#include <vector>

namespace alpenglow::world {

namespace {

constexpr size_t kTargetsOfLobe = 3; ///< minimum
constexpr size_t kFitted = 1024;     ///< maximum number of targets for a fit
/// Smallest radius of a lobe in radians, seen from the centre of its cell, because photons are few
constexpr float kLeastAngle = .02f;
constexpr float kWiden = 1.5f; ///< size of lobes relative to the spread of their targets
constexpr float kMostKappa = 1e5f, kLeastKappa = .05f;

float square(const Vec3& v) { return dot(v, v); }
Vec3 towards(const Vec3& from, const Vec3& to) {
    const Vec3 d = to - from;
    const float l = length(d);
    return l > 0 ? d * (1 / l) : Vec3(0, 0, 1);
}

using Eight = float __attribute__((vector_size(32)));
using EightInts = int32_t __attribute__((vector_size(32)));
static_assert(AimedLobes::kMost == 8);
Eight load(const float* at) {
    Eight v;
    std::memcpy(&v, at, sizeof v);
    return v;
}
Eight most(Eight a, Eight b) { return a > b ? a : b; }

/// Concentration of a lobe (AimedLobes) at this squared distance of its aim.
template <class F> F kappaOf(F far2, F perRadius2) {
    const F k = far2 * perRadius2;
    return k < kLeastKappa ? F{} + kLeastKappa : k > kMostKappa ? F{} + kMostKappa : k;
}

} // namespace

AimedLobes AimedLobes::fit(std::span<const Target> all, float scale) {
    std::vector<Target> some;
    for (size_t i = 0, step = all.size() / kFitted + 1; i < all.size(); i += step) some.push_back(all[i]);
    const size_t n = some.size(), most = std::clamp<size_t>(n / kTargetsOfLobe, 1, size_t(kMost));
    Vec3 middle(0.f);
    for (const Target& t : some) middle += t.P;
    middle = middle * (1 / float(n));
    std::vector<Vec3> w(n);
    for (size_t k = 0; k < n; ++k) w[k] = towards(middle, some[k].aim);
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
    // Then each moves to the mean of its nearest targets (Lloyd).
    std::vector<size_t> of(n);
    std::vector<Vec3> aims(axes.size());
    std::vector<float> power(axes.size());
    for (int turn = 0; turn < 4; ++turn) {
        std::fill(aims.begin(), aims.end(), Vec3(0.f));
        std::fill(power.begin(), power.end(), 0.f);
        for (size_t k = 0; k < n; ++k) {
            for (size_t a = of[k] = 0; a < axes.size(); ++a)
                if (square(w[k] - axes[a]) < square(w[k] - axes[of[k]])) of[k] = a;
            aims[of[k]] += some[k].aim * some[k].power;
            power[of[k]] += some[k].power;
        }
        for (size_t a = 0; a < axes.size(); ++a)
            if (power[a] > 0) axes[a] = towards(middle, aims[a] = aims[a] * (1 / power[a]));
    }
    std::vector<float> spread(axes.size());
    for (size_t k = 0; k < n; ++k) {
        const Target& p = some[k];
        spread[of[k]] += p.power * square(towards(p.P, p.aim) - towards(p.P, aims[of[k]]));
    }
    const float whole = std::accumulate(power.begin(), power.end(), 0.f);
    AimedLobes lobes;
    size_t count = 0;
    for (size_t a = 0; a < axes.size(); ++a) {
        if (!(power[a] > 0)) continue;
        const float angle2 = std::max(spread[a] / power[a] * (kWiden * kWiden), kLeastAngle * kLeastAngle);
        const float far2 = std::max(square(aims[a] - middle), 1e-12f * scale * scale);
        for (int q = 0; q < 3; ++q) lobes.aim[q][count] = aims[a][q];
        lobes.perRadius2[count] = 2 / (angle2 * far2);
        lobes.share[count++] = power[a] / whole;
    }
    return lobes;
}

int AimedLobes::count() const {
    return int(std::count_if(share, share + kMost, [](float s) { return s > 0; }));
}

float AimedLobes::density(const Vec3& P, const Vec3& w) const {
    Eight d[3], far2{}, away{};
    for (int q = 0; q < 3; ++q) {
        d[q] = load(aim[q]) - P[q];
        far2 += d[q] * d[q];
    }
    far2 = most(far2, Eight{} + 1e-30f);
    const Eight kappa = kappaOf(far2, load(perRadius2)), per = 1.f / __builtin_elementwise_sqrt(far2);
    for (int q = 0; q < 3; ++q) {
        const Eight off = d[q] * per - w[q];
        away += off * off;
    }
    // away / 2 = 1 - cos of the angle between w and the lobe's axis, without cancellation
    const Eight near = 1.f + kappa * (.5f * away), whole = 2.f * kappa / (1.f + 2.f * kappa);
    const Eight f = load(share) * kappa / (near * near * whole);
    float sum = 0;
    for (int k = 0; k < kMost; ++k) sum += f[k];
    return sum * float(.5 / kPi);
}

Vec3 AimedLobes::draw(const Vec3& P, Vec2 u) const {
    int k = 0;
    while (k + 1 < kMost && share[k + 1] > 0 && u.x >= share[k]) u.x -= share[k++];
    const Vec3 d = Vec3(aim[0][k], aim[1][k], aim[2][k]) - P;
    const float far2 = std::max(square(d), 1e-30f), kappa = kappaOf(far2, perRadius2[k]);
    const float v = std::clamp(u.x / share[k], 0.f, 1.f) * (2 * kappa / (1 + 2 * kappa));
    const float away = std::min(v / (kappa * (1 - v)), 2.f); // 1 - cos
    const float s = std::sqrt(std::max(away * (2 - away), 0.f));
    const Vec2 turn = unitCircle(u.y);
    return normalize(Basis(d * (1 / std::sqrt(far2))).toWorld({s * turn.x, s * turn.y, 1 - away}));
}

} // namespace alpenglow::world
