// What moves while the shutter is open, in whole scenes: coverage, shading, lights and shadows against closed forms (T5 e).
#include "integrator/floorscene.h"
#include <array>
#include <cstring>

namespace motion_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

CameraRay at(float shutter, CameraRay r) {
    r.shutter = shutter;
    r.time = shutter;
    return r;
}
/// The share of evenly spaced times at which a ray meets something.
double coverage(Scene& s, const CameraRay& ray, int n = 1000) {
    std::vector<CameraRay> rays;
    for (int i = 0; i < n; ++i) rays.push_back(at((float(i) + 0.5f) / float(n), ray));
    double sum = 0;
    for (const SampleResult& r : s.trace(rays)) sum += r.opacity.x;
    return sum / n;
}
std::string shutter(const std::string& inside) { return "Shutter 0 1\n" + inWorld(inside); }
std::string moving(const std::string& first, const std::string& last) {
    return "MotionBegin [0 1]\n" + first + "\n" + last + "\nMotionEnd\n";
}
const std::string kSquare = "Polygon \"P\" [-1 -1 0  -1 1 0  1 1 0  1 -1 0]\n";

} // namespace

// The right edge of a square goes from x = 1 to x = 3, the left one from -1 to 1: of what lies between, a ramp.
TEST(Motion, CoverageOfAMovingEdgeIsARamp) {
    for (Hider h : {Hider::Hidden, Hider::Raytrace, Hider::Path})
        for (const char* body : {kSquare.c_str(), "Patch \"bilinear\" \"P\" [-1 -1 0  1 -1 0  -1 1 0  1 1 0]\n"}) {
            Scene s(shutter("Surface \"constant\"\nTranslate 0 0 5\n" + moving("Translate 0 0 0", "Translate 2 0 0") + body),
                    withShaders(h));
            for (float x : {-.7f, 0.f, .6f, 1.3f, 2.f, 2.9f}) {
                const double want = x < 1 ? (x + 1) / 2 : 1 - (x - 1) / 2;
                EXPECT_NEAR(coverage(s, rayTo({x, .1f, 0}, {x, .1f, 5})), want, 1.1e-3) << x;
            }
        }
}

// The same where the points move, and where both do, in opposite directions: then the edge stands.
TEST(Motion, CoverageOfDeformation) {
    const std::string deforms = moving(kSquare, "Polygon \"P\" [1 -1 0  1 1 0  3 1 0  3 -1 0]");
    Scene s(shutter("Surface \"constant\"\nTranslate 0 0 5\n" + deforms), withShaders(Hider::Path));
    EXPECT_NEAR(coverage(s, rayTo({0, .1f, 0}, {0, .1f, 5})), .5, 1.1e-3);
    EXPECT_NEAR(coverage(s, rayTo({2.5f, .1f, 0}, {2.5f, .1f, 5})), .25, 1.1e-3);
    Scene both(shutter("Surface \"constant\"\nTranslate 0 0 5\n" + moving("Translate 0 0 0", "Translate -2 0 0") + deforms),
               withShaders(Hider::Path));
    EXPECT_EQ(coverage(both, rayTo({.999f, .1f, 0}, {.999f, .1f, 5})), 1);
    EXPECT_EQ(coverage(both, rayTo({1.001f, .1f, 0}, {1.001f, .1f, 5})), 0);
}

// A spoke of 10 degrees turns by 90: each place on the rim, wherever it lies, sees it for a ninth of the time. As Rotate, and as
// the matrices that exporters write.
TEST(Motion, AWheelTurnsRound) {
    const std::string spoke = "Polygon \"P\" [0 0 0  .9961947 -.0871557 0  .9961947 .0871557 0]\n"; // -5 to 5 degrees
    for (const char* last : {"Rotate 90 0 0 1", "ConcatTransform [0 1 0 0  -1 0 0 0  0 0 1 0  0 0 0 1]"}) {
        const std::string first =
            std::string(last)[0] == 'R' ? "Rotate 0 0 0 1" : "ConcatTransform [1 0 0 0  0 1 0 0  0 0 1 0  0 0 0 1]";
        Scene s(shutter("Surface \"constant\"\nTranslate 0 0 5\n" + moving(first, last) + spoke), withShaders(Hider::Path));
        for (float degrees : {10.f, 30.f, 45.f, 77.f}) {
            const float a = degrees * float(kPi) / 180, r = .9f, x = r * std::cos(a), y = r * std::sin(a);
            // keys of 2.5 degrees, and straight lines between them: a 4000th of the radius
            EXPECT_NEAR(coverage(s, rayTo({x, y, 0}, {x, y, 5})), 1. / 9, 2.5e-3) << last << degrees;
        }
        EXPECT_EQ(s.trace({std::array{at(.5f, rayTo({.7f, .7f, 0}, {.7f, .7f, 5}))}})[0].opacity.x, 1);
    }
}

