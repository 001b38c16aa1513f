// Photons that are placed by hand around a point: what lobes there give back of them, in closed form.
#include "integrator/floorscene.h"
#include "integrator/integrator.h"
#include "photonmap/photongrid.h"
#include "world/photonmaps.h"

namespace photongather_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

constexpr float kRadius = .5f;

photonmap::Photon photon(const Vec3& P, const Color& power, const Vec3& from, const Vec3& normal = {0, 1, 0}) {
    photonmap::Photon p;
    p.P = P;
    p.power = power;
    p.from = photonmap::packUnit(normalize(from));
    p.normal = photonmap::packUnit(normal);
    return p;
}
/// Three within kRadius of the origin, whose power sums to (.6, .9, .3); and others, which are too far away or lie on a wall.
std::vector<photonmap::Photon> aboutTheOrigin() {
    return {photon({.1f, 0, .2f}, {.1f, .2f, .1f}, {0, 1, 0}), photon({-.3f, 0, .1f}, {.2f, .3f, .1f}, {.8f, .6f, 0}),
            photon({0, 0, -.45f}, {.3f, .4f, .1f}, {-.5f, .7f, 2}), photon({.51f, 0, 0}, {9, 9, 9}, {0, 1, 0}),
            photon({0, .2f, 0}, {9, 9, 9}, {1, .5f, 0}, {1, 0, 0})};
}
constexpr float kSum[3] = {.6f, .9f, .3f};

/// Radiance at the origin of a floor. The power over the area that it is gathered from is irradiance; a diffuse surface gives
/// 1 / pi of that back, from wherever it comes. rho: reflectance.
void expectGivenBack(const std::string& shader, const Color& rho, const Settings& settings, const std::string& what) {
    Scene s(inWorld("Surface \"" + shader + "\"\nColor .8 .6 .4\n" + kFloor), settings);
    std::vector<std::unique_ptr<photonmap::PhotonGrid>> grids;
    grids.push_back(std::make_unique<photonmap::PhotonGrid>(aboutTheOrigin(), kRadius));
    setPhotonPasses(*s.world, 0, std::move(grids));
    const Moments m = s.estimate(kView, 16);
    for (int k = 0; k < 3; ++k) {
        const double want = double(rho[k]) * double(kSum[k]) / (kPi * kPi * double(kRadius) * double(kRadius));
        EXPECT_NEAR(m.mean(k), want, 1e-5 * want) << what << ", channel " << k;
    }
}

} // namespace

TEST(PhotonGather, GivesBackWhatIsWithinTheRadius) {
    const Settings s = withShaders(Hider::Path);
    const std::string begin = "() { normal n = faceforward(normalize(N), I); Oi = 1; Ci = Cs * ",
                      facets = "trace(P, n, \"distribution\", \"oren-nayar\", \"roughness\", 0, \"samplearealights\", 1)";
    const auto write = [&](const std::string& name, const std::string& value) {
        writeShader(name, "surface " + name + begin + value + "; }\n");
    };
    write("gathersone", ".5 * diffuse(n)");
    write("gathersfacets", ".5 * " + facets); // of roughness 0 they are Lambert's
    write("gatherstwo", "(.25 * diffuse(n) + .5 * " + facets + ")");
    write("gathersmuch", "2 * diffuse(n)");
    expectGivenBack("gathersone", Color(.8f, .6f, .4f) * .5f, s, "diffuse()");
    expectGivenBack("gathersfacets", Color(.8f, .6f, .4f) * .5f, s, "trace()");
    expectGivenBack("gatherstwo", Color(.8f, .6f, .4f) * .75f, s, "both");
    // Light of photons comes from surfaces: under the energy rule a surface gives no more of it back than it receives.
    expectGivenBack("gathersmuch", Color(.8f, .6f, .4f) * (2 / 1.6f), s, "under the energy rule");
    Settings unbiased = s;
    unbiased.unbiased = true;
    expectGivenBack("gathersmuch", Color(.8f, .6f, .4f) * 2.f, unbiased, "without the energy rule");
}

// Photons of a window of time count, per time that the window lasts: at the ends of the shutter it lasts half as long.
TEST(PhotonGather, GivesBackWhatIsWithinTheWindow) {
    Scene s("Shutter 0 1\n" + inWorld("Surface \"matte\" \"float Ka\" 0 \"float Kd\" 1\n" + std::string(kFloor)),
            withShaders(Hider::Path));
    std::vector<photonmap::Photon> all;
    std::vector<float> times;
    for (const float t : {.05f, .3f, .45f, .5f, .55f, .7f}) {
        all.push_back(photon({.1f, 0, .1f}, Color(.1f), {.3f, 1, .2f}));
        times.push_back(t);
    }
    std::vector<std::unique_ptr<photonmap::PhotonGrid>> grids;
    grids.push_back(std::make_unique<photonmap::PhotonGrid>(std::move(all), kRadius, times, .2f));
    setPhotonPasses(*s.world, 0, std::move(grids));
    for (const auto& [time, count, lasts] : {std::tuple(.5f, 3, .2), {0.f, 1, .1}, {.9f, 0, .2}}) {
        CameraRay ray = kView;
        ray.time = ray.shutter = time;
        const double want = count * .1 / lasts / (kPi * kPi * double(kRadius) * double(kRadius));
        EXPECT_NEAR(s.estimate(ray, 4).mean(), want, 1e-5 * want) << time;
    }
}

