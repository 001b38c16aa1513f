// Media that scatter: against closed forms, against quadrature, and against themselves by other techniques.
#include "integrator/mediumscene.h"
#include <functional>

namespace medium_test {

namespace {
TEST(Medium, AbsorptionIsExactUnderEveryHider) {
    for (const Hider h : kHiders) {
        Scene s(at5(wall() + inside("\"color scattering\" [0 0 0] \"color absorption\" [.2 .5 1.1] \"scale\" 1.5")),
                withShaders(h));
        for (const float x : {0.f, .6f}) {
            const double way = 2 * std::sqrt(1 - x * x);
            const Color c = s.one(along(x));
            int k = 0;
            for (const double a : {.2, .5, 1.1}) EXPECT_NEAR(c[k++], std::exp(-1.5 * a * way), 3e-6) << int(h) << " " << x;
        }
    }
}

TEST(Medium, EmissionIsExactUnderEveryHider) {
    for (const Hider h : kHiders) {
        Scene s(at5(wall("0 0 0") +
                    inside("\"color scattering\" [0 0 0] \"color absorption\" [0 .5 2] \"color emission\" [.3 .3 .3]")),
                withShaders(h));
        const Color c = s.one(along());
        EXPECT_NEAR(c.x, .3 * 2, 2e-6) << int(h);
        EXPECT_NEAR(c.y, .3 * (1 - std::exp(-1.)) / .5, 2e-6) << int(h);
        EXPECT_NEAR(c.z, .3 * (1 - std::exp(-4.)) / 2, 2e-6) << int(h);
    }
}

// Rays whose light fades with the distance, through a medium and a pane in it, and through a wall that bounds nothing there.
TEST(Medium, DimsWhatFades) {
    writeShader("shine", "surface shine() { Oi = Os; Ci = Os * Cs; }\n");
    writeShader("looker", "surface looker() { Oi = 1; Ci = indirectdiffuse(P, vector \"camera\" (0, 0, 1), 1, \"coneangle\", "
                          ".001, \"falloff\", .1); }\n");
    const auto plane = [](const std::string& surface, const std::string& z, const std::string& size) {
        return "AttributeBegin " + surface + " Translate 0 0 " + z + " Scale " + size + " " + size +
               " 1 Polygon \"P\" [-1 -1 0  -1 1 0  1 1 0  1 -1 0] AttributeEnd\n";
    };
    const std::string clear = "\"color scattering\" [0 0 0] \"color absorption\" [.2 .5 1.1]";
    const std::string scene = plane("Surface \"looker\"", "5", "9") +
                              plane("Surface \"shine\" Color .4 .4 .4 Opacity .5 .5 .5", "8", ".4") +
                              plane("Surface \"shine\"", "12", "99") + "Translate 0 0 8\n";
    for (const bool walls : {false, true}) {
        const std::string ball = walls ? inside(clear + " \"priority\" 2") +
                                             inside("\"color scattering\" [0 0 0] \"priority\" 1", "Sphere .6 -.6 .6 360\n")
                                       : inside(clear);
        Scene s(inWorld(scene + ball), withShaders(Hider::Path));
        const Moments m = s.estimate(along(), samples(4000));
        int k = 0;
        for (const double a : {.2, .5, 1.1}) {
            const double want = .5 * .4 * std::exp(-a - .3) + .5 * std::exp(-2 * a - .7);
            EXPECT_NEAR(m.mean(k), want, kZ * m.se(k) + 1e-5) << walls << k << s.messages();
            EXPECT_LE(m.se(k), .02 * want);
            ++k;
        }
    }
}

// Depths of what moves stay with their rays where others of the same shader go on behind walls that bound nothing.
TEST(Medium, DepthsOfWhatMovesBesideSuchWalls) {
    writeShader("shine", "surface shine() { Oi = 1; Ci = Cs; }\n");
    const std::string clear = "\"color scattering\" [0 0 0] \"priority\" ";
    Scene s("Shutter 0 1\n" + inWorld("AttributeBegin Surface \"shine\" MotionBegin [0 1] Translate 0 0 9 Translate 0 0 10 "
                                      "MotionEnd Polygon \"P\" [-9 -9 0  -9 9 0  9 9 0  9 -9 0] AttributeEnd\n" +
                                      inside(clear + "2", "Sphere 50 -50 50 360\n") + "Translate -2 0 5\n" +
                                      inside(clear + "1", "Sphere .5 -.5 .5 360\n", "shine")),
            withShaders(Hider::Hidden));
    std::vector<CameraRay> rays;
    for (int i = 0; i < 40; ++i) {
        rays.push_back(along(i % 3 ? 2.f : -2.f));
        rays.back().px = i;
        rays.back().time = rays.back().shutter = float(i) / 40;
    }
    const auto r = s.trace(rays);
    for (size_t i = 0; i < rays.size(); ++i) EXPECT_NEAR(r[i].z, 9 + rays[i].shutter, 1e-5) << i;
}

TEST(Medium, WhatTheCameraSeesThroughItIsNoMatterOfChance) {
    for (const Hider h : kHiders) {
        Scene s(at5(wall() + inside("\"color scattering\" [.2 .4 .8] \"color absorption\" [.1 .1 .1]")), withShaders(h));
        const auto r = s.trace(std::vector<CameraRay>{along()});
        int k = 0;
        for (const double e : {.3, .5, .9}) {
            if (h != Hider::Path) EXPECT_NEAR(r[0].color[k], std::exp(-2 * e), 3e-6);
            EXPECT_NEAR(r[0].opacity[k++], 1, 1e-6); // the wall behind is opaque
        }
    }
    Scene none(at5(inside("\"color scattering\" [.2 .4 .8] \"color absorption\" [.1 .1 .1]")), withShaders(Hider::Path));
    const auto r = none.trace(std::vector<CameraRay>{along()});
    int k = 0;
    for (const double e : {.3, .5, .9}) EXPECT_NEAR(r[0].opacity[k++], 1 - std::exp(-2 * e), 3e-6);
}

/// Light that is scattered once on the way from a to b, by quadrature: light of a place in a ball about the origin of radius 1.
Color scatteredOnce(const Vec3d& a, const Vec3d& b, const Vec3d& lamp, double intensity, const double* sigmaS,
                    const double* sigmaT, double g) {
    const Vec3d way = b - a;
    const double length = std::sqrt(dot(way, way));
    const Vec3d dir = way / length;
    const int n = 400000;
    double sum[3] = {};
    for (int i = 0; i < n; ++i) {
        const double t = (i + .5) / n * length;
        const Vec3d x = a + dir * t, to = lamp - x;
        const double d2 = dot(to, to), d = std::sqrt(d2), c = dot(to, dir) / d;
        // Inside of the ball on the way to the lamp.
        const Vec3d u = to / d;
        const double xb = dot(x, u), out = -xb + std::sqrt(std::max(0., xb * xb - dot(x, x) + 1)), in = std::min(d, out);
        const double q = 1 + g * g - 2 * g * c, phase = (1 - g * g) / (4 * kPi * q * std::sqrt(q));
        for (int k = 0; k < 3; ++k) sum[k] += sigmaS[k] * std::exp(-sigmaT[k] * (t + in)) * phase * kPi * intensity / d2;
    }
    return Color(float(sum[0] * length / n), float(sum[1] * length / n), float(sum[2] * length / n));
}

class Once : public ::testing::TestWithParam<std::tuple<MediumSampling, float, double>> {};
TEST_P(Once, IsThatOfQuadrature) {
    const auto [how, beside, g] = GetParam();
    const double sigmaS[] = {.4, .8, 1.6}, sigmaT[] = {.5, .8, 2.4};
    Settings set = withShaders(Hider::Path);
    set.mediumSampling = how;
    set.indirect = false;
    const std::string at = std::to_string(beside);
    Scene s(at5("LightSource \"pointlight\" 1 \"intensity\" 3 \"from\" [0 " + at + " .2]\n" +
                inside("\"color scattering\" [.4 .8 1.6] \"color absorption\" [.1 0 .8] \"anisotropy\" " + std::to_string(g))),
            set);
    const Moments m = s.estimate(along(.1f), samples(40000));
    const double half = std::sqrt(1 - .01);
    const Color want = scatteredOnce({.1, 0, -half}, {.1, 0, half}, {0, double(beside), .2f}, 3, sigmaS, sigmaT, g);
    for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(m.mean(k), want[k], kZ * m.se(k) + 1e-5 * want[k]) << k;
        EXPECT_LT(m.se(k), .04 * want[k]) << k;
    }
}
INSTANTIATE_TEST_SUITE_P(Medium, Once,
                         ::testing::Combine(::testing::Values(MediumSampling::Both, MediumSampling::Distance,
                                                              MediumSampling::Equiangular),
                                            ::testing::Values(.3f, 1.7f), // inside of it, and above
                                            ::testing::Values(0., .6, -.7)));

TEST(Medium, PointsNearALampAreWorthTheirWhile) {
    // A lamp close to the way: points by distance alone find it by chance.
    Moments m[2];
    for (int k = 0; k < 2; ++k) {
        Settings set = withShaders(Hider::Path);
        set.mediumSampling = k ? MediumSampling::Distance : MediumSampling::Both;
        set.indirect = false;
        Scene s(at5("LightSource \"pointlight\" 1 \"from\" [0 .05 .2]\n" + inside("\"color scattering\" [.3 .3 .3]")), set);
        m[k] = s.estimate(along(), samples(20000));
    }
    EXPECT_NEAR(m[0].mean(), m[1].mean(), kZ * (m[0].se() + m[1].se()));
    EXPECT_LT(m[0].se(), .3 * m[1].se());
}

// The lamp in thirty-two parts, of which chance chooses some: what is scattered once by quadrature. Cl is irradiance over pi.
TEST(Medium, PointsNearALampOfManyParts) {
    const double sigma = .3, high = .05, deep = .2;
    double want = 0;
    constexpr int n = 20000;
    for (int i = 0; i < n; ++i) {
        const double z = 2 * (i + .5) / n - 1, d2 = high * high + (z - deep) * (z - deep);
        want += sigma * std::exp(-sigma * (z + 1 + std::sqrt(d2))) / 4 / d2 * 2 / n;
    }
    for (const int parts : {1, 32}) {
        std::string lamps;
        for (int i = 1; i <= parts; ++i)
            lamps += "LightSource \"pointlight\" " + std::to_string(i) + " \"from\" [0 .05 .2] \"intensity\" " +
                     std::to_string(1. / parts) + "\n";
        Settings set = withShaders(Hider::Path);
        set.indirect = false;
        Scene s(at5(lamps + inside("\"color scattering\" [.3 .3 .3]")), set);
        expectMean(s.estimate(along(), samples(20000)), want, .02, std::to_string(parts) + " parts");
    }
}

// What is scattered twice and more about a lamp: rays that pass the lamp bring the more the nearer they come, so by the phase
// function alone a few samples bring most of it.
TEST(Medium, RaysThatPassALampBringNoOutliers) {
    Moments m[2];
    for (int k = 0; k < 2; ++k) {
        Settings set = withShaders(Hider::Path);
        set.mediumSampling = k ? MediumSampling::Distance : MediumSampling::Both;
        Scene s(at5("LightSource \"pointlight\" 1 \"from\" [0 .6 .2]\n" +
                    inside("\"color scattering\" [.4 .5 .7] \"anisotropy\" .4")),
                set);
        m[k] = s.estimate(along(), samples(k ? 100000 : 40000));
    }
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(m[0].mean(c), m[1].mean(c), kZ * (m[0].se(c) + m[1].se(c))) << c;
    EXPECT_LT(m[0].se(), .01 * m[0].mean());
}

// The same from surfaces: a small floor in a ball of fog, on which the lamp itself does not shine, sees the fog about the lamp.
// What is scattered once (the fog's depth allows no more) by quadrature over the angle off the lamp, the angle about that axis,
// and along each ray the angle at the lamp: there the sines cancel. The fog before the eye is below 2 parts in a thousand.
TEST(Medium, SurfacesSeeTheFogAboutALampWithoutOutliers) {
    const double sigma = .1, radius = 2, high = 1, aside = .5;
    const Vec3d lamp(aside, high, 0);
    const double far = std::sqrt(dot(lamp, lamp));
    const Vec3d axis = lamp / far, e1(axis.y, -axis.x, 0), e2(0, 0, 1);
    double sum = 0;
    const int n = 160;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const double theta = kPi * (i + .5) / n, phi = 2 * kPi * (j + .5) / n;
            const Vec3d w = axis * std::cos(theta) + (e1 * std::cos(phi) + e2 * std::sin(phi)) * std::sin(theta);
            if (!(w.y > 0)) continue;
            const double near = far * std::cos(theta), away = far * std::sin(theta);
            const double begin = std::atan2(-near, away), end = std::atan2(radius - near, away);
            for (int k = 0; k < n; ++k) {
                const double angle = begin + (k + .5) / n * (end - begin), t = near + away * std::tan(angle);
                // I pi / d^2 dt = I pi / away dangle; the floor gives back cos / pi, the solid angle is sin theta dtheta dphi.
                sum +=
                    w.y / kPi * sigma * std::exp(-sigma * (t + away / std::cos(angle))) / (4 * kPi) * kPi / far * (end - begin);
            }
        }
    const double want = sum * (kPi / n) * (2 * kPi / n) / n;
    Moments m[2];
    for (int k = 0; k < 2; ++k) {
        Settings set = withShaders(Hider::Path);
        set.mediumSampling = k ? MediumSampling::Distance : MediumSampling::Both;
        const std::string fog = "\"color scattering\" [.1 .1 .1]",
                          floor = "Polygon \"P\" [-.01 0 -.01  -.01 0 .01  .01 0 .01  .01 0 -.01]\n";
        Scene s(inWorld("LightSource \"pointlight\" 1 \"from\" [" + std::to_string(aside) + " 1 0]\n" +
                        "AttributeBegin Attribute \"trace\" \"integer maxdiffusedepth\" 0\n" +
                        inside(fog, "Sphere 2 -2 2 360\n") + "AttributeEnd\n" +
                        "AttributeBegin Illuminate 1 0 Surface \"matte\" \"Ka\" 0 \"Kd\" 1 " + floor + "AttributeEnd\n"),
                set);
        m[k] = s.estimate(rayTo({.002f, .005f, 0}, {0, 0, 0}), samples(40000));
        EXPECT_NEAR(m[k].mean(), want, kZ * m[k].se() + .002 * want) << k << s.messages();
    }
    if (samples(40000) >= 40000) EXPECT_LT(m[0].se(), .01 * want); // by the lobe alone .0156
}

