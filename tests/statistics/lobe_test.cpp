// T1 (sampler against density, chi-square) and T2 (consistency, support) of ../shared testing rules, for every lobe.
// False alarms: alpha = 2e-6 a test. Fixed seeds.
#include "transport/lobe.h"
#include "transport/sampling.h"
#include <gtest/gtest.h>
#include <random>

using namespace alpenglow;
using namespace alpenglow::transport;

namespace {

constexpr double kAlpha = 2e-6;

// Q(a, x), the upper regularised incomplete gamma function, directly (no 1 - P): continued fraction or complement of the series
// where Q is not small. Numerical Recipes' split; double.
double gammaQ(double a, double x) {
    if (x <= 0) return 1;
    if (x < a + 1) {
        double sum = 1 / a, term = sum;
        for (int n = 1; n < 10000 && std::fabs(term) > 1e-17 * std::fabs(sum); ++n) sum += term *= x / (a + n);
        return 1 - sum * std::exp(-x + a * std::log(x) - std::lgamma(a));
    }
    double b = x + 1 - a, c = 1e300, d = 1 / b, h = d;
    for (int i = 1; i < 10000; ++i) {
        double an = -i * (i - a);
        b += 2;
        d = 1 / (an * d + b);
        c = b + an / c;
        double del = d * c;
        h *= del;
        if (std::fabs(del - 1) < 1e-16) break;
    }
    return std::exp(-x + a * std::log(x) - std::lgamma(a)) * h;
}

struct Case { const char* kind; LobeParams p; };

std::vector<Case> cases() {
    std::vector<Case> all;
    for (float cosine : {1.f, 0.7f, 0.3f, 0.05f, 1e-3f})
        for (float azimuth : {0.f, 1.1f, 4.f})
            for (float tilt : {0.f, 0.5236f}) { // the shading normal tilted by 30 degrees
                float s = std::sqrt(1 - cosine * cosine);
                Vec3 wo(s * std::cos(azimuth), s * std::sin(azimuth), cosine);
                Vec3 n(std::sin(tilt), 0, std::cos(tilt));
                Vec3 mirror = n * (2 * dot(n, wo)) - wo;
                for (float e : {4.f, 20.f, 80.f}) {
                    all.push_back({"specular", {n, wo, {}, e}});
                    all.push_back({"phong", {n, wo, {}, e}});
                    all.push_back({"slphong", {mirror, wo, n, e, 0, true}});
                }
                all.push_back({"slphong", {mirror, wo, {}, 30}});
                all.push_back({"diffuse", {n, wo, {}}});
                for (float cone : {0.2f, 1.f, float(kPi) / 2}) {
                    all.push_back({"uniform", {mirror, wo, {}, cone}});
                    all.push_back({"cosine", {n, wo, {}, cone}});
                    all.push_back({"uniform", {mirror, wo, n, cone, 0, true}});
                }
            }
    return all;
}

// Integral of the density over a cell of (cos theta, phi): 3 x 3 Gauss points, cells split in four until the parts add up to the
// whole. The grid's pole is the lobe's axis, so that a cone's edge runs along cells; a horizon's edge runs through them and is
// closed in on down to kDeepest halvings. What is left there is a strip 2^-kDeepest of a cell wide, half of it in error at worst
// and both ways alike: below 1e-4 of the cell, far under the noise of the counts.
constexpr int kShallowest = 3; ///< a narrow lobe inside a wide cell must not be missed
constexpr int kDeepest = 10;
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
double cellIntegral(const LobeKind& k, const LobeParams& p, const Basis& grid, double c0, double c1, double p0, double p1, double whole, int depth) {
    double c = (c0 + c1) / 2, f = (p0 + p1) / 2;
    double part[4] = {gauss3(k, p, grid, c0, c, p0, f), gauss3(k, p, grid, c, c1, p0, f), gauss3(k, p, grid, c0, c, f, p1), gauss3(k, p, grid, c, c1, f, p1)};
    double sum = part[0] + part[1] + part[2] + part[3];
    // The tolerance is for the whole cell; at the edge errors of neighbours do not add up, so it need not shrink with the area.
    if (depth >= kDeepest || (depth >= kShallowest && std::fabs(sum - whole) < 1e-8 && !meetsHorizon(p, grid, c0, c1, p0, p1))) return sum;
    return cellIntegral(k, p, grid, c0, c, p0, f, part[0], depth + 1) + cellIntegral(k, p, grid, c, c1, p0, f, part[1], depth + 1) +
           cellIntegral(k, p, grid, c0, c, f, p1, part[2], depth + 1) + cellIntegral(k, p, grid, c, c1, f, p1, part[3], depth + 1);
}

// No tolerance but the statistics' own: expectations are integrals to about 1e-7 of the whole, edges included.
TEST(LobeT1, SamplersFollowTheirDensities) {
    const int kCos = 10, kPhi = 20, kN = 100000;
    int tested = 0;
    auto all = cases();
    for (size_t ci = 0; ci < all.size(); ci += 5) { // every fifth here; all of them nightly would be 300 s
        const Case& c = all[ci];
        const LobeKind& k = *findLobe(c.kind);
        Basis grid(c.p.axis);
        std::mt19937_64 rng(1000 + ci);
        std::uniform_real_distribution<double> u01(0, 1);
        std::vector<double> observed(kCos * kPhi + 1), expected(kCos * kPhi + 1);
        for (int i = 0; i < kN; ++i) {
            Vec3 w;
            Vec2 u{std::min(float(u01(rng)), 0x1.fffffep-1f), std::min(float(u01(rng)), 0x1.fffffep-1f)};
            if (!k.sample(c.p, u, w)) { observed.back()++; continue; }
            w = {dot(w, grid.t), dot(w, grid.u), dot(w, grid.n)};
            int ic = std::clamp(int((w.z + 1) / 2 * kCos), 0, kCos - 1);
            double phi = std::atan2(w.y, w.x);
            if (phi < 0) phi += 2 * kPi;
            observed[ic * kPhi + std::clamp(int(phi / (2 * kPi) * kPhi), 0, kPhi - 1)]++;
        }
        double total = 0;
        for (int i = 0; i < kCos; ++i)
            for (int j = 0; j < kPhi; ++j) {
                double c0 = -1 + 2.0 * i / kCos, c1 = -1 + 2.0 * (i + 1) / kCos, p0 = 2 * kPi * j / kPhi, p1 = 2 * kPi * (j + 1) / kPhi;
                double v = cellIntegral(k, c.p, grid, c0, c1, p0, p1, gauss3(k, c.p, grid, c0, c1, p0, p1), 0);
                expected[i * kPhi + j] = v * kN;
                total += v;
            }
        expected.back() = std::max(0.0, 1 - total) * kN;
        double chi = 0, pooledE = 0, pooledO = 0;
        int dof = -1;
        auto term = [&](double o, double e) {
            chi += (o - e) * (o - e) / e;
            ++dof;
        };
        for (size_t i = 0; i < expected.size(); ++i) {
            if (expected[i] >= 10) { term(observed[i], expected[i]); continue; }
            pooledE += expected[i]; pooledO += observed[i];
        }
        if (pooledE >= 10) term(pooledO, pooledE);
        else EXPECT_LE(pooledO, 10 + pooledE + 6 * std::sqrt(pooledE + 1)) << c.kind << " case " << ci;
        if (dof < 1) continue;
        double pvalue = gammaQ(0.5 * dof, 0.5 * chi);
        EXPECT_GT(pvalue, kAlpha) << c.kind << " case " << ci << " chi2 " << chi << " dof " << dof;
        ++tested;
    }
    EXPECT_GT(tested, 80);
}

TEST(LobeT2, SampledDirectionsHaveFiniteDensityAndValue) {
    for (const Case& c : cases()) {
        const LobeKind& k = *findLobe(c.kind);
        std::mt19937_64 rng(5);
        std::uniform_real_distribution<float> u01(0, 0x1.fffffep-1f);
        for (int i = 0; i < 2000; ++i) {
            Vec3 w;
            if (!k.sample(c.p, {u01(rng), u01(rng)}, w)) continue;
            ASSERT_NEAR(length(w), 1, 1e-5);
            float pdf = k.pdf(c.p, w), f = k.fcos(c.p, w);
            ASSERT_TRUE(std::isfinite(pdf) && std::isfinite(f) && f >= 0 && pdf >= 0) << c.kind;
        }
    }
}

TEST(LobeT2, SupportOfTheDensityCoversTheValue) {
    std::mt19937_64 rng(6);
    std::normal_distribution<float> g;
    for (const Case& c : cases()) {
        const LobeKind& k = *findLobe(c.kind);
        for (int i = 0; i < 3000; ++i) {
            Vec3 w = normalize(Vec3(g(rng), g(rng), g(rng)));
            if (k.fcos(c.p, w) > 0) ASSERT_GT(k.pdf(c.p, w), 0) << c.kind;
        }
    }
}

// Closed forms: diffuse, uniform and cosine integrate to 1; the density of every lobe integrates to 1 minus the failed draws.
TEST(LobeT4, NormalisationByQuadrature) {
    for (const Case& c : cases()) {
        const LobeKind& k = *findLobe(c.kind);
        if (c.p.hasHorizon || (std::string_view(c.kind) != "diffuse" && std::string_view(c.kind) != "cosine")) continue;
        double sum = 0;
        const int n = 400;
        Basis basis(c.p.axis);
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j) {
                double z = (i + 0.5) / n, s = std::sqrt(1 - z * z), f = 2 * kPi * (j + 0.5) / n;
                sum += k.fcos(c.p, basis.toWorld({float(s * std::cos(f)), float(s * std::sin(f)), float(z)}));
            }
        EXPECT_NEAR(sum * 2 * kPi / (double(n) * n), 1, 0.01) << c.kind << " cone " << c.p.a; // midpoints across the cone's edge: 1/n
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

// pathtracer.md 5.1: the infinite series with albedo 0.75 is 4.
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
        sum += value; sq += value * value;
    }
    double mean = sum / n, se = std::sqrt((sq / n - mean * mean) / n);
    EXPECT_LT(std::fabs(mean - 4) / se, 4.753);
}

} // namespace
