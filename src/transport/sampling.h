// The sampling formulas of pathtracer.md section 5, with their densities. All directions unit length; densities per solid angle.
#pragma once
#include "base/vec.h"
#include <algorithm>

namespace alpenglow::transport {

/// Orthonormal basis about a unit normal, without a branch and without trigonometry (pathtracer.md 5.3).
struct Basis {
    Vec3 t, u, n;
    explicit Basis(Vec3 n_) : n(n_) {
        float s = std::copysign(1.f, n.z), a = -1 / (s + n.z), b = n.x * n.y * a;
        t = {1 + s * n.x * n.x * a, s * b, -s * n.x};
        u = {b, s + n.y * n.y * a, -n.y};
    }
    Vec3 toWorld(Vec3 v) const { return t * v.x + u * v.y + n * v.z; }
};

/// Cosine-weighted direction about +z; density cos / pi.
inline Vec3 sampleCosine(Vec2 e) {
    float r = std::sqrt(std::max(0.f, 1 - e.x)), phi = 2 * float(kPi) * e.y;
    return {r * std::cos(phi), r * std::sin(phi), std::sqrt(e.x)};
}

/// Phong lobe of exponent n about +z; density (n+1)/(2 pi) cos^n.
inline Vec3 samplePhong(float n, Vec2 e) {
    float c = std::pow(e.x, 1 / (n + 1)), s = std::sqrt(std::max(0.f, 1 - c * c)), phi = 2 * float(kPi) * e.y;
    return {s * std::cos(phi), s * std::sin(phi), c};
}
inline float phongPdf(float n, float cosine) { return cosine > 0 ? (n + 1) / (2 * float(kPi)) * std::pow(cosine, n) : 0; }

/// Uniform direction in a cone about +z with the given cosine of its half angle; density 1 / (2 pi (1 - cosMax)).
/// oneMinusCos is passed beside it because small cones lose it in the subtraction.
inline Vec3 sampleCone(float oneMinusCos, Vec2 e) {
    float h = e.x * oneMinusCos, c = 1 - h, s = std::sqrt(std::max(0.f, h * (2 - h))), phi = 2 * float(kPi) * e.y;
    return {s * std::cos(phi), s * std::sin(phi), c};
}

/// Power heuristic, beta 2: the weight of technique a against b (pathtracer.md 5.2). misWeight(a,b) + misWeight(b,a) = 1.
inline float misWeight(float a, float b) {
    if (!(a > 0)) return 0;
    float r = b / a;
    return 1 / (1 + r * r);
}

/// The seed's local roulette (pathtracer.md 5.1): 1 up to depth 3, then the largest channel of the albedo. 0 = stop; the caller divides.
inline float rouletteLocal(int depth, const Color& albedo, float random) {
    if (depth <= 3) return 1;
    float q = std::min(maxComponent(albedo), 1.f);
    if (!(q > 0)) return 0;
    if (q >= 1) return 1;
    return random < q ? q : 0;
}

} // namespace alpenglow::transport
