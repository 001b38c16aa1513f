// specular(N, V, roughness) and specularstd: Blinn highlight. axis = N, wo = V, a = exponent of N.H.
// Per light term Cl max(0, N.H)^e, so f cos = (N.H)^e / pi on the side of N.
#pragma once
#include "bsdf/kinds/lobe.h"

namespace alpenglow::bsdf::AL_NAMESPACE {

/// Half angle of a highlight with exponent a.
AL_INLINE vf spreadOfExponent(vf a) { return minLanes(vf(0.7f), rootLanes(vf(2) / (a + vf(1)))); }

/// The lobe of specular(): RISpec's highlight about the halfway vector.
struct Specular {
    static constexpr const char* name = "specular";
    static constexpr const char* doc = "Blinn highlight: f cos = max(0, N.H)^a / pi above the surface.";
    static constexpr bool distribution = false;
    static constexpr int needs = kNeedsWo | kNeedsA;
    static constexpr int traits = kSameFromBoth;
    static AL_MEMBER void prepare(const Rows& p) {
        const vf a = p.number(kRowA), more = a + vf(1), facing = maxLanes(dot(p.axis(), p.wo()), vf(0.1f));
        p.common(minLanes(vf(1), facing * vf(8) / more), spreadOfExponent(a), vf(0));
        p.own(0, vf(1) / more);
    }
    static AL_MEMBER Value evaluate(const Given& p, const Direction& w) {
        const Direction h = normalize(w + p.wo());
        const vf a = p.number(kRowA), c = dot(p.axis(), h), d = dot(p.wo(), h);
        const vm above = dot(p.axis(), w) > 0;
        const vf lobe = where(above & (c > 0), powLanes(c, a) * vf(1 / kPi));
        return grey(lobe, where(d > 0, divide(lobe * (a + vf(1)) * vf(0.125f), d)));
    }
    static AL_MEMBER vm sample(const Given& p, const Pair<vf>& u, Direction& w) {
        const Direction h = toWorld(basisAbout(p.axis()), samplePhong(p.own(0), u));
        const vf d = dot(p.wo(), h); // below 0 the reflected direction would be below the facet
        w = normalize(mad3(h, d * vf(2), -p.wo()));
        return (d > 0) & (dot(p.axis(), w) > 0);
    }
};

} // namespace alpenglow::bsdf::AL_NAMESPACE
