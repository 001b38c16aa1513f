// Light of point, spot and distant lights by mirrors and glass under path: against closed forms, and with beginnings of searches
// that mean nothing.
#include "integrator/floorscene.h"
#include "integrator/integrator.h"
#include "world/causticseeds.h"
#include "world/photonstore.h"
#include <random>

namespace specular_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

/// The picture's depth: an image, and nothing that lit surfaces send on.
Settings path(int depth = 2) {
    Settings s = withShaders(Hider::Path);
    s.maxDepth = depth;
    return s;
}

/// As the renderer does it; returns the number of seeds.
size_t seed(Scene& s, float brightness = .01f, uint32_t count = 20000) {
    PhotonEmission emission(s.world, {.caustics = true, .learns = true, .unmet = true}, s.diagnostics);
    if (!emission.lights()) return 0;
    PhotonEmission::Thread thread(emission, s.diagnostics);
    std::vector<StoredPhoton> found;
    std::vector<CausticSeed> seeds;
    EXPECT_TRUE(thread.emit(5, 0, 60000, 60000, found, nullptr));
    emission.addSeeds(found, 5, seeds, s.diagnostics);
    emission.learn(found, 5, 60000);
    found.clear();
    EXPECT_TRUE(thread.emit(6, 0, count, count, found, nullptr));
    emission.addSeeds(found, 6, seeds, s.diagnostics);
    const size_t many = seeds.size();
    if (many > 0) s.world->photons()->seeds = std::make_shared<const CausticSeeds>(std::move(seeds), brightness, 2);
    return many;
}

/// Seeds that came to rest anywhere in a box, with derivatives that mean nothing.
void seedWrongly(Scene& s, Vec3 low, Vec3 high) {
    ASSERT_GT(seed(s), 0u);
    const CausticSeeds& right = *s.world->photons()->seeds;
    const CausticSeeds::Range all = right.anywhere();
    std::mt19937 random(11);
    std::uniform_real_distribution<float> u;
    std::vector<CausticSeed> wrong;
    for (uint32_t i = 0; i < std::min(all.count, 3000u); ++i) {
        CausticSeed w = right.seed(all, i);
        for (int k = 0; k < 3; ++k) w.P[k] = low[k] + (high[k] - low[k]) * u(random);
        w.side = 1 + int(6 * u(random));
        for (Vec3& c : w.columns) c = Vec3(u(random) - .5f, u(random) - .5f, u(random) - .5f);
        wrong.push_back(w);
    }
    s.world->photons()->seeds = std::make_shared<const CausticSeeds>(std::move(wrong), .01f, 2);
}

/// Differences of 5e-4 of what is met have errors below this share.
constexpr double kDifferences = 1e-3;

void expectLight(const Moments& m, double want, double precision, const std::string& what) {
    EXPECT_NEAR(m.mean(), want, kZ * m.se() + kDifferences * want) << what << ": +- " << m.se();
    EXPECT_LE(m.se(), precision * want) << what << ": not precise enough to decide";
}

const std::string kMirror = "Surface \"slmaterial\" \"color diffusecolor\" [0 0 0] \"color specularcolor\" [1 1 1]\n";
const std::string kGlass = "Surface \"slmaterial\" \"color diffusecolor\" [0 0 0] \"color transmissive\" [1 1 1] \"float kn\" "
                           "1.5 \"string fresnel\" \"exact\"\n";
const std::string kGrey = "Surface \"matte\" \"float Ka\" 0 \"float Kd\" 1 Color .5 .5 .5\n";
const std::string kMirrorBelow = "AttributeBegin " + kMirror + "Polygon \"P\" [-2 0 -2  -2 0 2  2 0 2  2 0 -2] AttributeEnd\n";
const std::string kCeiling = kGrey + "Polygon \"P\" [-2 2 -2  -2 2 2  2 2 2  2 2 -2]\n";
/// Shines down only.
const std::string kSpot = "LightSource \"spotlight\" 1 \"from\" [0 1 0] \"to\" [0 0 0] \"coneangle\" 1.2 \"conedeltaangle\" .01 "
                          "\"beamdistribution\" 0\n";
