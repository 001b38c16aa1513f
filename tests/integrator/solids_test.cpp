// Solids in whole scenes: each boundary has the shader, the opacity, the movement, the displacement and the light of the part
// that made it. Expected: intervals along each ray worked out by hand, and the light of flat discs, which is that of any body
// with their outline.
#include "integrator/floorscene.h"
#include <algorithm>
#include <array>
#include <random>

namespace solids_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

std::string block(const char* operation, const std::string& inside) {
    return "SolidBegin \"" + std::string(operation) + "\"\n" + inside + "SolidEnd\n";
}
std::string part(const std::string& inside) { return block("primitive", inside); }
std::string text(double x) { return std::to_string(x); }
std::string ball(double x, double y, double z, double radius) {
    const std::string r = text(radius);
    return "TransformBegin\nTranslate " + text(x) + " " + text(y) + " " + text(z) + "\nSphere " + r + " -" + r + " " + r +
           " 360\nTransformEnd\n";
}
std::string moving(const std::string& first, const std::string& last) {
    return "MotionBegin [0 1]\n" + first + "\n" + last + "\nMotionEnd\n";
}
CameraRay at(float shutter, CameraRay r) {
    r.shutter = shutter;
    r.time = shutter;
    return r;
}

/// A ball that a ray crosses, or not.
struct Ball {
    Vec3d centre;
    double radius;
    bool cross(const CameraRay& ray, double& in, double& out) const {
        const Vec3d w = Vec3d(ray.origin) - centre, d(ray.direction);
        const double a = dot(d, d), h = dot(w, d), q = h * h - a * (dot(w, w) - radius * radius);
        if (q <= 0) return false;
        in = (-h - std::sqrt(q)) / a, out = (-h + std::sqrt(q)) / a;
        return true;
    }
};
struct Boundary {
    double t;
    int part;
};
/// Where the whole begins and ends along a ray. False: two crossings are within `gap`, or a ray all but touches a ball.
template <class Balls, class Inside>
bool boundaries(const Balls& balls, const CameraRay& ray, double gap, Inside inside, std::vector<Boundary>& out) {
    std::vector<Boundary> all;
    int k = 0;
    for (const Ball& b : balls) {
        double t0, t1;
        if (b.cross(ray, t0, t1)) all.push_back({t0, k}), all.push_back({t1, k});
        ++k;
    }
    std::sort(all.begin(), all.end(), [](const Boundary& a, const Boundary& b) { return a.t < b.t; });
    bool in[8] = {}, was = false;
    out.clear();
    for (size_t i = 0; i < all.size(); ++i) {
        if (i && all[i].t - all[i - 1].t < gap) return false;
        in[all[i].part] = !in[all[i].part];
        if (inside(in) != was) out.push_back(all[i]);
        was = inside(in);
    }
    return true;
}
std::vector<CameraRay> raysFrom(Vec3 eye, Vec3 to, float around, int n, uint32_t seed) {
    std::mt19937 rng(seed);
    std::uniform_real_distribution<float> u(-around, around), shutter(0, 1);
    std::vector<CameraRay> rays;
    for (int i = 0; i < n; ++i) {
        rays.push_back(at(shutter(rng), rayTo(eye, to + Vec3(u(rng), u(rng), u(rng)))));
        rays.back().px = i;
    }
    return rays;
}
const std::string kRed = "Color 1 0 0\n", kGreen = "Color 0 1 0\n", kBlue = "Color 0 0 1\n";
Color colourOf(int part) { return part == 0 ? Color(1, 0, 0) : part == 1 ? Color(0, 1, 0) : Color(0, 0, 1); }

using Three = std::array<Ball, 3>;

