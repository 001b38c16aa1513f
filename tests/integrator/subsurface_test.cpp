// subsurface(): walks below surfaces against the half space of Chandrasekhar, furnaces, and the closed forms of the diffusion
// models.
#include "bsdf/dipole.h"
#include "integrator/floorscene.h"
#include "integrator/subsurface.h"
#include <random>

namespace subsurface_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

class Subsurface : public ::testing::Test {
protected:
    void SetUp() override {
        writeShader(
            "skin",
            "surface skin(color sc = 1, ab = 0; float ior = 1, sc_ = 1; string group = \"\";) { Oi = 1;\n"
            "    Ci = subsurface(P, normalize(N), \"scattering\", sc, \"absorption\", ab, \"ior\", ior, \"scale\", sc_); }\n");
        writeShader("plain", "surface plain() { Oi = 1; Ci = subsurface(P); }\n");
        writeShader(
            "dipole",
            "surface dipole(float ior = 1.3; color r = .5, mfp = 1;) { Oi = 1;\n"
            "    Ci = subsurface(P, N, \"model\", \"jensen\", \"reflectance\", r, \"meanfreepath\", mfp, \"ior\", ior); }\n");
        writeShader(
            "better",
            "surface better(float ior = 1.3; color r = .5, mfp = 1;) { Oi = 1;\n"
            "    Ci = subsurface(P, N, \"model\", \"grosjean\", \"reflectance\", r, \"meanfreepath\", mfp, \"ior\", ior); }\n");
        writeShader("coloured",
                    "surface coloured(color r = .5; float ior = 1.3;) { Oi = 1;\n"
                    "    Ci = subsurface(\"raytrace\", P, N, \"reflectance\", r, \"meanfreepath\", .2, \"ior\", ior); }\n");
        writeShader(
            "waits",
            "surface waits(color r = .5;) { Oi = 1; color c = subsurface(P, N, \"reflectance\", r, \"meanfreepath\", .2);\n"
            "    Ci = (c == color(0)) ? color(0) : c; }\n");
    }
};
const std::string kSky = "LightSource \"envlight\" 1\n";
const std::string kAbove = "LightSource \"distantlight\" 1 \"intensity\" .5 \"from\" [0 1 0] \"to\" [0 0 0]\n";

/// What the half space gives back by walks through its layers, an independent one-dimensional count. Isotropic scattering.
double counted(double albedo, double index, int n) {
    std::mt19937_64 random(5);
    const auto u = [&] { return std::generate_canonical<double, 53>(random); };
    double sum = 0, all = 0;
    for (int i = 0; i < n; ++i) {
        const double outside = std::sqrt(u()), inside = std::sqrt(1 - (1 - outside * outside) / (index * index));
        const double enters = 1 - fresnelInside(inside, index);
        all += enters;
        double depth = 0, mu = inside, weight = enters;
        for (int k = 0; k < 5000; ++k) {
            depth += mu * -std::log(1 - u());
            if (depth <= 0) {
                // Back to the surface: how much goes out and how much is reflected.
                const double f = fresnelInside(-mu, index);
                sum += weight * (1 - f);
                weight *= f;
                mu = -mu;
                depth = 0;
            } else {
                weight *= albedo;
                mu = 2 * u() - 1;
            }
            if (weight < 1e-9) break;
        }
    }
    return sum / all;
}

TEST_F(Subsurface, TheHalfSpaceOfTheTableIsThatOfACount) {
    // A count that reflects at the surface and walks on with a fresh distance: distances forget.
    size_t turn = 0;
    for (const double index : {1., 1.3, 1.5, .8}) {
        size_t of = turn++;
        for (const double albedo : {.3, .9}) {
            if (!chosen(of++, 2)) continue;
            const int n = samples(16000, 400000); // finds .014, nightly .003
            EXPECT_NEAR(AlbedoInversion(index).reflectance(albedo), counted(albedo, index, n), 3.5 * .5 / std::sqrt(double(n)))
                << index << " " << albedo;
        }
    }
    const AlbedoInversion h(1.3);
    for (const double r : {.01, .2, .5, .8, .97}) EXPECT_NEAR(h.reflectance(h.albedo(r)), r, 1e-9);
    EXPECT_EQ(h.albedo(0), 0);
    EXPECT_EQ(h.reflectance(1), 1);
}

