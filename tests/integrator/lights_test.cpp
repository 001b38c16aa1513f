// Which lights count where: through transparent surfaces, in mirrors, by category, by several samples, together with explicit
// emission.
#include "integrator/harness.h"

namespace lights_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

const char* kFloor = "Polygon \"P\" [-60 0 -60  -60 0 60  60 0 60  60 0 -60]\n";
const char* kDisk = "AttributeBegin\nAreaLightSource \"slrect\" 7 \"float intensity\" 5\nSurface \"constant\"\nColor 0 0 "
                    "0\nTranslate 0 2 0\nRotate 90 1 0 0\n"
                    "Disk 0 .7 360\nAttributeEnd\nIlluminate 7 1\n";
const double kDiskValue = 5 * .49 / 4.49;

// A pane that takes .4 of everything between floor and light: every estimator sees .6 of the light. The lobe's ray changes its
// origin at the pane; its weight must not.
TEST(Lights, ThroughAPane) {
    std::string rib = std::string("WorldBegin\nSides 2\n") + kDisk +
                      "AttributeBegin\nSurface \"constant\"\nColor 0 0 0\nOpacity .4 .4 .4\n"
                      "Polygon \"P\" [-60 1.2 -60  60 1.2 -60  60 1.2 60  -60 1.2 60]\nAttributeEnd\nSurface \"matte\"\n" +
                      kFloor + "WorldEnd\n";
    for (int mode = 0; mode < 3; ++mode) {
        Settings s;
        s.hider = Hider::Path;
        s.bsdfOnly = mode == 1;
        s.lightOnly = mode == 2;
        Scene scene(rib, s);
        expectMean(scene.estimate(rayTo({.3f, .8f, -.4f}, {0, 0, 0}), samples(mode == 1 ? 200000 : 20000)), .6 * kDiskValue, .01,
                   "mode " + std::to_string(mode));
    }
}
// Seen directly an emitter shows its radiance, from the front only, plus what its own surface shader adds.
TEST(Lights, SeenAndExplicitEmission) {
    for (const char* surface : {"Color 0 0 0", "Color .25 .5 1"}) {
        std::string rib = std::string("WorldBegin\nSides 2\nAttributeBegin\nAreaLightSource \"slrect\" 7 \"float intensity\" "
                                      "5\nSurface \"constant\"\n") +
                          surface + "\nTranslate 0 2 0\nRotate 90 1 0 0\nDisk 0 .7 360\nAttributeEnd\nWorldEnd\n";
        Settings s;
        s.hider = Hider::Path;
        Scene scene(rib, s);
        Color own = surface[6] == '0' ? Color(0) : Color(.25f, .5f, 1);
        Color front = scene.one(rayTo({.1f, 0, .2f}, {0, 2, 0})), back = scene.one(rayTo({.1f, 4, .2f}, {0, 2, 0}));
        for (int k = 0; k < 3; ++k) {
            EXPECT_NEAR(front[k], 5 + own[k], 1e-5);
            EXPECT_NEAR(back[k], own[k], 1e-6);
        }
    }
}
TEST(Lights, MirrorShowsALightThatIsOff) {
    writeShader("lookmirror", "surface lookmirror() { vector In = normalize(I); Oi = 1; Ci = trace(P, reflect(In, "
                              "faceforward(normalize(N), In))); }\n");
    std::string rib =
        std::string("WorldBegin\nSides 2\n") + kDisk + "Illuminate 7 0\nSurface \"lookmirror\"\n" + kFloor + "WorldEnd\n";
    Settings s;
    s.hider = Hider::Path;
    Scene scene(rib, s);
    EXPECT_NEAR(scene.one(rayTo({.2f, 1, 0}, {.1f, 0, 0})).x, 5, 1e-5); // reflected to (-.1, 2, 0), on the disk
    EXPECT_NEAR(scene.one(rayTo({1, .5f, 0}, {.1f, 0, 0})).x, 0, 1e-6);
}
// Several samples of an area light are several turns of a loop with the same mean and less noise.
TEST(Lights, SamplesOfAnAreaLight) {
    writeShader("lookloop", "surface lookloop() { normal Nf = faceforward(normalize(N), I); color c = 0; illuminance(P, Nf, PI / "
                            "2) { c += Cl * (normalize(L) . Nf); } Ci = c; Oi = 1; }\n");
    double noise[2];
    for (int k = 0; k < 2; ++k) {
        std::string rib = std::string("WorldBegin\nSides 2\nAttribute \"light\" \"integer samples\" [") + (k ? "16" : "1") +
                          "]\n" + kDisk + "Surface \"lookloop\"\n" + kFloor + "WorldEnd\n";
        Scene scene(rib);
        Moments m = scene.estimate(rayTo({.3f, .8f, -.4f}, {.2f, 0, .5f}), samples(8000));
        noise[k] = m.se();
        Settings s;
        s.hider = Hider::Path;
        Scene path(rib, s);
        Moments p = path.estimate(rayTo({.3f, .8f, -.4f}, {.2f, 0, .5f}), samples(8000));
        EXPECT_LE(std::fabs(m.mean() - p.mean()), kZ * std::sqrt(m.se() * m.se() + p.se() * p.se()));
    }
    // Sixteen independent samples would give 1 / sqrt(16); these are one net of sixteen points, which has at most half of that
    // error where the light varies smoothly.
    EXPECT_LE(noise[1] / noise[0], .125);
    EXPECT_GT(noise[1] / noise[0], 0);
}
TEST(Lights, Categories) {
    writeShader(
        "keylight",
        "light keylight(string __category = \"key\"; float intensity = 1;) { solar(vector(0, -1, 0), 0) Cl = intensity; }\n");
    writeShader("filllight", "light filllight(string __category = \"fill,soft\"; float intensity = 1;) { solar(vector(0, -1, 0), "
                             "0) Cl = intensity; }\n");
    const struct {
        const char* category;
        double want;
    } cases[] = {{"key", 1}, {"fill", 2}, {"soft", 2}, {"-key", 2}, {"-fill", 1}, {"nothing", 0}, {"", 3}};
    for (const auto& c : cases) {
        writeShader("lookcategory", std::string("surface lookcategory() { color c = 0; illuminance(\"") + c.category +
                                        "\", P, normal(0, 1, 0), PI / 2) { c += Cl; } Ci = c; Oi = 1; }\n");
        for (Hider h : {Hider::Hidden, Hider::Path}) {
            Settings s;
            s.hider = h;
            Scene scene(std::string("WorldBegin\nSides 2\nLightSource \"keylight\" 1\nLightSource \"filllight\" 2 \"intensity\" "
                                    "2\nSurface \"lookcategory\"\n") +
                            kFloor + "WorldEnd\n",
                        s);
            EXPECT_NEAR(scene.one(rayTo({.3f, .8f, -.4f}, {0, 0, 0})).x, c.want, 1e-6) << c.category;
        }
    }
}
// What one kernel is given of its lights may not depend on the points that share its batch.
TEST(Lights, NonDiffuseAndNonSpecular) {
    for (bool nonDiffuse : {false, true}) {
        writeShader("halfway", std::string("light halfway(output float ") + (nonDiffuse ? "__nondiffuse" : "__nonspecular") +
                                   " = 1;) { solar(vector(0, -1, 0), 0) Cl = 2; }\n");
        Settings s;
        s.hider = Hider::Path;
        s.indirect = false;
        Scene diffuse(std::string("WorldBegin\nSides 2\nLightSource \"halfway\" 1\nSurface \"matte\"\n") + kFloor + "WorldEnd\n",
                      s);
        EXPECT_NEAR(diffuse.one(rayTo({0, 1, 0}, {0, 0, 0})).x, nonDiffuse ? 0 : 2, 1e-5);
        Scene shiny(std::string("WorldBegin\nSides 2\nLightSource \"halfway\" 1\nSurface \"metal\"\n") + kFloor + "WorldEnd\n",
                    s);
        EXPECT_NEAR(shiny.one(rayTo({0, 1, 0}, {0, 0, 0})).x, nonDiffuse ? 2 : 0, 1e-5);
    }
}

} // namespace

} // namespace lights_test