/// Of a scene of three balls each ray sees the first boundary, in its part's colour, as far away as it is. at: the balls, for a
/// ray.
template <class BallsAt, class Inside>
void expectColours(const std::string& rib, BallsAt&& ballsAt, Inside&& inside, double tolerance,
                   std::initializer_list<Hider> hiders) {
    for (const Hider h : hiders) {
        Scene s(rib, withShaders(h));
        const auto rays = raysFrom({0, 0, 0}, {0, 0, 5}, 1.6f, 3000, 3);
        const auto got = s.trace(rays);
        int parts[3] = {}, nothing = 0, wrong = 0;
        std::vector<Boundary> want;
        for (size_t i = 0; i < rays.size(); ++i) {
            if (!boundaries(ballsAt(rays[i]), rays[i], 40 * tolerance, inside, want)) continue;
            const Color c = want.empty() ? Color(0) : colourOf(want[0].part);
            wrong += !(got[i].color == c);
            ++(want.empty() ? nothing : parts[want[0].part]);
            if (!want.empty() && got[i].color == c)
                EXPECT_NEAR(got[i].z, want[0].t * double(rays[i].direction.z), 20 * tolerance) << i;
        }
        EXPECT_EQ(wrong, 0) << "hider " << int(h);
        EXPECT_GT(nothing, 20);
        EXPECT_GT(*std::min_element(parts, parts + 3), 15) << parts[0] << " " << parts[1] << " " << parts[2];
    }
}
std::string lamp(int handle, const char* shader, const std::string& shapes) {
    return "Attribute \"light\" \"string units\" \"radiance\"\nAreaLightSource \"" + std::string(shader) + "\" " +
           std::to_string(handle) + "\n" + shapes;
}
/// Ways to find a lamp: both, by rays alone, by points on it alone; all agree with a value known to `known` of it.
void expectLight(const std::string& rib, double want, double known, const std::string& what, CameraRay view = kView) {
    for (const int mode : {0, 1, 2}) {
        Settings settings = withShaders(Hider::Path);
        settings.bsdfOnly = mode == 1;
        settings.lightOnly = mode == 2;
        Scene s(rib, settings);
        const Moments m = s.estimate(view, samples(mode == 0 ? 30'000 : 100'000));
        EXPECT_LE(std::fabs(m.mean() - want), kZ * m.se() + known * want)
            << what << ", mode " << mode << ": " << m.mean() << " +- " << m.se() << ", " << want;
        EXPECT_LE(m.se(), .02 * want) << what << ", mode " << mode << ": not precise enough to decide";
    }
}
std::string onFloor(const std::string& lights, const std::string& on = "Illuminate 1 1\n") {
    return inWorld("AttributeBegin\nSurface \"constant\"\nColor 0 0 0\n" + lights + "AttributeEnd\n" + on +
                   "Surface \"matte\" \"float Ka\" 0 \"float Kd\" 1\n" + kFloor);
}
/// Irradiance over pi under a disc of radiance 1, of radius a at height d over a floor that it is parallel to, b beside its axis:
/// Howell's catalogue of configuration factors, B-13.
double underDisc(double a, double d, double b) {
    const double z = a * a + b * b + d * d;
    return .5 * (1 - (z - 2 * a * a) / std::sqrt(z * z - 4 * a * a * b * b));
}
void writeLamps() {
    writeShader("one", "light one() { illuminate(P, N, PI / 2) Cl = 1; }\n");
    writeShader("three", "light three() { illuminate(P, N, PI / 2) Cl = 3; }\n");
}

} // namespace

// A ball (red) and a ball (green) less a third (blue), which is nearer to the eye.
const auto kCut = [](const bool* in) { return (in[0] || in[1]) && !in[2]; };

TEST(SolidParts, EachBoundaryHasItsShader) {
    writeShader("mine", "surface mine() { Oi = Os; Ci = Oi * Cs; }\n");
    writeShader("ours", "surface ours() { Oi = 1; Ci = color(0, 1, 0); }\n");
    const std::string red = part(kRed + ball(-.5, 0, 5, 1)), green = part("Surface \"ours\"\n" + ball(.5, 0, 5, 1)),
                      blue = part(kBlue + ball(0, 0, 4, .8));
    const auto balls = [](const CameraRay&) { return Three{{{{-.5, 0, 5}, 1}, {{.5, 0, 5}, 1}, {{0, 0, 4}, .8}}}; };
    expectColours(inWorld("Surface \"mine\"\n" + block("difference", block("union", red + green) + blue)), balls, kCut, 1e-6,
                  {Hider::Hidden, Hider::Raytrace, Hider::Path});
    // What is in both of the first and not in the third.
    expectColours(
        inWorld("Surface \"mine\"\n" +
                block("difference", block("intersection", red + green) + part(kBlue + ball(0, 0, 4.1, .8)))),
        [](const CameraRay&) { return Three{{{{-.5, 0, 5}, 1}, {{.5, 0, 5}, 1}, {{0, 0, 4.1}, .8}}}; },
        [](const bool* in) { return in[0] && in[1] && !in[2]; }, 1e-6, {Hider::Hidden, Hider::Raytrace, Hider::Path});
}