TEST(Medium, ASpotLightOutsideOfTheCentreOfItsShader) {
    // A cone from the side: what is scattered once where it crosses the way is by quadrature of both.
    Settings set = withShaders(Hider::Path);
    set.indirect = false;
    Moments m[3];
    for (int k = 0; k < 3; ++k) {
        set.mediumSampling = MediumSampling(k);
        Scene s(at5("LightSource \"spotlight\" 1 \"intensity\" 5 \"from\" [0 2 0] \"to\" [0 0 0] \"coneangle\" .3\n" +
                    inside("\"color scattering\" [.5 .5 .5]")),
                set);
        m[k] = s.estimate(along(), samples(40000));
        EXPECT_GT(m[k].mean(), 0);
    }
    for (int k = 1; k < 3; ++k) EXPECT_NEAR(m[k].mean(), m[0].mean(), kZ * (m[k].se() + m[0].se())) << k;
}

TEST(Medium, AreaLightsByEveryTechnique) {
    const std::string lamp =
        "AttributeBegin AreaLightSource \"arealight\" 1 \"intensity\" 4 Surface \"constant\" Translate 0 2 0 Rotate 90 1 0 0 "
        "Disk 0 .8 360 AttributeEnd\nIlluminate 1 1\n";
    Moments m[3];
    for (int k = 0; k < 3; ++k) {
        Settings set = withShaders(Hider::Path);
        set.bsdfOnly = k == 1;
        set.lightOnly = k == 2;
        Scene s(at5(lamp + inside("\"color scattering\" [1 1.5 2] \"color absorption\" [.2 .2 .2] \"anisotropy\" .4")), set);
        m[k] = s.estimate(along(), samples(20000));
        EXPECT_GT(m[k].mean(), (k == 1 ? 3 : 10) * m[k].se()) << k;
    }
    for (int k = 1; k < 3; ++k)
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(m[k].mean(c), m[0].mean(c), kZ * (m[k].se(c) + m[0].se(c))) << k;
}

