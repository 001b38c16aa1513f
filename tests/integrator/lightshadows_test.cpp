// Shadows that a light's shader asks for with transmission(): none of the surface on itself, and the right ones of others.
#include "integrator/floorscene.h"

namespace lightshadows_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

const std::string kBall =
    "Surface \"matte\" \"float Ka\" 0 \"float Kd\" 1\nAttributeBegin Translate 0 0 6 Sphere 1 -1 1 360 AttributeEnd\n";

// The side of a ball that a light sees gets all of its light, as from the same light without shadows; the other side none.
TEST(LightShadows, ABallDoesNotShadowItself) {
    const struct {
        const char *plain, *shadowed;
    } lights[] = {
        {"LightSource \"pointlight\" 1 \"intensity\" 25 \"from\" [-3 4 1]",
         "LightSource \"shadowpoint\" 1 \"intensity\" 25 \"from\" [-3 4 1] \"string sfpx\" \"map\""},
        {"LightSource \"spotlight\" 1 \"intensity\" 25 \"from\" [-3 4 1] \"to\" [0 0 6]",
         "LightSource \"shadowspot\" 1 \"intensity\" 25 \"from\" [-3 4 1] \"to\" [0 0 6] \"string shadowname\" \"map\""},
        {"LightSource \"distantlight\" 1 \"from\" [-3 4 1] \"to\" [0 0 6]",
         "LightSource \"shadowdistant\" 1 \"from\" [-3 4 1] \"to\" [0 0 6] \"string shadowname\" \"raytrace\""}};
    std::vector<CameraRay> rays;
    for (int y = 0; y < 24; ++y)
        for (int x = 0; x < 24; ++x) {
            CameraRay r = rayTo({0, 0, 0}, {(float(x) - 11.5f) * .013f, (float(y) - 11.5f) * .013f, 1});
            r.px = x;
            r.py = y;
            rays.push_back(r);
        }
    for (const auto& l : lights) {
        Scene plain("WorldBegin\n" + std::string(l.plain) + "\n" + kBall + "WorldEnd\n", withShaders(Hider::Hidden));
        Scene shadowed("WorldBegin\n" + std::string(l.shadowed) + "\n" + kBall + "WorldEnd\n", withShaders(Hider::Hidden));
        const auto want = plain.trace(rays), got = shadowed.trace(rays);
        int lit = 0;
        for (size_t i = 0; i < rays.size(); ++i) {
            lit += want[i].color.x > 0;
            EXPECT_NEAR(got[i].color.x, want[i].color.x, 1e-3f) << l.shadowed << ", ray " << i; // grazing light is that dark
        }
        EXPECT_GT(lit, 200) << l.plain;
        EXPECT_EQ(shadowed.diagnostics.warnings(), 0) << shadowed.messages();
    }
}

// A pane of opacity .25 between the light and the floor at the origin, L.N = 1.
TEST(LightShadows, OthersShadow) {
    const std::string floor = "Surface \"matte\" \"Ka\" 0 \"Kd\" 1\nPolygon \"P\" [-60 0 -60  -60 0 60  60 0 60  60 0 -60]\n";
    const std::string pane = "AttributeBegin Surface \"constant\" Color 0 0 0 Opacity .25 .25 .25 Polygon \"P\" [-9 1 -9  -9 1 9 "
                             " 9 1 9  9 1 -9] AttributeEnd\n";
    const CameraRay below = rayTo({.3f, .4f, -.4f}, {0, 0, 0});
    const struct {
        const char* light;
        float want;
    } cases[] = {{"\"shadowpoint\" 1 \"intensity\" 4 \"from\" [0 2 0]", 1},
                 {"\"shadowpoint\" 1 \"intensity\" 4 \"from\" [0 2 0] \"string sfnz\" \"map\"", .75f},
                 {"\"shadowspot\" 1 \"intensity\" 4 \"from\" [0 2 0] \"to\" [0 0 0]", 1},
                 {"\"shadowspot\" 1 \"intensity\" 4 \"from\" [0 2 0] \"to\" [0 0 0] \"string shadowname\" \"raytrace\"", .75f},
                 {"\"shadowdistant\" 1 \"from\" [0 1 0] \"to\" [0 0 0]", 1},
                 {"\"shadowdistant\" 1 \"from\" [0 1 0] \"to\" [0 0 0] \"string shadowname\" \"map\"", .75f}};
    for (const auto& c : cases) {
        const std::string world = "WorldBegin\nSides 2\nLightSource " + std::string(c.light) + "\n";
        Scene s(world + floor + pane + "WorldEnd\n", withShaders(Hider::Hidden));
        EXPECT_NEAR(s.one(below).x, c.want, 1e-5) << c.light << s.messages();
        // Under path every light has shadows; those that the light's shader asks for are not cast twice.
        writeShader(
            "sumslights",
            "surface sumslights() { Oi = 1; illuminance(P, normalize(N), PI/2) Ci += Cl * (normalize(L) . normalize(N)); }\n");
        for (const std::string& lit : {floor, "Surface \"sumslights\"" + floor.substr(floor.find('\n'))}) {
            Scene path(world + lit + pane + "WorldEnd\n", withShaders(Hider::Path));
            EXPECT_NEAR(path.one(below).x, .75f, 1e-5) << c.light << lit << path.messages();
        }
    }
}

} // namespace

} // namespace lightshadows_test
