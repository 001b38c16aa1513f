// A property of every kind of the list of lobes, whatever its parameters: a direction that sample() gives has a density above 0,
// and a value that is finite and not negative. Where a kind is not cut by a horizon or by shadowing the value is above 0 too.
// RapidCheck makes the parameters and shrinks what fails; fixed seeds here, fresh ones nightly.
#include "bsdf/lobe.h"
#include "bsdf/sampling.h"
#include "statistics/nightly.h"
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/detail/TestListenerAdapter.h>

namespace lobe_property_test {

using namespace alpenglow;
using namespace alpenglow::integrator;

namespace {

/// A number in [low, high) in 2^20 steps; shrinks to low.
float between(float low, float high) { return low + (high - low) * float(*rc::gen::inRange(0, 1 << 20)) * 0x1p-20f; }
Vec3 direction() {
    const float z = 1 - between(0, 2), phi = 2 * float(kPi) * between(0, 1), s = std::sqrt(std::max(0.f, 1 - z * z));
    return normalize(Vec3(s * std::cos(phi), s * std::sin(phi), z));
}
LobeParams parametersFor(const LobeKind& k) {
    LobeParams p;
    p.axis = direction();
    p.wo = direction();
    const bool cone = k.name == "uniform" || k.name == "cosine";
    p.a = cone ? between(.2f, k.name == "cosine" ? 1.5f : 3) : std::exp(between(0, 6.5f)); // half angle; exponent up to 665
    const bool mayBeCut = cone || k.name == "slphong" || k.distribution;                   // trace()'s kinds have a horizon
    if (mayBeCut && *rc::gen::inRange(0, 2)) {
        p.hasHorizon = true;
        p.horizon = direction();
    }
    if (!k.distribution) return p;
    auto m = std::make_shared<DistributionParams>();
    m->roughness = between(.05f, 1);
    m->roughnessv = between(.05f, 1);
    m->udir = direction();
    m->eta = Color(between(.4f, 3), between(1, 3), between(1, 3));
    m->k = Color(between(0, 3));
    m->absorption = Color(between(0, 1), between(0, 1), between(0, 1));
    m->part = *rc::gen::inRange(-1, 3);
    p.more = m;
    return p;
}

class LobeProperty : public ::testing::TestWithParam<const LobeKind*> {};

} // namespace

// 2,000 sets of parameters with 20 directions each; nightly 50,000.
TEST_P(LobeProperty, WhatIsDrawnHasADensityAndAValue) {
    const LobeKind& k = *GetParam();
    rc::detail::TestParams params;
    params.seed = 17 + teststat::seedBase();
    params.maxSuccess = teststat::samples(2000, 50000);
    const auto property = [&] {
        const LobeParams p = parametersFor(k);
        for (int i = 0; i < 20; ++i) {
            Vec3 w;
            if (!k.sample(p, {between(0, 1), between(0, 1)}, w)) continue;
            RC_ASSERT(std::fabs(length(w) - 1) < 1e-4f);
            const float pdf = k.pdf(p, w);
            const Color f = lobeValue(k, p, w);
            RC_ASSERT(std::isfinite(pdf));
            RC_ASSERT(std::isfinite(f.x) && std::isfinite(f.y) && std::isfinite(f.z));
            RC_ASSERT(std::min({f.x, f.y, f.z}) >= 0);
            // Opposite to the viewer a half vector is all rounding, and so is the side of a direction in the lobe's own plane.
            const bool rounding = length(w + p.wo) < 1e-2f || std::fabs(dot(w, p.axis)) < 1e-4f ||
                                  (p.hasHorizon && std::fabs(dot(w, p.horizon)) < 1e-4f);
            if (rounding) continue;
            RC_ASSERT(pdf > 0);
            if (!k.distribution) RC_ASSERT(k.fcos(p, w) > 0);
        }
    };
    rc::detail::TestListenerAdapter silent;
    const auto result = rc::detail::checkTestable(property, rc::detail::TestMetadata{std::string(k.name), ""}, params, silent,
                                                  std::unordered_map<std::string, rc::detail::Reproduce>());
    std::ostringstream said;
    rc::detail::printResultMessage(result, said);
    EXPECT_TRUE(result.is<rc::detail::SuccessResult>()) << said.str();
}

// The numbers at the ends of [0, 1): a cosine of 0 about a lobe's mirror direction is one that rounding may make negative.
TEST(LobeEdges, APhongDrawAtNinetyDegreesHasADensityOrIsRefused) {
    for (const LobeKind* kind : lobeKinds()) {
        const LobeKind& k = *kind;
        if (k.name != "phong" && k.name != "slphong") continue;
        int drawn = 0;
        for (int i = 0; i < 400; ++i) {
            const float z = -1 + (float(i) + .5f) / 200, s = std::sqrt(1 - z * z), phi = 2.399963f * float(i);
            LobeParams p;
            p.axis = Vec3(s * std::cos(phi), s * std::sin(phi), z);
            p.wo = normalize(p.axis + Vec3(.4f, -.2f, .3f));
            p.a = 1;
            for (int j = 0; j < 32; ++j) {
                Vec3 w;
                if (!k.sample(p, {0, float(j) / 32}, w)) continue;
                ++drawn;
                EXPECT_GT(k.pdf(p, w), 0) << k.name << " " << i << " " << j;
            }
        }
        EXPECT_GT(drawn, 50) << k.name;
    }
}

INSTANTIATE_TEST_SUITE_P(Kinds, LobeProperty, ::testing::ValuesIn(lobeKinds().begin(), lobeKinds().end()), [](const auto& i) {
    std::string name(i.param->name);
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
});

} // namespace lobe_property_test
