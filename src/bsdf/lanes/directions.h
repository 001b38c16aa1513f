// Directions in lanes: frames, rotations and sampling formulas (docs/design/light-transport.md; scalar versions:
// bsdf/sampling.h).
#pragma once
#include "shadeops/call.h"

namespace alpenglow::bsdf::AL_NAMESPACE {
using namespace shadeops::AL_NAMESPACE;

using Direction = Triple<vf>; ///< a direction for each lane

/// Orthonormal basis about a unit normal, without a branch and without trigonometry (Duff et al., JCGT 2017).
struct Basis {
    Direction t, u, n; ///< n is the normal
};
/// n: unit.
AL_INLINE Basis basisAbout(const Direction& n) {
    const vf s = copySign(vf(1), n.z), a = vf(-1) / (s + n.z), b = n.x * n.y * a;
    return {{mad(s * n.x, n.x * a, vf(1)), s * b, -s * n.x}, {b, mad(n.y, n.y * a, s), -n.y}, n};
}
/// A vector given by its components along t, u and n.
AL_INLINE Direction toWorld(const Basis& f, const Direction& v) { return mad3(f.t, v.x, mad3(f.u, v.y, times(f.n, v.z))); }

/// Cosine and sine of `turns`, 0 to 1, by series within an eighth of a turn.
AL_INLINE Pair<vf> unitCircle(vf turns) {
    const vi k = toInt(mad(turns, vf(4), vf(0.5f)));
    const vf x = mad(toReal(k), vf(-0.25f), turns) * vf(2 * kPi), q = x * x;
    vf s = mad(q, vf(1 / 362880.f), vf(-1 / 5040.f)), c = mad(q, vf(1 / 40320.f), vf(-1 / 720.f));
    s = mad(q, s, vf(1 / 120.f)), c = mad(q, c, vf(1 / 24.f));
    s = mad(q, s, vf(-1 / 6.f)), c = mad(q, c, vf(-0.5f));
    s = mad(x * q, s, x), c = mad(q, c, vf(1));
    const vu bits = __builtin_bit_cast(vu, k);
    const vm odd = __builtin_bit_cast(vi, bits << 31) < 0;
    // Rotated by k quarters: (c, s), (-s, c), (-c, -s), (s, -c).
    return {flipSign(select(odd, s, c), (bits + 1u) << 30), flipSign(select(odd, c, s), bits << 30)};
}

/// The square root; 0 for negative x.
AL_INLINE vf rootOf(vf x) { return rootLanes(maxLanes(x, vf(0))); }

/// Cosine-weighted direction about +z; density cos / pi.
AL_INLINE Direction sampleCosine(const Pair<vf>& u) {
    const vf r = rootOf(vf(1) - u.a);
    const Pair<vf> d = unitCircle(u.b);
    return {r * d.a, r * d.b, rootLanes(u.a)};
}
/// Direction at this cosine to +z, with azimuth d.
AL_INLINE Direction withCosine(vf cosine, const Pair<vf>& d) {
    const vf s = rootOf(mad(-cosine, cosine, vf(1)));
    return {s * d.a, s * d.b, cosine};
}
/// Phong lobe about +z, its exponent n given as 1 / (n + 1); density (n + 1) / (2 pi) cos^n.
AL_INLINE Direction samplePhong(vf perExponent1, const Pair<vf>& u) {
    return withCosine(powLanes(u.a, perExponent1), unitCircle(u.b));
}
/// Uniform direction in a cone around +z; density 1 / (2 pi (1 - cos)). The caller passes 1 - cos, because small cones lose it in
/// the subtraction.
AL_INLINE Direction sampleCone(vf oneMinusCos, const Pair<vf>& u) {
    const vf h = u.a * oneMinusCos, s = rootOf(h * (vf(2) - h));
    const Pair<vf> d = unitCircle(u.b);
    return {s * d.a, s * d.b, vf(1) - h};
}
/// Direction with squared slope tangent2 and azimuth d.
AL_INLINE Direction fromSlope(vf tangent2, const Pair<vf>& d) {
    const vf c = vf(1) / rootLanes(tangent2 + vf(1)), s = rootLanes(tangent2) * c;
    return {s * d.a, s * d.b, c};
}

} // namespace alpenglow::bsdf::AL_NAMESPACE