TEST(Medium, AFurnaceOfWhatOnlyScattersGivesWhatComesIn) {
    for (const double g : {0., .7}) {
        Scene s(at5("LightSource \"envlight\" 1\n" + inside("\"color scattering\" [3 5 1] \"anisotropy\" " + std::to_string(g))),
                withShaders(Hider::Path));
        const Moments m = s.estimate(along(.2f), samples(20000));
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(m.mean(k), 1, kZ * m.se(k) + 2e-5);
        EXPECT_LT(m.se(), .02);
        Scene grey(at5("LightSource \"envlight\" 1\n" + inside("\"color scattering\" [4 4 4]")), withShaders(Hider::Path));
        EXPECT_NEAR(grey.estimate(along(), 500).mean(), 1, 2e-4); // every single path: rounding only
    }
}

TEST(Medium, OverlapsBelongToTheHigherPriority) {
    // Balls at z -.5 and .5: [-1.5, .5] and [-.5, 1.5]. Boundaries inside of the higher one are not there.
    const auto ball = [](const char* z, const char* absorption, int priority, const char* surface) {
        return "AttributeBegin Translate 0 0 " + std::string(z) + " " +
               inside("\"color scattering\" [0 0 0] \"color absorption\" " + three(absorption) + " \"priority\" " +
                          std::to_string(priority),
                      kBall, surface) +
               "AttributeEnd\n";
    };
    writeShader("red", "surface red() { Oi = 1 - color(1, .5, .5); Ci = 0; }\n");
    for (const Hider h : kHiders) {
        Settings set = withShaders(h);
        Scene first(at5(wall() + ball("-.5", ".3", 2, "null") + ball(".5", ".9", 1, "null")), set);
        EXPECT_NEAR(first.one(along()).x, std::exp(-.3 * 2 - .9 * 1), 3e-6) << int(h);
        Scene second(at5(wall() + ball("-.5", ".3", 1, "null") + ball(".5", ".9", 2, "null")), set);
        EXPECT_NEAR(second.one(along()).x, std::exp(-.3 * 1 - .9 * 2), 3e-6) << int(h);
        Scene equal(at5(wall() + ball("-.5", ".3", 0, "null") + ball(".5", ".9", 0, "null")), set);
        EXPECT_NEAR(equal.one(along()).x, std::exp(-.3 * 1 - .9 * 2), 3e-6) << int(h);
        // Of the lower one's surface what lies in the other is not shaded, nor met by shadow rays.
        Scene red(at5(wall() + ball("-.5", "0", 2, "null") + ball(".5", "0", 1, "red")), set);
        EXPECT_NEAR(red.one(along()).y, .5, 3e-6) << int(h);
        Scene both(at5(wall() + ball("-.5", "0", 1, "red") + ball(".5", "0", 2, "null")), set);
        EXPECT_NEAR(both.one(along()).y, .5, 3e-6) << int(h);
        writeShader("litthrough", "surface litthrough() { Oi = 1; Ci = transmission(P, point \"world\" (0, 0, -2)); }\n");
        Scene shadow(at5("Attribute \"visibility\" \"int transmission\" 1 \"int camera\" 1 AttributeBegin Surface \"litthrough\" "
                         "Polygon \"P\" [-9 -9 2  -9 9 2  9 9 2  9 -9 2] AttributeEnd\n" +
                         ball("-.5", "0", 2, "null") + ball(".5", "0", 1, "red")),
                     set);
        EXPECT_NEAR(shadow.one(rayTo({.2f, 0, 6.8f}, {0, 0, 7})).y, .5, 3e-6) << int(h);
    }
}