TEST_F(Subsurface, WithoutABoundaryItIsChandrasekhars) {
    // 1 - 2 sqrt(1 - w) int H(m) m dm, by H on a plain rule.
    for (const double w : {.2, .6, .95}) {
        const int n = 800;
        std::vector<double> h(n, 1), next(n);
        double moved = 1;
        for (int round = 0; round < 200 && moved > 1e-9; ++round) {
            moved = 0;
            for (int i = 0; i < n; ++i) {
                double sum = std::sqrt(1 - w);
                for (int k = 0; k < n; ++k) sum += w / 2 * (k + .5) / n * h[size_t(k)] / ((i + .5) / n + (k + .5) / n) / n;
                next[size_t(i)] = 1 / sum;
            }
            for (int i = 0; i < n; ++i) {
                moved = std::max(moved, std::fabs(next[size_t(i)] - h[size_t(i)]));
                h[size_t(i)] = .5 * (h[size_t(i)] + next[size_t(i)]);
            }
        }
        double first = 0;
        for (int i = 0; i < n; ++i) first += (i + .5) / n * h[size_t(i)] / n;
        EXPECT_NEAR(AlbedoInversion(1).reflectance(w), 1 - 2 * std::sqrt(1 - w) * first, 2e-4) << w;
    }
}

TEST_F(Subsurface, AFurnaceGivesWhatComesIn) {
    for (const char* ior : {"1", "1.3"})
        for (const char* shape : {"Sphere 1 -1 1 360\n", "Rotate 20 1 2 0 Torus .8 .3 0 360 360\n"}) {
            Scene s(
                inWorld(kSky + "Translate 0 0 5 Surface \"skin\" \"color sc\" [3 2 5] \"ior\" " + std::string(ior) + " " + shape),
                withShaders(Hider::Path));
            const Moments m = s.estimate(rayTo({.7f, .1f, 0}, {.7f, .1f, 5}), samples(20000));
            for (int k = 0; k < 3; ++k) EXPECT_NEAR(m.mean(k), 1, kZ * m.se(k) + 1e-4) << ior << shape << k;
            EXPECT_LT(m.se(), .02);
        }
}

// Of walls that are no lights comes light of surfaces, of which the energy rule lets a surface give back no more than it
// receives.
TEST_F(Subsurface, AFurnaceOfWallsGivesNoMoreThanComesIn) {
    writeShader("skintwice", "surface skintwice() { Oi = 1; Ci = 2 * subsurface(P, normalize(N), \"scattering\", color(3, 2, 5), "
                             "\"absorption\", color 0, \"ior\", 1); }\n");
    Scene s(
        inWorld(
            "AttributeBegin Attribute \"visibility\" \"int diffuse\" 1 \"int specular\" 1 Surface \"constant\" Color .5 .5 .5 "
            "Sphere 50 -50 50 360 AttributeEnd\nTranslate 0 0 5 Surface \"skintwice\" Sphere 1 -1 1 360\n"),
        withShaders(Hider::Path));
    const Moments m = s.estimate(rayTo({.7f, .1f, 0}, {.7f, .1f, 5}), samples(20000));
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(m.mean(k), .5, kZ * m.se(k) + 1e-4) << k;
    EXPECT_LT(m.se(), .01);
}