const CameraRay kUp = rayTo({.02f, 1.2f, 0}, {0, 2, 0});

} // namespace

TEST(SpecularLights, ImageOfASpotInAMirror) {
    for (const bool right : {true, false}) {
        Scene s(inWorld(kSpot + kMirrorBelow + kCeiling), path());
        EXPECT_EQ(s.estimate(kUp, 100).mean(), 0) << "no ray finds this light";
        if (right) seed(s);
        else seedWrongly(s, {-2, 1.9f, -2}, {2, 2.1f, 2});
        Counters n;
        expectLight(s.estimate(kUp, samples(right ? 2000 : 40000), &n), .5 / 9, .02, right ? "learned" : "wrong");
        EXPECT_GT(n.searchesFound, 100u);
        EXPECT_LE(n.searchesFound, n.searches);
    }
}

// From 45 degrees, by a mirror that only light from the right reaches.
TEST(SpecularLights, ImageOfADistantLight) {
    Scene s(inWorld("LightSource \"distantlight\" 1 \"from\" [1 1 0] \"to\" [0 0 0] \"intensity\" 3\n" + kMirrorBelow + kGrey +
                    "Polygon \"P\" [-2.2 2 -.2  -2.2 2 .2  -1.8 2 .2  -1.8 2 -.2]"),
            path());
    EXPECT_GT(seed(s), 100u);
    expectLight(s.estimate(rayTo({-2, 1.2f, .1f}, {-2, 2, 0}), samples(2000)), .5 * 3 * std::sqrt(.5), .02, "distant");
}

// A sun of .2 radians above, whose mean cosine is (1 + cos .2) / 2. The patch itself shades the mirror: what leaves the middle at
// less than .05 radians along x and z, 4 units of way from the patch's edges, is dark.
TEST(SpecularLights, ImageOfASunWithAnAngle) {
    writeShader("wide", "light wide() { solar(vector(0, -1, 0), .2) { Cl = 3; } }\n");
    Scene s(inWorld("LightSource \"wide\" 1\n" + kMirrorBelow + kGrey + "Polygon \"P\" [-.2 2 -.2  -.2 2 .2  .2 2 .2  .2 2 -.2]"),
            path());
    EXPECT_GT(seed(s), 100u);
    const double dark = 4 * .05 * .05 / (2 * kPi * (1 - std::cos(.2))); // of the sun
    expectLight(s.estimate(rayTo({.1f, 1.2f, 0}, {0, 2, 0}), samples(20000)), .5 * 3 * ((1 + std::cos(.2)) / 2 - dark), .05,
                "sun");
}

// Two mirrors: each has an image, and searches find either.
TEST(SpecularLights, TwoMirrors) {
    for (const bool right : {true, false}) {
        Scene s(inWorld("LightSource \"pointlight\" 1 \"from\" [0 1 0]\n" + kMirrorBelow + "AttributeBegin " + kMirror +
                        "Polygon \"P\" [-1 -.1 -2  -1 -.1 2  -1 3 2  -1 3 -2] AttributeEnd\n" + kGrey +
                        "Polygon \"P\" [.4 2 -.1  .4 2 .1  .6 2 .1  .6 2 -.1]"),
                path(3));
        if (right) seed(s);
        else seedWrongly(s, {.3f, 1.9f, -.2f}, {.7f, 2.1f, .2f});
        // Seen from (.5, 2, 0): the light itself, its images at (0, -1, 0), (-2, 1, 0), (-2, -1, 0), the last by both mirrors.
        const auto by = [](double x, double y) { return (2 - y) / std::pow(std::hypot(.5 - x, 2 - y), 3); };
        const double want = .5 * (by(0, 1) + by(0, -1) + by(-2, 1) + by(-2, -1));
        expectLight(s.estimate(rayTo({.52f, 1.2f, 0}, {.5f, 2, 0}), samples(right ? 20000 : 60000)), want, .01,
                    right ? "learned" : "wrong");
    }
}