// A lamp that shines down and is not there from above lights a ceiling by way of a mirror, or of a lobe that photons treat as
// one. Where photons bring that light, paths leave it all to them: without a photon nearby the ceiling is black, bit by bit. What
// an eye sees in the mirror is not theirs.
TEST(PhotonGather, PathsLeaveToPhotonsWhatTheyBring) {
    const std::string begin = " { normal n = faceforward(normalize(N), I); Oi = 1; Ci = ";
    writeShader("exactmirror", "surface exactmirror()" + begin + "trace(P, reflect(normalize(I), n)); }\n");
    writeShader("nearlymirror", "surface nearlymirror()" + begin +
                                    "trace(P, n, \"distribution\", \"cook-torrance\", \"roughness\", .06, \"samplearealights\", "
                                    "1, \"type\", \"specular\"); }\n");
    const std::string lamp =
                          "AttributeBegin Sides 1 AreaLightSource \"slrect\" 1 \"float intensity\" 5 Surface \"constant\" Color "
                          "0 0 0 Polygon \"P\" [-.5 1 -.5  .5 1 -.5  .5 1 .5  -.5 1 .5] AttributeEnd\nIlluminate 1 1\n",
                      ceiling =
                          "Surface \"matte\" \"float Ka\" 0 \"float Kd\" 1 Polygon \"P\" [-2 2 -2  -2 2 2  2 2 2  2 2 -2]\n";
    for (const char* shader : {"exactmirror", "nearlymirror"}) {
        Scene s(inWorld(lamp + "AttributeBegin Surface \"" + shader +
                        "\" Polygon \"P\" [-2 0 -2  -2 0 2  2 0 2  2 0 -2] AttributeEnd\n" + ceiling),
                withShaders(Hider::Path));
        const CameraRay up = rayTo({1.1f, 1.2f, 0}, {1, 2, 0}), down = rayTo({.3f, .8f, 0}, {.2f, 0, 0});
        EXPECT_GT(s.estimate(up, 2000).mean(), .01) << shader;
        PhotonEmission emission(s.world, {.all = true, .sky = false, .caustics = true, .width = .1f}, s.diagnostics);
        emission.markPhotonLights();
        std::vector<std::unique_ptr<photonmap::PhotonGrid>> grids;
        grids.push_back(std::make_unique<photonmap::PhotonGrid>(
            std::vector<photonmap::Photon>{photon({40, 2, 0}, Color(1), {0, -1, 0}, {0, -1, 0})}, .1f));
        setPhotonPasses(*s.world, 0, std::move(grids));
        const Moments left = s.estimate(up, 2000);
        EXPECT_EQ(left.q[0], 0) << shader << ": no sample brings any";
        EXPECT_GT(s.estimate(down, 200).mean(), 1) << shader << ": the lamp in the mirror";
    }
}

// A distant light at 60 degrees through a flat sheet of glass of index 1.5 whose roughness is small, so that photons follow its
// lobe as they follow a mirror. What the sheet does not reflect arrives below it, by Fresnel's equations: .911. Refraction in
// shaders keeps radiance, which comes from a narrower cone: the flux is that over the square of the index. 5 % for the roughness.
TEST(PhotonFlux, ThroughANarrowLobe) {
    writeShader("roughpane", "surface roughpane() { Oi = 1; Ci = trace(P, normalize(N), \"distribution\", \"glass-ggx\", "
                             "\"roughness\", .05, \"eta\", 1.5, \"samplearealights\", 1, \"type\", \"specular\"); }\n");
    Scene s(
        inWorld("LightSource \"distantlight\" 1 \"float intensity\" 2 \"from\" [1.7320508 1 0] \"to\" [0 0 0]\nAttributeBegin "
                "Surface \"roughpane\" Polygon \"P\" [-6 1 -6  -6 1 6  6 1 6  6 1 -6] AttributeEnd\n"
                "Surface \"matte\" \"float Ka\" 0 \"float Kd\" .5\n"
                "Polygon \"P\" [-3 0 -3  -3 0 3  3 0 3  3 0 -3]\n"),
        withShaders(Hider::Path));
    const double cosine = .5, refracted = std::sqrt(1 - .75 / 2.25), s1 = (cosine - 1.5 * refracted) / (cosine + 1.5 * refracted),
                 p1 = (1.5 * cosine - refracted) / (1.5 * cosine + refracted), passes = 1 - (s1 * s1 + p1 * p1) / 2;
    double flux = 0;
    PhotonEmission emission(s.world, {.all = true, .sky = false, .caustics = true, .width = .1f}, s.diagnostics);
    PhotonEmission::Thread thread(emission, s.diagnostics);
    std::vector<StoredPhoton> found;
    ASSERT_TRUE(thread.emit(0, 0, 60000, 60000, found, nullptr));
    for (const StoredPhoton& p : found)
        if (std::fabs(p.photon.P.x) < 2 && std::fabs(p.photon.P.z) < 2 && p.photon.P.y < .5f) flux += double(p.photon.power.x);
    EXPECT_NEAR(flux / 16, 2 * kPi * cosine * passes / 2.25, .05 * 2 * kPi * cosine / 2.25); // intensity is irradiance over pi
}

} // namespace photongather_test
