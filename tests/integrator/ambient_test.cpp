// Ambient light is what ambient() finds, weighed by what it is multiplied with; under path, what of it comes past other surfaces.
// Closed forms.
#include "integrator/floorscene.h"
#include <cmath>
#include <cstring>

namespace ambient_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

const char* const kLights = "LightSource \"ambientlight\" 1 \"intensity\" .5\nLightSource \"ambientlight\" 2 \"intensity\" .25 "
                            "\"lightcolor\" [1 .5 0]\n";
/// A wall of height 1 beside the origin, half a unit away, that gives no light: it hides (1 - x / sqrt(x^2 + h^2)) / 2.
const char* const kWall = "AttributeBegin\nSurface \"constant\"\nColor 0 0 0\n"
                          "Polygon \"P\" [.5 0 -9000  .5 0 9000  .5 1 9000  .5 1 -9000]\nAttributeEnd\n";
const double kOpen = 1 - (1 - .5 / std::sqrt(1.25)) / 2;
const CameraRay kAbove = rayTo({.2f, .4f, -.3f}, {0, 0, 0});

Color seen(const std::string& inside, Hider h = Hider::Path) {
    Scene s(inWorld(kLights + inside), withShaders(h));
    return s.one(kAbove);
}
void near(const Color& a, const Color& b, const std::string& what) {
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(a[k], b[k], 2e-6) << what << ", component " << k;
}

TEST(Ambient, IsWeighedByWhatItIsMultipliedWith) {
    const Color all(.75f, .625f, .5f);
    for (const Hider h : {Hider::Path, Hider::Hidden, Hider::Raytrace}) {
        const std::string under = "hider " + std::to_string(int(h));
        near(seen(std::string("Surface \"matte\" \"Ka\" 1 \"Kd\" 0\n") + kFloor, h), all, under);
        near(seen(std::string("Surface \"matte\" \"Ka\" .2 \"Kd\" 1\n") + kFloor, h), all * .2f, under);
        near(seen(std::string("Surface \"plastic\" \"Ka\" 0 \"Kd\" 1 \"Ks\" 1\n") + kFloor, h), Color(0), under);
        near(seen(std::string("Surface \"metal\" \"Ka\" .5 \"Ks\" 1\n") + kFloor, h), all * .5f, under); // no diffuse lobe
        near(seen(std::string("Illuminate 1 0\nSurface \"matte\"\n") + kFloor, h), Color(.25f, .125f, 0), under);
    }
}

// As VTK writes its files: an ambient light of 1, surfaces with Ka 0, and a headlight.
TEST(Ambient, OfIntensityOneAndKaZero) {
    Scene s(inWorld("LightSource \"ambientlight\" 1\nLightSource \"distantlight\" 2 \"intensity\" .5 \"from\" [0 1 0] \"to\" "
                    "[0 0 0]\nSurface \"plastic\" \"Ka\" 0 \"Kd\" 1 \"Ks\" 0\n" +
                    std::string(kFloor)),
            withShaders(Hider::Path));
    expectMean(s.estimate(kAbove, 200), .5, 1e-6, "the headlight alone");
}

// Neither rays nor loops find it.
TEST(Ambient, IsNotFoundByRays) {
    writeShader("ambrays", R"(surface ambrays() {
    normal n = faceforward(normalize(N), I);
    color sum = diffuse(n) + indirectdiffuse(P, n, 4) + trace(P, vector(n), "type", "diffuse");
    illuminance(P, n, PI / 2) sum += Cl;
    Oi = 1;
    Ci = sum;
}
)");
    for (const Hider h : {Hider::Path, Hider::Raytrace})
        near(seen(std::string("Surface \"ambrays\"\n") + kFloor, h), Color(0), "rays");
}

TEST(Ambient, BesideAWall) {
    Scene s(inWorld(kLights + std::string("Surface \"matte\" \"Ka\" 1 \"Kd\" 0\n") + kFloor + kWall), withShaders(Hider::Path));
    expectMean(s.estimate(kAbove, samples(20000)), .75 * kOpen, .01, "beside a wall");
    near(seen(std::string("Surface \"matte\" \"Ka\" 1 \"Kd\" 0\n") + kFloor + kWall, Hider::Hidden), {.75f, .625f, .5f},
         "hidden has no occlusion");
}

