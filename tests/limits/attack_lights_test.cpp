// Scenes that ended the program: lights whose shaders are not there, and lights that ask about what they light.
#include "integrator/harness.h"
#include "scene/scene.h"

namespace attack_lights_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

Settings under(Hider h) {
    Settings s;
    s.hider = h;
    return s;
}
constexpr Hider kHiders[] = {Hider::Path, Hider::Hidden, Hider::Raytrace};

/// One sample of the middle of the sphere of radius 1 about the origin, from below.
Color middle(Scene& s) { return s.one(rayTo({0, 0, -3}, {0, 0, 0})); }

// The shader of an area light is missing, does not compile or is no light: said once, and its geometry is an ordinary surface,
// with its own shader and the light of the others.
TEST(AttackLights, AreaLightsWithoutALight) {
    writeShader("attackbroken", "light attackbroken() { Cl = nosuchvariable; }\n");
    writeShader("attackother", "surface attackother() { Oi = 1; Ci = 1; }\n");
    writeShader("attackblue",
                "surface attackblue() { Oi = 1; Ci = color(0, 0, .5) + .25 * diffuse(faceforward(normalize(N), I)); }\n");
    for (const Hider h : kHiders)
        for (const std::string light : {"attackmissing", "attackbroken", "attackother"}) {
            const std::string area = "AreaLightSource \"" + light + "\" ",
                              head = "WorldBegin\nLightSource \"distantlight\" 2 \"from\" [0 0 -1] \"to\" [0 0 0]\n",
                              near = "Surface \"attackblue\"\nSphere 1 -1 1 360\nSphere 2 -2 2 360\n",
                              far = "Sphere 3 -3 3 360\nWorldEnd\n";
            Scene s(head + area + "1\n" + near + area + "3\n" + far, under(h), 1), plain(head + near + far, under(h));
            ASSERT_TRUE(s.world && plain.world);
            EXPECT_NE(s.messages().find(light == "attackbroken" ? "attackbroken.sl:1:29" : "test.rib:3:1"), std::string::npos)
                << s.messages();
            const CameraRay between = rayTo({0, 0, -1.5f}, {0, 0, 0});
            EXPECT_EQ(s.one(between), plain.one(between)) << light << " " << int(h);
            EXPECT_GT(plain.one(between).z, .5f);
        }
}

// A light learns parameters of the surface's atmosphere, and of the lights of the surface.
TEST(AttackLights, WhatALightAsksAboutTheSurface) {
    writeShader("attackhaze", "volume attackhaze(float density = 0;) { Ci = Ci; Oi = Oi; }\n");
    writeShader("attackair",
                "light attackair() { float q = 1; atmosphere(\"density\", q); solar(vector \"world\" (0, 0, 1), 0) Cl = q; }\n");
    writeShader("attackone", "light attackone() { shader l = getlight(\"key\"); float q = 1; if (l != null) q = l->intensity; "
                             "solar(vector \"world\" (0, 0, 1), 0) Cl = q; }\n");
    writeShader("attackall", "light attackall() { shader l[] = getlights(); float q = arraylength(l); solar(vector \"world\" (0, "
                             "0, 1), 0) Cl = q; }\n");
    writeShader("attackname",
                "light attackname(string which = \"Kd\";) { string w = concat(which, \"\"); float q = 1; surface(w, q); "
                "solar(vector \"world\" (0, 0, 1), 0) Cl = q; }\n");
    struct Case {
        const char *before, *light, *after;
        float want;
    };
    for (const Case& one : {Case{"Atmosphere \"attackhaze\" \"density\" [3]\n", "attackair", "", 3},
                            {"", "attackair", "", 1},
                            {"LightSource \"pointlight\" \"key\" \"intensity\" [0]\n", "attackone", "", 0},
                            {"", "attackone", "", 1},
                            {"LightSource \"pointlight\" \"key\" \"intensity\" [0]\n", "attackall", "", 2},
                            {"", "attackall", "", 1},
                            {"", "attackname", "\"Kd\" [.5]", .5f}})
        for (const Hider h : kHiders) {
            const bool own = std::string(one.light) == "attackname"; // the reflection of matte is the Kd that is asked for
            Scene s(std::string("WorldBegin\n") + one.before + "LightSource \"" + one.light + "\" 1\nSurface \"matte\" " +
                        one.after + "\nSphere 1 -1 1 360\nWorldEnd\n",
                    under(h));
            ASSERT_TRUE(s.world);
            EXPECT_NEAR(middle(s).x, one.want * (own ? .5f : 1), 1e-4f) << one.light << " " << one.before << " " << int(h);
        }
}

// The same where a ray meets the light by chance: a glowing floor that asks the mirror's atmosphere and lights.
TEST(AttackLights, WhatAnAreaLightAsksAboutTheSurface) {
    writeShader("attackhaze", "volume attackhaze(float density = 0;) { Ci = Ci; Oi = Oi; }\n");
    writeShader("attackglow", "light attackglow() { float q = 1; atmosphere(\"density\", q); shader l[] = getlights(); "
                              "illuminate(P, N, PI / 2) Cl = q + arraylength(l); }\n");
    writeShader("attackblack", "surface attackblack() { Oi = 1; Ci = 0; }\n");
    Scene s("WorldBegin\nAttributeBegin\nAreaLightSource \"attackglow\" 1\nSurface \"attackblack\"\nSides "
            "2\nReverseOrientation\nSphere 5 -5 5 360\nAttributeEnd\nIlluminate 1 1\nAtmosphere \"attackhaze\" \"density\" [3]\n"
            "Surface \"matte\"\nSphere 1 -1 1 360\nWorldEnd\n",
            under(Hider::Path));
    ASSERT_TRUE(s.world);
    const Moments m = s.estimate(rayTo({0, 0, -3}, {0, 0, 0}), 2000);
    // A white sphere in a sphere that glows: 3 for the atmosphere, 1 for the one light, times pi (irradiance over pi is the
    // radiance).
    EXPECT_NEAR(m.mean(), 4, .2) << s.messages();
}

// 30,000 lights took 2.3 GB: each kept the list of those before it.
TEST(AttackLights, ManyLightsKeepNoListsOfEachOther) {
    std::string rib = "WorldBegin\n";
    for (int i = 0; i < 200; ++i) rib += "LightSource \"pointlight\" \"l" + std::to_string(i) + "\"\n";
    Scene s(rib + "Illuminate \"l7\" 0\nSphere 1 -1 1 360\nWorldEnd\n");
    ASSERT_TRUE(s.frame);
    ASSERT_EQ(s.frame->lights.size(), 200u);
    for (const scene::Light& l : s.frame->lights) EXPECT_TRUE(l.attributes->lights.empty());
    ASSERT_EQ(s.frame->primitives.size(), 1u);
    EXPECT_EQ(s.frame->primitives[0]->attributes->lights.size(), 199u);
}

} // namespace

} // namespace attack_lights_test