// Parts that go their own ways: at each time the boundaries of where they are then.
TEST(SolidParts, MoveOnTheirOwn) {
    const auto goes = [](const char* from, const char* to, double radius) {
        return "TransformBegin\n" + moving(from, to) + ball(0, 0, 0, radius) + "TransformEnd\n";
    };
    const std::string parts = part(kRed + goes("Translate -.5 0 5", "Translate -.3 .2 5", 1)) + part(kGreen + ball(.5, 0, 5, 1));
    const auto centre = [](const CameraRay& r, Vec3d a, Vec3d b) { return a + (b - a) * double(r.shutter); };
    expectColours(
        "Shutter 0 1\n" +
            inWorld("Surface \"constant\"\n" +
                    block("difference", block("union", parts) + part(kBlue + goes("Translate -1 0 4", "Translate 1 0 4", .8)))),
        [&](const CameraRay& r) {
            return Three{{{centre(r, {-.5, 0, 5}, {-.3, .2, 5}), 1}, {{.5, 0, 5}, 1}, {centre(r, {-1, 0, 4}, {1, 0, 4}), .8}}};
        },
        kCut, 2e-6, {Hider::Hidden, Hider::Raytrace, Hider::Path});
    // One that grows is followed by facets, a twentieth of a pixel beside it.
    const std::string grows =
        "TransformBegin\nTranslate 0 0 4\n" + moving("Sphere .4 -.4 .4 360", "Sphere 1 -1 1 360") + "TransformEnd\n";
    expectColours(
        "Shutter 0 1\n" + inWorld("Surface \"constant\"\n" + block("difference", block("union", parts) + part(kBlue + grows))),
        [&](const CameraRay& r) {
            return Three{{{centre(r, {-.5, 0, 5}, {-.3, .2, 5}), 1}, {{.5, 0, 5}, 1}, {{0, 0, 4}, .4 + .6 * double(r.shutter)}}};
        },
        kCut, 1e-3, {Hider::Hidden, Hider::Path});
}

// A solid that moves as a whole, and the same one as an instance that does.
TEST(SolidParts, MoveTogether) {
    const std::string solid =
        block("difference", block("union", part(kRed + ball(-.5, 0, 0, 1)) + part(kGreen + ball(.5, 0, 0, 1))) +
                                part(kBlue + ball(0, 0, -1, .8)));
    const std::string goes = moving("Translate -.6 0 5", "Translate .6 .2 5.5");
    const auto balls = [](const CameraRay& r) {
        const Vec3d o = Vec3d(-.6, 0, 5) + Vec3d(1.2, .2, .5) * double(r.shutter);
        return Three{{{o + Vec3d(-.5, 0, 0), 1}, {o + Vec3d(.5, 0, 0), 1}, {o + Vec3d(0, 0, -1), .8}}};
    };
    expectColours("Shutter 0 1\n" + inWorld("Surface \"constant\"\n" + goes + solid), balls, kCut, 2e-6,
                  {Hider::Hidden, Hider::Raytrace, Hider::Path});
    const std::string object = "ObjectBegin 1\n" + solid + "ObjectEnd\n";
    expectColours("Shutter 0 1\n" + inWorld(object + "Surface \"constant\"\n" + goes + "ObjectInstance 1\n"), balls, kCut, 2e-6,
                  {Hider::Hidden, Hider::Raytrace, Hider::Path});
}

