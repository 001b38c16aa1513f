// Sides 1: a surface is not there for who looks at it from behind, in whatever way light is found: by rays, shadow rays, photons,
// transmission(), in loops, and with traced shadows outside of path. A white floor with a sheet over it.
#include "integrator/floorscene.h"
#include "integrator/integrator.h"
#include "world/photonmaps.h"

namespace sides_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

const std::string kLambert = "Surface \"matte\" \"float Ka\" 0 \"float Kd\" 1\n";
const std::string kLamp = "AttributeBegin\nSurface \"constant\"\nColor 0 0 0\nAttribute \"light\" \"string units\" \"radiance\"\n"
                          "AreaLightSource \"sidelamp\" 1\nPatch \"bilinear\" \"P\" [-2 3 -2  2 3 -2  -2 3 2  2 3 2]\n"
                          "AttributeEnd\nIlluminate 1 1\n";
/// A black sheet at height 1, wider than all that the floor at the origin sees of the lamp. Its normal is up or down.
std::string sheet(bool up, const std::string& sides = "Sides 1\n") {
    return "AttributeBegin\nOrientation \"" + std::string(up ? "outside" : "inside") + "\"\n" + sides +
           "Surface \"constant\"\nColor 0 0 0\nPatch \"bilinear\" \"P\" [-9 1 -9  9 1 -9  -9 1 9  9 1 9]\nAttributeEnd\n";
}
/// The sheet through which the floor is seen, and light comes.
bool upIsBack() {
    static const bool back = [] {
        writeShader("sidewhite", "surface sidewhite() { Oi = 1; Ci = 1; }\n");
        Scene s(inWorld("AttributeBegin\nSurface \"sidewhite\"\nSides 1\nPatch \"bilinear\" \"P\" [-9 1 -9  9 1 -9  -9 1 9  9 1 "
                        "9]\nAttributeEnd\n"),
                withShaders(Hider::Path));
        return s.one(rayTo({0, 0, 0}, {.1f, 1, 0})).x == 0;
    }();
    return back;
}
std::string open() { return sheet(upIsBack()); }
std::string closed() { return sheet(!upIsBack()); }

/// diffuse() under the lamp of radiance 1: a square of side 4 at height 3.
double underLamp() {
    const double x = 2. / 3, c = x / std::sqrt(1 + x * x);
    return 4 * c * std::atan(c) / kPi; // four corners, each a / r atan(b / r)
}

Settings of(Hider h, int mode = 0) {
    Settings s = withShaders(h);
    s.bsdfOnly = mode == 1;
    s.lightOnly = mode == 2;
    return s;
}
const CameraRay kBelow = rayTo({.3f, .4f, -.4f}, {0, 0, 0}); ///< the eye is under the sheet

void shaders() {
    writeShader("sidelamp", "light sidelamp() { illuminate(P, N, PI) Cl = 1; }\n");
    writeShader("sideloop", "surface sideloop() { normal n = normalize(faceforward(N, I)); illuminance(P, n, PI / 2) Ci += Cl * "
                            "(normalize(L) . n); Oi = 1; }\n");
}

} // namespace

