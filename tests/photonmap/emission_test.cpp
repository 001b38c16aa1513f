// Photons as lights emit them and surfaces scatter them: their power against closed forms, maps against closed forms, the same
// bits in any company.
#include "bsdf/sampling.h"
#include "integrator/floorscene.h"
#include "integrator/integrator.h"
#include "photonmap/photonmap.h"
#include "world/photonmaps.h"
#include <cstring>

namespace emission_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

/// All that come to rest of one emission.
std::vector<StoredPhoton> emitted(Scene& s, uint32_t count, const PhotonUse& use = {}, uint32_t block = 4096) {
    PhotonEmission emission(s.world, use, s.diagnostics);
    PhotonEmission::Thread thread(emission, s.diagnostics);
    std::vector<StoredPhoton> all;
    for (uint32_t first = 0; first < count; first += block)
        EXPECT_TRUE(thread.emit(0, first, std::min(block, count - first), count, all, nullptr));
    return all;
}
/// Power of those with so many bounces.
double powerOf(const std::vector<StoredPhoton>& all, int bounces, int channel = 0) {
    double sum = 0;
    for (const StoredPhoton& p : all)
        if (p.photon.bounces == bounces) sum += double(p.photon.power[channel]);
    return sum;
}

const std::string kMatte = "Surface \"matte\" \"float Ka\" 0 \"float Kd\" .5\n";
const std::string kBall = kMatte + "Sphere 5 -5 5 360\n"; // about everything
Settings path() { return withShaders(Hider::Path); }

// Between levels of detail a shape is there for some photons, by the chance of that level, whichever it is.
TEST(Emission, OfWhatFades) {
    const std::string light = "LightSource \"pointlight\" 1 \"float intensity\" 3 \"point from\" [1 .5 2]\n";
    const double power = 3 * kPi * 4 * kPi;
    for (const auto& [levels, part] : {std::pair{"0 .3", .3}, std::pair{".3 1", .7}}) {
        Scene s(inWorld(light + "Attribute \"user\" \"float[2] level\" [" + levels + "]\n" + kBall), path());
        const double n = 40000;
        EXPECT_NEAR(powerOf(emitted(s, uint32_t(n)), 0), part * power, 4.5 * std::sqrt(part * (1 - part) / n) * power) << levels;
    }
}

// A photon's power is the same whatever it meets first; all together carry what the light sends.
TEST(Emission, PowerOfLights) {
    struct Case {
        std::string light;
        double power, error;
    };
    const double pi = kPi;
    const std::string area =
        "AttributeBegin AreaLightSource \"slrect\" 1 \"float intensity\" 7 Surface \"constant\" Color 0 0 0 ";
    const Case cases[] = {
        // Intensity pi a steradian for Cl = 1 / d^2: 4 pi of them.
        {"LightSource \"pointlight\" 1 \"float intensity\" 3 \"point from\" [1 .5 2]\n", 3 * pi * 4 * pi, 1e-4},
        // A one-sided rectangle, a sphere, a disc of both sides: pi L A.
        {area + "Sides 1 Polygon \"P\" [-.5 1 -.3  -.5 1 .4  .5 1 .4  .5 1 -.3] AttributeEnd\nIlluminate 1 1\n", 7 * pi * .7,
         1e-4},
        {area + "Sides 1 Sphere .4 -.4 .4 360 AttributeEnd\nIlluminate 1 1\n", 7 * pi * 4 * pi * .16, .01},
        {area + "Sides 2 Disk 0 .5 360 AttributeEnd\nIlluminate 1 1\n", 7 * pi * pi * .25, .01},
        // BMRT's: intensity over squared distance; as radiance pi I / A, so pi A of that.
        {"AttributeBegin AreaLightSource \"arealight\" 1 \"float intensity\" 2 Surface \"constant\" Color 0 0 0 Sides 1 "
         "Polygon \"P\" [-.5 1 -.5  -.5 1 .5  .5 1 .5  .5 1 -.5] AttributeEnd\nIlluminate 1 1\n",
         2 * pi * pi, 1e-3}};
    for (const Case& c : cases) {
        Scene s(inWorld(c.light + kBall), path());
        const auto all = emitted(s, 40000);
        EXPECT_NEAR(powerOf(all, 0), c.power, c.error * c.power) << c.light;
        EXPECT_NEAR(PhotonEmission(s.world, {}, s.diagnostics).power(), c.power, .2 * c.power) << c.light;
        // Half of what arrives goes on.
        EXPECT_NEAR(powerOf(all, 1), c.power / 2, .03 * c.power) << c.light;
        EXPECT_NEAR(powerOf(all, 2), c.power / 4, .03 * c.power) << c.light;
    }
}