// Where each point is, at the time of its sample; when shaded by hidden, where it was when the shutter opened.
TEST(Motion, PointsTimesAndSpaces) {
    writeShader("tells", "surface tells(string what = \"P\"; point mark = point \"shader\" (1, 2, 3)) {\n"
                         "  Oi = 1; if (what == \"P\") Ci = color(P); else if (what == \"dPdtime\") Ci = color(dPdtime); else if "
                         "(what == \"time\") Ci = time;\n"
                         "  else if (what == \"dtime\") Ci = dtime;\n"
                         "  else if (what == \"mark\") Ci = color(mark); else Ci = color(transform(what, P)); }\n");
    const auto scene = [](const std::string& what, const std::string& before = "") {
        return "Shutter 1 3\n" + before +
               inWorld("Translate 0 0 5\nMotionBegin [0 4]\nTranslate -2 0 0\nTranslate 6 0 0\nMotionEnd\nSurface \"tells\" "
                       "\"what\" \"" +
                       what + "\"\n" + kSquare);
    };
    // At shutter s the middle lies at x = 4 s.
    for (float s : {0.f, .25f, 1.f}) {
        CameraRay ray = at(s, rayTo({4 * s + .5f, .25f, 0}, {4 * s + .5f, .25f, 5}));
        ray.time = 1 + 2 * s;
        const auto value = [&](Hider h, const std::string& what, const std::string& before = "") {
            return Scene(scene(what, before), under(h)).one(ray);
        };
        const auto near = [&](const Color& a, const Color& b, const char* what) {
            for (int k = 0; k < 3; ++k) EXPECT_NEAR(a[k], b[k], 1e-5) << what << " " << s;
        };
        near(value(Hider::Path, "P"), Color(4 * s + .5f, .25f, 5), "P");
        near(value(Hider::Hidden, "P"), Color(.5f, .25f, 5), "hidden P");
        near(value(Hider::Hidden, "P", "Hider \"hidden\" \"int samplemotion\" 1\n"), Color(4 * s + .5f, .25f, 5), "samplemotion");
        near(value(Hider::Path, "time"), Color(1 + 2 * s), "time");
        near(value(Hider::Hidden, "time"), Color(1), "hidden time");
        near(value(Hider::Hidden, "dtime"), Color(2), "hidden dtime"); // the whole shutter
        near(value(Hider::Hidden, "dtime", "Hider \"hidden\" \"int samplemotion\" 1\n"), Color(0), "samplemotion dtime");
        near(value(Hider::Path, "dtime"), Color(0), "dtime"); // an instant
        near(value(Hider::Path, "object"), Color(.5f, .25f, 0), "object");
        near(value(Hider::Path, "shader"), Color(.5f, .25f, 0), "shader");
        near(value(Hider::Path, "mark"), Color(4 * s + 1, 2, 8), "mark");
        near(value(Hider::Path, "dPdtime"), Color(2, 0, 0), "dPdtime");
    }
}

// Uniform in RSL, but rays that are shaded together have times and eyes of their own.
TEST(Motion, EachPointOfABatchHasItsTimeAndItsEye) {
    writeShader(
        "tellstime",
        "surface tellstime() { uniform float twice = 2 * time; Ci = color(time, twice, (time > .5) ? 1 : 0); Oi = 1; }\n");
    writeShader("tellseye", "surface tellseye() { Ci = color(E); Oi = 1; }\n");
    writeShader("looksup", "surface looksup() { Ci = trace(P, vector (0, 1, 0)); Oi = 1; }\n");
    for (const Hider h : {Hider::Raytrace, Hider::Path}) {
        Scene moves(shutter("Surface \"tellstime\"\nTranslate 0 0 5\n" + moving("Translate 0 0 0", "Translate .1 0 0") + kSquare),
                    under(h));
        std::vector<CameraRay> rays;
        for (int i = 0; i < 64; ++i) rays.push_back(at((float(i) + .5f) / 64, rayTo({0, .1f, 0}, {0, .1f, 5})));
        const std::vector<SampleResult> times = moves.trace(rays);
        const auto shown = [&](const SampleResult& r, int k) { return r.color[k]; };
        for (size_t i = 0; i < rays.size(); ++i) {
            EXPECT_EQ(shown(times[i], 0), rays[i].time) << i;
            EXPECT_EQ(shown(times[i], 1), 2 * rays[i].time) << i;
            EXPECT_EQ(shown(times[i], 2), rays[i].time > .5f ? 1 : 0) << i;
        }
        Scene eyes(inWorld("AttributeBegin Surface \"tellseye\" Translate 0 5 0 " + std::string(kFloor) +
                           "AttributeEnd\nSurface \"looksup\"\n" + kFloor),
                   under(h));
        for (size_t i = 0; i < rays.size(); ++i) rays[i] = rayTo({0, 1, 0}, {.25f + float(i), 0, .5f});
        const std::vector<SampleResult> from = eyes.trace(rays);
        for (size_t i = 0; i < rays.size() && .25f + float(i) < 60; ++i) {
            EXPECT_NEAR(shown(from[i], 0), .25f + float(i), 1e-4) << i;
            EXPECT_NEAR(shown(from[i], 2), .5f, 1e-4) << i;
        }
    }
}