TEST(SidesOne, EveryWayOfFindingALamp) {
    shaders();
    for (const int mode : {0, 1, 2}) {
        Scene seen(inWorld(kLamp + open() + kLambert + kFloor), of(Hider::Path, mode));
        const Moments m = seen.estimate(kBelow, samples(mode == 1 ? 12'000 : 3000));
        EXPECT_NEAR(m.mean(), underLamp(), kZ * m.se()) << mode;
        EXPECT_LE(m.se(), .03 * underLamp()) << mode;
        Scene dark(inWorld(kLamp + closed() + kLambert + kFloor), of(Hider::Path, mode));
        EXPECT_EQ(dark.estimate(kBelow, 500).mean(), 0) << mode;
    }
    Scene loop(inWorld(kLamp + open() + "Surface \"sideloop\"\n" + kFloor), of(Hider::Path));
    const Moments m = loop.estimate(kBelow, samples(3000));
    EXPECT_NEAR(m.mean(), underLamp(), kZ * m.se());
    EXPECT_EQ(Scene(inWorld(kLamp + closed() + "Surface \"sideloop\"\n" + kFloor), of(Hider::Path)).estimate(kBelow, 500).mean(),
              0);
}

TEST(SidesOne, PointLightsAndSkies) {
    const std::string point = "Attribute \"light\" \"string shadows\" \"on\"\nLightSource \"pointlight\" 1 \"float intensity\" 9 "
                              "\"point from\" [0 3 0]\n";
    for (const Hider h : {Hider::Path, Hider::Hidden, Hider::Raytrace}) {
        EXPECT_NEAR(Scene(inWorld(point + open() + kLambert + kFloor), of(h)).one(kBelow).x, 1, 1e-5);
        EXPECT_EQ(Scene(inWorld(point + closed() + kLambert + kFloor), of(h)).one(kBelow).x, 0);
        EXPECT_EQ(Scene(inWorld(point + sheet(upIsBack(), "") + kLambert + kFloor), of(h)).one(kBelow).x, 0);
    }
    const std::string sky = "LightSource \"envlight\" 1 \"float intensity\" 1\n";
    const Moments m = Scene(inWorld(sky + open() + kLambert + kFloor), of(Hider::Path)).estimate(kBelow, 400);
    EXPECT_NEAR(m.mean(), 1, kZ * m.se() + .02); // beside the sheet at flat angles, too
}

// From where a way is asked for does not count: it is seen from the shaded point, or from the point that a light lights.
TEST(SidesOne, Transmission) {
    writeShader("sideway",
                "surface sideway(float back = 0; string sides = \"\";) { point up = P + vector \"world\" (0, 2, 0); if "
                "(sides == \"\") Ci = back > 0 ? transmission(up, P) : transmission(P, up); else Ci = "
                "transmission(P, up, \"hitsides\", sides); Oi = 1; }\n");
    writeShader("sideray",
                "light sideray(float back = 0;) { illuminate(point \"world\" (0, 3, 0)) { point from = Ps - L; Cl = 9 / "
                "(L . L) * (back > 0 ? transmission(from, Ps) : transmission(Ps, from)); } }\n");
    for (const Hider h : {Hider::Path, Hider::Hidden}) {
        for (const char* back : {"0", "1"}) {
            const std::string way = "Surface \"sideway\" \"float back\" " + std::string(back) + "\n" + kFloor;
            EXPECT_NEAR(Scene(inWorld(open() + way), of(h)).one(kBelow).x, 1, 1e-6) << back;
            EXPECT_EQ(Scene(inWorld(closed() + way), of(h)).one(kBelow).x, 0) << back;
            const std::string light = "LightSource \"sideray\" 1 \"float back\" " + std::string(back) + "\n";
            EXPECT_NEAR(Scene(inWorld(light + open() + kLambert + kFloor), of(h)).one(kBelow).x, 1, 1e-5) << back;
            EXPECT_EQ(Scene(inWorld(light + closed() + kLambert + kFloor), of(h)).one(kBelow).x, 0) << back;
        }
        for (const auto& [sides, openIs, closedIs] : {std::tuple{"front", 1, 0}, {"back", 0, 1}, {"both", 0, 0}}) {
            const std::string way = "Surface \"sideway\" \"string sides\" \"" + std::string(sides) + "\"\n" + kFloor;
            EXPECT_EQ(Scene(inWorld(open() + way), of(h)).one(kBelow).x, float(openIs)) << sides;
            EXPECT_EQ(Scene(inWorld(closed() + way), of(h)).one(kBelow).x, float(closedIs)) << sides;
        }
    }
}

// Photons go the other way: those that meet the front are there, and go on as well, for who looks from behind.
TEST(SidesOne, Photons) {
    shaders();
    const std::string white = "AttributeBegin\nOrientation \"" + std::string(upIsBack() ? "outside" : "inside") +
                              "\"\nSides 1\n" + kLambert +
                              "Patch \"bilinear\" \"P\" [-9 1 -9  9 1 -9  -9 1 9  9 1 9]\nAttributeEnd\n";
    const auto landed = [](const std::string& rib, float height) { // as diffuse() would have it, near the axis
        Scene s(inWorld(rib), of(Hider::Path));
        PhotonEmission emission(s.world, {}, s.diagnostics);
        PhotonEmission::Thread thread(emission, s.diagnostics);
        std::vector<StoredPhoton> all;
        EXPECT_TRUE(thread.emit(0, 0, 100'000, 100'000, all, nullptr));
        double sum = 0;
        for (const StoredPhoton& p : all)
            if (p.photon.bounces == 0 && std::fabs(p.photon.P.y - height) < .01f && std::hypot(p.photon.P.x, p.photon.P.z) < .8f)
                sum += double(p.photon.power.x) / (kPi * kPi * .64);
        return sum;
    };
    EXPECT_NEAR(landed(kLamp + open() + kLambert + kFloor, 0), underLamp(), .12 * underLamp());
    EXPECT_EQ(landed(kLamp + closed() + kLambert + kFloor, 0), 0);
    EXPECT_NEAR(landed(kLamp + white + kLambert + kFloor, 0), underLamp(), .12 * underLamp());
    // The lamp is two above the sheet.
    const double c = 1 / std::sqrt(2.), above = 4 * c * std::atan(c) / kPi;
    EXPECT_NEAR(landed(kLamp + white + kLambert + kFloor, 1), above, .12 * above);
}

// A fog that only scatters, in a ball of one side: all light of the lamp in it comes out, whatever the way of the normals. A wall
// around it receives 4 PI I, times PI for what diffuse() calls irradiance.
TEST(SidesOne, PhotonsScatterInAMedium) {
    for (const char* sides : {"Sides 2\n", "Sides 1\n", "Sides 1 ReverseOrientation\n"}) {
        const std::string fog = "AttributeBegin\nSurface \"null\"\nInterior \"medium\" \"color scattering\" [2 2 2] \"color "
                                "absorption\" [0 0 0]\n" +
                                std::string(sides) + "Sphere 1 -1 1 360\nAttributeEnd\n";
        Scene s(inWorld("LightSource \"pointlight\" 1 \"float intensity\" 1\n" + fog +
                        "Surface \"matte\" \"float Ka\" 0 \"float Kd\" .001\nSphere 3 -3 3 360\n"),
                of(Hider::Path));
        PhotonEmission emission(s.world, {}, s.diagnostics);
        PhotonEmission::Thread thread(emission, s.diagnostics);
        std::vector<StoredPhoton> all;
        EXPECT_TRUE(thread.emit(0, 0, 4000, 4000, all, nullptr));
        double sum = 0;
        for (const StoredPhoton& p : all)
            if (length(p.photon.P) > 2) sum += double(p.photon.power.x);
        EXPECT_NEAR(sum / (4 * kPi * kPi), 1, .02) << sides;
    }
}

} // namespace sides_test