// What turns to rays shines in all directions: a disc shows each its whole area, a square too, and a ribbon its area times the
// sine of the angle to its axis. Power and the mean square of each coordinate of a direction, both with the ribbon along y.
TEST(Emission, OfWhatTurnsToRays) {
    writeShader("white5", "light white5() { illuminate(P, N, PI / 2) Cl = 5; }\n");
    struct Case {
        const char* lamp;
        double power, along; ///< along: mean square of y
    };
    const double pi = kPi;
    for (const Case& c : {Case{"Points \"P\" [0 0 0] \"constantwidth\" .2", 5 * 4 * pi * pi * .01, 1. / 3},
                          Case{"Points \"P\" [0 0 0] \"constantwidth\" .2 \"string type\" \"patch\"", 5 * 4 * pi * .04, 1. / 3},
                          Case{"Curves \"linear\" [2] \"nonperiodic\" \"P\" [0 -.1 0 0 .1 0] \"constantwidth\" .02",
                               5 * pi * pi * .2 * .02, .25}}) {
        Scene s("Hider \"path\"\n" +
                    inWorld("AttributeBegin AreaLightSource \"white5\" 1 Surface \"constant\" Color 0 0 0 Sides 1\n" +
                            std::string(c.lamp) + " AttributeEnd\nIlluminate 1 1\n" + kBall),
                path());
        const int n = 40000;
        Moments squares;
        double sum = 0;
        for (const StoredPhoton& p : emitted(s, n)) {
            if (p.photon.bounces != 0) continue;
            const Vec3 d = p.photon.P / 5;
            sum += double(p.photon.power.x);
            squares.add(p.photon.power.x * float(n) * d * d);
        }
        EXPECT_NEAR(sum, c.power, .01 * c.power) << c.lamp;
        for (int k = 0; k < 3; ++k) {
            const double want = (k == 1 ? c.along : (1 - c.along) / 2) * c.power;
            EXPECT_LE(std::fabs(squares.mean(k) - want), kZ * squares.se(k)) << c.lamp << ", " << k;
        }
    }
}

// A disc that turns to rays looks like a ball of its radius: light samples find pi L (r / h)^2 below it, and photons bring to a
// floor, within rho, pi L r^2 2 pi (1 - h / sqrt(h^2 + rho^2)).
TEST(Emission, FloorBelowABillboard) {
    writeShader("white5", "light white5() { illuminate(P, N, PI / 2) Cl = 5; }\n");
    const std::string lamp = "AttributeBegin AreaLightSource \"white5\" 1 Surface \"constant\" Color 0 0 0 Points \"P\" [0 2 0] "
                             "\"constantwidth\" 1 AttributeEnd\nIlluminate 1 1\n";
    Scene s("Hider \"path\"\n" + inWorld(lamp + "Surface \"matte\" \"float Ka\" 0 \"float Kd\" 1\n" + kFloor), path());
    const double h = 2, r = .5, pi = kPi;
    expectMean(s.estimate(kView, 4000), 5 * r * r / (h * h), .01, "light samples");
    const int n = 200000;
    const std::vector<StoredPhoton> all = emitted(s, n);
    for (const double rho : {.5, 2., 6.}) {
        double sum = 0, one = 0;
        for (const StoredPhoton& p : all)
            if (const Vec3 at = p.photon.P; std::hypot(double(at.x), double(at.z)) < rho) sum += one = double(p.photon.power.x);
        const double want = pi * 5 * r * r * 2 * pi * (1 - h / std::hypot(h, rho));
        EXPECT_NEAR(sum, want, kZ * std::sqrt(want * one)) << rho;
    }
}