// A point light goes from x = 0 to x = 2, one above the floor: cos / d^2 where it is at the time. A card hides it for half of
// that.
TEST(Motion, LightsMoveAndSoDoShadows) {
    const std::string light =
        "AttributeBegin\n" + moving("Translate 0 1 0", "Translate 2 1 0") +
        "LightSource \"pointlight\" 1 \"intensity\" 3.14159265 \"from\" [0 0 0]\nAttributeEnd\nIlluminate 1 1\n";
    const std::string card =
        "AttributeBegin\nSurface \"constant\"\nPolygon \"P\" [.5 .5 -1  .5 .5 1  5 .5 1  5 .5 -1]\nAttributeEnd\n";
    for (bool shaded : {false, true})
        for (Hider h : {Hider::Path, Hider::Raytrace, Hider::Hidden}) {
            Scene s(shutter(light + (shaded ? card : "") + "Surface \"matte\" \"Ka\" 0 \"Kd\" 1\n" + kFloor), withShaders(h));
            for (float t : {0.f, .3f, .45f, .55f, 1.f}) {
                const double x = h == Hider::Hidden ? 0 : 2 * t, d2 = 1 + x * x, cosine = 1 / std::sqrt(d2);
                const bool hidden = shaded && h == Hider::Path && x / 2 > .5; // halfway up, the way to the light lies at x / 2
                EXPECT_NEAR(s.one(at(t, rayTo({-.3f, .8f, -.4f}, {0, 0, 0}))).x,
                            hidden ? 0 : (h == Hider::Path ? 1 : 1) * kPi * cosine / d2, 2e-4 * kPi)
                    << t << int(h);
            }
        }
}

// A lamp that moves: its light is that of where it is. A sphere of radius r and radiance 1 at height d over a matte floor: (r /
// d)^2.
TEST(Motion, AreaLightsMove) {
    const std::string lamp = "AttributeBegin\nAreaLightSource \"arealight\" 1 \"intensity\" 1\nSurface \"constant\"\n" +
                             moving("Translate 0 2 0", "Translate 0 4 0") + "Sphere .5 -.5 .5 360\nAttributeEnd\n";
    Scene s(shutter(lamp + "Surface \"matte\" \"Ka\" 0 \"Kd\" 1\n" + kFloor), withShaders(Hider::Path));
    double seen[2] = {};
    for (int k = 0; k < 2; ++k) {
        const Moments m = s.estimate(at(float(k), kView), samples(20000));
        seen[k] = m.mean();
        const double d = 2 + 2 * k;
        if (k == 1) EXPECT_NEAR(seen[1] / seen[0], 4. / (d * d), 8 * (m.se() / seen[1]));
    }
}

