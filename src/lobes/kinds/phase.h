// What a medium scatters: the phase function of Henyey and Greenstein. axis = direction of travel, a = mean cosine, -1 to 1.
#pragma once
#include "lobes/kinds/lobe.h"

namespace alpenglow::transport::AL_NAMESPACE {

/// About the axis where a is positive, about its opposite where it is negative: what is narrow is then near the pole, and lengths
/// of chords keep what 1 - cos would lose in rounding.
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

} // namespace alpenglow::transport::AL_NAMESPACE