// A ball of radius 1 that a displacement makes one of radius 1.5 sends pi L A of the latter, from where it is: none starts within
// it. Its facets have .3 % less area.
TEST(Emission, DisplacedLamp) {
    writeShader("swell", "displacement swell() { P += .5 * normalize(N); N = calculatenormal(P); }\n");
    writeShader("white5", "light white5() { illuminate(P, N, PI / 2) Cl = 5; }\n");
    const std::string lamp = "AttributeBegin AreaLightSource \"white5\" 1 Surface \"constant\" Color 0 0 0 Sides 1 Attribute "
                             "\"displacementbound\" \"float sphere\" 1\n"
                             "Displacement \"swell\"\nSphere 1 -1 1 360 AttributeEnd\nIlluminate 1 1\n";
    // The inner ball, which photons would meet that started at radius 1.
    const std::string inner = "AttributeBegin Color 0 0 0 " + kMatte + "Sphere 1.2 -1.2 1.2 360 AttributeEnd\n";
    Scene s(inWorld(lamp + inner + kBall), path());
    const double power = 5 * kPi * 4 * kPi * 2.25;
    double far = 0;
    for (const StoredPhoton& p : emitted(s, 40000))
        if (p.photon.bounces == 0 && length(p.photon.P) > 4) far += double(p.photon.power.x);
    EXPECT_NEAR(far, power, .01 * power);
}

// A spot: its shader's own fall-off to the rim, integrated over directions.
TEST(Emission, PowerOfASpot) {
    Scene s(inWorld("LightSource \"spotlight\" 1 \"float intensity\" 2 \"point from\" [0 1 0] \"point to\" [0 0 0] \"float "
                    "coneangle\" .6 "
                    "\"float conedeltaangle\" .2 \"float beamdistribution\" 3\n" +
                    kBall),
            path());
    double want = 0;
    const int n = 20000;
    for (int i = 0; i < n; ++i) { // over the cosine
        const double c = std::cos(.6) + (1 - std::cos(.6)) * (i + .5) / n, edge = std::cos(.4), low = std::cos(.6);
        const double t = std::clamp((c - low) / (edge - low), 0.0, 1.0);
        want += 2 * std::pow(c, 3) * t * t * (3 - 2 * t) * 2 * kPi * kPi * (1 - std::cos(.6)) / n;
    }
    EXPECT_NEAR(powerOf(emitted(s, 400000), 0), want, .02 * want);
}

// Light from far away: what falls on a floor is its area times the irradiance; on a ball in a sky, pi L times the surface.
TEST(Emission, PowerFromFarAway) {
    const std::string floor = "Polygon \"P\" [-2 0 -2  -2 0 2  2 0 2  2 0 -2]\n";
    Scene sun(inWorld("LightSource \"distantlight\" 1 \"float intensity\" 1.5 \"point from\" [0 1 0] \"point to\" [1 0 0]\n" +
                      kMatte + floor),
              path());
    EXPECT_NEAR(powerOf(emitted(sun, 100000), 0), 1.5 * kPi * std::sqrt(.5) * 16, .01 * 1.5 * kPi * std::sqrt(.5) * 16);
    Scene sky(inWorld("LightSource \"envlight\" 1 \"float intensity\" 2\n" + kMatte + "Sphere 1 -1 1 360\n"), path());
    EXPECT_NEAR(powerOf(emitted(sky, 100000), 0), 2 * kPi * 4 * kPi, .02 * 2 * kPi * 4 * kPi);
}

