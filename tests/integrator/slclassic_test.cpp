// slclassic.sl: SLProject's classic ray tracer by its formulas (docs/design/slproject.md), each at points where they are known.
#include "integrator/floorscene.h"

namespace slclassic_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

const std::string kRays = "Option \"trace\" \"int maxdepth\" 20\n";
std::string floor(const std::string& parameters) {
    return "Attribute \"trace\" \"int maxspeculardepth\" 20\nSurface \"slclassic\" " + parameters + "\n" + kFloor;
}
/// Unit, from the floor to the eye of kView.
Vec3d toEye() { return normalize(Vec3d(.3, .8, -.4)); }

void expectColour(const Color& c, const Vec3d& want, const std::string& what, double error = 2e-5) {
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(c[k], want[k], error) << what << " " << k;
}

/// What a place looks like: its x and z, and 1.
void writePlaces() {
    writeShader("places",
                "surface places() { Oi = 1; Ci = color(xcomp(transform(\"world\", P)), zcomp(transform(\"world\", P)), 1); }\n");
}
std::string card(double y) {
    const std::string h = std::to_string(y);
    return "AttributeBegin\nSurface \"places\"\nPolygon \"P\" [-60 " + h + " -60  -60 " + h + " 60  60 " + h + " 60  60 " + h +
           " -60]\nAttributeEnd\n";
}

} // namespace

TEST(SlClassic, LightAndItsHighlight) {
    const Vec3d at(.5, 2, .7), L = normalize(at), H = normalize(L + toEye());
    const double d2 = dot(at, at);
    const std::string lamp =
        "LightSource \"slpoint\" 1 \"float intensity\" 2 \"float kc\" 0 \"float kq\" 1 \"point from\" [.5 2 .7]\n";
    for (const double exponent : {1., 10., 60., 700.})
        for (const Hider h : {Hider::Raytrace, Hider::Hidden}) {
            Scene s(
                inWorld(
                    lamp +
                    floor(
                        "\"color diffusecolor\" [.2 .4 .6] \"color specularcolor\" [.3 .2 .1] \"color ambientcolor\" [.1 .2 .3] "
                        "\"color globalambient\" [.5 .5 .5] \"color emissive\" [.01 .02 .03] \"float shininess\" " +
                        std::to_string(exponent))),
                withShaders(h));
            const double diff = 2 / d2 * L.y, spec = 2 / d2 * std::pow(H.y, exponent);
            expectColour(
                s.one(kView),
                Vec3d(.01 + .05 + .2 * diff + .3 * spec, .02 + .1 + .4 * diff + .2 * spec, .03 + .15 + .6 * diff + .1 * spec),
                "exponent " + std::to_string(exponent));
        }
    // Ambient lights; a light below the horizon; more than white is white.
    Scene ambient(inWorld("LightSource \"ambientlight\" 1 \"float intensity\" .25\n" +
                          floor("\"color ambientcolor\" [.4 .8 1] \"color diffusecolor\" [0 0 0]")),
                  withShaders(Hider::Raytrace));
    expectColour(ambient.one(kView), {.1, .2, .25}, "ambient");
    Scene below(inWorld("LightSource \"slpoint\" 1 \"point from\" [0 -1 0]\n" + floor("\"float shininess\" 1")),
                withShaders(Hider::Raytrace));
    expectColour(below.one(kView), {0, 0, 0}, "below");
    Scene bright(inWorld(lamp + floor("\"color diffusecolor\" [90 90 90]")), withShaders(Hider::Raytrace));
    expectColour(bright.one(kView), {1, 1, 1}, "cut at 1");
}

TEST(SlClassic, Shadows) {
    const std::string wall = "AttributeBegin\nSurface \"constant\"\nPolygon \"P\" [-9 1 -9 -9 1 9 9 1 9 9 1 -9]\nAttributeEnd\n";
    const std::string lamp = "Attribute \"light\" \"string shadows\" \"on\"\nLightSource \"slpoint\" 1 \"float intensity\" .5 "
                             "\"point from\" [0 2 0]\n";
    for (const bool blocked : {false, true}) {
        Scene s(inWorld(lamp + (blocked ? wall : "") + floor("\"color specularcolor\" [0 0 0] \"color diffusecolor\" [1 1 1]")),
                withShaders(Hider::Raytrace));
        Counters c;
        const Moments m = s.estimate(rayTo({.3f, .5f, -.4f}, {0, 0, 0}), 4, &c);
        EXPECT_NEAR(m.mean(), blocked ? 0 : .5, 1e-5);
        EXPECT_EQ(c.shadow, 4u);
    }
}

TEST(SlClassic, Mirrors) {
    writePlaces();
    const Vec3d v = toEye(), mirrored(-v.x / v.y, 1, -v.z / v.y); // meets y = 3 at three times that
    for (const char* fresnel : {"0", "1"}) {                      // Schlick's formula is for what lets light through
        Scene s(
            kRays +
                inWorld(card(3) +
                        floor("\"color diffusecolor\" [0 0 0] \"color ambientcolor\" [0 0 0] \"float kr\" .4 \"float fresnel\" " +
                              std::string(fresnel))),
            withShaders(Hider::Raytrace));
        Counters c;
        const Moments m = s.estimate(kView, 8, &c);
        EXPECT_NEAR(m.mean(0), .4 * 3 * mirrored.x, 1e-5);
        EXPECT_NEAR(m.mean(1), .4 * 3 * mirrored.z, 1e-5);
        EXPECT_NEAR(m.mean(2), .4, 1e-6);
        EXPECT_EQ(c.reflected, 8u);
        EXPECT_EQ(c.refracted, 0u);
    }
}

