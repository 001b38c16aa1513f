// A white furnace for each distribution at every roughness and angle: what its samples bring under a sky of radiance 1 is the
// integral of its value by quadrature. docs/bsdfs.md shows the figures.
#include "bsdf/lobe.h"
#include "bsdf/sampling.h"
#include "statistics/agreement.h"
#include <gtest/gtest.h>
#include <random>

namespace whitefurnace_test {

using namespace alpenglow;
using namespace alpenglow::integrator;

namespace {

constexpr float kRoughness[] = {.05f, .1f, .2f, .3f, .5f, .7f, 1.f};
constexpr float kCosines[] = {1.f, .7f, .5f, .3f, .17f};

LobeParams lobe(float roughness, float cosine) {
    LobeParams p{Vec3(0, 0, 1), Vec3(std::sqrt(1 - cosine * cosine), 0, cosine), {}};
    auto m = std::make_shared<DistributionParams>();
    m->roughness = m->roughnessv = roughness;
    m->udir = Vec3(1, 0, 0);
    p.more = m;
    return p;
}

/// Over the sphere, by midpoints in coordinates that are dense about the mirror direction, straight on, and the poles of the
/// plane.
double integral(const LobeKind& k, const LobeParams& p, int n) {
    const Bsdf one(k, p);
    const Basis about(normalize(p.axis * (2 * dot(p.axis, p.wo)) - p.wo));
    double sum = 0;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const double s = (i + .5) / n, z = 1 - 2 * s * s * s, q = std::sqrt(std::max(0.0, 1 - z * z)),
                         f = 2 * kPi * (j + .5) / n; // dz = 6 s^2 ds
            sum += 6 * s * s / n * 2 * kPi / n *
                   one.value(about.toWorld({float(q * std::cos(f)), float(q * std::sin(f)), float(z)})).fcos;
        }
    return sum;
}

} // namespace

TEST(WhiteFurnace, SamplesBringTheIntegral) {
    int compared = 0;
    size_t turn = 0; // 3 is no divisor of the 35 lobes of a kind: each has other ones
    for (const LobeKind* k : lobeKinds()) {
        if (!k->distribution) continue;
        for (const float roughness : kRoughness)
            for (const float cosine : kCosines) {
                if (!teststat::chosen(turn++, 3)) continue;
                const LobeParams p = lobe(roughness, cosine);
                const std::string what =
                    std::string(k->name) + ", roughness " + std::to_string(roughness) + ", cosine " + std::to_string(cosine);
                const Bsdf one(*k, p);
                if (one.delta()) continue;
                std::mt19937_64 rng(uint64_t(5) + teststat::seedBase());
                std::uniform_real_distribution<float> u01(0, 0x1.fffffep-1f);
                const int n = teststat::samples(10'000, 300'000);
                double sum = 0, square = 0;
                for (int i = 0; i < n; ++i) {
                    Vec3 w;
                    if (!one.sample({u01(rng), u01(rng)}, w)) continue;
                    const LobeValue v = one.value(w);
                    const double x = v.pdf > 0 ? v.fcos / double(v.pdf) : 0;
                    ASSERT_TRUE(std::isfinite(x) && x >= 0) << what;
                    sum += x, square += x * x;
                }
                const double mean = sum / n, se = std::sqrt(std::max(0.0, square / n - mean * mean) / n);
                // Two grids say how good the quadrature is; where it does not see the lobe well nothing is compared.
                const double coarse = integral(*k, p, 96), fine = integral(*k, p, 192), off = 2 * std::fabs(fine - coarse);
                if (off > .02 * fine) continue;
                ++compared;
                EXPECT_LE(std::fabs(mean - fine), teststat::kZ * se + off + 1e-3 * fine)
                    << what << ": " << mean << " +- " << se << ", " << fine;
            }
    }
    EXPECT_GE(compared, teststat::nightly() ? 120 : 40); // of 245, of 82
}

} // namespace whitefurnace_test