// A light that does not fall off, and one that shines through a slide: the photons carry what it sends where they arrive.
TEST(Emission, LightsAsTheirShadersSay) {
    writeShader(
        "photonslide",
        "light photonslide(point from = point \"world\" (0, 2, 0);) { illuminate(from) { vector d = vtransform(\"world\", L); "
        "Cl = ptransform(\"world\", Ps)[0] > 0 ? color(1, 0, 0) : color(0, .5, 0); } }\n");
    writeShader("photonflat", "light photonflat(point from = point \"world\" (0, 2, 0);) { illuminate(from) Cl = 1; }\n");
    const std::string floor = "Polygon \"P\" [-1 0 -1  -1 0 1  1 0 1  1 0 -1]\n";
    Scene s(inWorld("LightSource \"photonflat\" 1\n" + kMatte + floor), path());
    double want = 0; // irradiance pi cos over the floor
    const int n = 400;
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < n; ++k) {
            const double x = -1 + 2 * (i + .5) / n, z = -1 + 2 * (k + .5) / n;
            want += kPi * 2 / std::sqrt(x * x + z * z + 4) * 4 / (n * n);
        }
    EXPECT_NEAR(powerOf(emitted(s, 200000), 0), want, .01 * want);
}

// A class light that says by generatePhoton() where photons begin: a square of radiance 6 and area 2 sends pi L A about its
// normal, by the cosine, and nothing else of the light is asked. Where the density varies, each photon brings power over density.
TEST(Emission, AsGeneratePhotonSays) {
    writeShader("photonsquare", R"(#include <stdrsl/AreaSampler.h>
    class photonsquare(float intensity = 3; color lightcolor = 1) {
        public void light(output vector L; output color Cl) { L = 0; Cl = 0; }
        public void generateSamples(string integrationdomain; output __radiancesample samples[]) {
            stdrsl_AreaSampler sampler;
            sampler->generateSamples(Ps, "rect", 4, samples);
        }
        public void generatePhoton(output point origin; output vector direction; output color power; output float pdf) {
            stdrsl_AreaSampler sampler;
            float ss, tt, size;
            sampler->generatePhoton("rect", 1, origin, direction, ss, tt, size);
            power = intensity * lightcolor * size;
            pdf = intensity * size;
        }
    })");
    writeShader("photonpair", R"(class photonpair() {
        public void light(output vector L; output color Cl) { illuminate(point "shader" (0, 0, 0)) Cl = 1000; }
        public void generatePhoton(output point origin; output vector direction; output color power; output float pdf) {
            origin = point "shader" (0, 0, 0);
            pdf = random() < .75 ? 3 : 1;
            direction = vector "world" (0, pdf - 2, 0);
            power = pdf * color(1, .5, 0);
        }
    })");
    const int n = 40000;
    const double power = 6 * kPi * 2;
    Scene s(
        inWorld(
            "TransformBegin\nTranslate .5 1 -.5\nRotate 90 1 0 0\nScale 2 1 1\nLightSource \"photonsquare\" 1 \"intensity\" 6 "
            "\"lightcolor\" [1 .5 0]\nTransformEnd\n" +
            kBall),
        path());
    const auto all = emitted(s, n);
    EXPECT_NEAR(powerOf(all, 0), power, 1e-4 * power);
    EXPECT_NEAR(powerOf(all, 0, 1), power / 2, 1e-4 * power);
    EXPECT_EQ(powerOf(all, 0, 2), 0);
    Moments cosine;
    for (const StoredPhoton& p : all)
        if (p.photon.bounces == 0) cosine.add(Color(p.photon.direction().y));
    EXPECT_LE(std::fabs(std::fabs(cosine.mean()) - 2. / 3), kZ * cosine.se());
    Scene pair(inWorld("LightSource \"photonpair\" 1\n" + kBall), path());
    double up = 0, down = 0;
    for (const StoredPhoton& p : emitted(pair, n))
        if (p.photon.bounces == 0) (p.photon.P.y > 0 ? up : down) += double(p.photon.power.x);
    EXPECT_NEAR(up / (up + down), .75, 4.5 * std::sqrt(.75 * .25 / n));
}