// Balls that a displacement makes larger: also the one that is taken away, by as much.
TEST(SolidParts, AreDisplaced) {
    writeShader("swollen", "displacement swollen(float by = .2;) { P += by * normalize(N); N = calculatenormal(P); }\n");
    const auto swollen = [](const char* by, const std::string& body) {
        return "Attribute \"displacementbound\" \"float sphere\" 1\nDisplacement \"swollen\" \"float by\" " + std::string(by) +
               "\n" + body;
    };
    for (const bool all : {false, true}) {
        const std::string rib = inWorld(
            "ShadingRate 16\nSurface \"constant\"\n" +
            block("difference", block("union", part(kRed + (all ? swollen(".2", ball(-.5, 0, 5, .8)) : ball(-.5, 0, 5, 1))) +
                                                   part(kGreen + swollen(".4", ball(.5, 0, 5, .6)))) +
                                    part(kBlue + swollen(".3", ball(0, 0, 4, .5)))));
        // Facets stray by a twentieth of a pixel, 1e-3 here.
        expectColours(rib, [](const CameraRay&) { return Three{{{{-.5, 0, 5}, 1}, {{.5, 0, 5}, 1}, {{0, 0, 4}, .8}}}; }, kCut,
                      1e-3, {Hider::Hidden, Hider::Raytrace, Hider::Path});
    }
    // The normal that shaders see looks out of the whole, also from the wall of a hole.
    writeShader("normals", "surface normals() { Oi = 1; Ci = color(normalize(N)); }\n");
    for (const char* by : {"0", ".3"}) {
        const std::string hole = *by == '0' ? ball(0, 0, 4, .8) : swollen(by, ball(0, 0, 4, .5));
        Scene s(inWorld("ShadingRate 16\nSurface \"normals\"\n" + block("difference", part(ball(0, 0, 5, 1)) + part(hole))),
                withShaders(Hider::Path));
        for (const CameraRay& ray : raysFrom({0, 0, 0}, {0, 0, 4}, .4f, 100, 5)) {
            const SampleResult r = s.trace({&ray, 1})[0];
            const Vec3d p = Vec3d(ray.direction) * double(r.z / ray.direction.z), n = normalize(Vec3d(0, 0, 4) - p);
            EXPECT_NEAR(length(p - Vec3d(0, 0, 4)), .8, 2e-3);
            for (int k = 0; k < 3; ++k) EXPECT_NEAR(r.color[k], n[k], 5e-2) << by; // calculatenormal() goes by differences
        }
    }
}

// A ball of red glass, its hole with walls of another: what comes through all of it, each boundary once; so for shadows.
TEST(SolidParts, AreTransparent) {
    const std::string solid = block("difference", part("Opacity .5 .2 .1\nColor 1 0 0\n" + ball(0, 0, 5, 1)) +
                                                      part("Opacity .1 .3 .6\nColor 0 1 0\n" + ball(0, 0, 4.6, .8)));
    const Color opacity[2] = {{.5f, .2f, .1f}, {.1f, .3f, .6f}};
    const auto whole = [](const bool* in) { return in[0] && !in[1]; };
    for (const Hider h : {Hider::Hidden, Hider::Raytrace, Hider::Path}) {
        Scene s(inWorld("Surface \"constant\"\n" + solid), withShaders(h));
        int most = 0;
        for (const CameraRay& ray : raysFrom({0, 0, 0}, {0, 0, 5}, 1.2f, 1000, 8)) {
            std::vector<Boundary> want;
            if (!boundaries(std::array<Ball, 2>{{{{0, 0, 5}, 1}, {{0, 0, 4.6}, .8}}}, ray, 1e-5, whole, want)) continue;
            Color through(1), light(0);
            for (const Boundary& b : want) {
                light = light + through * opacity[b.part] * colourOf(b.part);
                through = through * (Color(1) - opacity[b.part]);
            }
            const SampleResult r = s.trace({&ray, 1})[0];
            for (int k = 0; k < 3; ++k) {
                EXPECT_NEAR(r.opacity[k], 1 - through[k], 1e-6) << want.size();
                EXPECT_NEAR(r.color[k], light[k], 1e-6) << want.size();
            }
            most = std::max(most, int(want.size()));
        }
        EXPECT_EQ(most, 4); // in, into the hole, out of it, out
    }
    // The shadow on a floor straight under the middle: in above, through the hole, out below.
    Scene shade(inWorld("LightSource \"pointlight\" 1 \"intensity\" 100 \"from\" [0 10 0]\nAttributeBegin\nSurface \"constant\"\n"
                        "TransformBegin\nTranslate 0 3 0\nRotate 30 1 0 0\nTranslate 0 0 -5\n" +
                        solid +
                        "TransformEnd\nAttributeEnd\n"
                        "Surface \"matte\" \"float Ka\" 0 \"float Kd\" 1\n" +
                        kFloor),
                withShaders(Hider::Path));
    Scene bare(
        inWorld("LightSource \"pointlight\" 1 \"intensity\" 100 \"from\" [0 10 0]\nSurface \"matte\" \"float Ka\" 0 \"float "
                "Kd\" 1\n" +
                std::string(kFloor)),
        withShaders(Hider::Path));
    // In the space of the solid the ray goes along -y turned by -30 degrees about x, through its middle.
    CameraRay inside;
    const double a = kPi / 6;
    inside.direction = Vec3(0, float(-std::cos(a)), float(std::sin(a)));
    inside.origin = Vec3(0, 0, 5) - inside.direction * 7.f;
    std::vector<Boundary> want;
    ASSERT_TRUE(boundaries(std::array<Ball, 2>{{{{0, 0, 5}, 1}, {{0, 0, 4.6}, .8}}}, inside, 1e-5, whole, want));
    ASSERT_EQ(want.size(), 4u);
    for (int k = 0; k < 3; ++k) {
        double through = 1;
        for (const Boundary& b : want) through *= 1 - double(opacity[b.part][k]);
        EXPECT_NEAR(shade.one(kView)[k] / bare.one(kView)[k], through, 1e-5) << k;
    }
}