TEST_F(Subsurface, AHalfSpaceReflectsAsTheClosedFormHasIt) {
    for (const Hider h : {Hider::Hidden, Hider::Raytrace, Hider::Path})
        for (const char* ior : {"1", "1.375"}) {
            Scene s(inWorld(kAbove + "Surface \"skin\" \"color sc\" [.3 .8 .99] \"color ab\" [.7 .2 .01] \"sc_\" 20 \"ior\" " +
                            std::string(ior) + " " + kFloor),
                    withShaders(h));
            const Moments m = s.estimate(kView, h == Hider::Path ? samples(20000) : 1500); // of 16 walks each
            int k = 0;
            const AlbedoInversion half(std::atof(ior));
            for (const double albedo : {.3, .8, .99}) {
                const double want = .5 * half.reflectance(albedo);
                EXPECT_NEAR(m.mean(k), want, kZ * m.se(k) + 1e-5) << int(h) << " " << ior << " " << k;
                EXPECT_LT(m.se(k), .03 * want);
                ++k;
            }
        }
}

TEST_F(Subsurface, AReflectanceThatIsAskedForIsSeen) {
    for (const char* shader : {"coloured", "waits"})
        for (const Hider h : {Hider::Hidden, Hider::Path}) {
            Scene s(inWorld(kAbove + "Surface \"" + std::string(shader) + "\" \"color r\" [.2 .5 .9] " + kFloor), withShaders(h));
            const Moments m = s.estimate(kView, h == Hider::Path ? samples(4000) : 600);
            int k = 0;
            for (const double r : {.2, .5, .9}) {
                EXPECT_NEAR(m.mean(k), .5 * r, kZ * m.se(k) + 2e-5) << shader << int(h) << k;
                ++k;
            }
        }
    // The same by attributes.
    Scene s(
        inWorld(kAbove +
                "Attribute \"subsurface\" \"color reflectance\" [.2 .5 .9] \"color meanfreepath\" [.1 .1 .1] \"float scale\" 2 "
                "\"float refractionindex\" 1.5 Surface \"plain\" " +
                kFloor),
        withShaders(Hider::Path));
    const Moments m = s.estimate(kView, samples(4000));
    int k = 0;
    for (const double r : {.2, .5, .9}) {
        EXPECT_NEAR(m.mean(k), .5 * r, kZ * m.se(k) + 2e-5);
        ++k;
    }
}

TEST_F(Subsurface, TheDiffusionModelsAreTheirIntegrals) {
    for (const char* shader : {"dipole", "better"})
        for (const char* ior : {"1", "1.3"}) {
            Scene s(inWorld(kAbove + "Surface \"" + std::string(shader) +
                            "\" \"color r\" [.2 .5 .8] \"color mfp\" [.1 .05 .2] \"ior\" " + ior + " " + kFloor),
                    withShaders(Hider::Path));
            const Moments m = s.estimate(kView, samples(30000));
            int k = 0;
            for (const double r : {.2, .5, .8}) {
                EXPECT_NEAR(m.mean(k), .5 * r, kZ * m.se(k) + 1e-5) << shader << ior << k;
                EXPECT_LT(m.se(k), .03 * r);
                ++k;
            }
        }
    // The total is the integral over the plane.
    for (const bool better : {false, true}) {
        const Dipole d(AlbedoInversion(1.3), better, .1, .9);
        double sum = 0, chosen = 0;
        const int n = 400000;
        for (int i = 0; i < n; ++i) {
            const double r = std::exp((i + .5) / n * 24 - 14), dr = r * 24 / n;
            sum += d.at(r) * 2 * kPi * r * dr;
            chosen += d.density(r) * 2 * kPi * r * dr;
        }
        EXPECT_NEAR(sum, d.total(), 1e-5 * d.total());
        EXPECT_NEAR(chosen, 1, 1e-4);
    }
    // Jensen's reflectance (2001, equation 5, summed up): a' / 2 (1 + exp(-4/3 A sqrt(3 (1 - a')))) exp(-sqrt(3 (1 - a'))).
    const double a = .9, root = std::sqrt(3 * (1 - a));
    EXPECT_NEAR(Dipole(AlbedoInversion(1), false, .1, .9).total(), a / 2 * (1 + std::exp(-4 / 3. * root)) * std::exp(-root),
                1e-12);
}