// A ribbon, half wide, goes from x = 0 to x = 2: each place on its way is behind it for a quarter of the time, less at both ends.
// So a tube, and the bristle that bends: its foot stands, its tip goes twice as far.
TEST(Motion, CoverageOfMovingCurves) {
    const std::string line = "Curves \"linear\" [2] \"nonperiodic\" \"constantwidth\" .5 \"P\" ",
                      cubic = "Curves \"cubic\" [4] \"nonperiodic\" \"constantwidth\" .5 \"P\" ";
    struct {
        std::string before, first, last;
    } cases[] = {
        {"", line + "[0 -1 0  0 1 0]\n", line + "[2 -1 0  2 1 0]\n"},
        {"", cubic + "[0 -1 0  0 -.4 0  0 .4 0  0 1 0]\n", cubic + "[2 -1 0  2 -.4 0  2 .4 0  2 1 0]\n"},
        {"Attribute \"dice\" \"roundcurve\" 1\n", cubic + "[0 -1 0  0 -.4 0  0 .4 0  0 1 0]\n",
         cubic + "[2 -1 0  2 -.4 0  2 .4 0  2 1 0]\n"},
        {"", line + "[0 -1 0  0 1 0]\n", line + "[0 -1 0  4 1 0]\n"},
    };
    for (Hider h : {Hider::Hidden, Hider::Path})
        for (int c = 0; c < 4; ++c) {
            Scene s(
                shutter("Surface \"constant\"\n" + cases[c].before + "Translate 0 0 5\n" + moving(cases[c].first, cases[c].last)),
                withShaders(h));
            for (float x : {-.3f, -.1f, .1f, .6f, 1.4f, 1.9f, 2.2f, 2.3f}) {
                // In the middle of the bristle, at y = 0: it stands at x = 2 t with the slope 2 t, and is wider along x by 1 /
                // cosine.
                double want = 0;
                for (int i = 0; i < 1000; ++i) {
                    const double t = (i + .5) / 1000, half = c == 3 ? .25 * std::sqrt(1 + 4 * t * t) : .25;
                    want += std::fabs(x - 2 * t) < half;
                }
                EXPECT_NEAR(coverage(s, rayTo({x, 0, 0}, {x, 0, 5})), want / 1000, 2.1e-3) << c << " " << x;
            }
        }
}

// A disc, a ball, a square go by: a chord of theirs, over the way of 2. What grows from nothing to a radius of 1 is there from
// its time on.
TEST(Motion, CoverageOfMovingPoints) {
    const auto dots = [](const std::string& type, const std::string& P, const std::string& width) {
        return "Points \"P\" [" + P + "] \"width\" [" + width + "] \"uniform string type\" \"" + type + "\"\n";
    };
    for (const char* type : {"particle", "sphere", "patch"})
        for (Hider h : {Hider::Hidden, Hider::Path}) {
            Scene s(
                shutter("Surface \"constant\"\nTranslate 0 0 5\n" + moving(dots(type, "0 0 0", "1"), dots(type, "2 0 0", "1"))),
                withShaders(h));
            for (float y : {0.f, .2f, .45f, .51f}) {
                const double chord = y > .5 ? 0 : std::string(type) == "patch" ? 1 : 2 * std::sqrt(.25 - double(y) * y);
                EXPECT_NEAR(coverage(s, rayTo({1, y, 0}, {1, y, 5})), chord / 2, 1.1e-3) << type << y;
            }
            Scene grows(
                shutter("Surface \"constant\"\nTranslate 0 0 5\n" + moving(dots(type, "0 0 0", "0"), dots(type, "0 0 0", "2"))),
                withShaders(h));
            EXPECT_NEAR(coverage(grows, rayTo({.3f, 0, 0}, {.3f, 0, 5})), .7, 1.1e-3) << type;
        }
}

// A Blobby's ball goes by, or grows from nothing, as the points above do.
TEST(Motion, CoverageOfMovingBlobbies) {
    const auto ball = [](double x, double radius) { // of its surface: half of that of its field
        const std::string r = std::to_string(2 * radius);
        return "Blobby 1 [1001 0] [" + r + " 0 0 0  0 " + r + " 0 0  0 0 " + r + " 0  " + std::to_string(x) + " 0 0 1] [\"\"]\n";
    };
    for (Hider h : {Hider::Hidden, Hider::Path}) {
        Scene s(shutter("Surface \"constant\"\nTranslate 0 0 5\n" + moving(ball(0, .5), ball(2, .5))), withShaders(h));
        for (float y : {0.f, .2f, .45f, .51f})
            EXPECT_NEAR(coverage(s, rayTo({1, y, 0}, {1, y, 5})), y > .5 ? 0 : std::sqrt(.25 - double(y) * y), 1.1e-3) << y;
        Scene grows(shutter("Surface \"constant\"\nTranslate 0 0 5\n" + moving(ball(0, 0), ball(0, 1))), withShaders(h));
        EXPECT_NEAR(coverage(grows, rayTo({.3f, 0, 0}, {.3f, 0, 5})), .7, 1.1e-3);
    }
    // As a lamp it lights as one that stands where it is at the time: a ball of radiance 1, (r / d)^2.
    const auto scene = [](const std::string& body) {
        return shutter("AttributeBegin\nAttribute \"light\" \"string units\" \"radiance\"\nAreaLightSource \"arealight\" 1 "
                       "\"intensity\" 1\nSurface \"constant\"\nTranslate 0 3 0\n" +
                       body + "AttributeEnd\nSurface \"matte\" \"Ka\" 0 \"Kd\" 1\n" + kFloor);
    };
    Scene lamp(scene(moving(ball(0, .25), ball(0, .75))), withShaders(Hider::Path));
    for (float t : {0.f, .5f, 1.f}) {
        const double r = .25 + .5 * double(t);
        const Moments m = lamp.estimate(at(t, kView), samples(40000));
        EXPECT_NEAR(m.mean(), r * r / 9, 5 * m.se()) << t;
        EXPECT_LT(m.se(), .08 * m.mean()) << t;
    }
}