TEST(Ambient, ComesToTheSideThatIsSeen) {
    for (const char* orientation : {"", "ReverseOrientation\n"})
        for (const char* normals : {"", " \"N\" [0 1 0 0 1 0 0 1 0 0 1 0]", " \"N\" [0 -1 0 0 -1 0 0 -1 0 0 -1 0]"}) {
            Scene s(inWorld(kLights + std::string("Surface \"matte\" \"Ka\" 1 \"Kd\" 0\n") + orientation +
                            "Polygon \"P\" [-60 0 -60  -60 0 60  60 0 60  60 0 -60]" + normals + "\nTranslate 0 -3 0\n" + kFloor),
                    withShaders(Hider::Path));
            near(s.one(kAbove), {.75f, .625f, .5f}, std::string("above") + orientation + normals);
        }
}

// A kernel that decides on it waits for it.
TEST(Ambient, InAKernelThatWaits) {
    writeShader("ambwaits", "surface ambwaits() { color a = ambient(); Oi = 1; Ci = (comp(a, 0) > .7) ? a * a : color(9); }\n");
    near(seen(std::string("Surface \"ambwaits\"\n") + kFloor), Color(.5625f, .390625f, .25f), "squared");
}

// Surfaces that are lit by ambient light light others; what they hide is dark.
TEST(Ambient, IsReflected) {
    const std::string ceiling =
        "AttributeBegin\nSurface \"matte\" \"Ka\" 1 \"Kd\" 0\nTranslate 0 3 0\n" + std::string(kFloor) + "AttributeEnd\n";
    // From below the ceiling sees the floor: its ambient light is in the gap between them, which is narrow and far away, nearly
    // 0.
    Scene s(inWorld("LightSource \"ambientlight\" 1\nSurface \"matte\" \"Ka\" 0 \"Kd\" .5\n" + std::string(kFloor) + ceiling),
            withShaders(Hider::Path));
    EXPECT_LT(s.estimate(kAbove, 2000).mean(), .01);
    // A wall that shines instead hides a part of the hemisphere, of which the floor gives half.
    writeShader("ambalways", "surface ambalways() { Oi = 1; Ci = 1; }\n");
    Scene wall(inWorld("LightSource \"ambientlight\" 1\nSurface \"matte\" \"Ka\" 0 \"Kd\" .5\n" + std::string(kFloor) +
                       "Surface \"ambalways\"\nPolygon \"P\" [.5 0 -9000  .5 0 9000  .5 1 9000  .5 1 -9000]\n"),
               withShaders(Hider::Path));
    expectMean(wall.estimate(kAbove, samples(20000)), .5 * (1 - kOpen), .02, "a wall that shines");
}

// Outputs that ask for parts of Ci find the same in every sample, and do not change it.
TEST(Ambient, InPartsOfCi) {
    writeShader("ambparts", R"(surface ambparts(output varying color a = 0; output varying color d = 0;) {
    a = .5 * Cs * ambient();
    d = .25 * Cs * diffuse(faceforward(normalize(N), I));
    Oi = 1;
    Ci = a + d;
}
)");
    const std::string rib = inWorld(kLights + std::string("LightSource \"envlight\" 3\nSurface \"ambparts\"\n") + kFloor + kWall);
    std::vector<CameraRay> rays;
    for (int i = 0; i < 64; ++i) {
        rays.push_back(kAbove);
        rays.back().px = i;
    }
    Settings set = withShaders(Hider::Path);
    Scene plain(rib, set);
    set.outputs = {"a", "d"};
    Scene with(rib, set);
    const auto alone = plain.trace(rays), both = with.trace(rays);
    for (size_t i = 0; i < rays.size(); ++i) {
        EXPECT_EQ(std::memcmp(&alone[i].color, &both[i].color, sizeof(Color)), 0) << i;
        for (size_t k = 0; k < 3; ++k) EXPECT_NEAR(both[i].aovs[k] + both[i].aovs[3 + k], both[i].color[int(k)], 1e-6) << i;
    }
}

} // namespace

} // namespace ambient_test
