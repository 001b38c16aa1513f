// __nondiffuse and __nonspecular: how much of a light the lobes of a surface take.
#include "services/lightloopscene.h"

namespace lightloop_test {
namespace {

TEST(LightWeights, NonDiffuseAndNonSpecular) {
    writeLights();
    // The light shines along the normal, and so does the eye look: every lobe is 1 there.
    const CameraRay straight = rayTo({0, .8f, 0}, {0, 0, 0});
    const struct {
        const char* body;
        bool diffuse;
    } cases[] = {{"Ci = diffuse(normalize(faceforward(N, I)));", true},
                 {"Ci = specularstd(normalize(faceforward(N, I)), -normalize(I), .1);", false},
                 {"Ci = phong(normalize(faceforward(N, I)), -normalize(I), 10);", false},
                 {"Ci = specular(normalize(faceforward(N, I)), -normalize(I), .1);", false}};
    for (const auto& c : cases)
        for (float w : {0.f, .25f, 1.f}) {
            surfaceOf("weighs", std::string("    ") + c.body);
            const std::string weight =
                std::string("\"float __non") + (c.diffuse ? "diffuse" : "specular") + "\" " + std::to_string(w);
            const std::string other = std::string("\"float __non") + (c.diffuse ? "specular" : "diffuse") + "\" 1";
            const double want = 8 * (1 - w);
            Scene hidden(scene(flat(1, 8, 2, weight + " " + other), "\"weighs\""), under(Hider::Hidden));
            EXPECT_NEAR(hidden.one(straight).x, want, 1e-4) << c.body << w;
            Scene path(scene(flat(1, 8, 2, weight + " " + other), "\"weighs\""), under(Hider::Path));
            EXPECT_NEAR(path.one(straight).x, want, 1e-4) << c.body << w;
        }
}

// Emitters that a lobe's own ray meets are weighed like those that it samples: L R^2 / (R^2 + h^2) in all three ways.
TEST(LightWeights, OfEmittersMetByRays) {
    writeShader("weighedarea", "light weighedarea(float __nondiffuse = .75;) { illuminate(P, N, PI / 2) Cl = 5; }\n");
    const std::string disk = "AttributeBegin\nAttribute \"light\" \"string units\" \"radiance\" AreaLightSource \"weighedarea\" "
                             "7\nSurface \"constant\"\nColor 0 0 0\nTranslate 0 2 0\nRotate 90 1 0 0\nDisk 0 .7 360\n"
                             "AttributeEnd\nIlluminate 7 1\n";
    for (int mode : {0, 1, 2}) {
        Settings set = under(Hider::Path);
        set.bsdfOnly = mode == 1;
        set.lightOnly = mode == 2;
        Scene s(scene(disk, "\"matte\" \"float Ka\" 0 \"float Kd\" 1"), set);
        expectMean(s.estimate(kView, samples(mode == 1 ? 200000 : 20000)), .25 * 5 * .49 / 4.49, .02,
                   "mode " + std::to_string(mode));
    }
    writeShader("weighedsky", "light weighedsky(float __nondiffuse = .75;) { solar() Cl = 4; }\n");
    Scene sky(scene("LightSource \"weighedsky\" 1\n", "\"matte\" \"float Ka\" 0 \"float Kd\" 1"), under(Hider::Path));
    expectMean(sky.estimate(kView, samples(2000)), 1, .02, "sky");
}

} // namespace
} // namespace lightloop_test
