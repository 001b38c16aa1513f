// trace()'s "uniform" and "cosine": averages of radiance over a cone. axis = R, a = half angle (samplecone); 0 = one ray.
#pragma once
#include "bsdf/kinds/lobe.h"

namespace alpenglow::bsdf::AL_NAMESPACE {

/// Shared by both: the cone, and the horizon plane.
struct Cone {
    static constexpr bool distribution = false;
    static constexpr int needs = kNeedsHorizon | kNeedsA;
    /// The part of prepare() that both share; perWeight: density of a sample over its value.
    static AL_MEMBER void prepareCone(const Rows& p, vf perWeight) {
        const vf a = p.number(kRowA), s = sinLanes(minLanes(a, vf(kPi)) * vf(0.5f));
        p.common(vf(1), minLanes(a * vf(0.5f), vf(0.7f)), select(a > 1e-6f, vf(0), vf(1)));
        p.own(0, s * s * vf(2)); // 1 - cos a
        p.own(1, perWeight);
        // Chord of half the cone angle; the last term bounds the rounding of both directions.
        const vf chord = mad(s * vf(2), vf(1 + 1e-6f), vf(3e-7f));
        p.own(2, chord * chord);
    }
    /// Whether w is in the cone and above the horizon.
    static AL_MEMBER vm overHorizon(const Given& p, const Direction& w) {
        return (p.number(kRowHasHorizon) == 0) | (dot(p.triple(kRowHorizon), w) > 0);
    }
    /// The cone is one direction.
    static AL_MEMBER vm delta(const Given& p) { return p.number(kRowDelta) != 0; }
    /// By the chord, because 1 - cos of a narrow cone is lost in rounding.
    static AL_MEMBER vm inside(const Given& p, const Direction& w) {
        const Direction chord = w - p.axis();
        return ~delta(p) & overHorizon(p, w) & (dot(chord, chord) <= p.own(2));
    }
};
struct UniformCone : Cone {
    static constexpr const char* name = "uniform";
    static constexpr const char* doc = "Plain average over the cone of half angle a about axis.";
    static AL_MEMBER void prepare(const Rows& p) {
        prepareCone(p, vf(0));
        p.own(1, divide(vf(0.5f / kPi), p.own(0)));
    }
    static AL_MEMBER Value evaluate(const Given& p, const Direction& w) {
        const vf f = where(inside(p, w), p.own(1));
        return grey(f, f);
    }
    static AL_MEMBER vm sample(const Given& p, const Pair<vf>& u, Direction& w) {
        w = select3(delta(p), p.axis(), toWorld(basisAbout(p.axis()), sampleCone(p.own(0), u)));
        return overHorizon(p, w);
    }
};
/// Counts only light above the plane of the axis.
struct CosineCone : Cone {
    static constexpr const char* name = "cosine";
    static constexpr const char* doc =
        "Cosine-weighted average over the cone of half angle a about axis; pi/2 is irradiance / pi.";
    static AL_MEMBER void prepare(const Rows& p) {
        const vf s = sinLanes(minLanes(p.number(kRowA), vf(kPi / 2))), s2 = s * s;
        prepareCone(p, divide(vf(1 / kPi), s2));
        p.own(3, s2);
    }
    static AL_MEMBER Value evaluate(const Given& p, const Direction& w) {
        const vf c = dot(p.axis(), w), f = where((c > 0) & inside(p, w), c * p.own(1));
        return grey(f, f);
    }
    static AL_MEMBER vm sample(const Given& p, const Pair<vf>& u, Direction& w) {
        const vf r2 = u.a * p.own(3), r = rootLanes(r2);
        const Pair<vf> d = unitCircle(u.b);
        const vm straight = delta(p);
        w = select3(straight, p.axis(), toWorld(basisAbout(p.axis()), {r * d.a, r * d.b, rootOf(vf(1) - r2)}));
        return overHorizon(p, w) & (straight | (dot(p.axis(), w) > 0));
    }
};

} // namespace alpenglow::bsdf::AL_NAMESPACE
