// trace()'s "slphong": SLProject's glossy lobe (docs/design/slproject.md, "Glossy lobe"). axis = perfect reflected or refracted
// direction, a = exponent (1000 and above: perfect), horizon = surface normal. f cos = (n+2)/(2 pi) cos^n |w . horizon|, only on
// the perfect direction's side of the surface; without a horizon the plain normalised lobe (n+1)/(2 pi) cos^n. Loses energy at
// grazing angles, where part of the lobe is below the surface, as in SLProject.
#pragma once
#include "bsdf/kinds/specular.h"

namespace alpenglow::bsdf::AL_NAMESPACE {

/// SLProject's lobe of a traced reflection.
struct PhongTrace {
    static constexpr const char* name = "slphong";
    static constexpr const char* doc =
        "SLProject's normalised Phong lobe of exponent a about axis; 1000 and above: one direction.";
    static constexpr bool distribution = false;
    static constexpr int needs = kNeedsHorizon | kNeedsA;
    static constexpr int traits = kCosineOfHorizon | kAxisIsMirror | kTakesExponent;
    static constexpr float kPerfect = 1000; ///< SLMaterial::PERFECT
    /// Whether w is on the side of the horizon where the axis is.
    static AL_MEMBER vm sameSide(const Given& p, const Direction& w) {
        const Direction horizon = p.triple(kRowHorizon);
        return (p.number(kRowHasHorizon) == 0) | (dot(horizon, p.axis()) * dot(horizon, w) > 0);
    }
    static AL_MEMBER void prepare(const Rows& p) {
        const vf a = p.number(kRowA);
        const vm delta = a >= kPerfect;
        p.common(vf(1), select(delta, vf(0), spreadOfExponent(a)), where(delta, vf(1)));
        p.own(0, vf(1) / (a + vf(1)));
    }
    static AL_MEMBER Value evaluate(const Given& p, const Direction& w) {
        const vf a = p.number(kRowA), c = dot(p.axis(), w);
        const vm seen = (p.number(kRowDelta) == 0) & (c > 0) & sameSide(p, w);
        const vf lobe = where(seen, powLanes(c, a) * vf(0.5f / kPi)), plain = (a + vf(1)) * lobe;
        const vf cosine = absLanes(dot(p.triple(kRowHorizon), w));
        return grey(select(p.number(kRowHasHorizon) == 0, plain, (a + vf(2)) * lobe * cosine), plain);
    }
    static AL_MEMBER vm sample(const Given& p, const Pair<vf>& u, Direction& w) {
        const vm delta = p.number(kRowDelta) != 0;
        w = select3(delta, p.axis(), toWorld(basisAbout(p.axis()), samplePhong(p.own(0), u)));
        return delta | ((dot(p.axis(), w) > 0) & sameSide(p, w)); // rounding can violate the first condition at 90 degrees
    }
};

} // namespace alpenglow::bsdf::AL_NAMESPACE
