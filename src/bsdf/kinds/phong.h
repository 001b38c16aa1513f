// phong(N, V, size): the mirror direction of V about N, to the power of size. axis = N, wo = V, a = size.
// Per light term Cl max(0, R.L)^size, so f cos = (R.w)^size / pi on the side of N.
#pragma once
#include "bsdf/kinds/specular.h"

namespace alpenglow::bsdf::AL_NAMESPACE {

/// The lobe of phong(): RISpec's highlight about the mirrored direction.
struct Phong {
    static constexpr const char* name = "phong";
    static constexpr const char* doc = "Phong highlight: f cos = max(0, R.w)^a / pi above the surface.";
    static constexpr bool distribution = false;
    static constexpr int needs = kNeedsWo | kNeedsA;
    static constexpr int traits = kSameFromBoth;
    static AL_MEMBER void prepare(const Rows& p) {
        const vf a = p.number(kRowA);
        p.common(minLanes(vf(1), vf(2) / (a + vf(1))), spreadOfExponent(a), vf(0));
        p.own(0, vf(1) / (a + vf(1)));
        p.own(1, mad3(p.axis(), dot(p.axis(), p.wo()) * vf(2), -p.wo()));
    }
    static AL_MEMBER Value evaluate(const Given& p, const Direction& w) {
        const vf a = p.number(kRowA), c = dot(p.ownTriple(1), w);
        const vf lobe = where((c > 0) & (dot(p.axis(), w) > 0), powLanes(c, a) * vf(1 / kPi));
        return grey(lobe, lobe * (a + vf(1)) * vf(0.5f));
    }
    static AL_MEMBER vm sample(const Given& p, const Pair<vf>& u, Direction& w) {
        w = toWorld(basisAbout(normalize(p.ownTriple(1))), samplePhong(p.own(0), u));
        return (dot(p.axis(), w) > 0) &
               (dot(p.ownTriple(1), w) > 0); // as in evaluate(): rounding can violate the second condition at 90 degrees
    }
};

} // namespace alpenglow::bsdf::AL_NAMESPACE
