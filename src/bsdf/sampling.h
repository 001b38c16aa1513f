// Sampling formulas (docs/design/light-transport.md). All directions unit length; densities per solid angle.
#pragma once
#include "base/vec.h"
#include <algorithm>
#include <cstdint>

namespace alpenglow::bsdf {

/// Orthonormal basis about a unit normal, without a branch and without trigonometry (Duff et al., JCGT 2017).
struct Basis {
    Vec3 t, u, n; ///< n is the normal
    /// N_: unit.
    explicit Basis(Vec3 n_) : n(n_) {
        float s = std::copysign(1.f, n.z), a = -1 / (s + n.z), b = n.x * n.y * a;
        t = {1 + s * n.x * n.x * a, s * b, -s * n.x};
        u = {b, s + n.y * n.y * a, -n.y};
    }
    /// A vector given by its components along t, u and n.
    Vec3 toWorld(Vec3 v) const { return t * v.x + u * v.y + n * v.z; }
};

/// Cosine and sine of `turns`, 0 to 1, by series within an eighth of a turn, to float precision. Library functions differ between
/// versions.
inline Vec2 unitCircle(float turns) {
    float quarters = float(int(4 * turns + 0.5f));
    float x = (turns - 0.25f * quarters) * float(2 * kPi), q = x * x;
    float s = x * (1 - q * (1 / 6.f - q * (1 / 120.f - q * (1 / 5040.f - q * (1 / 362880.f)))));
    float c = 1 - q * (0.5f - q * (1 / 24.f - q * (1 / 720.f - q * (1 / 40320.f))));
    int k = int(quarters);
    float a = k & 1 ? s : c, b = k & 1 ? c : s; // rotated by k quarters: (c, s), (-s, c), (-c, -s), (s, -c)
    return {(k + 1) & 2 ? -a : a, k & 2 ? -b : b};
}

/// Cosine-weighted direction about +z; density cos / pi.
inline Vec3 sampleCosine(Vec2 e) {
    float r = std::sqrt(std::max(0.f, 1 - e.x));
    Vec2 d = unitCircle(e.y);
    return {r * d.x, r * d.y, std::sqrt(e.x)};
}

/// Uniform direction in a cone around +z; density 1 / (2 pi (1 - cosMax)). Takes 1 - cosMax, because small cones lose it in the
/// subtraction.
inline Vec3 sampleCone(float oneMinusCos, Vec2 e) {
    float h = e.x * oneMinusCos, c = 1 - h, s = std::sqrt(std::max(0.f, h * (2 - h)));
    Vec2 d = unitCircle(e.y);
    return {s * d.x, s * d.y, c};
}

/// Power heuristic, beta 2 (Veach and Guibas 1995): the weight of technique a against b. misWeight(a,b) + misWeight(b,a) = 1.
inline float misWeight(float a, float b) {
    if (!(a > 0)) return 0;
    float r = b / a;
    return 1 / (1 + r * r);
}

/// Survival probability of a ray that a waiting kernel requests; its use of the result is unknown, and it may request any number
/// of rays. `bounces`: of the requesting point; `known`: largest number of rays requested at an earlier point of the path;
/// `before`: rays that the kernel has requested there; `count`: rays of this call. At the camera's hit all rays are sent, at the
/// next two points three on average. From there on the probabilities at a point sum to s < 1, so that the tree of rays ends: s =
/// .8 for two or three rays, .7 for more, with 1 / (1 - s) further points on average. All rays of a point have about the same
/// probability. For kernels that reflect a fraction r of the light the variance is finite while r^2 < s, and s about .8 minimises
/// variance times rays for r from .5 to .8. A single known ray has .5, because its kernel may request others; calls that the path
/// did not know of share .4, because their number becomes known only gradually. Unbiased: the probabilities depend on no number
/// drawn here.
inline float rouletteWaiting(int bounces, uint32_t known, uint32_t before, uint32_t count) {
    const uint32_t many = std::max(known, before + count);
    const float n = float(many);
    const bool learns = before > 0 && before + count > known;
    if (bounces < 3) return bounces < 1 ? 1 : std::min(1.f, 3 / n);
    return many < 2 ? .5f : (learns ? .4f : many < 4 ? .8f : .7f) / n;
}

/// Survival probability of a ray that a light's shader requests at a point that it lights after so many bounces. `many`: largest
/// number of such rays known at one point. Hits of such a ray are lit by all lights again, and its paths continue as well: so the
/// probabilities at a point sum to 1/2, and the tree of rays ends if surfaces reflect at most half.
inline float rouletteOfLight(int bounces, uint32_t many) { return bounces < 1 ? 1 : .5f / float(std::max(many, 1u)); }

/// Survival probability of a path after its third bounce, with throughput `weight`; 0: it ends; the caller divides by it. 1.5
/// times the root of the largest channel, because the throughput itself would end paths whose light costs more variance than
/// their time (figures in docs/noise.md). `dice` draws a random number if needed.
template <class Dice> float rouletteOfPath(const Color& weight, const Dice& dice) {
    const float m = maxComponent(Color(std::fabs(weight.x), std::fabs(weight.y), std::fabs(weight.z)));
    const float q = std::min(1.f, 1.5f * std::sqrt(m));
    return q >= 1 ? 1 : q > 0 && dice() < q ? q : 0;
}

/// SLProject's local roulette (docs/design/slproject.md): 1 up to depth 3, then the largest channel of the albedo. 0: ends; the
/// caller divides.
inline float rouletteLocal(int depth, const Color& albedo, float random) {
    if (depth <= 3) return 1;
    float q = std::min(maxComponent(albedo), 1.f);
    if (!(q > 0)) return 0;
    if (q >= 1) return 1;
    return random < q ? q : 0;
}

} // namespace alpenglow::bsdf