// The mirror rises by .2 while the shutter is open; the image's distance is 3 - 2 y at height y.
TEST(SpecularLights, AMirrorThatMoves) {
    Scene s("Shutter 0 1\n" + inWorld(kSpot + "AttributeBegin MotionBegin [0 1] Translate 0 0 0 Translate 0 .2 0 MotionEnd " +
                                      kMirrorBelow + "AttributeEnd\n" + kCeiling),
            path());
    EXPECT_GT(seed(s), 100u);
    std::vector<CameraRay> rays;
    const int n = samples(4000);
    for (int i = 0; i < n; ++i) {
        CameraRay r = kUp;
        r.px = i;
        r.time = r.shutter = (float(i) + .5f) / float(n);
        rays.push_back(r);
    }
    Moments m;
    for (const SampleResult& r : s.trace(rays)) m.add(r.color);
    expectLight(m, .5 * (1 / (2 * 2.6) - 1 / 6.) / .2, .02, "moving");
}

// A glass ball on the axis of a light and a floor. By Snell and Fresnel in double precision: where the ray at angle a from the
// axis lands after two refractions, and what of it passes. Light between two angles lands between two radii.
TEST(SpecularLights, GlassBall) {
    const double radius = .5, centre = 1, eye = 3, index = 1.5;
    // Radius on the floor and share that passes, of a ray at angle a.
    const auto lands = [&](double a, double& passes) {
        const double x0 = 0, y0 = eye, dx = std::sin(a), dy = -std::cos(a);
        const auto meet = [&](double x, double y, double ux, double uy, bool far) {
            const double b = x * ux + (y - centre) * uy, c = x * x + (y - centre) * (y - centre) - radius * radius;
            return far ? -b + std::sqrt(b * b - c) : -b - std::sqrt(b * b - c);
        };
        const auto refract = [&](double& ux, double& uy, double nx, double ny, double eta) { // n against u
            const double ci = -(ux * nx + uy * ny), st2 = eta * eta * (1 - ci * ci), ct = std::sqrt(1 - st2);
            ux = eta * ux + (eta * ci - ct) * nx, uy = eta * uy + (eta * ci - ct) * ny;
            const double rs = (eta * ci - ct) / (eta * ci + ct), rp = (eta * ct - ci) / (eta * ct + ci);
            return 1 - (rs * rs + rp * rp) / 2;
        };
        double t = meet(x0, y0, dx, dy, false), x = t * dx, y = eye + t * dy, ux = dx, uy = dy;
        passes = refract(ux, uy, x / radius, (y - centre) / radius, 1 / index);
        t = meet(x, y, ux, uy, true);
        x += t * ux, y += t * uy;
        passes *= refract(ux, uy, -x / radius, -(y - centre) / radius, index);
        return x - y / uy * ux;
    };
    // The rays cross the axis before the floor. Light within the annulus from r0 to r1, over pi and its area.
    const double r0 = .3, r1 = .5;
    double flux = 0, share = 0;
    const int steps = 200000;
    const double edge = std::asin(radius / (eye - centre)) * (1 - 1e-9);
    for (int i = 0; i < steps; ++i) {
        const double a = edge * (i + .5) / steps, r = std::fabs(lands(a, share));
        if (r > r0 && r < r1) flux += 2 * std::sin(a) * edge / steps * kPi * share;
    }
    const double want = .5 * flux / (kPi * (r1 * r1 - r0 * r0));
    for (const bool right : {true, false}) {
        Scene s(inWorld("LightSource \"pointlight\" 1 \"from\" [0 3 0]\nAttributeBegin " + kGlass +
                        "Translate 0 1 0 Sphere .5 -.5 .5 360 AttributeEnd\n" + kGrey +
                        "Polygon \"P\" [-.6 0 -.6  -.6 0 .6  .6 0 .6  .6 0 -.6]"),
                path(3));
        if (right) EXPECT_GT(seed(s), 100u);
        else seedWrongly(s, {-.6f, -.1f, -.6f}, {.6f, .1f, .6f});
        std::mt19937 random(9);
        std::uniform_real_distribution<float> u;
        std::vector<CameraRay> rays;
        for (int i = 0; i < samples(right ? 20000 : 40000); ++i) {
            const double r = std::sqrt(r0 * r0 + (r1 * r1 - r0 * r0) * u(random)), phi = 2 * kPi * u(random);
            const Vec3 at(float(r * std::cos(phi)), 0, float(r * std::sin(phi)));
            rays.push_back(rayTo(at + Vec3(0, .01f, 0), at));
            rays.back().px = i;
        }
        Moments m;
        for (const SampleResult& r : s.trace(rays)) m.add(r.color);
        // The direct light of the point is in the ball's shadow here: within .5 of the axis all of it meets the ball.
        expectLight(m, want, .03, right ? "learned" : "wrong");
    }
}

