// What shines and is not plain: lamps with a texture, displaced, cut out of solids, of many shapes; as many lamps as there are. A
// large white floor seen at the origin; lamps whose light is found by light samples, by rays, and by both.
#include "base/limits.h"
#include "integrator/floorscene.h"
#include "integrator/maps.h"
#include "sanitized.h"

namespace emitters_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

const char* const kLambert = "Surface \"matte\" \"float Ka\" 0 \"float Kd\" 1\n";

Settings of(int mode) {
    Settings s = withShaders(Hider::Path);
    s.bsdfOnly = mode == 1;
    s.lightOnly = mode == 2;
    return s;
}
std::string lamp(const std::string& light, const std::string& shapes) {
    return "AttributeBegin\nSurface \"constant\"\nColor 0 0 0\nAttribute \"light\" \"string units\" "
           "\"radiance\"\nAreaLightSource " +
           light + "\n" + shapes + "AttributeEnd\nIlluminate 1 1\n";
}
std::string lit(const std::string& lights) { return inWorld(lights + kLambert + kFloor); }

/// All three ways agree with a value that is known to `known` of it. So many rays alone as a small lamp needs, unless it is a
/// large one.
void expectAll(const std::string& rib, double want, double known, const std::string& what, int raysAlone = 200'000) {
    for (const int mode : {0, 1, 2}) {
        Scene s(rib, of(mode));
        const Moments m = s.estimate(kView, samples(mode == 1 ? raysAlone : 40'000));
        EXPECT_LE(std::fabs(m.mean() - want), kZ * m.se() + known * want)
            << what << ", mode " << mode << ": " << m.mean() << " +- " << m.se() << ", " << want;
        EXPECT_LE(m.se(), .02 * want) << what << ", mode " << mode << ": not precise enough to decide";
    }
}

/// diffuse() under a square lamp of side 2 at height 2 whose radiance is f(u, v), u along x and v along z from -1 to 1; the
/// midpoint rule.
template <class F> double underSquare(F&& f) {
    double sum = 0;
    constexpr int n = 1000;
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < n; ++k) {
            const double u = (i + .5) / n, v = (k + .5) / n, x = 2 * u - 1, z = 2 * v - 1, d2 = x * x + z * z + 4;
            sum += f(u, v) * 4 / (d2 * d2) * 4 / n / n; // cosines 2 / d at both ends
        }
    return sum / kPi;
}
const char* const kSquare = "Patch \"bilinear\" \"P\" [-1 2 -1  1 2 -1  -1 2 1  1 2 1]\n";

} // namespace

TEST(Emitters, Textured) {
    writeShader("ramplamp", "light ramplamp() { illuminate(P, N, PI) Cl = 9 * u * u; }\n");
    expectAll(lit(lamp("\"ramplamp\" 1", kSquare)), underSquare([](double u, double) { return 9 * u * u; }), 1e-4, "ramp");
    // A map of two by two texels between whose middles it is interpolated, and clamped beyond.
    const std::string map = writeMap("lampmap.exr", 2, 2, [](int x, int y, int) { return x == 1 && y == 0 ? 20.f : 1.f; });
    writeShader("maplamp",
                "light maplamp(string map = \"\";) { illuminate(P, N, PI) Cl = color texture(map, u, v, \"width\", 0); }\n");
    const auto blend = [](double t) { return std::clamp(2 * t - .5, 0.0, 1.0); };
    expectAll(lit(lamp("\"maplamp\" 1 \"string map\" " + map, kSquare)),
              underSquare([&](double u, double v) { return 1 + 19 * blend(u) * (1 - blend(v)); }), 1e-3, "map");
}

