// Values that are not finite numbers: the sample that meets one is left out as a whole, and who made it is named.
#include "integrator/harness.h"

namespace finite_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

void writeShaders() {
    writeShader("infinite", "surface infinite() { float big = 1e30 * (2 + u); Oi = 1; Ci = big * big; }\n");
    writeShader("nonumber", "surface nonumber() { float big = 1e30 * (2 + u); Oi = 1; Ci = big * big - big * big; }\n");
    writeShader("nonumberoi", "surface nonumberoi() { float big = 1e30 * (2 + u); Oi = big * big - big * big; Ci = .5; }\n");
    writeShader(
        "heavy",
        "surface heavy() { float big = 1e30 * (2 + u); Oi = 1;\n    Ci = big * big * diffuse(faceforward(normalize(N), I)); }\n");
    writeShader("lamp", "light lamp() { float big = 1e30 * (2 + length(Ps)); solar(vector \"world\" (0, 0, 1), 0) Cl = big * big "
                        "- big * big; }\n");
    writeShader("glowing", "light glowing() { float big = 1e30 * (2 + length(Ps)); illuminate(P, N, PI) Cl = big * big; }\n");
    writeShader("mirrorof", "surface mirrorof() { Oi = 1; Ci = .5 * trace(P, reflect(normalize(I), normalize(N))); }\n");
    writeShader("hides", "surface hides() { color c = trace(P, reflect(normalize(I), normalize(N))); Oi = 1; Ci = comp(c, 0) > 0 "
                         "? color(1) : color(.25); }\n");
}
Settings under(Hider h) {
    Settings s;
    s.hider = h;
    return s;
}
const char* kBall = "Sphere 1 -1 1 360\n";
const CameraRay kSee = rayTo({0, 0, -3}, {.1f, .1f, 0});

TEST(NotFinite, TheSampleIsLeftOutAndNamed) {
    writeShaders();
    const std::string matte = "Surface \"matte\"\n", lamp = "LightSource \"lamp\" 1\n";
    struct Case {
        std::string what, world, named;
        bool path;
    };
    const Case cases[] = {
        {"inf", std::string("Surface \"infinite\"\n") + kBall, "Ci of shader \"infinite\"", false},
        {"nan", std::string("Surface \"nonumber\"\n") + kBall, "Ci of shader \"nonumber\"", false},
        {"opacity", std::string("Surface \"nonumberoi\"\n") + kBall, "Oi of shader \"nonumberoi\"", false},
        {"weight", "LightSource \"distantlight\" 2\n" + std::string("Surface \"heavy\"\n") + kBall, "diffuse()", true},
        {"light", lamp + matte + kBall, "\"lamp\"", true},
        {"light in a loop", lamp + matte + kBall, "\"matte\"", false},
        {"emitter that is sampled or met",
         "AttributeBegin\nAreaLightSource \"glowing\" 1\nSides 2\nReverseOrientation\nSphere 9 -9 9 "
         "360\nAttributeEnd\nIlluminate 1 1\n" +
             matte + kBall,
         "\"glowing\"", true},
        {"behind a mirror", std::string("Surface \"mirrorof\"\n") + kBall + "Surface \"infinite\"\nSides 2\nSphere 9 -9 9 360\n",
         "\"infinite\"", false},
        {"behind a shader that hides it",
         std::string("Surface \"hides\"\n") + kBall + "Surface \"nonumber\"\nSides 2\nSphere 9 -9 9 360\n", "\"nonumber\"",
         false},
        {"shadow",
         "LightSource \"distantlight\" 2 \"from\" [0 0 -1] \"to\" [0 0 0]\n" + matte +
             "Disk 0 1 360\nSurface \"nonumberoi\"\nDisk -4 9 360\n",
         "Oi of shader \"nonumberoi\"", true}};
    for (const Case& c : cases)
        for (const Hider h : {Hider::Path, Hider::Raytrace}) {
            if (c.path != (h == Hider::Path) && (c.path || c.what == "light in a loop")) continue;
            Scene s("WorldBegin\n" + c.world + "WorldEnd\n", under(h));
            ASSERT_TRUE(s.world);
            Counters n;
            const SampleResult r = s.trace(std::vector{kSee}, &n)[0];
            EXPECT_TRUE(!std::isfinite(r.color.x) || !std::isfinite(r.opacity.x)) << c.what << " " << r.color.x;
            EXPECT_GT(n.nonFinite, 0u) << c.what;
            EXPECT_NE(s.messages().find(c.named), std::string::npos) << c.what << ": " << s.messages();
            EXPECT_NE(s.messages().find("is not a finite number"), std::string::npos) << c.what << ": " << s.messages();
        }
}
// Where the call stands that gives it.
TEST(NotFinite, TheCallIsNamed) {
    writeShaders();
    Scene s(std::string("WorldBegin\nLightSource \"distantlight\" 2\nSurface \"heavy\"\n") + kBall + "WorldEnd\n",
            under(Hider::Path));
    s.one(kSee);
    EXPECT_NE(s.messages().find("heavy.sl:2:"), std::string::npos) << s.messages();
}
// Samples that share a call with a spoiled one keep their bits.
TEST(NotFinite, OtherSamplesStay) {
    writeShaders();
    const std::string rib = std::string("WorldBegin\nLightSource \"distantlight\" 2\nSurface \"matte\"\n") + kBall +
                            "Surface \"infinite\"\nTranslate 0 0 20\nSphere 9 -9 9 360\nWorldEnd\n";
    Scene s(rib, under(Hider::Path));
    std::vector<CameraRay> rays{kSee, rayTo({0, 0, -3}, {.8f, .8f, 0}), rayTo({0, 0, -3}, {-.2f, .1f, 0})};
    for (int i = 0; i < 3; ++i) rays[size_t(i)].px = i;
    const std::vector<SampleResult> all = s.trace(rays);
    EXPECT_TRUE(std::isnan(all[1].color.x));
    for (int i : {0, 2}) EXPECT_EQ(s.one(rays[size_t(i)]), all[size_t(i)].color);
}

} // namespace

} // namespace finite_test
