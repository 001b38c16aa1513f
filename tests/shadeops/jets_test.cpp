// Values against the double reference, and first and second derivatives of every symbol of the runtime against central
// differences of it.
#define ALPENGLOW_REFERENCE "../tests/shadeops/reference_lanes.h"
#include "jets_runtime.h"
#include "shadeops/descriptor.h"
#include "shadeops/host_runtime.h"
#include "shadeops/runtime.h"
#include <cmath>
#include <cstring>
#include <gtest/gtest.h>
#include <random>
#include <string>

namespace jets_test {

using namespace alpenglow::shadeops;

namespace {

/// Where the inputs of a symbol are drawn from: the interior of its domain.
struct Domain {
    float lo = -2, hi = 2;
};

bool starts(std::string_view s, std::string_view prefix) { return s.substr(0, prefix.size()) == prefix; }

Domain domainOf(std::string_view symbol, int input, int inputs) {
    if (starts(symbol, "al_asin") || starts(symbol, "al_acos")) return {-0.9f, 0.9f};
    if (symbol == "al_sqrt" || symbol == "al_inversesqrt" || symbol == "al_log") return {0.2f, 9};
    if (symbol == "al_logbase") return {1.5f, 9};
    if (symbol == "al_pow") return input == 0 ? Domain{0.2f, 3} : Domain{-3, 3};
    if (symbol == "al_specularbrdf")
        return input == 9 ? Domain{4, 16} : input == 2 || input == 5 || input == 8 ? Domain{1, 2} : Domain{-0.7f, 0.7f};
    if (starts(symbol, "al_fresnel"))
        return input == 2   ? Domain{-1, -0.8f}
               : input == 5 ? Domain{0.8f, 1}
               : input == 6 ? Domain{0.5f, 0.8f}
                            : Domain{-0.2f, 0.2f};
    if (starts(symbol, "al_rgb") || starts(symbol, "al_hs") || starts(symbol, "al_yiq") || starts(symbol, "al_xyz"))
        return {0.05f, 0.95f};
    if (starts(symbol, "al_splinesolve")) { // rising control points, a value between the middle ones
        if (starts(symbol, "al_splinesolve_hermite"))
            return input == 0   ? Domain{0.3f, 0.7f}
                   : input == 1 ? Domain{-0.1f, 0.1f}
                   : input == 3 ? Domain{0.9f, 1.1f}
                                : Domain{0.8f, 1.2f};
        return input == 0 ? Domain{1.3f, 1.7f}
                          : Domain{static_cast<float>(input - 1) - 0.1f, static_cast<float>(input - 1) + 0.1f};
    }
    if (symbol == "al_splinesegment") return input == 0 ? Domain{0, 1} : Domain{5, 5};
    if (starts(symbol, "al_bsdf")) {
        const bool hair = symbol == "al_bsdf_hair", glass = symbol == "al_bsdf_glassggx";
        const bool cone = symbol == "al_bsdf_uniform" || symbol == "al_bsdf_cosine";
        if (hair) { // across the fibre, away from where the bell is cut off; second lobe inside
            static constexpr Domain kHair[] = {{1, 2}, {-1, 1}, {-0.5f, 0.5f}, {-0.2f, 0.2f}, {-0.2f, 0.2f},
                                               {1, 2}, {1, 2},  {-1, 1},       {-0.5f, 0.5f}};
            if (input < 9) return kHair[input];
            if (input < 12) return {0.2f, 0.4f}; // eccentricity
            if (input == 12) return {1.4f, 1.7f};
            if (input < 16) return {0.1f, 1};
            if (input == 16) return {2.5f, 2.5f};
            return input == 17 ? Domain{-0.1f, 0.1f} : Domain{0.5f, 0.9f};
        }
        if (cone && input == 6) return {1.2f, 1.5f};
        if (glass && input == 2) return {-2, -1}; // refraction
        if (input < 9) return input % 3 == 2 ? Domain{1, 2} : glass ? Domain{-0.3f, 0.3f} : Domain{-0.7f, 0.7f};
        if (symbol == "al_bsdf_ward" || symbol == "al_bsdf_ashikhminshirley" || glass) {
            if (input == 9) return {1, 2}; // udir
            if (input < 12) return {-0.5f, 0.5f};
            if (input < 14) return {0.5f, 0.9f};
        } else if (input == 9) {
            return {0.5f, 0.9f};
        }
        return {1.3f, 1.6f};
    }
    if (starts(symbol, "al_pnoise") && input >= inputs / 2) return {7, 7};
    return {};
}

struct Polynomial { // x(u, v) to second order
    float part[6];
    double at(double u, double v) const {
        return part[0] + part[1] * u + part[2] * v + 0.5 * part[3] * u * u + part[4] * u * v + 0.5 * part[5] * v * v;
    }
};

// A looked-up value gets the derivatives of its coordinates times its slopes, and none from the slopes' own.
TEST(Jets, Chain) {
    const float in[] = {7,
                        1,
                        1,
                        1,
                        1,
                        1,
                        /* slopes */ 2,
                        1,
                        1,
                        1,
                        1,
                        1,
                        3,
                        1,
                        1,
                        1,
                        1,
                        1,
                        /* coordinates */ .5f,
                        10,
                        20,
                        30,
                        40,
                        50,
                        .25f,
                        1,
                        2,
                        3,
                        4,
                        5};
    float out[6];
    ASSERT_TRUE(evaluateRuntimeJet("al_chain2_f", 2, in, 30, out, 6));
    const float want[] = {7, 23, 46, 69, 92, 115};
    for (int k = 0; k < 6; ++k) EXPECT_EQ(out[k], want[k]) << k;
    // With second derivatives 4, 5 and 6 of the map: a parabola over the coordinates.
    float curved[48] = {7, 1, 1, 1, 1, 1, 2, 1, 1, 1, 1, 1, 3, 1, 1, 1, 1, 1,
                        4, 1, 1, 1, 1, 1, 5, 1, 1, 1, 1, 1, 6, 1, 1, 1, 1, 1};
    std::copy_n(in + 18, 12, curved + 36);
    ASSERT_TRUE(evaluateRuntimeJet("al_chain2c_f", 2, curved, 48, out, 6));
    const float parabola[] = {7, 23, 46, 69 + 400 + 100 + 6, 92 + 800 + 200 + 12, 115 + 1600 + 400 + 24};
    for (int k = 0; k < 6; ++k) EXPECT_EQ(out[k], parabola[k]) << k;
    float t[60] = {}, r[9];
    for (int c = 0; c < 3; ++c) {
        t[3 * c] = float(c + 1);               // the value
        t[9 + 3 * c] = float(2 + c);           // by x
        t[18 + 3 * c] = 1;                     // by y
        t[27 + 3 * c] = 0;                     // by z
        t[36 + 3 * c + 1] = float(c + 1) * 10; // d/du of the direction
        t[36 + 3 * c + 2] = float(c + 1);
    }
    ASSERT_TRUE(evaluateRuntimeJet("al_chain3_t", 1, t, 45, r, 9));
    for (int c = 0; c < 3; ++c) {
        EXPECT_EQ(r[3 * c], float(c + 1));
        EXPECT_EQ(r[3 * c + 1], float(2 + c) * 10 + 20);
        EXPECT_EQ(r[3 * c + 2], float(2 + c) + 2);
    }
}

/// What a symbol gives in double precision at a place near the point.
std::vector<double> referenceAt(const reference::RuntimeEntry& entry, const std::vector<Polynomial>& x, double u, double v) {
    std::vector<reference::vf> in(entry.in), out(entry.out);
    for (int i = 0; i < entry.in; ++i) in[i] = reference::vf(x[i].at(u, v));
    entry.order[0](in.data(), out.data());
    std::vector<double> r(entry.out);
    for (int i = 0; i < entry.out; ++i) r[i] = out[i][0];
    return r;
}

/// Value and derivatives of it at the point, by central differences of step h.
std::vector<std::array<double, 6>> differences(const reference::RuntimeEntry& entry, const std::vector<Polynomial>& x, double h) {
    const auto value = [&](double u, double v) { return referenceAt(entry, x, u, v); };
    const auto c = value(0, 0), e = value(h, 0), w = value(-h, 0), n = value(0, h), s = value(0, -h), ne = value(h, h),
               nw = value(-h, h), se = value(h, -h), sw = value(-h, -h);
    std::vector<std::array<double, 6>> r(entry.out);
    for (int i = 0; i < entry.out; ++i)
        r[i] = {c[i],
                (e[i] - w[i]) / (2 * h),
                (n[i] - s[i]) / (2 * h),
                (e[i] - 2 * c[i] + w[i]) / (h * h),
                (ne[i] - nw[i] - se[i] + sw[i]) / (4 * h * h),
                (n[i] - 2 * c[i] + s[i]) / (h * h)};
    return r;
}

class Jets : public testing::TestWithParam<int> {};

TEST(Jets, EveryRuntimeSymbolAgainstCentralDifferences) {
    std::mt19937 random(1);
    const auto draw = [&](float lo, float hi) { return lo + (hi - lo) * std::generate_canonical<float, 24>(random); };
    int symbols = 0;
    for (const auto& entry : reference::kEntries) {
        const std::string name(entry.symbol);
        if (starts(name, "al_random")) continue; // takes a hash, not a number
        if (starts(name, "al_chain")) continue;  // takes slopes that count as constant: below
        ++symbols;
        const RuntimeShape shape = runtimeShape(name);
        ASSERT_EQ(shape.in, entry.in) << name;
        ASSERT_EQ(shape.out, entry.out) << name;
        const bool matrix = starts(name, "al_transform") || name == "al_translate" || name == "al_scale" ||
                            name == "al_rotatematrix" || name == "al_inverse" || name == "al_determinant" ||
                            name == "al_multiply";
        int used = 0, failures = 0;
        const int kPoints = 60;
        for (int point = 0; point < kPoints && failures < 3; ++point) {
            std::vector<Polynomial> x(entry.in);
            for (int i = 0; i < entry.in; ++i) {
                const Domain d = domainOf(name, i, entry.in);
                const bool fixed = d.lo == d.hi;
                x[i].part[0] = draw(d.lo, d.hi);
                if (matrix && (i < 16 || name == "al_multiply"))
                    x[i].part[0] = 0.25f * x[i].part[0] + (i % 16 % 5 == 0 ? 1.5f : 0);
                for (int k = 1; k < 6; ++k) x[i].part[k] = fixed ? 0 : draw(-1, 1);
            }
            const auto coarse = differences(entry, x, 2e-4), fine = differences(entry, x, 1e-4);
            bool smooth = true; // no kink within the stencil
            for (int i = 0; i < entry.out; ++i)
                for (int k = 0; k < 6; ++k)
                    smooth = smooth && std::abs(coarse[i][k] - fine[i][k]) <= 1e-4 * (1 + std::abs(fine[i][k]));
            if (!smooth) continue;
            ++used;
            std::vector<float> in2, in1, in0;
            for (const Polynomial& p : x) {
                in2.insert(in2.end(), p.part, p.part + 6);
                in1.insert(in1.end(), p.part, p.part + 3);
                in0.push_back(p.part[0]);
            }
            std::vector<float> out2(6 * entry.out), out1(3 * entry.out), out0(entry.out);
            ASSERT_TRUE(evaluateRuntimeJet(name, 2, in2.data(), int(in2.size()), out2.data(), int(out2.size()))) << name;
            ASSERT_TRUE(evaluateRuntimeJet(name, 1, in1.data(), int(in1.size()), out1.data(), int(out1.size()))) << name;
            ASSERT_TRUE(evaluateRuntime(name, in0.data(), int(in0.size()), out0.data(), int(out0.size()))) << name;
            for (int i = 0; i < entry.out; ++i) {
                double scale = 1e-3;
                for (int k = 0; k < 6; ++k) scale = std::max(scale, std::abs(fine[i][k]));
                for (int k = 0; k < 6; ++k) {
                    const double tolerance = k == 0 ? 1e-5 * scale : 1e-3 * std::max(std::abs(fine[i][k]), 0.05 * scale);
                    if (!(std::abs(out2[6 * i + k] - fine[i][k]) <= tolerance)) {
                        ++failures;
                        ADD_FAILURE() << name << " output " << i << " part " << k << ": " << out2[6 * i + k] << ", differences "
                                      << fine[i][k];
                    }
                }
                // the three orders agree to the bit
                EXPECT_EQ(0, std::memcmp(&out2[6 * i], &out0[i], sizeof(float))) << name;
                EXPECT_EQ(0, std::memcmp(&out1[3 * i], &out0[i], sizeof(float))) << name;
                for (int k = 1; k < 3; ++k) EXPECT_EQ(out1[3 * i + k], out2[6 * i + k]) << name;
            }
        }
        EXPECT_GE(used, kPoints / 3) << name << ": too few points away from kinks";
    }
    EXPECT_GT(symbols, 100);
}

} // namespace

} // namespace jets_test
