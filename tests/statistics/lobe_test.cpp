// Every lobe: its sampler against its density (LobeT1, chi-square), consistency and support (LobeT2); docs/proof.md.
// False alarms: alpha = 2e-6 a test. Power: on 200 cells and 1e5 draws an error of alternating +-5 % is found in 200 of 200
// runs; nightly on 5,202 cells and 1e6 draws +-6 % (noncentrality N delta^2 against 7.1 sqrt(2 k), sum of delta^2 e = N delta^2).
// Distributions have 4e5 draws on 200 cells: finds 2.3 % (root of the mean square over what is drawn) in 99 of 100 runs.
#include "bsdf/lobe.h"
#include "bsdf/sampling.h"
#include "statistics/agreement.h"
#include <gtest/gtest.h>
#include <random>
#include <set>
#include <utility>

namespace lobe_test {

using namespace alpenglow;
using namespace alpenglow::integrator;

namespace {

using teststat::gammaQ, teststat::kAlpha, teststat::nightly, teststat::samples, teststat::seedBase;

struct Case {
    std::string_view kind;
    LobeParams p;
};
constexpr float kViewers[] = {1.f, 0.7f, 0.3f, 0.05f, 1e-3f, -0.3f}; ///< cosines; the last: the viewer is below the horizon

std::vector<Case> cases() {
    std::vector<Case> all;
    for (float cosine : kViewers)
        for (float azimuth : {0.f, 1.1f, 4.f})
            for (float tilt : {0.f, 0.5236f}) { // the shading normal tilted by 30 degrees
                float s = std::sqrt(1 - cosine * cosine);
                Vec3 wo(s * std::cos(azimuth), s * std::sin(azimuth), cosine);
                Vec3 n(std::sin(tilt), 0, std::cos(tilt));
                Vec3 mirror = n * (2 * dot(n, wo)) - wo;
                for (float e : {4.f, 20.f, 80.f}) {
                    all.push_back({"specular", {n, wo, {}, e}});
                    all.push_back({"phong", {n, wo, {}, e}});
                    all.push_back({"slphong", {mirror, wo, n, e, true}});
                }
                all.push_back({"slphong", {mirror, wo, {}, 30}});
                all.push_back({"diffuse", {n, wo, {}}});
                for (float g : {-.6f, 0.f, .3f, .9f}) all.push_back({"henyey-greenstein", {n, wo, {}, g}});
                for (float g : {-.6f, .3f}) all.push_back({"henyey-greenstein-toward-light", {n, wo, {}, g}});
                for (float cone : {0.2f, 1.f, float(kPi) / 2}) {
                    all.push_back({"uniform", {mirror, wo, {}, cone}});
                    all.push_back({"cosine", {n, wo, {}, cone}});
                    all.push_back({"uniform", {mirror, wo, n, cone, true}});
                }
            }
    return all;
}

// A distribution of the list, whichever it is, with the same parameters: what a kind does not read it does not notice. By viewer,
// four each.
constexpr size_t kDistributionCases = 4;
std::vector<Case> distributionCases(const LobeKind& k) {
    struct Surface {
        float roughness, roughnessv;
        int part;
    };
    constexpr Surface surfaces[kDistributionCases] = {{.2f, .45f, -1}, {.3f, .3f, -1}, {.5f, .4f, 0}, {.4f, .3f, 1}};
    std::vector<Case> all;
    for (float cosine : kViewers)
        for (float azimuth : {0.f, 1.1f, 4.f})
            for (float tilt : {0.f, 0.5236f})
                for (const Surface& s : surfaces) {
                    auto m = std::make_shared<DistributionParams>();
                    m->roughness = s.roughness;
                    m->roughnessv = s.roughnessv;
                    m->udir = Vec3(1, .2f, .1f);
                    m->eta = Color(1.5f, 1.3f, 2);
                    m->absorption = Color(.2f, .4f, .8f);
                    m->part = s.part;
                    const float sine = std::sqrt(1 - cosine * cosine);
                    Case c{k.name,
                           {Vec3(std::sin(tilt), 0, std::cos(tilt)),
                            Vec3(sine * std::cos(azimuth), sine * std::sin(azimuth), cosine),
                            {}}};
                    c.p.more = m;
                    all.push_back(c);
                }
    return all;
}
std::vector<const LobeKind*> distributions() {
    std::vector<const LobeKind*> all;
    for (const LobeKind* k : lobeKinds())
        if (k->distribution) all.push_back(k);
    return all;
}
/// The cases of every kind; of the distributions, whose values take long, here every `stride`-th, nightly all.
std::vector<Case> allCases(size_t stride = 13) {
    std::vector<Case> all = cases();
    for (const LobeKind* k : distributions()) {
        const auto of = distributionCases(*k);
        for (size_t i = 0; i < of.size(); ++i)
            if (nightly() || i % stride == stride - 1) all.push_back(of[i]);
    }
    return all;
}
TEST(LobeCases, EveryKindOfTheListHasCases) {
    std::set<std::string_view> with;
    for (const Case& c : allCases()) with.insert(c.kind);
    for (const LobeKind* k : lobeKinds())
        EXPECT_TRUE(with.count(k->name)) << k->name << " is in the list of lobes, and no case tests it";
    EXPECT_EQ(with.size(), lobeKinds().size());
}

// Integral of the density over a cell of (cos theta, phi): 3 x 3 Gauss points, cells split in four until the parts add up to the
// whole. The grid's pole is the lobe's axis, so that a cone's edge is an edge of cells; a horizon's edge runs through them and is
// closed in on down to `deepest` halvings. What is left there is a strip 2^-8 of a coarse cell wide, half of it in error at
// worst and both ways alike: below 4e-4 of the cell, far under the noise of the counts.
struct Depths {
    int shallowest, deepest;
    double close; ///< what four parts of a cell and the whole may differ by
};
constexpr Depths kCoarse = {3, 8, 1e-7}; ///< a narrow lobe inside a wide cell must not be missed; of 2e5 draws a 50th of one
constexpr Depths kFine = {1, 8, 1e-8};   ///< nightly cells are a fifth as wide
// Whether the edge of the horizon may run through a cell: near the pole it can cut off a sliver between all quadrature points.
bool meetsHorizon(const LobeParams& p, const Basis& grid, double c0, double c1, double p0, double p1) {
    if (!p.hasHorizon) return false;
    auto at = [&](double c, double f) {
        double s = std::sqrt(std::max(0.0, 1 - c * c));
        return grid.toWorld({float(s * std::cos(f)), float(s * std::sin(f)), float(c)});
    };
    Vec3 middle = at((c0 + c1) / 2, (p0 + p1) / 2);
    float reach = 0;
    for (double c : {c0, c1})
        for (double f : {p0, p1}) reach = std::max(reach, length(at(c, f) - middle));
    return std::fabs(dot(p.horizon, middle)) <= 1.5f * reach;
}
double gauss3(const LobeKind& k, const LobeParams& p, const Basis& grid, double c0, double c1, double p0, double p1) {
    static const double x[3] = {-std::sqrt(0.6), 0, std::sqrt(0.6)}, w[3] = {5 / 9.0, 8 / 9.0, 5 / 9.0};
    double sum = 0;
    for (int j = 0; j < 3; ++j) {
        double f = (p0 + p1) / 2 + (p1 - p0) / 2 * x[j], cf = std::cos(f), sf = std::sin(f);
        for (int i = 0; i < 3; ++i) {
            double c = (c0 + c1) / 2 + (c1 - c0) / 2 * x[i], s = std::sqrt(std::max(0.0, 1 - c * c));
            sum += w[i] * w[j] * k.pdf(p, grid.toWorld({float(s * cf), float(s * sf), float(c)}));
        }
    }
    return sum * (c1 - c0) * (p1 - p0) / 4;
}
double cellIntegral(const LobeKind& k, const LobeParams& p, const Basis& grid, double c0, double c1, double p0, double p1,
                    double whole, Depths d, int depth) {
    double c = (c0 + c1) / 2, f = (p0 + p1) / 2;
    double part[4] = {gauss3(k, p, grid, c0, c, p0, f), gauss3(k, p, grid, c, c1, p0, f), gauss3(k, p, grid, c0, c, f, p1),
                      gauss3(k, p, grid, c, c1, f, p1)};
    double sum = part[0] + part[1] + part[2] + part[3];
    // The tolerance is for the whole cell; at the edge errors of neighbours do not add up, so it need not shrink with the area.
    if (depth >= d.deepest ||
        (depth >= d.shallowest && std::fabs(sum - whole) < d.close && !meetsHorizon(p, grid, c0, c1, p0, p1)))
        return sum;
    return cellIntegral(k, p, grid, c0, c, p0, f, part[0], d, depth + 1) +
           cellIntegral(k, p, grid, c, c1, p0, f, part[1], d, depth + 1) +
           cellIntegral(k, p, grid, c0, c, f, p1, part[2], d, depth + 1) +
           cellIntegral(k, p, grid, c, c1, f, p1, part[3], d, depth + 1);
}

// No tolerance but the statistics' own: expectations are integrals to about 1e-6 (nightly 1e-7) of the whole, edges included.
// False: too few cells to test.
bool followsItsDensity(const Case& c, size_t ci, int kN) {
    const int kCos = nightly() ? 51 : 10, kPhi = nightly() ? 102 : 20;
    const LobeKind& k = *findLobe(c.kind);
    Basis grid(c.p.axis);
    // The grid of a cone ends at its edge, so that no cell is cut by it.
    bool cone = c.kind == "uniform" || c.kind == "cosine";
    const double low = cone ? std::cos(double(c.p.a)) : -1, step = (1 - low) / kCos;
    auto cellOf = [&](Vec3 w) {
        // By the way from the axis to w: the cosine of a narrow cone is lost in rounding.
        const Vec3d way = Vec3d(w) - Vec3d(grid.n);
        double phi = std::atan2(dot(way, Vec3d(grid.u)), dot(way, Vec3d(grid.t)));
        return size_t(std::clamp(int((1 - low - dot(way, way) / 2) / step), 0, kCos - 1) * kPhi +
                      std::clamp(int((phi < 0 ? phi + 2 * kPi : phi) / (2 * kPi) * kPhi), 0, kPhi - 1));
    };
    std::mt19937_64 rng(1000 + ci + seedBase());
    std::uniform_real_distribution<double> u01(0, 1);
    std::vector<double> observed(size_t(kCos * kPhi + 1)), expected(size_t(kCos * kPhi + 1));
    for (int i = 0; i < kN; ++i) {
        Vec3 w;
        Vec2 u{std::min(float(u01(rng)), 0x1.fffffep-1f), std::min(float(u01(rng)), 0x1.fffffep-1f)};
        observed[k.sample(c.p, u, w) ? cellOf(w) : observed.size() - 1]++;
    }
    // A highlight's density has a pole at -wo, 1 / (4 wo . h): where that lies above the lobe's plane no quadrature is good
    // there, and its cell counts with the failed draws, whose expectation is what the other cells leave.
    const bool pole = (c.kind == "specular" || k.distribution) && dot(c.p.axis, c.p.wo) < 0.1f;
    const size_t poleCell = cellOf(-c.p.wo);
    double total = 0;
    for (int i = 0; i < kCos; ++i)
        for (int j = 0; j < kPhi; ++j) {
            double c0 = low + step * i, c1 = low + step * (i + 1), p0 = 2 * kPi * j / kPhi, p1 = 2 * kPi * (j + 1) / kPhi;
            double v =
                cellIntegral(k, c.p, grid, c0, c1, p0, p1, gauss3(k, c.p, grid, c0, c1, p0, p1), nightly() ? kFine : kCoarse, 0);
            if (pole && size_t(i * kPhi + j) == poleCell) continue;
            expected[size_t(i * kPhi + j)] = v * kN;
            total += v;
        }
    expected.back() = std::max(0.0, 1 - total) * kN;
    if (pole) observed.back() += std::exchange(observed[poleCell], 0);
    double chi = 0, pooledE = 0, pooledO = 0;
    int dof = -1;
    auto term = [&](double o, double e) {
        chi += (o - e) * (o - e) / e;
        ++dof;
    };
    for (size_t i = 0; i < expected.size(); ++i) {
        if (expected[i] >= 10) {
            term(observed[i], expected[i]);
            continue;
        }
        pooledE += expected[i];
        pooledO += observed[i];
    }
    if (pooledE >= 10) term(pooledO, pooledE);
    else EXPECT_LE(pooledO, 10 + pooledE + 6 * std::sqrt(pooledE + 1)) << c.kind << " case " << ci;
    if (dof < 1) return false;
    double pvalue = gammaQ(0.5 * dof, 0.5 * chi);
    EXPECT_GT(pvalue, kAlpha) << c.kind << " case " << ci << " chi2 " << chi << " dof " << dof;
    return true;
}

// A quarter of the cases each; here a tenth of them, nightly all.
class LobeT1 : public ::testing::TestWithParam<int> {};
TEST_P(LobeT1, SamplersFollowTheirDensities) {
    const size_t stride =
        nightly() ? 4 : 41; // 41: no divisor in common with the 20 cases of one viewer, so all kinds have their turn
    int tested = 0;
    auto all = cases();
    for (size_t ci = size_t(GetParam()) * (nightly() ? 1 : 5); ci < all.size(); ci += stride)
        tested += followsItsDensity(all[ci], ci, samples(60000, 1000000));
    EXPECT_GT(tested, nightly() ? 120 : 10);
}
INSTANTIATE_TEST_SUITE_P(Quarters, LobeT1, ::testing::Range(0, 4));

// Cones as narrow as highlights and suns get: the cells are of the cone itself, from its axis to its edge.
TEST(LobeT1, NarrowCones) {
    size_t ci = 5000;
    for (const char* kind : {"uniform", "cosine"})
        for (float cone : {.003f, .0005f})
            for (Vec3 axis : {Vec3(0, 0, 1), normalize(Vec3(.3f, -.8f, .5f)), normalize(Vec3(-.7f, .1f, -.6f))})
                EXPECT_TRUE(followsItsDensity({kind, {axis, axis, {}, cone}}, ci++, samples(100000, 1000000)))
                    << kind << " " << cone;
}

// Each distribution of the list: here two viewers for each of its parameters, one of them well above the surface; nightly nine,
// on 5,202 cells with 2e6 draws (finds 1.9 %).
class DistributionT1 : public ::testing::TestWithParam<const LobeKind*> {};
TEST_P(DistributionT1, SamplersFollowTheirDensities) {
    const auto all = distributionCases(*GetParam());
    int tested = 0, above = 0; // a surface that is seen from below gives no draws
    for (size_t ci = 0; ci < all.size(); ++ci) {
        const size_t viewer = ci / kDistributionCases, of = ci % kDistributionCases;
        if (!(nightly() ? viewer % 4 == of : viewer % 18 == (of * 5 + 2) % 18)) continue;
        tested += followsItsDensity(all[ci], ci, samples(200000, 2000000));
        above += dot(all[ci].p.axis, all[ci].p.wo) > 0;
    }
    EXPECT_GE(above, int(nightly() ? all.size() / 8 : kDistributionCases));
    EXPECT_GE(tested, above - 1) << "a kind whose every draw fails shows nothing";
}
INSTANTIATE_TEST_SUITE_P(Kinds, DistributionT1, ::testing::ValuesIn(distributions()), [](const auto& i) {
    std::string name(i.param->name);
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
});

// A drawn direction is unit, has a finite value and density, and a density above 0 but for rounding on a lobe's edge: what is
// drawn where pdf says 0 would be lost. Draws: 2,000 a case, nightly 1e5.
TEST(LobeT2, SampledDirectionsHaveFiniteDensityAndValue) {
    for (const Case& c : allCases()) {
        const LobeKind& k = *findLobe(c.kind);
        std::mt19937_64 rng(5 + seedBase());
        std::uniform_real_distribution<float> u01(0, 0x1.fffffep-1f);
        const int n = samples(2000, k.distribution ? 20000 : 100000);
        int lost = 0;
        for (int i = 0; i < n; ++i) {
            Vec3 w;
            if (!k.sample(c.p, {u01(rng), u01(rng)}, w)) continue;
            ASSERT_NEAR(length(w), 1, 1e-5);
            float pdf = k.pdf(c.p, w), f = k.fcos(c.p, w);
            ASSERT_TRUE(std::isfinite(pdf) && std::isfinite(f) && f >= 0 && pdf >= 0) << c.kind;
            lost += !(pdf > 0);
        }
        // With the viewer below the lobe's horizon a highlight may be drawn nearly opposite to it, where its half vector is all
        // rounding.
        EXPECT_LE(lost, 1 + (dot(c.p.axis, c.p.wo) < 0.1f ? 1e-3 : 1e-4) * n)
            << c.kind << " a " << c.p.a << " viewer " << c.p.wo.z;
    }
}

// Where a lobe has a value it has a density, without exception: necessary for an unbiased estimate. 3,000 directions a case,
// nightly 1e5.
TEST(LobeT2, SupportOfTheDensityCoversTheValue) {
    std::mt19937_64 rng(6 + seedBase());
    std::normal_distribution<float> g;
    size_t turn = 0; // 3 is no divisor of the 20 cases of a viewer: all kinds have their turn
    for (const Case& c : allCases()) {
        if (!chosen(turn++, 3)) continue;
        const LobeKind& k = *findLobe(c.kind);
        const int n = samples(3000, k.distribution ? 20000 : 100000);
        for (int i = 0; i < n; ++i) {
            Vec3 w = normalize(Vec3(g(rng), g(rng), g(rng)));
            if (k.fcos(c.p, w) > 0) ASSERT_GT(k.pdf(c.p, w), 0) << c.kind;
        }
    }
}

// T4: the mean of value over density is the lobe's integral, here by midpoints over (cos, phi) about the lobe's own axis. Smooth
// lobes only (no horizon, viewer well above the surface and the lobe's own plane); delta found with 99 % power: 7.1 r / sqrt(N),
// r < 3: 7 % here, below 1 % nightly.
TEST(LobeT4, MeanOfTheWeightsIsTheIntegral) {
    size_t turn = 0; // 3 is no divisor of the 20 cases of a viewer: all kinds have their turn
    for (const Case& c : allCases(29)) {
        if (!chosen(turn++, 3)) continue;
        const LobeKind& k = *findLobe(c.kind);
        if (c.p.hasHorizon || c.p.wo.z < 0.2f || dot(c.p.axis, c.p.wo) < 0.2f || c.kind == "uniform" || c.kind == "cosine")
            continue; // edges: below
        std::mt19937_64 rng(8 + seedBase());
        std::uniform_real_distribution<float> u01(0, 0x1.fffffep-1f);
        const int n = samples(20000, k.distribution ? 50000 : 500000), m = k.distribution ? 256 : 512;
        double sum = 0, square = 0, whole = 0;
        for (int i = 0; i < n; ++i) {
            Vec3 w;
            if (!k.sample(c.p, {u01(rng), u01(rng)}, w)) continue;
            float pdf = k.pdf(c.p, w);
            double x = pdf > 0 ? k.fcos(c.p, w) / double(pdf) : 0;
            sum += x, square += x * x;
        }
        Basis basis(c.p.axis);
        for (int i = 0; i < m; ++i)
            for (int j = 0; j < m / 2; ++j) {
                // Midpoints in s, cos = 1 - s^2 and s^2 - 1: dense about both poles.
                double side = i < m / 2 ? 1 : -1, s = 2 * (i % (m / 2) + 0.5) / m, z = side * (1 - s * s),
                       q = std::sqrt(std::max(0.0, 1 - z * z)), f = 2 * kPi * (j + 0.5) / (m / 2);
                whole += 4 * s / m * 2 * kPi / (m / 2) *
                         k.fcos(c.p, basis.toWorld({float(q * std::cos(f)), float(q * std::sin(f)), float(z)}));
            }
        double mean = sum / n, se = std::sqrt(std::max(0.0, square / n - mean * mean) / n);
        EXPECT_LE(std::fabs(mean - whole), teststat::kZ * se + 4e-3 * whole)
            << c.kind << " a " << c.p.a << ": " << mean << " +- " << se << ", " << whole;
    }
}

// Closed forms: diffuse, uniform and cosine integrate to 1; the density of every lobe integrates to 1 minus the failed draws.
TEST(LobeT4, NormalisationByQuadrature) {
    for (const Case& c : allCases()) {
        const LobeKind& k = *findLobe(c.kind);
        if (c.p.hasHorizon || (c.kind != "diffuse" && c.kind != "cosine")) continue;
        double sum = 0;
        const int n = 400;
        Basis basis(c.p.axis);
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j) {
                double z = (i + 0.5) / n, s = std::sqrt(1 - z * z), f = 2 * kPi * (j + 0.5) / n;
                sum += k.fcos(c.p, basis.toWorld({float(s * std::cos(f)), float(s * std::sin(f)), float(z)}));
            }
        EXPECT_NEAR(sum * 2 * kPi / (double(n) * n), 1, 0.01)
            << c.kind << " cone " << c.p.a; // midpoints across the cone's edge: 1/n
    }
}

TEST(Sampling, PowerHeuristic) {
    EXPECT_EQ(misWeight(0, 5), 0);
    EXPECT_EQ(misWeight(5, 0), 1);
    EXPECT_FLOAT_EQ(misWeight(1, 3) + misWeight(3, 1), 1);
    EXPECT_FLOAT_EQ(misWeight(3, 1), 0.9f);
    EXPECT_EQ(misWeight(1e-30f, 1e30f), 0);
}

TEST(Sampling, BasisIsOrthonormalAtThePoles) {
    for (Vec3 n : {Vec3(0, 0, 1), Vec3(0, 0, -1), Vec3(1, 0, 0), normalize(Vec3(1e-4f, 0, -1))}) {
        Basis b(n);
        EXPECT_NEAR(dot(b.t, b.u), 0, 1e-6);
        EXPECT_NEAR(dot(b.t, b.n), 0, 1e-6);
        EXPECT_NEAR(length(b.t), 1, 1e-6);
        EXPECT_NEAR(length(b.u), 1, 1e-6);
        EXPECT_GT(dot(cross(b.t, b.u), b.n), 0.999f);
    }
}

// The infinite series of interreflection with albedo 0.75 is 4.
TEST(Sampling, RouletteIsUnbiased) {
    std::mt19937_64 rng(9);
    std::uniform_real_distribution<float> u01(0, 1);
    double sum = 0, sq = 0;
    const int n = 400000;
    for (int i = 0; i < n; ++i) {
        double value = 0, throughput = 1;
        for (int depth = 1;; ++depth) {
            value += throughput;
            float q = rouletteLocal(depth, Color(0.75f), u01(rng));
            if (q == 0) break;
            throughput *= 0.75 / q;
        }
        sum += value;
        sq += value * value;
    }
    double mean = sum / n, se = std::sqrt((sq / n - mean * mean) / n);
    EXPECT_LT(std::fabs(mean - 4) / se, 4.753);
}

// Every direction that a narrow cone draws is in it and has the density of the whole, down to 1e-5 radians; far outside there is
// none.
TEST(Lobe, NarrowCones) {
    std::mt19937_64 rng(seedBase() + 11);
    std::uniform_real_distribution<float> u01(0, 0x1.fffffep-1f);
    for (const char* name : {"uniform", "cosine"}) {
        const LobeKind& kind = *findLobe(name);
        for (float a : {1e-5f, 3e-5f, 1e-4f, 3e-4f, 5e-4f, 1e-3f, 1.7e-3f, 3e-3f, 0.01f, 0.1f})
            for (int turn = 0; turn < 20; ++turn) {
                const Vec3 axis = normalize(Vec3(u01(rng) - .5f, u01(rng) - .5f, u01(rng) - .5f));
                LobeParams p;
                p.axis = axis;
                p.a = a;
                const double half = std::sin(0.5 * double(a)), sine = std::sin(double(a));
                const double want = std::string_view(name) == "uniform" ? 1 / (4 * kPi * half * half)
                                                                        : 1 / (kPi * sine * sine); // cos: 1 up to a^2 / 2
                int lost = 0;
                double worst = 0;
                for (int i = 0; i < 500; ++i) {
                    Vec3 w;
                    if (!kind.sample(p, {u01(rng), u01(rng)}, w) || !(kind.pdf(p, w) > 0)) {
                        ++lost;
                        continue;
                    }
                    worst = std::max(worst, std::fabs(kind.pdf(p, w) / want - 1));
                }
                EXPECT_EQ(lost, 0) << name << " " << a;
                EXPECT_LT(worst, double(a) * a + 1e-5) << name << " " << a;
                const Vec3 beside = normalize(axis + Basis(axis).t * (1.1f * a + 1e-6f));
                EXPECT_EQ(kind.pdf(p, beside), 0) << name << " " << a;
            }
    }
}

} // namespace

} // namespace lobe_test
