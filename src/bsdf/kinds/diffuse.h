// diffuse(N), diffusely: Lambert. axis = N. f = 1/pi.
#pragma once
#include "bsdf/kinds/lobe.h"

namespace alpenglow::bsdf::AL_NAMESPACE {

/// The lobe "diffuse": cosine-weighted directions about the axis.
struct Diffuse {
    static constexpr const char* name = "diffuse";
    static constexpr const char* doc = "Lambert about axis: f = 1/pi. Radiance 1 from everywhere gives 1.";
    static constexpr bool distribution = false;
    static constexpr int needs = 0;
    static constexpr int traits = kCosineOfAxis | kLambert;
    static AL_MEMBER void prepare(const Rows& p) { p.common(vf(1), vf(0.7f), vf(0)); }
    static AL_MEMBER Value evaluate(const Given& p, const Direction& w) {
        const vf f = maxLanes(dot(p.axis(), w), vf(0)) * vf(1 / kPi);
        return grey(f, f);
    }
    static AL_MEMBER vm sample(const Given& p, const Pair<vf>& u, Direction& w) {
        w = toWorld(basisAbout(p.axis()), sampleCosine(u));
        return dot(p.axis(), w) > 0;
    }
};

} // namespace alpenglow::bsdf::AL_NAMESPACE
