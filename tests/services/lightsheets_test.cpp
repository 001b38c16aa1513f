// Loops over lights find what a light gives all points of a batch at once, where they begin at P. Who shares the batch, and which
// loops ask before, changes no bit; and what they find is what the light gives.
#include "integrator/floorscene.h"
#include <cmath>

namespace lightsheets_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

/// Rays down to points of a floor, x and z from -1 to 1.
std::vector<CameraRay> raysToFloor(int side) {
    std::vector<CameraRay> rays;
    for (int i = 0; i < side; ++i)
        for (int j = 0; j < side; ++j) {
            const float x = -1 + 2 * (float(i) + .5f) / float(side), z = -1 + 2 * (float(j) + .5f) / float(side);
            CameraRay r = rayTo({x, 1, z}, {x, 0, z});
            r.px = i;
            r.py = j;
            rays.push_back(r);
        }
    return rays;
}
constexpr const char* kSquare = "Polygon \"P\" [-2 0 -2  -2 0 2  2 0 2  2 0 -2] \"st\" [0 0  0 1  1 1  1 0]\n";

} // namespace

TEST(LightSheets, NoBitDependsOnWhoSharesTheBatch) {
    writeShader("sheets", R"(surface sheets() {
    normal Nf = faceforward(normalize(N), I);
    color c = ambient();
    illuminance(P, Nf, PI / 2) {
        float nothing = 0, k = 0;
        lightsource("__nondiffuse", nothing);
        lightsource("intensity", k);
        c += Cl * (Nf . normalize(L)) * (1 - nothing + .01 * k);
    }
    if (s > .65) illuminance(P + .1 * Nf, Nf, PI / 2) c += .5 * Cl;
    if (s < .3 && t < .3) illuminance("-odd", P, Nf, PI / 3) c += .25 * Cl;
    illuminance("odd", P, Nf, .6) {
        c += .1 * Cl;
        illuminance(P, Nf, PI / 2) c += .01 * Cl;
    }
    Ci = c;
    Oi = 1;
})");
    writeShader("oddlight", R"(light oddlight(float intensity = 1; string __category = "odd"; output varying float seen = 0;) {
    illuminate(point "shader" (0, 0, 0)) { seen = length(L); Cl = intensity * random() / (L . L); }
})");
    const std::string lights =
        "LightSource \"ambientlight\" 1 \"intensity\" .1\nLightSource \"distantlight\" 2 \"from\" [1 2 0] \"to\" [0 0 0]\n"
        "Attribute \"light\" \"shadows\" \"on\"\nLightSource \"pointlight\" 3 \"from\" [.2 1.5 .1]\n"
        "Attribute \"light\" \"shadows\" \"off\"\n"
        "LightSource \"spotlight\" 4 \"from\" [0 2 0] \"to\" [.3 0 0] \"coneangle\" .4 \"intensity\" 3\n"
        "TransformBegin\nTranslate .4 1.2 -.3\nLightSource \"oddlight\" 5\nTransformEnd\n"
        "AttributeBegin\nAttribute \"light\" \"samples\" 3\nAreaLightSource \"arealight\" 6 \"intensity\" 2\n"
        "Polygon \"P\" [-.3 1.8 -.3  .3 1.8 -.3  .3 1.8 .3  -.3 1.8 .3]\nAttributeEnd\nIlluminate 6 1\n";
    const std::vector<CameraRay> rays = raysToFloor(20);
    for (Hider hider : {Hider::Hidden, Hider::Path}) {
        const auto look = [&](int lanes, size_t together) {
            Settings set = withShaders(hider);
            set.lanes = lanes;
            Scene s("WorldBegin\nSides 2\n" + lights + "Surface \"sheets\"\n" + kSquare +
                        "Translate .5 .3 .2\nSphere .1 -.1 .1 360\nWorldEnd\n", // it throws a shadow
                    set);
            std::vector<Color> out;
            for (size_t i = 0; i < rays.size(); i += together)
                for (const SampleResult& r : s.trace({rays.data() + i, std::min(together, rays.size() - i)}))
                    out.push_back(r.color);
            EXPECT_EQ(s.diagnostics.warnings(), 0) << s.messages();
            return out;
        };
        const std::vector<Color> all = look(16, rays.size());
        for (const std::vector<Color>& other : {look(4, rays.size()), look(16, 1), look(8, 7)})
            for (size_t i = 0; i < rays.size(); ++i)
                for (int k = 0; k < 3; ++k) ASSERT_EQ(all[i][k], other[i][k]) << "point " << i;
        EXPECT_GT(all[0].x, 0);
    }
}

// I cos a / d^2 at every point of a batch; behind a loop that asks at other points.
TEST(LightSheets, ClosedForm) {
    writeShader("sheetlambert", R"(surface sheetlambert() {
    normal Nf = faceforward(normalize(N), I);
    color away = 0, c = 0;
    illuminance(P + 2 * Nf, Nf, PI) away += Cl;
    illuminance(P, Nf, PI / 2) c += Cl * (Nf . normalize(L));
    Ci = c + 0 * away;
    Oi = 1;
})");
    Scene s(
        "WorldBegin\nSides 2\nLightSource \"pointlight\" 1 \"from\" [.25 .75 -.5] \"intensity\" 2\nSurface \"sheetlambert\"\n" +
            std::string(kSquare) + "WorldEnd\n",
        withShaders(Hider::Hidden));
    const std::vector<CameraRay> rays = raysToFloor(20);
    const std::vector<SampleResult> got = s.trace(rays);
    for (size_t i = 0; i < rays.size(); ++i) {
        const double x = double(rays[i].origin.x) - .25, z = double(rays[i].origin.z) + .5, d2 = x * x + .5625 + z * z;
        const double want = 2 * .75 / std::sqrt(d2) / d2;
        EXPECT_NEAR(double(got[i].color.x), want, 2e-5 * want);
    }
}

} // namespace lightsheets_test
