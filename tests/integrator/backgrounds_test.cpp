// slbackground.sl: what rays see that leave the scene, under every hider; over the picture for the camera's, else by direction.
#include "integrator/floorscene.h"

namespace backgrounds_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

const std::string kCamera = "Format 100 100 1\nProjection \"perspective\" \"fov\" 90\n";
constexpr Hider kHiders[] = {Hider::Hidden, Hider::Raytrace, Hider::Path};
std::string background(const std::string& parameters) { return "LightSource \"slbackground\" \"sky\" " + parameters + "\n"; }
void expectColour(const Color& c, const Color& want, const std::string& what) {
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(c[k], want[k], 2e-4) << what << " " << k;
}

} // namespace

TEST(Backgrounds, OfCameraRaysLieOverThePicture) {
    const std::string corners = "\"color bottomleft\" [1 0 0] \"color bottomright\" [0 1 0] \"color topleft\" [0 0 1] \"color "
                                "topright\" [1 1 1] \"color bgcolor\" [.5 .5 1]";
    for (const Hider h : kHiders) {
        Scene s(kCamera + inWorld(background(corners)), withShaders(h));
        for (const Vec3& to : {Vec3(0, 0, 1), Vec3(-.8f, .6f, 1), Vec3(.9f, -.5f, 1), Vec3(-1, -1, 1)}) {
            const float x = .5f + to.x / 2, y = .5f + to.y / 2; // from the lower left
            const Color want((1 - x) * (1 - y) + x * y, x * (1 - y) + x * y, (1 - x) * y + x * y);
            const SampleResult r = s.trace(std::vector<CameraRay>{rayTo({0, 0, 0}, to)})[0];
            expectColour(r.color, want * Color(.5, .5, 1), "corner");
            EXPECT_EQ(r.opacity, Color(0)); // it is behind everything, and covers nothing
        }
        // Behind a pane that lets three quarters through.
        Scene pane(kCamera + inWorld(background(corners) +
                                     "Surface \"constant\"\nOpacity .25 .25 .25\nColor 0 0 0\nPolygon \"P\" [-9 -9 2 -9 9 2 "
                                     "9 9 2 9 -9 2]\n"),
                   withShaders(h));
        expectColour(pane.one(rayTo({0, 0, 0}, {-1, 1, 1})), {0, 0, .75}, "behind a pane");
    }
}

TEST(Backgrounds, OfOtherRaysLieByDirection) {
    writeShader("mirrors",
                "surface mirrors(vector way = 0;) { Oi = 1; Ci = trace(P, vtransform(\"world\", \"current\", way)); }\n");
    const struct {
        const char* way;
        Color want;
    } ways[] = {{"0 1 0", {0, 0, 1}}, {"0 .5 .8660254", {1 / 3.f, 0, 2 / 3.f}}, {".8 .6 0", {.295167f, 0, .704833f}}};
    for (const Hider h : kHiders)
        for (const auto& w : ways) {
            Scene s(
                inWorld(background("\"color bottomleft\" [1 0 0] \"color bottomright\" [1 0 0] \"color topleft\" [0 0 1] \"color "
                                   "topright\" [0 0 1]") +
                        "Surface \"mirrors\" \"vector way\" [" + w.way + "]\n" + kFloor),
                withShaders(h));
            expectColour(s.one(kView), w.want, w.way);
        }
}

TEST(Backgrounds, LightUnderPathOnly) {
    const std::string scene =
        inWorld(background("\"color bgcolor\" [.5 .5 .5]") + "Surface \"matte\" \"Ka\" 0 \"Kd\" 1\n" + kFloor);
    for (const Hider h : {Hider::Hidden, Hider::Raytrace}) {
        Scene s(scene, withShaders(h));
        EXPECT_EQ(s.one(kView), Color(0));
    }
    Scene path(scene, withShaders(Hider::Path));
    expectMean(path.estimate(kView, 64), .5, .01, "a furnace");
}

// Any sky is such a background where its light is left to rays.
TEST(Backgrounds, OfAnySky) {
    const std::string sky = "LightSource \"envlight\" 1 \"float intensity\" .25\n";
    for (const Hider h : {Hider::Hidden, Hider::Raytrace}) {
        Scene all(kCamera + inWorld(sky), withShaders(h));
        EXPECT_EQ(all.one(rayTo({0, 0, 0}, {0, 0, 1})), Color(0));
        Scene rays(kCamera + inWorld("Attribute \"light\" \"string samplingstrategy\" \"trace\"\n" + sky), withShaders(h));
        expectColour(rays.one(rayTo({0, 0, 0}, {0, 0, 1})), Color(.25), "for rays");
    }
}

} // namespace backgrounds_test