// A lamp that rays of a lobe do not see: light samples bring all of its light. Two lobes in halves, a diffuse and a specular one
// of the same shape (facets of roughness 0 are Lambert's); a lamp of triangles and one that is none.
TEST(Emitters, UnseenByRaysOfALobe) {
    writeShader("halves",
                "surface halves() { normal n = faceforward(normalize(N), I); Oi = 1; Ci = .5 * diffuse(n) + .5 * trace(P, "
                "n, \"distribution\", \"oren-nayar\", \"roughness\", 0, \"samplearealights\", 1, \"type\", "
                "\"specular\"); }\n");
    writeShader("both5", "light both5() { illuminate(P, N, PI) Cl = 5; }\n");
    const std::string square = "Polygon \"P\" [-1 2 -1  1 2 -1  1 2 1  -1 2 1]\n",
                      disk = "Translate 0 2 0\nRotate 90 1 0 0\nDisk 0 1 360\n";
    const double ofSquare = underSquare([](double, double) { return 5.; }), ofDisk = 5 / (1 + 4.);
    for (const char* unseen : {"", "\"int diffuse\" 0", "\"int specular\" 0", "\"int diffuse\" 0 \"int specular\" 0"})
        for (const bool flat : {true, false}) {
            const std::string hidden = *unseen ? std::string("Attribute \"visibility\" ") + unseen + "\n" : "";
            Scene s(inWorld(lamp("\"both5\" 1", hidden + (flat ? square : disk)) + "Surface \"halves\"\n" + kFloor), of(0));
            expectMean(s.estimate(kView, samples(10'000)), flat ? ofSquare : ofDisk, .01,
                       unseen + std::string(flat ? " square" : " disk"));
        }
}

// A ball of radius 1 that a displacement makes one of radius 1.5: L (R / d)^2. Light samples lie where rays meet it.
TEST(Emitters, Displaced) {
    writeShader("swell", "displacement swell() { P += .5 * normalize(N); N = calculatenormal(P); }\n");
    writeShader("white5", "light white5() { illuminate(P, N, PI / 2) Cl = 5; }\n");
    const std::string ball =
        "Attribute \"displacementbound\" \"float sphere\" 1\nDisplacement \"swell\"\nTranslate 0 5 0\nSphere 1 -1 1 360\n";
    // Facets lie within the ball: at the default rate they are some hundredths of a radius long.
    expectAll(lit(lamp("\"white5\" 1", ball)), 5 * 2.25 / 25, 4e-3, "displaced ball", 60'000);
    // A square that a displacement lifts by 1, from height 1 to 2, and one that moves, which rays alone find.
    writeShader("lift", "displacement lift() { P += vector \"world\" (0, 1, 0); }\n");
    const std::string low = "Patch \"bilinear\" \"P\" [-1 1 -1  1 1 -1  -1 1 1  1 1 1]\n",
                      up = "Attribute \"displacementbound\" \"float sphere\" 2\nDisplacement \"lift\"\n";
    writeShader("both5", "light both5() { illuminate(P, N, PI) Cl = 5; }\n");
    const double want = underSquare([](double, double) { return 5.; });
    expectAll(lit(lamp("\"both5\" 1", up + low)), want, 1e-3, "displaced square", 60'000);
    const std::string moving = "MotionBegin [0 1]\nTranslate 0 0 0\nTranslate 1e-6 0 0\nMotionEnd\n";
    Scene s("Shutter 0 1\n" + lit(lamp("\"both5\" 1", up + moving + low)), of(0));
    const Moments m = s.estimate(kView, samples(60'000));
    EXPECT_LE(m.se(), .02 * want);
    EXPECT_LE(std::fabs(m.mean() - want), kZ * m.se() + 1e-3 * want)
        << "moving: " << m.mean() << " +- " << m.se() << ", " << want;
}

// At the centre of a ball of which each side shines alike: every direction brings L. L points against N, where the cosine
// of the cone is -1 but for rounding.
TEST(Emitters, FromInsideOfABall) {
    writeShader("both5", "light both5() { illuminate(P, N, PI) Cl = 5; }\n");
    expectAll(lit(lamp("\"both5\" 1", "Sphere 50 -50 50 360\n")), 5, 1e-3, "inside of a ball");
}

// Half of a ball, cut by a box whose face stands on edge as seen from the origin: half of L (R / d)^2.
TEST(Emitters, CutOutOfASolid) {
    writeShader("white5", "light white5() { illuminate(P, N, PI / 2) Cl = 5; }\n");
    const std::string box = "PointsPolygons [4 4 4 4 4 4] [0 1 3 2  4 6 7 5  0 4 5 1  2 3 7 6  0 2 6 4  1 5 7 3] \"P\" "
                            "[0 2 -3  3 2 -3  0 8 -3  3 8 -3  0 2 3  3 2 3  0 8 3  3 8 3]\n";
    const std::string cut = "SolidBegin \"difference\"\nSolidBegin \"primitive\"\nTransformBegin\nTranslate 0 5 0\nSphere 1 -1 1 "
                            "360\nTransformEnd\nSolidEnd\n"
                            "SolidBegin \"primitive\"\nAreaLightSource \"null\" \"none\"\n" +
                            box + "SolidEnd\nSolidEnd\n";
    expectAll(lit(lamp("\"white5\" 1", cut)), 5. / 25 / 2, 1e-3, "half a ball");
}

// A sheet of NURBS two wide at height 2 that trim curves leave a disc of, a ring, a disc beside the middle: what these light
// (Howell B-13).
TEST(Emitters, Trimmed) {
    writeShader("both5", "light both5() { illuminate(P, N, PI) Cl = 5; }\n");
    struct Circle {
        double u, v, r;
    };
    const auto sheet = [](const std::vector<Circle>& circles) {
        std::string counts, orders, knots, least, most, ns, u, v, w;
        const double x[9] = {1, 1, 0, -1, -1, -1, 0, 1, 1}, y[9] = {0, 1, 1, 1, 0, -1, -1, -1, 0};
        for (const Circle& c : circles) {
            counts += "1 ", orders += "3 ", knots += "0 0 0 1 1 2 2 3 3 4 4 4 ", least += "0 ", most += "4 ", ns += "9 ";
            for (int i = 0; i < 9; ++i) {
                const double weight = i % 2 ? std::sqrt(.5) : 1;
                u += std::to_string((c.u + c.r * x[i]) * weight) + " ";
                v += std::to_string((c.v + c.r * y[i]) * weight) + " ";
                w += std::to_string(weight) + " ";
            }
        }
        return "Attribute \"trimcurve\" \"sense\" \"outside\"\nTrimCurve [" + counts + "] [" + orders + "] [" + knots + "] [" +
               least + "] [" + most + "] [" + ns + "] [" + u + "] [" + v + "] [" + w +
               "]\nNuPatch 2 2 [0 0 1 1] 0 1 2 2 [0 0 1 1] 0 1 \"P\" [-1 2 -1  1 2 -1  -1 2 1  1 2 1]\n";
    };
    const auto disc = [](double a, double b) { // radius, beside the axis; twice those in u and v
        const double d = 2, z = a * a + b * b + d * d;
        return .5 * (1 - (z - 2 * a * a) / std::sqrt(z * z - 4 * a * a * b * b));
    };
    expectAll(lit(lamp("\"both5\" 1", sheet({{.5, .5, .4}}))), 5 * disc(.8, 0), 1e-3, "disc");
    expectAll(lit(lamp("\"both5\" 1", sheet({{.5, .5, .45}, {.5, .5, .25}}))), 5 * (disc(.9, 0) - disc(.5, 0)), 1e-3, "ring");
    expectAll(lit(lamp("\"both5\" 1", sheet({{.8, .5, .15}}))), 5 * disc(.3, .6), 1e-3, "disc beside the middle");
}

// One light of many shapes: samples go where they bring most.
TEST(Emitters, ManyShapes) {
    std::string balls;
    double want = 0;
    for (int i = 0; i < 300; ++i) {
        const double x = std::sin(i * 1.7) * (.2 + i % 7), z = std::cos(i * 2.3) * (.2 + i % 5), y = .3 + .21 * (i % 9),
                     r = .02 + .01 * (i % 3);
        const double d2 = x * x + y * y + z * z;
        balls += "TransformBegin\nTranslate " + std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z) +
                 "\nSphere " + std::to_string(r) + " " + std::to_string(-r) + " " + std::to_string(r) + " 360\nTransformEnd\n";
        want += 40 * r * r / d2 * y / std::sqrt(d2);
    }
    // Balls hide parts of each other, which the sum does not know: lamps that let light through hide nothing.
    const std::string light = "Opacity 0 0 0\nAttribute \"visibility\" \"transmission\" \"transparent\"\n";
    for (const int mode : {0, 2}) {
        Scene s(lit(lamp("\"slrect\" 1 \"float intensity\" 40", light + balls)), of(mode));
        Counters c;
        const int n = samples(40'000);
        const Moments m = s.estimate(kView, n, &c);
        expectMean(m, want, .02, "mode " + std::to_string(mode));
        EXPECT_LE(double(c.shadow) / n, 1.01); // one sample a vertex
    }
}

// Ten thousand lamps, each with attributes and a list of lights of its own: what is kept grows with their number, and not with
// its square.
TEST(Emitters, TenThousandLamps) {
    std::string lights;
    double want = 0;
    const int n = 10'000;
    for (int i = 0; i < n; ++i) {
        const double x = std::sin(i * 1.7) * (1 + i % 17), z = std::cos(i * 2.3) * (1 + i % 13), y = 1 + .037 * (i % 40),
                     r = .001;
        const double d2 = x * x + y * y + z * z;
        const std::string name = std::to_string(i + 1);
        lights += "AttributeBegin\nSurface \"constant\"\nAreaLightSource \"slrect\" " + name +
                  " \"float intensity\" 400\nTranslate " + std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z) +
                  "\nSphere .001 -.001 .001 360\nAttributeEnd\nIlluminate " + name + " 1\n";
        want += 400 * r * r / d2 * y / std::sqrt(d2);
    }
    const auto resident = [] { // bytes
        std::ifstream f("/proc/self/statm");
        size_t all = 0, here = 0;
        f >> all >> here;
        return double(here) * double(sysconf(_SC_PAGESIZE));
    };
    const double before = resident();
    Scene s(lit(lights), of(2));
    // 8 KB a lamp with its shape, shaders and attributes; the lists alone took 400 KB each when they were lists.
    if (!kSanitized) EXPECT_LT(resident() - before, n * 20e3); // what is freed stays there for a while
    Counters c;
    const int count = samples(10'000);
    expectMean(s.estimate(kView, count, &c), want, .02, "sum of all");
    EXPECT_LE(double(c.shadow) / count, limits::kLightsSampled + 1.5);
    std::vector<CameraRay> rays{kView};
    EXPECT_EQ(s.one(kView), s.one(kView));
}

// A thousand lamps of uneven power over a floor: the tree against even choice, both with about eight lights a vertex. Efficiency
// is one over the product of variance and time; the choice's time is asserted nowhere, the variance leaves room for twice the
// time of an even choice (measured: 1.1 times).
TEST(Emitters, TheTreeAgainstEvenChoice) {
    std::string lights;
    for (int i = 0; i < 1000; ++i) {
        const double x = 20 * std::sin(i * 12.9898), z = 20 * std::cos(i * 78.233), y = .5 + .037 * (i % 40),
                     power = std::exp(2 * std::sin(i * 3.7));
        lights += "AttributeBegin\nSurface \"constant\"\nColor 0 0 0\nAreaLightSource \"slrect\" " + std::to_string(i + 1) +
                  " \"float intensity\" " + std::to_string(power) + "\nTranslate " + std::to_string(x) + " " + std::to_string(y) +
                  " " + std::to_string(z) + "\nSphere .1 -.1 .1 360\nAttributeEnd\nIlluminate " + std::to_string(i + 1) + " 1\n";
    }
    Settings even = of(0);
    even.evenLights = true;
    Scene tree(lit(lights), of(0)), uniform(lit(lights), even);
    double a = 0, b = 0, timeA = 0, timeB = 0;
    for (int k = 0; k < 12; ++k) {
        if (!chosen(size_t(k), 3)) continue;
        const CameraRay view =
            rayTo({float(k) * 2 - 11 + .3f, .4f, float(k % 5) * 3 - 6}, {float(k) * 2 - 11, 0, float(k % 5) * 3 - 6});
        const int n = samples(2000);
        const auto timed = [&](Scene& s, double& time) {
            const clock_t begin = clock();
            const Moments m = s.estimate(view, n);
            time += double(clock() - begin) / CLOCKS_PER_SEC;
            return m;
        };
        const Moments one = timed(tree, timeA), other = timed(uniform, timeB);
        EXPECT_LE(std::fabs(one.mean() - other.mean()), kZ * std::hypot(one.se(), other.se())) << k;
        a += std::pow(one.se() / one.mean(), 2), b += std::pow(other.se() / one.mean(), 2);
    }
    RecordProperty("variance", std::to_string(b / a));
    RecordProperty("efficiency", std::to_string(b * timeB / (a * timeA)));
    std::printf("variance %.1f times, time %.2f times, efficiency %.1f times\n", b / a, timeA / timeB, b * timeB / (a * timeA));
    EXPECT_GT(b / a, 6);
}

} // namespace emitters_test