TEST(Medium, TheEyeInside) {
    for (const Hider h : kHiders) {
        Scene s(inWorld(wall() + inside("\"color scattering\" [0 0 0] \"color absorption\" [.6 .6 .6]", "Sphere 3 -3 3 360\n")),
                withShaders(h));
        EXPECT_NEAR(s.one(rayTo({0, 0, 0}, {0, 0, 1})).x, std::exp(-.6 * 3), 3e-6) << int(h);
        // As of an orthographic camera, or from a lens: some start inside, some outside.
        EXPECT_NEAR(s.one(along(2)).x, std::exp(-.6 * std::sqrt(5)), 3e-6) << int(h);
        EXPECT_NEAR(s.one(along(4)).x, 1, 3e-6) << int(h);
        EXPECT_NEAR(s.one(rayTo({0, 0, -5}, {0, 0, 1})).x, std::exp(-.6 * 6), 3e-6) << int(h);
    }
}

TEST(Medium, ShadowsAreDimmed) {
    // A floor at y = -2 under a ball of fog under a lamp: without what the fog scatters there.
    Settings set = withShaders(Hider::Path);
    set.maxDepth = 0;
    const std::string lit =
        "LightSource \"pointlight\" 1 \"intensity\" 9 \"from\" [0 3 0]\nAttributeBegin Surface \"matte\" \"Ka\" 0 \"Kd\" 1 "
        "Translate 0 -2 0 " +
        std::string(kFloor) + "AttributeEnd\n";
    const CameraRay below = rayTo({4, -1, 5}, {0, -2, 5});
    Scene with(at5(lit + inside("\"color scattering\" [.2 .4 .6] \"color absorption\" [.1 .1 .1]")), set), without(at5(lit), set);
    const Color a = with.one(below), b = without.one(below);
    int k = 0;
    for (const double e : {.3, .5, .7}) {
        EXPECT_NEAR(a[k] / b[k], std::exp(-2 * e), 3e-6);
        ++k;
    }
}