// Where nothing is scattered in one colour the others are as bright as without it.
TEST_F(Subsurface, TheDiffusionModelsOfSomeColoursAlone) {
    writeShader("some", "surface some(color sc = 1, ab = .1;) { Oi = 1; Ci = subsurface(P, N, \"model\", \"jensen\", "
                        "\"scattering\", sc, \"absorption\", ab, \"ior\", 1); }\n");
    const double absorbs[3] = {2, 1, 3};
    for (int dark = 0; dark < 3; ++dark) {
        double scatters[3] = {20, 40, 30};
        scatters[dark] = 0;
        char text[200];
        std::snprintf(text, sizeof text, "Surface \"some\" \"color sc\" [%g %g %g] \"color ab\" [%g %g %g] ", scatters[0],
                      scatters[1], scatters[2], absorbs[0], absorbs[1], absorbs[2]);
        Scene s(inWorld(kAbove + text + kFloor), withShaders(Hider::Path));
        const Moments m = s.estimate(kView, samples(20000));
        for (int k = 0; k < 3; ++k) {
            const double want = k == dark ? 0 : .5 * Dipole(AlbedoInversion(1), false, absorbs[k], scatters[k]).total();
            EXPECT_NEAR(m.mean(k), want, kZ * m.se(k) + 1e-5) << dark << k;
            EXPECT_LE(m.se(k), .03 * want) << dark << k;
        }
    }
}

TEST_F(Subsurface, GroupsBoundOneInside) {
    // Two halves of a ball with attributes of their own: alone each is open, together they are a ball, of which a furnace
    // gives 1.
    const auto halves = [](const std::string& group) {
        return "Translate 0 0 5 AttributeBegin " + group +
               "Surface \"skin\" \"color sc\" [.5 .5 .5] Sphere 1 0 1 360 AttributeEnd AttributeBegin " + group +
               "Surface \"skin\" \"color sc\" [.5 .5 .5] Sphere 1 -1 0 360 AttributeEnd\n";
    };
    const CameraRay ray = rayTo({.3f, .1f, 0}, {.3f, .1f, 5});
    Scene one(inWorld(kSky + halves("Attribute \"subsurface\" \"string groupname\" \"ball\" ")), withShaders(Hider::Path));
    const Moments m = one.estimate(ray, samples(5000));
    EXPECT_NEAR(m.mean(), 1, kZ * m.se() + 1e-3); // a walk may slip through where both end
    Scene apart(inWorld(kSky + halves("")), withShaders(Hider::Path));
    EXPECT_TRUE(std::isfinite(apart.estimate(ray, 2000).mean()));
    // What comes out of a half whose own shader asks for no light is lit there all the same.
    const std::string group = "Attribute \"subsurface\" \"string groupname\" \"ball\" ";
    Scene mute(inWorld(kSky + "Translate 0 0 5 AttributeBegin " + group +
                       "Surface \"constant\" Sphere 1 0 1 360 AttributeEnd AttributeBegin " + group +
                       "Surface \"skin\" \"color sc\" [.5 .5 .5] Sphere 1 -1 0 360 AttributeEnd\n"),
               withShaders(Hider::Path));
    const Moments half = mute.estimate(ray, samples(5000));
    EXPECT_NEAR(half.mean(), 1, kZ * half.se() + 1e-3);
    // Balls that overlap in a group are one.
    Scene both(inWorld(kSky + "Attribute \"subsurface\" \"string groupname\" \"pair\" Surface \"skin\" \"color sc\" [.7 .7 .7] "
                              "Translate -.4 0 5 Sphere 1 -1 1 360 Translate .8 0 0 Sphere 1 -1 1 360\n"),
               withShaders(Hider::Path));
    const Moments b = both.estimate(rayTo({.2f, .1f, 0}, {.2f, .1f, 5}), samples(5000));
    EXPECT_NEAR(b.mean(), 1, kZ * b.se() + 1e-3);
}