// Lamps of curves and points that move light what they are where they are: as those that stand there.
TEST(Motion, LampsOfCurvesAndPointsMove) {
    const auto dots = [](float x, float y) {
        return "Points \"P\" [" + std::to_string(x) + " " + std::to_string(y) + " 0  .5 " + std::to_string(y) +
               " .7] \"constantwidth\" .6\n";
    };
    const auto hair = [](float x, float y) {
        return "Curves \"linear\" [2] \"nonperiodic\" \"P\" [-1 " + std::to_string(y) + " 0  " + std::to_string(x) + " " +
               std::to_string(y) + " 1] \"constantwidth\" .2\n";
    };
    const auto scene = [](const std::string& body) {
        return shutter("AttributeBegin\nAreaLightSource \"arealight\" 1 \"intensity\" 1\nSurface \"constant\"\n" + body +
                       "AttributeEnd\nSurface \"matte\" \"Ka\" 0 \"Kd\" 1\n" + kFloor);
    };
    const auto both = [&](const std::string& first, const std::string& last, const std::string& middle, const char* what) {
        Scene moves(scene(moving(first, last)), withShaders(Hider::Path)), stands(scene(middle), withShaders(Hider::Path));
        const Moments a = moves.estimate(at(.5f, kView), samples(20000)), b = stands.estimate(at(.5f, kView), samples(20000));
        EXPECT_GT(a.mean(), 0);
        EXPECT_NEAR(a.mean(), b.mean(), 5 * std::hypot(a.se(), b.se())) << what;
    };
    both(dots(0, 1), dots(1, 3), dots(.5f, 2), "points");
    both(hair(0, 1), hair(1, 3), hair(.5f, 2), "curves");
}

// The same samples have the same bits, whoever shares their call.
TEST(Motion, BitsDoNotDependOnTheBatch) {
    Scene s(shutter("LightSource \"pointlight\" 1 \"intensity\" 20 \"from\" [2 4 0]\nSurface \"matte\"\n" +
                    std::string("Polygon \"P\" [-9 -2 0  -9 -2 20  9 -2 20  9 -2 0]\n") + "Translate 0 0 5\n" +
                    moving("Rotate 0 1 2 3", "Rotate 70 1 2 3") + moving("Sphere 1 -1 1 360", "Sphere 2 -2 2 360") +
                    "Translate 1 0 0\n" + kSquare +
                    moving("Points \"P\" [-1 0 -2  1 1 -2] \"constantwidth\" .5",
                           "Points \"P\" [1 0 -2  1 -1 -1] \"constantwidth\" .9") +
                    moving("Curves \"linear\" [3] \"nonperiodic\" \"P\" [-2 -2 -2  0 0 -2  2 2 -2] \"constantwidth\" .2",
                           "Curves \"linear\" [3] \"nonperiodic\" \"P\" [-2 -2 -2  0 1 -2  2 -2 -2] \"constantwidth\" .4") +
                    moving("Blobby 1 [1001 0] [2 0 0 0  0 2 0 0  0 0 2 0  -2 1 -1 1] [\"\"]",
                           "Blobby 1 [1001 0] [3 0 0 0  0 2 0 0  0 1 2 0  -1 2 -1 1] [\"\"]")),
            withShaders(Hider::Path));
    std::vector<CameraRay> rays;
    for (int i = 0; i < 300; ++i) {
        const float x = float(i % 20 - 10) / 5, y = float(i / 20 - 8) / 4;
        CameraRay r = at(float(i * 37 % 101) / 101, rayTo({0, 0, 0}, {x, y, 5}));
        r.px = i;
        rays.push_back(r);
    }
    const auto all = s.trace(rays);
    for (size_t i = 0; i < rays.size(); ++i) {
        const Color c = s.one(rays[i]);
        EXPECT_EQ(0, memcmp(&c, &all[i].color, sizeof c)) << i;
    }
}

} // namespace motion_test