// Where two balls of radius 1 are both, 1.2 apart: a lens whose rim has the radius .8. Seen from where no edge but the rim is
// seen it lights like a disc. Under its axis, and beside it.
TEST(SolidParts, ALensLightsLikeItsRim) {
    writeLamps();
    for (const double beside : {0., .9}) {
        const std::string lens = block("intersection", part(ball(beside, 3.6, 0, 1)) + part(ball(beside, 2.4, 0, 1)));
        expectLight(onFloor(lamp(1, "one", lens)), underDisc(.8, 3, beside), 1e-3, "lens " + text(beside));
    }
}

// A ball of radiance 1 that a box of radiance 3 cuts in its middle: the flat face is the box's. And each part alone.
TEST(SolidParts, ALampOfTwoParts) {
    writeLamps();
    const std::string below = "PointsPolygons [4 4 4 4 4 4] [0 2 3 1  4 5 7 6  0 1 5 4  2 6 7 3  0 4 6 2  1 3 7 5] \"P\" "
                              "[-3 0.5 -3  3 0.5 -3  -3 2 -3  3 2 -3  -3 0.5 3  3 0.5 3  -3 2 3  3 2 3]\n";
    const std::string kBoth = "Illuminate 1 1\nIlluminate 2 1\n";
    const auto half = [&](const std::string& a, const std::string& b, const std::string& on) {
        return onFloor(block("difference", part(a + ball(0, 2, 0, 1)) + part(b + below)), on);
    };
    const std::string one = lamp(1, "one", ""), three = lamp(2, "three", ""), dark = "AreaLightSource \"null\" \"none\"\n";
    // Seen from below there is the face alone.
    expectLight(half(one, three, kBoth), 3 * underDisc(1, 2, 0), 1e-3, "both");
    expectLight(half(dark, three, "Illuminate 2 1\n"), 3 * underDisc(1, 2, 0), 1e-3, "the face");
    // A ball with a ball taken out of its lower end: the rim has a wall of radiance 3 within it, and a shell of 1 around it. The
    // rim: at the height where the two meet; all that is seen within it is the hollow, whatever its depth.
    const double d = 1.2, y = 3 - (1 + d * d - .36) / (2 * d),
                 rim = std::sqrt(1 - (3 - y) * (3 - y)); // centres 3 and 1.8, radii 1 and .6
    const double inner = underDisc(rim, y, 0), ballAll = 1. / 9;
    // The whole ball's outline is seen from the origin; of it the cone through the rim shows the hollow.
    expectLight(onFloor(block("difference", part(one + ball(0, 3, 0, 1)) + part(three + ball(0, 1.8, 0, .6))), kBoth),
                (ballAll - inner) + 3 * inner, 1e-3, "hollow");
    expectLight(onFloor(block("difference", part(one + ball(0, 3, 0, 1)) + part(dark + ball(0, 1.8, 0, .6)))), ballAll - inner,
                1e-3, "shell");
}

// A lens whose parts move in the meantime: at each time it lights from where it is.
TEST(SolidParts, ALampMoves) {
    writeLamps();
    const std::string lens = block(
        "intersection",
        part("TransformBegin\n" + moving("Translate 0 3.6 0", "Translate 0 2.6 0") + ball(0, 0, 0, 1) + "TransformEnd\n") +
            part("TransformBegin\n" + moving("Translate 0 2.4 0", "Translate 0 1.4 0") + ball(0, 0, 0, 1) + "TransformEnd\n"));
    for (const float t : {0.f, .5f, 1.f})
        expectLight("Shutter 0 1\n" + onFloor(lamp(1, "one", lens)), underDisc(.8, 3 - double(t), 0), 1e-3, "at " + text(t),
                    at(t, kView));
}

} // namespace solids_test