TEST_F(Subsurface, ScaleIsMillimetresInAUnit) {
    const auto seen = [](const std::string& values) {
        Scene s(inWorld("LightSource \"pointlight\" 1 \"from\" [0 2 3] Translate 0 0 5 Surface \"skin\" " + values +
                        " Sphere 1 -1 1 360\n"),
                withShaders(Hider::Path));
        return s.estimate(rayTo({.3f, .1f, 0}, {.3f, .1f, 5}), 300).mean();
    };
    EXPECT_EQ(seen("\"color sc\" [3 3 3] \"color ab\" [.5 .5 .5] \"sc_\" 2"),
              seen("\"color sc\" [6 6 6] \"color ab\" [1 1 1] \"sc_\" 1"));
}

// "albedo" is a reflectance; on a plane under even light no path length changes what comes back.
TEST_F(Subsurface, OtherNamesOfParameters) {
    writeShader(
        "named",
        "surface named() { Oi = 1; Ci = subsurface(P, N, \"albedo\", color(.5), \"meanfreepath\", .2, \"ior\", 1.3); }\n");
    writeShader("diffusely", "surface diffusely() { Oi = 1; Ci = subsurface(P, N, \"model\", \"jensen\", \"albedo\", color(.5), "
                             "\"diffusemeanfreepath\", .2, \"ior\", 1.3); }\n");
    const auto seen = [](const std::string& shader) {
        return Scene(inWorld(kAbove + "Surface \"" + shader + "\" " + kFloor), withShaders(Hider::Path)).estimate(kView, 4000);
    };
    for (const auto& [a, b] : {std::pair("named", "coloured"), std::pair("diffusely", "dipole")}) {
        const Moments x = seen(a), y = seen(b);
        EXPECT_GT(x.mean(), .05) << a;
        EXPECT_LE(std::fabs(x.mean() - y.mean()), kZ * std::hypot(x.se(), y.se()) + 1e-6)
            << a << " " << x.mean() << " " << y.mean();
    }
}

TEST_F(Subsurface, WhatIsAskedForInVainIsSaid) {
    writeShader("everyword",
                "surface everyword() { Oi = 1; Ci = subsurface(P, N, \"label\", \"s1\", \"subset\", \"s1\", \"bias\", 1, "
                "\"hitmode\", \"s1\", \"hitsides\", \"s1\", \"maxdist\", 1, \"samplecone\", 1, \"samples\", 1, \"type\", \"s1\", "
                "\"weight\", color(1, 2, 3), \"minsamples\", 1, \"samplebase\", 1, \"excludesubset\", \"s1\", \"raytype\", "
                "\"s1\", \"raylabel\", \"s1\", \"maxhitdist\", 1, \"model\", \"s1\", \"irradiance\", color(1, 2, 3), "
                "\"scattering\", color(1, 2, 3), \"absorption\", color(1, 2, 3), \"meanfreepath\", color(1, 2, 3), "
                "\"reflectance\", color(1, 2, 3), \"albedo\", color(1, 2, 3), \"diffusemeanfreepath\", color(1, 2, 3), \"ior\", "
                "1, \"refractionindex\", 1, \"scale\", 1, \"groupname\", \"s1\", \"unitlength\", 1, \"anisotropy\", .5); }\n");
    Scene every(inWorld(kAbove + "Surface \"everyword\" " + kFloor), withShaders(Hider::Path));
    EXPECT_TRUE(std::isfinite(every.one(kView).x));
    EXPECT_NE(every.messages().find("unknown type \"s1\""), std::string::npos) << every.messages();
    writeShader("odd", "surface odd() { Oi = 1; Ci = subsurface(P, N, \"model\", \"mirror\", \"irradiance\", color(1)) + "
                       "subsurface(\"pointcloud\", P, N, \"samples\", 1e9); }\n");
    Scene s(inWorld(kAbove + "Surface \"odd\" " + kFloor), withShaders(Hider::Path));
    EXPECT_TRUE(std::isfinite(s.one(kView).x));
    for (const char* word : {"unknown model \"mirror\"", "name a point cloud by \"filename\""})
        EXPECT_NE(s.messages().find(word), std::string::npos) << s.messages();
    for (const char* bad : {"\"color sc\" [0 0 0]", "\"color sc\" [-1 -1 -1]", "\"sc_\" 0", "\"ior\" 0", "\"ior\" 1e9",
                            "\"color sc\" [1e30 1e30 1e30] \"color ab\" [1e30 1e30 1e30]"}) {
        Scene b(inWorld(kAbove + "Surface \"skin\" " + std::string(bad) + " " + kFloor), withShaders(Hider::Path));
        const double v = b.estimate(kView, 50).mean();
        EXPECT_TRUE(std::isfinite(v) && v >= 0) << bad;
    }
}