// Only lights that say so, as soon as one does; lights without a place send none.
TEST(Emission, WhichLights) {
    const std::string other = "LightSource \"pointlight\" 2 \"float intensity\" 100 \"point from\" [1 1 1]\n";
    const std::string one = "Attribute \"light\" \"integer emitphotons\" 1\nLightSource \"pointlight\" 1 \"float intensity\" 1 "
                            "\"point from\" [-1 1 0]\n";
    const std::string none = "Attribute \"light\" \"integer emitphotons\" 0\n";
    const double unit = 4 * kPi * kPi;
    Scene some(inWorld(one + none + other + kBall), path());
    EXPECT_NEAR(powerOf(emitted(some, 4096), 0), unit, 1e-3 * unit);
    Scene all(inWorld(other + kBall), path());
    EXPECT_NEAR(powerOf(emitted(all, 4096), 0), 100 * unit, .1 * unit);
    EXPECT_TRUE(emitted(all, 4096, {.all = false}).empty());
    Scene off(inWorld(none + other + kBall), path());
    EXPECT_TRUE(emitted(off, 4096).empty());
    Scene placeless(inWorld("LightSource \"indirect\" 1\nLightSource \"ambientlight\" 2\n" + kBall), path());
    EXPECT_TRUE(emitted(placeless, 4096).empty());
}

// Attribute "photon" "shadingmodel" in the place of the shader's lobes; "visibility" "photon".
TEST(Emission, ShadingModels) {
    const std::string lamp = "LightSource \"pointlight\" 1 \"float intensity\" 1 \"point from\" [0 2 0]\n";
    const std::string outer = "AttributeBegin " + kMatte + "Sphere 9 -9 9 360 AttributeEnd\n";
    const double unit = 4 * kPi * kPi, half = (1 - 2 / std::sqrt(5.)) / 2; // of the light that goes through the disc below
    // Refraction takes energy for radiance: through the one surface, out of what is denser, light is n^2 times what is refracted.
    const auto through = [](double n) {
        const double kr = (n - 1) / (n + 1) * (n - 1) / (n + 1);
        return kr + (1 - kr) * n * n;
    };
    const double glass = through(1.5), water = through(1.33);
    struct Case {
        const char* model;
        double kept, caustic;
    };
    for (const Case& c : {Case{"matte", 1, 0},
                          {"chrome", 0, 1},
                          {"glass", 0, glass},
                          {"water", 0, water},
                          {"dielectric", 0, glass},
                          {"conductor", 0, 1},
                          {"transparent", 0, 0}}) {
        const std::string disc = std::string("AttributeBegin Attribute \"photon\" \"string shadingmodel\" \"") + c.model +
                                 "\" Color .5 .5 .5 Surface \"constant\" Rotate 90 1 0 0 Disk 0 1 360 AttributeEnd\n";
        Scene s(inWorld(lamp + disc + outer), path());
        const auto all = emitted(s, 100000);
        double onDisc = 0, caustics = 0, direct = 0;
        for (const StoredPhoton& p : all) {
            const bool far = length(p.photon.P) > 5;
            if (!far) onDisc += double(p.photon.power.x);
            else if (p.photon.bounces == 0) direct += double(p.photon.power.x);
            else if (p.caustic && p.photon.bounces == 1) caustics += double(p.photon.power.x);
        }
        EXPECT_NEAR(onDisc, c.kept * half * unit, .01 * unit) << c.model;
        EXPECT_NEAR(caustics, .5 * c.caustic * half * unit, .01 * unit) << c.model;
        EXPECT_NEAR(direct, (1 - (std::string(c.model) == "transparent" ? 0 : half)) * unit, .01 * unit) << c.model;
    }
    const std::string unseen = "AttributeBegin Attribute \"visibility\" \"integer photon\" 0 Surface \"matte\" Rotate 90 1 0 0 "
                               "Disk 0 1 360 AttributeEnd\n";
    Scene s(inWorld(lamp + unseen + outer), path());
    EXPECT_NEAR(powerOf(emitted(s, 20000), 0), unit, 1e-3 * unit);
}