TEST(Medium, WhatHasNoEndIsCountedAndEnds) {
    // A sheet whose inside is half of space.
    Scene s(at5("LightSource \"envlight\" 1\nReverseOrientation " +
                inside("\"color scattering\" [1 1 1]", "Polygon \"P\" [-9 -9 0  -9 9 0  9 9 0  9 -9 0]\n") +
                "ReverseOrientation " +
                inside("\"color scattering\" [1 1 1]", "Polygon \"P\" [-9 -9 1  -9 9 1  9 9 1  9 -9 1]\n")),
            withShaders(Hider::Path));
    Counters counters;
    const Moments m = s.estimate(along(), 2000, &counters);
    EXPECT_TRUE(std::isfinite(m.mean()));
    uint64_t lost = 0;
    for (const MediumSegments& medium : counters.media) {
        EXPECT_LE(medium.lost, medium.all);
        lost += medium.lost;
    }
    EXPECT_GT(lost, 100u); // the renderer reports them: cli/Said.OpenMedia
}

TEST(Medium, WhatIsNoNumberOrNotTheSameEverywhereIsSaid) {
    writeShader("patchy", "volume patchy(output color __scattering = 0;) { __scattering = abs(xcomp(P)); Ci *= .5; }\n");
    Scene patchy(at5(wall() + "AttributeBegin Surface \"null\" Interior \"patchy\" " + kBall + "AttributeEnd\n"),
                 withShaders(Hider::Path));
    EXPECT_NEAR(patchy.one(along()).x, .5, 1e-6); // as the shader has it
    EXPECT_NE(patchy.messages().find("not the same everywhere"), std::string::npos) << patchy.messages();
    Scene negative(at5(wall() + inside("\"color scattering\" [-1 0 0] \"color absorption\" [.5 .5 .5]")),
                   withShaders(Hider::Path));
    EXPECT_NEAR(negative.one(along()).x, std::exp(-1.), 3e-6);
    EXPECT_NE(negative.messages().find("__scattering"), std::string::npos) << negative.messages();
}