// A clear body that absorbs, in a furnace: what is left is exp(-absorption way), over ways that are known.
TEST_F(Subsurface, ItBeginsAtItsPointAndAboutItsNormal) {
    writeShader(
        "begins",
        "surface begins(float at = 0, tilt = 0;) { Oi = 1; normal n = normalize(N); vector t = normalize(n ^ "
        "vector(.3, 1, .2)); point c = point \"object\" (0, 0, 0);\n"
        "    Ci = subsurface(at > 0 ? c + (at - 1) * n : at < 0 ? c - n : P, cos(tilt) * n + sin(tilt) * t, \"scattering\", 0, "
        "\"absorption\", .7, \"ior\", 1); }\n");
    // Entering a ball of radius 1 about a normal that is tilted by so much, a way of cosine c with the ball's own is 2 |c| long.
    const auto chords = [](double tilt) {
        double sum = 0;
        const int n = 400;
        for (int i = 0; i < n; ++i)
            for (int k = 0; k < n; ++k) {
                const double z2 = (i + .5) / n, z = std::sqrt(z2), x = std::sqrt(1 - z2) * std::cos(2 * kPi * (k + .5) / n);
                sum += std::exp(-.7 * 2 * std::fabs(z * std::cos(tilt) + x * std::sin(tilt)));
            }
        return sum / (n * n);
    };
    EXPECT_NEAR(chords(0), 2 * (1 - 2.4 * std::exp(-1.4)) / (1.4 * 1.4), 1e-4);
    struct Case {
        const char* given;
        double want;
    };
    for (const Case& k : {Case{"", chords(0)}, Case{"\"tilt\" .6", chords(.6)}, Case{"\"tilt\" 1.2", chords(1.2)},
                          Case{"\"at\" 1", std::exp(-.7)}, // from the middle
                          Case{"\"at\" 3.5", chords(0)},   // above the surface: it is put onto it
                          Case{"\"at\" -1", chords(0)}}) { // on the other side: n points inward there
        Scene s(inWorld(kSky + "Translate 0 0 5 Surface \"begins\" " + std::string(k.given) + " Sphere 1 -1 1 360\n"),
                withShaders(Hider::Path));
        const Moments m = s.estimate(rayTo({.3f, .1f, 0}, {.3f, .1f, 5}), samples(6000));
        EXPECT_NEAR(m.mean(), k.want, kZ * m.se() + 1e-4) << k.given;
        EXPECT_LT(m.se(), .01) << k.given;
    }
}

// The floor is dark, and what its shader asks for is on a wall behind it that has the light of the sun straight on.
TEST_F(Subsurface, ItBeginsOnAnotherPrimitiveOfTheGroup) {
    writeShader("there", "surface there() { Oi = 1; vector x = vector \"world\" (-1, 0, 0);\n"
                         "    Ci = subsurface(point \"world\" (-70, 2, 0), x, \"model\", \"walk\", \"scattering\", .8, "
                         "\"absorption\", .2, \"scale\", 20, \"ior\", 1.3); }\n");
    writeShader("thereflat", "surface thereflat() { Oi = 1; vector x = vector \"world\" (-1, 0, 0);\n"
                             "    Ci = subsurface(point \"world\" (-70, 2, 0), x, \"model\", \"jensen\", \"scattering\", .8, "
                             "\"absorption\", .2, \"scale\", 20, \"ior\", 1.3); }\n");
    for (const char* shader : {"there", "thereflat"})
        for (const Hider h : {Hider::Hidden, Hider::Path}) {
            Scene s(inWorld("LightSource \"distantlight\" 1 \"intensity\" .5 \"from\" [-1 0 0] \"to\" [0 0 0] Attribute "
                            "\"subsurface\" \"string groupname\" \"all\" Surface \"" +
                            std::string(shader) + "\" " + kFloor + "Polygon \"P\" [-70 -9 -9  -70 -9 9  -70 13 9  -70 13 -9]\n"),
                    withShaders(h));
            const Moments m = s.estimate(kView, h == Hider::Path ? samples(8000) : 600);
            const double whole = shader == std::string("there") ? AlbedoInversion(1.3).reflectance(.8)
                                                                : Dipole(AlbedoInversion(1.3), false, .2 * 20, .8 * 20).total();
            EXPECT_NEAR(m.mean(), .5 * whole, kZ * m.se() + 1e-5) << shader << int(h);
            EXPECT_LT(m.se(), .03 * whole) << shader << int(h);
        }
}