// A surface that decides on what its rays bring scatters as a matte one, and says so.
TEST(Emission, SurfacesThatWait) {
    writeShader("photonwaits", "surface photonwaits() { color c = trace(P, reflect(normalize(I), normalize(N))); Oi = 1; Ci = "
                               "comp(c, 0) > .1 ? .5 : .25; }\n");
    Scene s(
        inWorld("LightSource \"pointlight\" 1 \"float intensity\" 1\nSurface \"photonwaits\" Color .5 .5 .5 Sphere 5 -5 5 360\n"),
        path());
    const auto all = emitted(s, 40000);
    EXPECT_NEAR(powerOf(all, 0), 4 * kPi * kPi, .01);
    EXPECT_NEAR(powerOf(all, 1), 2 * kPi * kPi, 1);
    EXPECT_NE(s.messages().find("photonwaits"), std::string::npos);
}

// The same photons, bit by bit, whatever they are emitted with, at any number of lanes.
TEST(Emission, SameBitsInAnyCompany) {
    const std::string scene = inWorld(
        "LightSource \"pointlight\" 1 \"float intensity\" 1 \"point from\" [0 2 0]\n"
        "AttributeBegin Surface \"slmaterial\" \"color diffusecolor\" [0 0 0] \"color transmissive\" [1 1 1] \"float kn\" 1.5 "
        "Sphere 1 -1 1 360 AttributeEnd\nSurface \"plastic\" Sphere 5 -5 5 360\n");
    Scene s(scene, path());
    const auto want = emitted(s, 6000);
    ASSERT_GT(want.size(), 6000u);
    const auto same = [&](const std::vector<StoredPhoton>& got) {
        if (got.size() != want.size()) return false;
        for (size_t i = 0; i < got.size(); ++i)
            if (std::memcmp(&got[i].photon, &want[i].photon, sizeof(photonmap::Photon)) != 0 || got[i].number != want[i].number)
                return false;
        return true;
    };
    EXPECT_TRUE(same(emitted(s, 6000, {}, 6000)));
    EXPECT_TRUE(same(emitted(s, 6000, {}, 517)));
    for (const int lanes : {4, 8}) {
        Settings narrow = path();
        narrow.lanes = lanes;
        Scene other(scene, narrow);
        EXPECT_TRUE(same(emitted(other, 6000))) << lanes;
    }
}

TEST(Emission, Stops) {
    Scene s(inWorld("LightSource \"pointlight\" 1 \"float intensity\" 1\n" + kBall), path());
    PhotonEmission emission(s.world, {}, s.diagnostics);
    PhotonEmission::Thread thread(emission, s.diagnostics);
    std::vector<StoredPhoton> all;
    const StopFlag stop{1};
    EXPECT_FALSE(thread.emit(0, 0, 4096, 4096, all, &stop));
}

void showing(const std::string& name, const std::string& value) {
    writeShader(name, "surface " + name +
                          "(string map = \"all.photons\";) { normal n = faceforward(normalize(N), I); Oi = 1; "
                          "Ci = 0 * diffuse(n) + " +
                          value + "; }\n");
}