TEST(Medium, NoBitDependsOnWhoSharesABatch) {
    const std::string rib =
        at5("LightSource \"pointlight\" 1 \"from\" [.2 .4 0] LightSource \"envlight\" 2 \"intensity\" .2\n" + wall(".2 .3 .4") +
            inside("\"color scattering\" [1 2 3] \"anisotropy\" .5 \"priority\" 1") + "AttributeBegin Translate .5 0 .5 " +
            inside("\"color scattering\" [.3 .3 .3] \"color absorption\" [.1 .2 .4]") +
            "AttributeEnd AttributeBegin Surface \"matte\" Translate 0 -.9 0 Sphere .3 -.3 .3 360 AttributeEnd\n");
    std::vector<CameraRay> rays;
    for (int i = 0; i < 200; ++i) {
        rays.push_back(along(float(i) * .012f - 1.2f));
        rays.back().px = i;
    }
    std::vector<Color> first;
    for (const int lanes : {16, 4, 8}) {
        Settings set = withShaders(Hider::Path);
        set.lanes = lanes;
        Scene s(rib, set);
        const auto all = s.trace(rays);
        if (first.empty())
            for (const SampleResult& r : all) first.push_back(r.color);
        for (size_t i = 0; i < rays.size(); ++i) EXPECT_EQ(all[i].color, first[i]) << lanes << " " << i;
        for (size_t i = 0; i < rays.size(); i += 17) EXPECT_EQ(s.trace({&rays[i], 1})[0].color, first[i]) << "alone, " << lanes;
    }
}

