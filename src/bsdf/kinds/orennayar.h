// trace()'s "oren-nayar": axis = normal. Cosine-weighted sampling.
#pragma once
#include "bsdf/kinds/lobe.h"
#include "shadeops/bsdf/oren_nayar.h"

namespace alpenglow::bsdf::AL_NAMESPACE {

/// The lobe "oren-nayar" (formula: shadeops/bsdf).
struct OrenNayar {
    static constexpr const char* name = "oren-nayar";
    static constexpr const char* doc = "Rough diffuse surface with normal axis, seen from wo.";
    static constexpr bool distribution = true;
    static constexpr int needs = kNeedsWo | kNeedsHorizon | kNeedsSurface;
    static constexpr int traits = kCosineOfAxis | kSameFromBoth;
    static AL_MEMBER void prepare(const Rows& p) { p.common(vf(1), vf(0.5f), vf(0)); }
    static AL_MEMBER Value evaluate(const Given& p, const Direction& w) {
        const vf f = where(aboveHorizon(p, w), orenNayar(w, p.axis(), p.wo(), p.number(kRowRoughness)));
        return grey(f, maxLanes(dot(p.axis(), w), vf(0)) * vf(1 / kPi));
    }
    static AL_MEMBER vm sample(const Given& p, const Pair<vf>& u, Direction& w) {
        w = toWorld(basisAbout(p.axis()), sampleCosine(u));
        return (dot(p.axis(), w) > 0) & aboveHorizon(p, w);
    }
};

} // namespace alpenglow::bsdf::AL_NAMESPACE