// Irradiance under a point light: pi Cl cos, so Cl cos by photonmap(). The error falls as photons grow. Pixie's form goes by N.
TEST(PhotonMaps, UnderAPointLight) {
    showing("photonshow", "(photonmap(map, P, \"estimator\", 200) + photonmap(map, P, -N, \"estimator\", 200))");
    writeShader("photonfloor", "surface photonfloor() { Oi = 1; Ci = .5 * diffuse(normalize(N)); }\n");
    const std::string lamp = "LightSource \"pointlight\" 1 \"float intensity\" 4 \"point from\" [0 1 0]\n",
                      floor = "Polygon \"P\" [-2 0 -2  -2 0 2  2 0 2  2 0 -2]\n";
    double before = 1e9;
    for (const uint32_t count : {20000u, 1000000u}) {
        Scene s(inWorld(lamp + "Surface \"photonshow\"\n" + floor), path());
        Scene emitting(inWorld(lamp + "Surface \"photonfloor\"\n" + floor), path());
        std::vector<photonmap::Photon> photons;
        for (const StoredPhoton& p : emitted(emitting, count)) photons.push_back(p.photon);
        setPhotonMap(*s.world, "all.photons", std::move(photons));
        double error = 0;
        for (int i = 0; i < 25; ++i) {
            const double x = -.8 + .4 * (i % 5), z = -.8 + .4 * (i / 5), d2 = x * x + z * z + 1, want = 4 / d2 / std::sqrt(d2);
            const double got = double(s.one(rayTo({float(x) + .1f, .5f, float(z)}, {float(x), 0, float(z)})).x);
            error += (got - want) * (got - want) / (want * want) / 25;
        }
        error = std::sqrt(error);
        EXPECT_LT(error, before) << count;
        EXPECT_LT(error, count > 100000 ? .09 : .25) << count; // 200 photons: 7 %, and the gradient within their disc
        before = error;
    }
}

// A hollow furnace: within a ball of albedo a, lit from its middle, irradiance is that of the light over 1 - a everywhere.
// photonmap(), its part of other surfaces, and indirectdiffuse() by way of photons and by rays agree with the closed form.
TEST(PhotonMaps, HollowFurnace) {
    const double a = .5, direct = 4 / 25., all = direct / (1 - a), other = all - direct;
    const std::string ball =
        "Attribute \"visibility\" \"integer diffuse\" 1 \"integer specular\" 1\nAttribute \"photon\" \"string globalmap\" "
        "\"room.photons\" \"integer estimator\" 200\nSurface \"matte\" \"float Ka\" 0 \"float Kd\" .5\nSphere 5 -5 5 360\n";
    const std::string lamp = "LightSource \"pointlight\" 1 \"float intensity\" 4 \"point from\" [0 0 0]\n";
    showing("photonroom", "photonmap(\"room.photons\", P, n, \"estimator\", 500)");
    showing("photonroom1", "photonmap(\"room.photons\", P, n, \"estimator\", 500, \"mindepth\", 1)");
    showing("photongather", "indirectdiffuse(P, n, 64)");
    // Small plates near the wall, in 14 directions, see what the wall sees, of which they take little away.
    std::vector<Vec3> ways;
    for (const float u : {-1.f, 1.f}) {
        ways.insert(ways.end(), {Vec3(u, 0, 0), Vec3(0, u, 0), Vec3(0, 0, u)});
        for (const float v : {-.57735f, .57735f})
            for (const float w : {-.57735f, .57735f}) ways.push_back({u * .57735f, v, w});
    }
    const auto plates = [&](const std::string& shader) {
        std::string rib = "AttributeBegin Attribute \"visibility\" \"integer diffuse\" 0 \"integer specular\" 0 \"integer "
                          "photon\" 0 Surface \"" +
                          shader + "\"\n";
        for (const Vec3& d : ways) {
            const Basis b(d);
            rib += "Polygon \"P\" [";
            for (const auto [x, y] : {std::pair(-.01f, -.01f), {-.01f, .01f}, {.01f, .01f}, {.01f, -.01f}}) {
                const Vec3 at = d * 4.99f + b.t * x + b.u * y;
                rib += std::to_string(at.x) + " " + std::to_string(at.y) + " " + std::to_string(at.z) + " ";
            }
            rib += "]\n";
        }
        return rib + "AttributeEnd\n";
    };
    // Photons do not meet the plate.
    Scene emitting(inWorld(lamp + ball), path());
    const auto stored = emitted(emitting, nightly() ? 200000 : 100000);
    const std::vector<std::string> names = {"room.photons"};
    struct Case {
        const char* shader;
        double want;
    };
    for (const Case& c : {Case{"photonroom", all}, {"photonroom1", other}, {"photongather", a * all}}) {
        for (const Hider h : {Hider::Path, Hider::Raytrace}) {
            Scene s(inWorld(lamp + plates(c.shader) + ball), withShaders(h));
            for (auto& [name, photons] : photonsByMap(*emitting.world, names, stored))
                setPhotonMap(*s.world, name, std::move(photons));
            double mean = 0;
            for (const Vec3& d : ways) {
                const Vec3 beside = Basis(d).t * .003f;
                mean += s.estimate(rayTo(d * 4.9f + beside, d * 4.99f), 4).mean() / double(ways.size());
            }
            EXPECT_NEAR(mean, c.want, .04 * c.want) << c.shader << " " << int(h); // 500 photons at each: 4.5 %, 1.2 % of all
        }
    }
    EXPECT_NEAR(other, a * all, 1e-9);
}

