// Media that only scatter, any number of times: against solutions of the equation of transfer, of a half space and of a slab.
#include "integrator/mediumscene.h"

namespace medium_test {
namespace {

/// Chandrasekhar's H of isotropic scattering, on 400 points of a plain rule.
struct H {
    std::vector<double> at, h;
    explicit H(double albedo) {
        const int n = 400;
        for (int i = 0; i < n; ++i) at.push_back((i + .5) / n);
        h.assign(size_t(n), 1);
        for (int round = 0; round < 300; ++round) {
            std::vector<double> next;
            for (const double m : at) {
                double sum = std::sqrt(1 - albedo);
                for (int k = 0; k < n; ++k) sum += albedo / 2 * at[size_t(k)] * h[size_t(k)] / (m + at[size_t(k)]) / n;
                next.push_back(1 / sum);
            }
            for (int k = 0; k < n; ++k) h[size_t(k)] = .5 * (h[size_t(k)] + next[size_t(k)]);
        }
    }
    double operator()(double m) const { return h[size_t(std::min(399., m * 400))]; }
};

TEST(Medium, AHalfSpaceReflectsAsChandrasekharHasIt) {
    // Light straight down on a half space, which a large ball stands for; radiance F w / 4 m0 / (m + m0) H(m) H(m0), pi F the
    // light.
    for (const double albedo : {.5, .9}) {
        const std::string ss = three(std::to_string(albedo)), aa = three(std::to_string(1 - albedo));
        Scene s(at5("LightSource \"distantlight\" 1 \"from\" [0 1 0] \"to\" [0 0 0]\nTranslate 0 -1000 0\n" +
                    inside("\"color scattering\" " + ss + " \"color absorption\" " + aa, "Sphere 1000 -1000 1000 360\n")),
                withShaders(Hider::Path));
        const H h(albedo);
        for (const float tilt : {0.f, 1.f}) {
            const Vec3 from(std::sin(tilt), std::cos(tilt), 0);
            const Moments m = s.estimate(rayTo(from + Vec3(0, 0, 5), {0, 0, 5}), samples(60000));
            const double mu = std::cos(tilt), want = albedo / 4 / (mu + 1) * h(mu * .9999) * h(.9999);
            EXPECT_NEAR(m.mean(), want, kZ * m.se() + 2e-3 * want)
                << albedo << " " << tilt; // mean free path over radius, and the rule
            EXPECT_LT(m.se(), .01 * want);
        }
    }
}

/// The source function of a slab of isotropic scattering, `depth` mean free paths deep, under light straight down of which pi F
/// comes with F = 1: S(t) = albedo (1/2 integral of E1(|t - t'|) S(t') + exp(-t) / 4). In 400 layers, of which the kernel is
/// integrated exactly.
struct Slab {
    double depth, step;
    std::vector<double> s;
    static double e2(double x) {
        double sum = 0;
        for (int i = 0; i < 4000; ++i) sum += std::exp(-x * 4000 / (i + .5)) / 4000;
        return x > 0 ? sum : 1;
    }
    Slab(double albedo, double d, int n = 400) : depth(d), step(d / n), s(size_t(n), 0) {
        std::vector<double> kernel{2 * (1 - e2(step / 2))}; // by the distance of layers
        for (int k = 1; k < n; ++k) kernel.push_back(e2((k - .5) * step) - e2((k + .5) * step));
        for (int round = 0; round < 200; ++round) {
            std::vector<double> next;
            for (int i = 0; i < n; ++i) {
                double sum = std::exp(-(i + .5) * step) / 4;
                for (int k = 0; k < n; ++k) sum += .5 * kernel[size_t(std::abs(i - k))] * s[size_t(k)];
                next.push_back(albedo * sum);
            }
            s = next;
        }
    }
    double out(double mu, bool above) const {
        double sum = 0;
        for (size_t i = 0; i < s.size(); ++i) {
            const double t = (double(i) + .5) * step;
            sum += s[i] * std::exp(-(above ? t : depth - t) / mu) * step / mu;
        }
        return sum;
    }
};

// What comes back from a slab, and what comes through it: light that is scattered any number of times.
TEST(Medium, ASlabReflectsAndLetsThroughAsItsEquationSays) {
    const std::string faces =
        "ReverseOrientation PointsPolygons [4 4 4 4 4 4] [0 1 3 2  4 6 7 5  0 4 5 1  2 3 7 6  0 2 6 4  1 5 7 3] \"P\" "
        "[-100 -1 -100  100 -1 -100  -100 0 -100  100 0 -100  -100 -1 100  100 -1 100  -100 0 100  100 0 100]\n";
    EXPECT_NEAR(Slab(.5, 12).out(1, true), .5 / 8 * H(.5)(.9999) * H(.5)(.9999), 2e-4); // deep enough, it is the half space
    struct Case {
        double albedo, depth;
    };
    for (const Case& c : {Case{.9, 1}, {.99, 2}}) {
        const Slab slab(c.albedo, c.depth);
        Scene s(at5("LightSource \"distantlight\" 1 \"from\" [0 1 0] \"to\" [0 0 0]\n" +
                    inside("\"color scattering\" " + three(std::to_string(c.albedo * c.depth)) + " \"color absorption\" " +
                               three(std::to_string((1 - c.albedo) * c.depth)),
                           faces)),
                withShaders(Hider::Path));
        for (const float tilt : {0.f, 1.f})
            for (const bool above : {true, false}) {
                const Vec3 at(0, above ? 0.f : -1.f, 5),
                    from = at + Vec3(std::sin(tilt), std::cos(tilt) * (above ? 1.f : -1.f), 0);
                const Moments m = s.estimate(rayTo(from, at), samples(40000));
                const double want = slab.out(double(std::cos(tilt)), above);
                EXPECT_NEAR(m.mean(), want, kZ * m.se() + 1e-3 * want)
                    << c.albedo << " " << c.depth << " " << tilt << " " << above;
                EXPECT_LT(m.se(), .01 * want);
            }
    }
}

} // namespace
} // namespace medium_test