// What enters is what shaders say of it: no light is there, and of the spot comes as much back to its middle as the dipole's
// integral over it.
TEST_F(Subsurface, WhatEntersIsWhatShadersSay) {
    const std::string tail = "\"scattering\", .8, \"absorption\", .2, \"ior\", 1.3); }\n";
    writeShader("even",
                "surface even() { Oi = 1; Ci = subsurface(P, N, \"scale\", 20, \"irradiance\", color(.2, .5, 2), " + tail);
    writeShader("spot",
                "surface spot() { Oi = 1; point w = transform(\"world\", P); float r = sqrt(xcomp(w) * xcomp(w) + zcomp(w) * "
                "zcomp(w));\n    Ci = subsurface(P, N, \"model\", \"jensen\", \"scale\", 1, \"irradiance\", color(r < .8 ? "
                "1 : 0), " +
                    tail);
    const AlbedoInversion half(1.3);
    const Dipole dipole(half, false, .2, .8);
    double within = 0;
    for (int i = 0; i < 4000; ++i) {
        const double r = .8 * (i + .5) / 4000;
        within += 2 * kPi * r * dipole.at(r) * .8 / 4000;
    }
    EXPECT_LT(within, .7 * dipole.total());
    for (const Hider h : {Hider::Hidden, Hider::Raytrace, Hider::Path}) {
        const int n = h == Hider::Path ? samples(20000) : 1500;
        const Moments even = Scene(inWorld("Surface \"even\" " + std::string(kFloor)), withShaders(h)).estimate(kView, n);
        int k = 0;
        for (const double irradiance : {.2, .5, 2.}) {
            const double want = irradiance * half.reflectance(.8);
            EXPECT_NEAR(even.mean(k), want, kZ * even.se(k) + 1e-5) << int(h);
            EXPECT_LT(even.se(k++), .03 * want);
        }
        const Moments spot = Scene(inWorld("Surface \"spot\" " + std::string(kFloor)), withShaders(h)).estimate(kView, n);
        EXPECT_NEAR(spot.mean(), within, kZ * spot.se() + 1e-5) << int(h);
        EXPECT_LT(spot.se(), .03 * within);
    }
}