TEST(Slfog, ItsThreeModesAreExact) {
    struct Mode {
        const char* given;
        std::function<double(double)> f;
    };
    const Mode modes[] = {{"\"mode\" 0 \"start\" 3 \"end\" 20", [](double z) { return (20 - z) / 17; }},
                          {"\"mode\" 1 \"density\" .07", [](double z) { return std::exp(-.07 * z); }},
                          {"\"mode\" 2 \"density\" .07", [](double z) { return std::exp(-.07 * z * .07 * z); }},
                          {"\"mode\" 0 \"start\" 1 \"end\" 8", [](double z) { return (8 - z) / 7; }}, // beyond its end
                          {"\"mode\" 1 \"density\" .07 \"clipfar\" 5", [](double) { return std::exp(-.35); }}};
    const double fog[] = {.2, .5, .9}, seen[] = {.8, .3, .6};
    for (const Hider h : kHiders)
        for (const Mode& m : modes) {
            Scene s(
                inWorld("Atmosphere \"slfog\" " + std::string(m.given) + " \"color fogcolor\" [.2 .5 .9]\n" + wall(".8 .3 .6")),
                withShaders(h));
            const Color c = s.one(rayTo({0, 0, 0}, {0, 0, 1})); // the wall is 9 away
            const double f = m.f(9);
            for (int k = 0; k < 3; ++k)
                EXPECT_NEAR(c[k], std::clamp(f * seen[k] + (1 - f) * fog[k], 0., 1.), 2e-6) << int(h) << " " << m.given;
        }
    // The far plane of Clipping is where it ends by itself.
    Scene s("Clipping 1 4\n" + inWorld("Atmosphere \"slfog\" \"mode\" 1 \"density\" .1 \"color fogcolor\" [0 0 0]\n" + wall()),
            withShaders(Hider::Raytrace));
    EXPECT_NEAR(s.one(rayTo({0, 0, 0}, {0, 0, 1})).x, std::exp(-.4), 2e-6);
}

} // namespace

} // namespace medium_test
