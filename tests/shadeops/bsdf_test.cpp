// The distributions of bsdf(): closed forms, reciprocity, and that they give back no more light than arrives.
#include "shadeops/descriptor.h"
#include "shadeops/host_runtime.h"
#include <array>
#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <random>
#include <string>

namespace bsdf_test {

using namespace alpenglow::shadeops;

namespace {

using V = std::array<float, 3>;
constexpr double kPi = 3.14159265358979323846;
const V kUp{0, 0, 1}, kAlong{1, 0, 0};

V direction(double theta, double phi) {
    return {float(std::sin(theta) * std::cos(phi)), float(std::sin(theta) * std::sin(phi)), float(std::cos(theta))};
}

/// First value of a symbol; the arguments one after the other.
std::vector<float> call(const std::string& symbol, std::vector<float> in) {
    const RuntimeShape shape = runtimeShape(symbol);
    std::vector<float> out(size_t(std::max(1, shape.out)));
    EXPECT_TRUE(evaluateRuntime(symbol, in.data(), int(in.size()), out.data(), int(out.size()))) << symbol;
    return out;
}
void append(std::vector<float>& in, const V& v) { in.insert(in.end(), v.begin(), v.end()); }

/// The value for one direction of light and one of view, with the normal up.
using Model = std::function<double(const V& l, const V& o)>;

/// Models that need rows of vectors, then numbers.
Model model(const std::string& symbol, bool udir, const std::vector<float>& numbers, size_t part = 0) {
    return [=](const V& l, const V& o) {
        std::vector<float> in;
        append(in, l), append(in, kUp), append(in, o);
        if (udir) append(in, kAlong);
        in.insert(in.end(), numbers.begin(), numbers.end());
        return double(call(symbol, in)[part]);
    };
}
Model lambert(const std::string& symbol, float cone) {
    return [=](const V& l, const V&) {
        std::vector<float> in;
        append(in, l), append(in, kUp), in.push_back(cone);
        return double(call(symbol, in)[0]);
    };
}
Model glass(std::vector<float> numbers, size_t part) { // roughness, roughnessv, eta
    numbers.insert(numbers.end(), {0, 0});
    return model("al_bsdf_glassggx", true, numbers, part);
}

/// Integral over all directions of light.
double albedo(const Model& f, const V& o, int steps = 160) {
    double sum = 0;
    for (int i = 0; i < steps; ++i)
        for (int j = 0; j < 2 * steps; ++j) {
            const double z = -1 + (i + 0.5) * 2 / steps, phi = (j + 0.5) * kPi / steps;
            sum += f(direction(std::acos(z), phi), o);
        }
    return sum * (2.0 / steps) * (kPi / steps);
}

struct Case {
    const char* name;
    Model f;
};
const std::vector<float> kFull = {0, 0, 0, 0, 0, 0}; // eta and k: no Fresnel factor
std::vector<float> with(std::vector<float> a, const std::vector<float>& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}
std::vector<Case> surfaces() {
    return {{"oren-nayar", model("al_bsdf_orennayar", false, {0.6f})},
            {"blinn", model("al_bsdf_blinn", false, with({0.4f}, kFull))},
            {"ashikhmin-shirley", model("al_bsdf_ashikhminshirley", true, with({0.4f, 0.6f}, kFull))},
            {"cook-torrance", model("al_bsdf_cooktorrance", false, with({0.5f}, {0.2f, 2, 3, 3, 1, 4}))},
            {"ward", model("al_bsdf_ward", true, {0.3f, 0.5f})},
            {"ggx", model("al_bsdf_ggx", true, with({0.4f, 0.6f}, {0.2f, 2, 3, 3, 1, 4}))},
            {"beckmann", model("al_bsdf_beckmann", true, with({0.3f, 0.6f}, kFull))}};
}

TEST(Bsdf, Reciprocity) {
    std::mt19937 random(2);
    const auto draw = [&](double lo, double hi) { return lo + (hi - lo) * std::generate_canonical<double, 30>(random); };
    for (const Case& c : surfaces())
        for (int i = 0; i < 200; ++i) {
            const V l = direction(draw(0, 1.4), draw(0, 6)), o = direction(draw(0, 1.4), draw(0, 6));
            const double a = c.f(l, o) / l[2], b = c.f(o, l) / o[2];
            EXPECT_NEAR(a, b, 2e-4 * std::max({a, b, 1e-3})) << c.name;
        }
    // Refracted light counts as energy: a factor of the square of the index on the side of the light is left.
    const Model reflected = glass({0.4f, 0.6f, 1.5f}, 0), refracted = glass({0.4f, 0.6f, 1.5f}, 1);
    for (int i = 0; i < 200; ++i) {
        const double phi = draw(0, 6);
        const V l = direction(draw(0, 1.4), phi), o = direction(draw(0, 1.4), draw(0, 6)),
                below = direction(kPi - draw(0, 0.6), phi + kPi);
        const double a = reflected(l, o) / l[2], b = reflected(o, l) / o[2];
        EXPECT_NEAR(a, b, 2e-4 * std::max({a, b, 1e-3}));
        const double in = refracted(below, l) / -below[2] / (1.5 * 1.5), out = refracted(l, below) / l[2];
        EXPECT_NEAR(in, out, 1e-3 * std::max({in, out, 1e-3}));
    }
    // Hair, tip up: the cosine is the one with the plane across the fibre.
    for (const float lobe : {0.0f, 1.0f, 2.0f, 3.0f})
        for (int i = 0; i < 60; ++i) {
            const Model hair = model("al_bsdf_hair", false, {0.3f, 0.2f, 0, 1.55f, 0.2f, 0.4f, 0.9f, lobe, 0, 0.4f, 0.5f});
            const double tl = draw(0.3, 2.8), to = draw(0.3, 2.8);
            const V l = direction(tl, draw(0, 6)), o = direction(to, draw(0, 6));
            const double a = hair(l, o) / std::sin(tl), b = hair(o, l) / std::sin(to);
            EXPECT_NEAR(a, b, 3e-3 * std::max({a, b, 1e-3})) << lobe;
        }
}

TEST(Bsdf, NoMoreLightThanArrives) {
    for (const Case& c : surfaces())
        for (const double theta : {0.05, 0.4, 0.8, 1.2, 1.45}) {
            const double a = albedo(c.f, direction(theta, 0.7));
            EXPECT_LE(a, 1.001) << c.name << " at " << theta;
            EXPECT_GT(a, 0.05) << c.name << " at " << theta;
        }
    for (const double theta : {0.05, 0.8, 1.3, kPi - 0.3, kPi - 1.0}) { // from both sides
        const V o = direction(theta, 0.7);
        const double sum = albedo(glass({0.3f, 0.5f, 1.5f}, 0), o) + albedo(glass({0.3f, 0.5f, 1.5f}, 1), o);
        EXPECT_LE(sum, 1.001) << theta;
        EXPECT_GT(sum, 0.7) << theta;
    }
}

TEST(Bsdf, DiffuseOnesAreExact) {
    const V o = direction(0.6, 0);
    // Roughness 0 is Lambert's law; the weight of diffuse() is PI times it.
    const Model smooth = model("al_bsdf_orennayar", false, {0});
    for (const double theta : {0.0, 0.5, 1.0, 1.5}) {
        EXPECT_NEAR(smooth(direction(theta, 1), o), std::cos(theta) / kPi, 1e-7);
        EXPECT_NEAR(lambert("al_bsdf_cosine", float(kPi / 2))(direction(theta, 1), o), std::cos(theta) / kPi, 1e-7);
        EXPECT_NEAR(lambert("al_bsdf_uniform", float(kPi / 2))(direction(theta, 1), o), 0.5 / kPi, 1e-7);
    }
    EXPECT_NEAR(albedo(smooth, o), 1, 1e-3);
    for (const float cone : {0.3f, 0.8f, 1.5f}) {
        EXPECT_NEAR(lambert("al_bsdf_cosine", cone)(kUp, o) * kPi * std::pow(std::sin(cone), 2), 1, 1e-5) << cone;
        EXPECT_NEAR(lambert("al_bsdf_uniform", cone)(kUp, o) * 2 * kPi * (1 - std::cos(cone)), 1, 1e-5) << cone;
    }
    EXPECT_EQ(lambert("al_bsdf_uniform", 1)(direction(1.1, 0), o), 0);
    EXPECT_EQ(lambert("al_bsdf_cosine", 1)(direction(1.1, 0), o), 0);
    EXPECT_EQ(lambert("al_bsdf_cosine", 0)(kUp, o), 0) << "a cone of one direction has no value";
    // Oren and Nayar's own formula with angles.
    const double s2 = 0.36, A = 1 - 0.5 * s2 / (s2 + 0.33), B = 0.45 * s2 / (s2 + 0.09);
    const Model rough = model("al_bsdf_orennayar", false, {0.6f});
    for (const double phi : {0.2, 1.0, 2.0, 3.0}) {
        const double tl = 0.9, to = 0.4;
        const double expected = std::cos(tl) / kPi * (A + B * std::max(0.0, std::cos(phi)) * std::sin(tl) * std::tan(to));
        EXPECT_NEAR(rough(direction(tl, phi), direction(to, 0)), expected, 1e-6);
    }
}

/// Half vector's angle and azimuth for light and view at angles in one plane.
TEST(Bsdf, FacetFormulas) {
    const double tl = 0.7, to = 0.3; // on opposite sides: h is 0.2 from the normal
    const V l = direction(tl, 0), o = direction(to, kPi);
    const double th = (tl - to) / 2, td = (tl + to) / 2, nl = std::cos(tl), no = std::cos(to), nh = std::cos(th),
                 oh = std::cos(td);
    const double G = std::min({1.0, 2 * nh * no / oh, 2 * nh * nl / oh});
    const double e = std::pow(0.5, -3.5) - 1;
    EXPECT_NEAR(model("al_bsdf_blinn", false, with({0.5f}, kFull))(l, o), (e + 2) / (2 * kPi) * std::pow(nh, e) * G / (4 * no),
                1e-5);
    const double m = 0.4, beckmann = std::exp(-std::pow(std::tan(th) / m, 2)) / (kPi * m * m * std::pow(nh, 4));
    EXPECT_NEAR(model("al_bsdf_cooktorrance", false, with({0.4f}, kFull))(l, o), beckmann * G / (4 * no), 1e-5);
    // Light and view lie in the plane of udir, so only roughness counts.
    EXPECT_NEAR(model("al_bsdf_ward", true, {0.3f, 0.7f})(l, o),
                std::sqrt(nl / no) * std::exp(-std::pow(std::tan(th) / 0.3, 2)) / (4 * kPi * 0.3 * 0.7), 1e-5);
    const double eu = std::pow(0.4, -3.5) - 1, ev = std::pow(0.8, -3.5) - 1;
    EXPECT_NEAR(model("al_bsdf_ashikhminshirley", true, with({0.4f, 0.8f}, kFull))(l, o),
                nl * std::sqrt((eu + 1) * (ev + 1)) / (8 * kPi) * std::pow(nh, eu) / (oh * std::max(nl, no)), 1e-4);
    // Smith's facets with both heights: G = 1 / (1 + A(l) + A(o)), of the roughness along udir.
    const auto smith = [&](double a, const auto& lambda) {
        return 1 / (1 + lambda(1 / (a * std::tan(tl))) + lambda(1 / (a * std::tan(to))));
    };
    const auto ggxLambda = [](double x) { return (std::sqrt(1 + 1 / (x * x)) - 1) / 2; };
    const auto beckmannLambda = [](double x) { return (std::exp(-x * x) / (x * std::sqrt(kPi)) - std::erfc(x)) / 2; };
    for (const double a : {0.05, 0.4, 1.5}) {
        const double t = std::tan(th) / a, ggx = 1 / (kPi * a * 0.7 * std::pow(nh, 4) * std::pow(1 + t * t, 2)),
                     gauss = std::exp(-t * t) / (kPi * a * 0.7 * std::pow(nh, 4));
        const double first = ggx * smith(a, ggxLambda) / (4 * no), second = gauss * smith(a, beckmannLambda) / (4 * no);
        EXPECT_NEAR(model("al_bsdf_ggx", true, with({float(a), 0.7f}, kFull))(l, o), first, 1e-5 * first);
        EXPECT_NEAR(model("al_bsdf_beckmann", true, with({float(a), 0.7f}, kFull))(l, o), second, 4e-5 * second);
    }
    // Fresnel's factor: glass at normal incidence 0.04, per channel; a conductor ((n-1)^2 + k^2) / ((n+1)^2 + k^2).
    std::vector<float> in;
    append(in, kUp), append(in, kUp), append(in, kUp);
    const auto full = call("al_bsdf_cooktorrance", with(in, with({0.5f}, kFull)));
    const auto metal = call("al_bsdf_cooktorrance", with(in, {0.5f, 1.5f, 0.2f, 0, 0, 3, 7}));
    EXPECT_NEAR(metal[0] / full[0], 0.04, 1e-6);
    EXPECT_NEAR(metal[1] / full[1], (0.64 + 9) / (1.44 + 9), 1e-5);
    EXPECT_EQ(metal[2], full[2]) << "index 0: no Fresnel factor";
    // The mean slope of the facets: each distribution projects to 1.
    for (const auto& [symbol, udir] : {std::pair{"al_bsdf_blinn", false}, {"al_bsdf_cooktorrance", false}}) {
        double sum = 0; // integral of D (n . h) = 4 f / G with light and view both along h, seen at right angles to the facet
        const int steps = 2000;
        for (int i = 0; i < steps; ++i) {
            const double t = (i + 0.5) * kPi / 2 / steps;
            const V h = direction(t, 0);
            const double g = std::min(1.0, 2 * std::cos(t) * std::cos(t));
            sum += 4 * std::cos(t) * model(symbol, udir, with({0.4f}, kFull))(h, h) / g * std::cos(t) * std::sin(t) * kPi / 2 /
                   steps * 2 * kPi;
        }
        EXPECT_NEAR(sum, 1, 2e-3) << symbol;
    }
}

TEST(Bsdf, Glass) {
    // Normal incidence, light along the normal: F D G / 4 with D = 1 / (PI a b), G = 1.
    std::vector<float> in;
    append(in, kUp), append(in, kUp), append(in, kUp), append(in, kAlong);
    const auto r = call("al_bsdf_glassggx", with(in, {0.2f, 0.4f, 1.5f, 0, 0}));
    EXPECT_NEAR(r[0], 0.04 / (kPi * 0.08) / 4, 1e-5);
    EXPECT_EQ(r[1], 0);
    // Straight through: h is the normal; (1 - F) D 1.5^2 / (1 - 1.5)^2.
    in.clear();
    append(in, {0, 0, -1}), append(in, kUp), append(in, kUp), append(in, kAlong);
    const auto t = call("al_bsdf_glassggx", with(in, {0.2f, 0.4f, 1.5f, 0, 0}));
    EXPECT_EQ(t[0], 0);
    EXPECT_NEAR(t[1], 0.96 / (kPi * 0.08) * 2.25 / 0.25, 2e-3);
    // A smooth surface sends light where Snell's law says: the value is largest there.
    const V o = direction(0.8, 0);
    const double exact = kPi - std::asin(std::sin(0.8) / 1.5);
    const Model f = glass({0.02f, 0.02f, 1.5f}, 1);
    EXPECT_GT(f(direction(exact, kPi), o), 20 * f(direction(exact + 0.1, kPi), o));
    EXPECT_GT(f(direction(exact, kPi), o), 20 * f(direction(exact - 0.1, kPi), o));
    // From inside beyond the critical angle nothing leaves.
    EXPECT_NEAR(albedo(glass({0.02f, 0.02f, 1.5f}, 1), direction(kPi - 1.1, 0), 60), 0, 1e-3);
}

TEST(Bsdf, Hair) {
    const auto lobe = [](float which, float tilt, float along, float around, V absorption, V udir = {0, 0, 0}) {
        return model("al_bsdf_hair", false,
                     {udir[0], udir[1], udir[2], 1.55f, absorption[0], absorption[1], absorption[2], which, tilt, along, around});
    };
    // All lobes together keep less than arrives, and without absorption most of it (what is left are higher lobes, and what
    // reciprocity takes).
    for (const double theta : {kPi / 2, 1.1, 0.6})
        for (const V& udir : {V{0, 0, 0}, V{0.6f, 0, 0}}) {
            double sum = 0;
            for (const float p : {0.0f, 1.0f, 2.0f, 3.0f})
                sum += albedo(lobe(p, 0, 0.4f, 0.4f, {0, 0, 0}, udir), direction(theta, 0.3), 50);
            EXPECT_LE(sum, 1.005) << theta;
            if (udir[0] == 0) EXPECT_GE(sum, 0.85) << theta; // what is left of an elliptic section is not known
        }
    // R at a right angle to the fibre: the mean Fresnel reflectance over its width.
    double mean = 0;
    const int steps = 4000;
    for (int i = 0; i < steps; ++i) {
        const double h = (i + 0.5) / steps, c = std::sqrt(1 - h * h), t = std::sqrt(1 - (1 - c * c) / (1.55 * 1.55));
        const double rs = (c - 1.55 * t) / (c + 1.55 * t), rp = (t - 1.55 * c) / (t + 1.55 * c);
        mean += (rs * rs + rp * rp) / 2 / steps;
    }
    EXPECT_NEAR(albedo(lobe(0, 0, 0.1f, 0.3f, {0, 0, 0}), direction(kPi / 2, 0), 120), mean, 0.03 * mean);
    // The scales turn the highlight: R peaks at 2 tilt, TT at -tilt.
    for (const auto& [p, factor] : {std::pair{0.0f, 2.0}, {1.0f, -1.0}, {2.0f, -4.0}}) {
        double best = -1, at = 0;
        for (double a = -0.6; a <= 0.6; a += 0.005) { // inclination toward the tip
            const double v =
                lobe(p, 0.1f, 0.15f, 0.5f, {0, 0, 0})(direction(kPi / 2 - a, p == 1 ? kPi : 0), direction(kPi / 2, 0));
            if (v > best) best = v, at = a;
        }
        EXPECT_NEAR(at, factor * 0.1, 0.02) << p;
    }
    // Absorption leaves R as it is and takes from the others, channel by channel.
    std::vector<float> in;
    append(in, direction(1.4, 0.5)), append(in, kUp), append(in, direction(1.5, 0)), append(in, {0, 0, 0});
    const auto clear = call("al_bsdf_hair", with(in, {1.55f, 0, 0, 0, 2, 0, 0.4f, 0.4f}));
    const auto dark = call("al_bsdf_hair", with(in, {1.55f, 0, 0.5f, 2, 2, 0, 0.4f, 0.4f}));
    EXPECT_EQ(clear[0], dark[0]);
    EXPECT_LT(dark[1], clear[1]);
    EXPECT_LT(dark[2], dark[1]);
    const auto first = call("al_bsdf_hair", with(in, {1.55f, 0, 0.5f, 2, 0, 0, 0.4f, 0.4f}));
    EXPECT_EQ(first[0], first[2]);
}

TEST(Bsdf, BelowTheSurfaceAndOddInputs) {
    for (const Case& c : surfaces()) {
        EXPECT_EQ(c.f(direction(2, 0), direction(0.4, 1)), 0) << c.name;
        EXPECT_EQ(c.f(direction(0.4, 0), direction(2, 1)), 0) << c.name;
        for (const V& odd : {V{0, 0, 0}, V{1e20f, 0, 0}, V{0, 0, 1e-30f}}) {
            EXPECT_TRUE(std::isfinite(c.f(odd, kUp))) << c.name;
            EXPECT_TRUE(std::isfinite(c.f(kUp, odd))) << c.name;
        }
    }
    for (const float p : {0.0f, 1.0f, 2.0f, 3.0f})
        for (const V& l : {kUp, V{0, 0, -1}, kAlong, V{0, 0, 0}})
            for (const float rough : {0.0f, 1.0f, 5.0f})
                EXPECT_TRUE(
                    std::isfinite(model("al_bsdf_hair", false, {0.3f, 9, 0, 1.55f, 1, 1, 1, p, 0.1f, rough, rough})(l, kAlong)))
                    << p;
    for (const float rough : {0.0f, 1e-6f, 3.0f}) {
        EXPECT_TRUE(std::isfinite(model("al_bsdf_blinn", false, with({rough}, kFull))(kUp, kUp)));
        EXPECT_TRUE(std::isfinite(model("al_bsdf_ward", true, {rough, rough})(kUp, kUp)));
        EXPECT_TRUE(std::isfinite(model("al_bsdf_ggx", true, with({rough, rough}, kFull))(kUp, kUp)));
        EXPECT_TRUE(std::isfinite(model("al_bsdf_beckmann", true, with({rough, rough}, kFull))(kUp, kUp)));
        EXPECT_TRUE(std::isfinite(glass({rough, rough, 1.0f}, 1)(direction(kPi, 0), kUp)));
    }
}

} // namespace

} // namespace bsdf_test