// caustic() in a surface and in a light: the map of the surface's attributes. A mirror on the floor throws light to the ceiling.
TEST(PhotonMaps, CausticOfAMirror) {
    const std::string scene = "LightSource \"pointlight\" 1 \"float intensity\" 4 \"point from\" [0 1 0]\n"
                              "AttributeBegin Surface \"slmaterial\" \"color diffusecolor\" [0 0 0] \"color specularcolor\" [1 1 "
                              "1] Polygon \"P\" [-2 0 -2  -2 0 2  2 0 2  2 0 -2] AttributeEnd\n";
    const std::string ceiling = "Polygon \"P\" [-2 2 -2  -2 2 2  2 2 2  2 2 -2]\n",
                      maps = "Attribute \"photon\" \"string causticmap\" \"c.photons\" \"integer estimator\" 400\n";
    showing("photoncaustic", "caustic(P, n)");
    for (const std::string& shader :
         {std::string("Surface \"photoncaustic\"\n"),
          std::string("LightSource \"causticlight\" 2\nSurface \"matte\" \"float Ka\" 0 \"float Kd\" 1\n")}) {
        const bool light = shader[0] == 'L';
        Scene emitting(inWorld(scene + maps + "Surface \"matte\"\n" + ceiling), path());
        const auto stored = emitted(emitting, 600000);
        Scene s(inWorld(scene + maps + shader + ceiling), withShaders(Hider::Hidden));
        const std::vector<std::string> names = {"c.photons"};
        for (auto& [name, photons] : photonsByMap(*emitting.world, names, stored))
            setPhotonMap(*s.world, name, std::move(photons));
        // The image of the light lies 3 below the ceiling: Cl cos = 4 / 9 above it; the light itself is 1 away.
        const double want = 4 / 9. + (light ? 4 : 0), got = double(s.one(rayTo({.1f, 1.2f, 0}, {0, 2, 0})).x);
        EXPECT_NEAR(got, want, .15 * 4 / 9.) << light; // 400 photons: 5 %
    }
}

// A map that is not there: said once, with a place and a way out.
TEST(PhotonMaps, MissingMap) {
    showing("photonmissing", "photonmap(\"nosuch.photons\", P, n)");
    Scene s(inWorld("Surface \"photonmissing\"\n" + std::string(kFloor)), path());
    EXPECT_EQ(s.one(kView).x, 0);
    EXPECT_EQ(s.one(kView).x, 0);
    EXPECT_EQ(s.diagnostics.errors(), 1) << s.messages();
    EXPECT_NE(s.messages().find("there is no photon map \"nosuch.photons\""), std::string::npos) << s.messages();
    EXPECT_NE(s.messages().find("photonmissing.sl:1:"), std::string::npos) << s.messages();
}

} // namespace

} // namespace emission_test
