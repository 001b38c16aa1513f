// Scattering in media: the Henyey-Greenstein phase function. axis = direction of travel, a = mean cosine, -1 to 1.
#pragma once
#include "bsdf/kinds/lobe.h"

namespace alpenglow::bsdf::AL_NAMESPACE {

/// Around the axis for positive a, around its opposite for negative a: narrow lobes are then near the pole, and chord lengths
/// keep the precision that 1 - cos would lose.
struct HenyeyGreenstein {
    static constexpr const char* name = "henyey-greenstein";
    static constexpr const char* doc = "Phase function: (1 - a^2) / (4 pi (1 + a^2 - 2 a cos)^1.5), cos that to the axis.";
    static constexpr bool distribution = false;
    static constexpr int needs = kNeedsA;
    static AL_MEMBER void prepare(const Rows& p) {
        const vf a = p.number(kRowA), g = minLanes(absLanes(a), vf(0.999f));
        p.common(vf(1), vf(0.7f), vf(0));
        p.own(0, g);
        p.own(1, times(p.axis(), select(a < 0, vf(-1), vf(1))));
    }
    static AL_MEMBER Value evaluate(const Given& p, const Direction& w) {
        const vf g = p.own(0);
        const Direction chord = w - p.ownTriple(1);
        const vf d2 = mad(g, dot(chord, chord), (vf(1) - g) * (vf(1) - g)); // 1 + g^2 - 2 g cos
        const vf f = (vf(1) - g) * (vf(1) + g) * vf(0.25f / kPi) / (d2 * rootLanes(d2));
        return grey(f, f);
    }
    static AL_MEMBER vm sample(const Given& p, const Pair<vf>& u, Direction& w) {
        const vf g = p.own(0), q = mad(g * vf(2), u.a, vf(1) - g), r = (vf(1) - g) / q;
        const vf h = minLanes(r * r * (vf(1) - u.a) * mad(g, u.a, vf(1)) * vf(2), vf(2)); // 1 - cos
        const vf s = rootOf(h * (vf(2) - h));
        const Pair<vf> d = unitCircle(u.b);
        w = toWorld(basisAbout(p.ownTriple(1)), {s * d.a, s * d.b, vf(1) - h});
        return h >= 0;
    }
};

/// The same value with light-directed sampling: single scattering along a ray is about one over the sine of its angle to a
/// light's direction, so sampling the phase function alone has unbounded variance. wo = unit, toward the light.
struct PhaseTowardLight {
    static constexpr const char* name = "henyey-greenstein-toward-light";
    static constexpr const char* doc = "As henyey-greenstein; three of ten draws are even in the angle to a light.";
    static constexpr bool distribution = false;
    static constexpr int needs = kNeedsA | kNeedsWo;
    static constexpr float kShare = 0.3f; ///< part of the draws that are directed at the light
    static AL_MEMBER void prepare(const Rows& p) { HenyeyGreenstein::prepare(p); }
    static AL_MEMBER Value evaluate(const Given& p, const Direction& w) {
        Value v = HenyeyGreenstein::evaluate(p, w);
        const Direction off = cross(w, p.wo());
        const vf sine = maxLanes(rootLanes(dot(off, off)), vf(1e-6f));
        v.pdf = mad(v.pdf, vf(1 - kShare), vf(kShare * 0.5f / (kPi * kPi)) / sine);
        return v;
    }
    static AL_MEMBER vm sample(const Given& p, const Pair<vf>& u, Direction& w) {
        const vm toward = u.a < kShare;
        HenyeyGreenstein::sample(p, {maxLanes((u.a - kShare) / vf(1 - kShare), vf(0)), u.b}, w);
        const Pair<vf> off = unitCircle(minLanes(u.a * vf(0.5f / kShare), vf(0.5f))), d = unitCircle(u.b);
        const Direction b = toWorld(basisAbout(p.wo()), {off.b * d.a, off.b * d.b, off.a});
        w = {select(toward, b.x, w.x), select(toward, b.y, w.y), select(toward, b.z, w.z)};
        return u.a >= 0;
    }
};

} // namespace alpenglow::bsdf::AL_NAMESPACE