TEST(SlClassic, GlassBySnellAndSchlick) {
    writePlaces();
    const Vec3d v = toEye();
    const double cosine = v.y, sine = std::sqrt(1 - cosine * cosine), kn = 1.5, kr = .1, kt = .7;
    const double sineT = sine / kn, tangentT = sineT / std::sqrt(1 - sineT * sineT);
    const Vec3d side(-v.x / sine, 0, -v.z / sine); // the way that the ray goes, along the floor
    const std::string glass = "\"color diffusecolor\" [0 0 0] \"color ambientcolor\" [0 0 0] \"float kn\" 1.5 \"float kr\" .1 "
                              "\"float kt\" .7 \"float fresnel\" ";
    for (const bool fresnel : {false, true}) {
        Scene s(kRays + inWorld(card(3) + card(-2) + floor(glass + (fresnel ? "1" : "0"))), withShaders(Hider::Raytrace));
        Counters c;
        const Moments m = s.estimate(kView, 8, &c);
        const double F = kr + (1 - kr) * std::pow(1 - cosine, 5), through = fresnel ? 1 - F : kt, back = fresnel ? F : kr;
        for (const int k : {0, 1}) {
            const double d = k == 0 ? side.x : side.z;
            EXPECT_NEAR(m.mean(k), through * 2 * tangentT * d + back * 3 * sine / cosine * d, 2e-5) << fresnel << k;
        }
        EXPECT_NEAR(m.mean(2), through + back, 1e-5);
        EXPECT_EQ(c.reflected, 8u);
        EXPECT_EQ(c.refracted, 8u);
    }
    // From inside: out below the critical angle, all back beyond it.
    const std::string inside = "\"color diffusecolor\" [0 0 0] \"color ambientcolor\" [0 0 0] \"float kn\" 1.5 \"float kr\" 0 "
                               "\"float kt\" 1 \"float fresnel\" 0";
    Scene s(kRays + inWorld(card(3) + card(-2) + floor(inside)), withShaders(Hider::Raytrace));
    for (const double x : {.3, .85, .95, 3.}) { // the critical tangent is 1 / sqrt(1.25) = .894
        const double sin1 = x / std::sqrt(1 + x * x), sin2 = 1.5 * sin1;
        const Color c = s.one(rayTo({float(-x), -1, 0}, {0, 0, 0}));
        expectColour(c, {sin2 < 1 ? 3 * sin2 / std::sqrt(1 - sin2 * sin2) : 2 * x, 0, 1}, "from inside, " + std::to_string(x),
                     2e-4);
        Counters count;
        s.estimate(rayTo({float(-x), -1, 0}, {0, 0, 0}), 1, &count);
        EXPECT_EQ(count.totalReflected, sin2 < 1 ? 0u : 1u) << x;
        EXPECT_EQ(count.refracted, sin2 < 1 ? 1u : 0u) << x;
        EXPECT_EQ(count.reflected, 0u) << x;
    }
}

// Two mirrors that face each other: each sends a quarter on, and where a 256th or less would arrive nothing is sent: four
// reflections.
TEST(SlClassic, ContributionIsCut) {
    const std::string
        upper = "Polygon \"P\" [-60 1 -60  60 1 -60  60 1 60  -60 1 60]\n",
        looks = "\"color diffusecolor\" [0 0 0] \"color ambientcolor\" [0 0 0] \"color emissive\" [.5 .5 .5] \"float kr\" .25";
    const struct {
        const char* more;
        int rays;
    } cases[] = {{"", 4},
                 {" \"float mincontribution\" .01", 4},
                 {" \"float mincontribution\" .02", 3},
                 {" \"float mincontribution\" .9", 1},
                 {" \"float mincontribution\" 1", 0},
                 {" \"float mincontribution\" 0", 20}};
    for (const auto& c : cases) {
        Scene s(kRays + inWorld(floor(looks + c.more) + upper), withShaders(Hider::Raytrace));
        Counters count;
        const Moments m = s.estimate(rayTo({0, .5f, 0}, {0, 0, 0}), 1, &count);
        double want = 0;
        for (int k = 0; k <= c.rays; ++k) want += .5 * std::pow(.25, k);
        EXPECT_NEAR(m.mean(), want, 1e-6) << c.more;
        EXPECT_EQ(count.reflected, uint64_t(c.rays)) << c.more;
        EXPECT_EQ(count.ignored, c.rays < 20 ? 1u : 0u) << c.more;
        EXPECT_EQ(count.tests, uint64_t(c.rays) + 1) << c.more; // every ray meets a mirror
        EXPECT_EQ(count.hits, count.tests) << c.more;
        EXPECT_EQ(count.depthMax, c.rays) << c.more;
    }
    // Without weights all of its way is 1.
    writeShader("weightless", "surface weightless() { float w = 0; rayinfo(\"weight\", w); Oi = 1; Ci = w + .5 * trace(P, N, "
                              "\"weight\", color(.5, .25, 0)); }\n");
    Scene s("Option \"trace\" \"int maxdepth\" 3\n" +
                inWorld("Attribute \"trace\" \"int maxspeculardepth\" 3\nSurface \"weightless\"\n" + std::string(kFloor) + upper),
            withShaders(Hider::Raytrace));
    EXPECT_NEAR(s.one(rayTo({0, .5f, 0}, {0, 0, 0})).x, 1 + .25 + .0625 + .015625,
                1e-6); // (1/2 of the sum) times (1/2 of the weight)
}

} // namespace slclassic_test