// Results depend on no other point of a batch.
TEST(SpecularLights, AloneAsTogether) {
    Scene s(inWorld(kSpot + kMirrorBelow + kCeiling + "AttributeBegin " + kGlass +
                    "Translate .5 .7 0 Sphere .2 -.2 .2 360 AttributeEnd\n"),
            path(6));
    seed(s, .05f);
    std::vector<CameraRay> rays;
    for (int i = 0; i < 64; ++i) {
        rays.push_back(rayTo({0, 1.2f, 0}, {.02f * float(i), 2, .1f}));
        rays.back().px = i;
    }
    const std::vector<SampleResult> together = s.trace(rays);
    float light = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
        EXPECT_EQ(s.trace({&rays[i], 1})[0].color, together[i].color) << i;
        light += together[i].color.x;
    }
    EXPECT_GT(light, 1);
}

// A light of class "L" that mirrors have sent on is <RS>L for light path outputs; __nondiffuse keeps it from diffuse lobes.
TEST(SpecularLights, LightsThatDiffuseLobesLeaveOut) {
    writeShader("nodiffuse", "light nodiffuse(output varying float __nondiffuse = 1;) { illuminate(point \"shader\" (0, 1, 0), "
                             "vector(0, -1, 0), 1.2) { Cl = 1 / (L . L); } }\n");
    Scene s(inWorld("LightSource \"nodiffuse\" 1\n" + kMirrorBelow + kCeiling), path());
    EXPECT_GT(seed(s), 100u);
    EXPECT_EQ(s.estimate(kUp, 200).mean(), 0);
}

// A mirror that throws each ray somewhere else has no path that could be found again.
TEST(SpecularLights, MirrorsByRandomNumbers) {
    writeShader("shaking", "surface shaking() { vector r = reflect(normalize(I), normalize(N)); Oi = 1;"
                           " Ci = trace(P, normalize(r + .2 * (vector random() - vector(.5, .5, .5)))); }\n");
    Scene s(inWorld(kSpot + "AttributeBegin Surface \"shaking\" Polygon \"P\" [-2 0 -2  -2 0 2  2 0 2  2 0 -2] AttributeEnd\n" +
                    kCeiling),
            path());
    EXPECT_EQ(seed(s), 0u);
}

// No search where no mirror is, nor for lamps that rays meet.
TEST(SpecularLights, NothingToSearch) {
    Scene plain(inWorld("LightSource \"pointlight\" 1 \"from\" [0 1 0]\n" + kCeiling), path());
    EXPECT_EQ(seed(plain), 0u);
    Scene lamp(
        inWorld("AttributeBegin AreaLightSource \"slrect\" 1 Surface \"constant\" Color 0 0 0 Translate 0 1 0 Sphere .1 -.1 .1 "
                "360 AttributeEnd Illuminate 1 1\n" +
                kMirrorBelow + kCeiling),
        path());
    EXPECT_EQ(seed(lamp), 0u);
}

} // namespace specular_test