// Light that the surface gathers where walks come out: as much comes back as of a constant that is the same. What no light would
// bring by itself, the factors, shows that it's the shader's; what it takes of other surfaces comes with it.
TEST_F(Subsurface, WhatEntersMayBeMadeOfLight) {
    const std::string tail = ", \"scattering\", .8, \"absorption\", .2, \"ior\", 1.3, \"scale\", 20); }\n";
    const std::string head = "normal n = normalize(N); Oi = 1; color e = 0;\n";
    writeShader("lit", "surface lit() { " + head + "Ci = subsurface(P, N, \"irradiance\", diffuse(n)" + tail);
    writeShader("tinted", "surface tinted() { " + head +
                              "Ci = subsurface(P, N, \"irradiance\", color(1, .5, .25) * diffuse(n) + color(0, .1, .2)" + tail);
    writeShader("summed", "surface summed() { " + head +
                              "illuminance(P, n, PI / 2) e += color(.75, .5, 1) * Cl * (n . normalize(L));\n"
                              "Ci = subsurface(P, N, \"irradiance\", e" +
                              tail);
    writeShader("output", "surface output(output varying color e = 0;) { normal n = normalize(N); Oi = 1; float i;\n"
                          "color below(color what; float on) { return on > 0 ? subsurface(P, N, \"irradiance\", what" +
                              tail.substr(0, tail.size() - 4) +
                              " : color(0); }\n"
                              "e = .5 * diffuse(n); for (i = 0; i < 2; i += 1) { if (i == 1) Ci += below(e, 1); } }\n");
    struct Case {
        const char* shader;
        Color factor, more{0};
    };
    const double whole = AlbedoInversion(1.3).reflectance(.8);
    for (const Case& k : {Case{"lit", Color(1)}, Case{"tinted", {1, .5f, .25f}, {0, .1f, .2f}}, Case{"summed", {.75f, .5f, 1}},
                          Case{"output", Color(.5f)}})
        for (const Hider h : {Hider::Hidden, Hider::Raytrace, Hider::Path}) {
            Scene s(inWorld(kAbove + "Surface \"" + k.shader + "\" " + kFloor), withShaders(h));
            const Moments m = s.estimate(kView, h == Hider::Path ? samples(8000) : 600);
            for (int c = 0; c < 3; ++c) {
                EXPECT_NEAR(m.mean(c), (.5 * k.factor[c] + k.more[c]) * whole, kZ * m.se(c) + 1e-5) << k.shader << int(h) << c;
                EXPECT_LT(m.se(c), .03 * whole);
            }
            EXPECT_EQ(s.messages(), "") << k.shader << int(h);
        }
    // A sky of 1 that rays find: diffuse() is 1.
    Scene s(inWorld(kSky + "Surface \"tinted\" " + kFloor), withShaders(Hider::Path));
    const Moments m = s.estimate(kView, samples(8000));
    const double want[] = {whole, .6 * whole, .45 * whole};
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(m.mean(c), want[c], kZ * m.se(c) + 1e-5) << c;
    EXPECT_LT(m.se(), .03 * whole);
}

// A square of it would have to wait for the light: the lights say what enters then, and a message says why.
TEST_F(Subsurface, WhatEntersDoesNotWait) {
    writeShader("squared", "surface squared() { Oi = 1; color d = diffuse(normalize(N));\n"
                           "    Ci = subsurface(P, N, \"scattering\", .8, \"absorption\", .2, \"ior\", 1.3, \"scale\", 20,\n"
                           "        \"irradiance\", d * d); }\n");
    Scene s(inWorld(kAbove + "Surface \"squared\" " + kFloor), withShaders(Hider::Path));
    const Moments m = s.estimate(kView, samples(8000));
    EXPECT_NEAR(m.mean(), .5 * AlbedoInversion(1.3).reflectance(.8), kZ * m.se() + 1e-5);
    EXPECT_NE(s.messages().find("its \"irradiance\" waits for rays (lightvisibility()"), std::string::npos) << s.messages();
}

TEST_F(Subsurface, NoBitDependsOnWhoSharesABatch) {
    const std::string rib =
        inWorld("LightSource \"pointlight\" 1 \"from\" [1 2 0] LightSource \"envlight\" 2 \"intensity\" .3\nTranslate 0 0 5 "
                "Surface \"coloured\" \"color r\" [.3 .6 .9] Sphere 1 -1 1 360 AttributeBegin Surface \"dipole\" Translate .8 0 "
                "-.8 Sphere .5 -.5 .5 360 AttributeEnd\n");
    std::vector<CameraRay> rays;
    for (int i = 0; i < 100; ++i) {
        rays.push_back(rayTo({0, 0, 0}, {float(i) * .02f - .7f, .1f, 4.5f}));
        rays.back().px = i;
    }
    std::vector<Color> first;
    for (const int lanes : {16, 4}) {
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

} // namespace

} // namespace subsurface_test
