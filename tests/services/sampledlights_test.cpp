// Class lights of PRMan that have no illuminate() and no light() of their own: they send what generateSamples() gives, each
// sample one nth.
#include "base/limits.h"
#include "integrator/floorscene.h"

namespace sampledlights_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

const char* kWhite = "Surface \"white\"\n";

void writeWhite() {
    writeShader("white", "surface white() { Oi = Os; Ci = Os * diffuse(normalize(N)); }\n");
    writeShader(
        "loops",
        "surface loops() { Oi = 1; Ci = 0; illuminance(P, normalize(N), PI/2) Ci += Cl * (normalize(N) . normalize(L)); }\n");
    writeShader("turns", "surface turns() { float n = 0, far = 0; illuminance(P) { n += 1; far += length(L); } Oi = 1; Ci = "
                         "color(n, far, 0); }\n");
    writeShader("answers", R"(class answers() {
        public void evaluateSamples(string distribution; output __radiancesample samples[]) {
            uniform float i;
            for (i = 0; i < arraylength(samples); i += 1) {
                float cosine = max(0, samples[i]->direction . shadingnormal(N));
                if (distribution == "diffuse") samples[i]->setMaterialResponse(color(1, .5, .25) * cosine / PI, cosine / PI);
            }
        }
        public void lighting(output color Ci, Oi) { Ci = directlighting(this, getlights()); Oi = 1; }
    }
)");
    // Radiometry: an intensity of I per steradian sends I / d^2 of irradiance, which a white surface shows as I cos / (pi d^2).
    writeShader("onepoint", R"(class onepoint(float intensity = 1; color lightcolor = 1; string __category = "one") {
        public void generateSamples(string integrationdomain; output __radiancesample samples[]) {
            vector to = point "shader" (0, 0, 0) - Ps;
            resize(samples, 1);
            samples[0]->direction = normalize(to);
            samples[0]->distance = length(to);
            samples[0]->setLightRadiance(intensity * lightcolor / (to . to), 1);
        }
    }
)");
    // A shape of radiance 1, sampled evenly over its area.
    const std::string shape = R"(#include <stdrsl/AreaSampler.h>
    class shape(float radiance = 1; uniform float n = 4; string shape = "rect") {
        public void generateSamples(string integrationdomain; output __radiancesample samples[]) {
            stdrsl_AreaSampler sampler;
            sampler->generateSamples(Ps, shape, n, samples);
            uniform float i;
            for (i = 0; i < arraylength(samples); i += 1) {
                samples[i]->radiance = samples[i]->lightPdf > 0 ? color(radiance) : color(0);
                samples[i]->lightPdf = abs(samples[i]->lightPdf);
            }
        }
        public void shadowSamples(output __radiancesample samples[]) {}
    }
)";
    writeShader("shape", shape);
    // With a method light() that says no more than that this is a light.
    std::string zero = shape;
    zero.replace(zero.find("class shape"), 11, "class zero");
    zero.insert(zero.find("        public void generate"),
                "        public void light(output vector L; output color Cl) { L = 0; Cl = color 0; }\n");
    writeShader("zero", zero);
}

/// The light stands 2 above the origin of the floor.
std::string above(const std::string& light) { return "TransformBegin\nTranslate 0 2 0\n" + light + "TransformEnd\n"; }
/// The same with z of the light's space down.
std::string facingDown(const std::string& light) {
    return "TransformBegin\nTranslate 0 2 0\nRotate 90 1 0 0\n" + light + "TransformEnd\n";
}

class SampledLights : public ::testing::TestWithParam<Hider> {};

// An intensity of 3 pi at distance 2: 3 / 4 straight below it.
TEST_P(SampledLights, PointLight) {
    writeWhite();
    const std::string light = above("LightSource \"onepoint\" 1 \"intensity\" 9.42477796 \"lightcolor\" [1 .5 0]\n");
    for (const char* surface : {"white", "loops"}) {
        const Color c = Scene(inWorld(light + "Surface \"" + surface + "\"\n" + kFloor), under(GetParam())).one(kView);
        EXPECT_NEAR(c[0], .75, 1e-5) << surface;
        EXPECT_NEAR(c[1], .375, 1e-5) << surface;
        EXPECT_EQ(c[2], 0) << surface;
    }
    const Color c = Scene(inWorld(light + std::string("Surface \"answers\"\n") + kFloor), under(GetParam())).one(kView);
    EXPECT_NEAR(c[0], .75, 1e-5);
    EXPECT_NEAR(c[1], .1875, 1e-5);
}

// A square of side 1, 2 above the floor and parallel to it: the form factor of its four quarters of 1/2 by 1/2 at distance 2 is
// 4 / (2 pi) (a / sqrt(1 + a^2) atan(b / sqrt(1 + a^2)) + ...) with a = b = 1/4.
TEST_P(SampledLights, SquareOfSeveralSamples) {
    writeWhite();
    const double a = .25, r = std::sqrt(1 + a * a), factor = 4 / (2 * M_PI) * 2 * (a / r) * std::atan(a / r);
    // More samples than have turns share those.
    for (const std::string& n : {std::string("1"), std::string("4"), std::to_string(limits::kLightIterations + 36)})
        for (const char* surface : {"white", "loops"}) {
            Scene s(inWorld(facingDown(std::string("LightSource \"shape\" 1 \"n\" ") + n + "\n") + "Surface \"" + surface +
                            "\"\n" + kFloor),
                    under(GetParam()));
            expectMean(s.estimate(kView, samples(n.size() > 1 ? 4000 : 16000)), factor, .01, std::string(surface) + " " + n);
        }
}

// A sphere of radius 1/2 whose centre is 2 above the floor sends pi sin^2 of its half angle: (1/2 / 2)^2 of what an even sky
// sends.
TEST_P(SampledLights, SphereOfSeveralSamples) {
    writeWhite();
    Scene s(inWorld(above("LightSource \"shape\" 1 \"n\" 8 \"shape\" \"sphere\"\n") + kWhite + kFloor), under(GetParam()));
    expectMean(s.estimate(kView, samples(10000)), 1. / 16, .01, "sphere");
}

// Each sample has a turn of its own, as far as the light has any; L reaches to where it lies: between 2 and sqrt(4.5) away.
TEST_P(SampledLights, TurnsOfTheLoop) {
    writeWhite();
    for (int n : {1, 5}) {
        const std::string light = facingDown("LightSource \"shape\" 1 \"n\" " + std::to_string(n) + "\n");
        const Color c = Scene(inWorld(light + "Surface \"turns\"\n" + kFloor), under(GetParam())).one(kView);
        EXPECT_EQ(c[0], n);
        EXPECT_GE(c[1], 2 * n * (1 - 1e-6));
        EXPECT_LE(c[1], std::sqrt(4.5) * n);
    }
}

// A light() that says zero means it for surfaces that know nothing of samples, as in PRMan, but under path, where all light
// counts.
TEST_P(SampledLights, ThatSayZeroLightDirectlightingAlone) {
    writeWhite();
    const double a = .25, r = std::sqrt(1 + a * a), factor = 4 / (2 * M_PI) * 2 * (a / r) * std::atan(a / r);
    const std::string light = facingDown("LightSource \"zero\" 1 \"n\" 4\n");
    for (const char* surface : {"white", "loops"}) {
        Scene s(inWorld(light + "Surface \"" + surface + "\"\n" + kFloor), under(GetParam()));
        if (GetParam() == Hider::Path) expectMean(s.estimate(kView, samples(4000)), factor, .01, surface);
        else EXPECT_EQ(s.one(kView), Color(0)) << surface;
    }
    Scene s(inWorld(light + "Surface \"answers\"\n" + kFloor), under(GetParam()));
    expectMean(s.estimate(kView, samples(4000)), factor, .01, "directlighting()");
}

// A handle asks for all samples at once: the mean is the same.
TEST_P(SampledLights, ByTheirHandles) {
    writeWhite();
    writeShader("called", R"(class called() {
        public void surface(output color Ci, Oi) {
            shader l = getlight("1");
            vector way = 0;
            color c = 0;
            if (l != null) l->light(way, c);
            Oi = 1;
            Ci = c * max(0, -normalize(way) . normalize(N));
        }
    }
)");
    const double a = .25, r = std::sqrt(1 + a * a), factor = 4 / (2 * M_PI) * 2 * (a / r) * std::atan(a / r);
    Scene s(inWorld(facingDown("LightSource \"shape\" 1 \"n\" 4\n") + "Surface \"called\"\n" + kFloor), under(GetParam()));
    expectMean(s.estimate(kView, samples(10000)), factor, .01, "handle");
}

// A card between the light and the floor: under path every light has traced shadows, elsewhere a light with shadowSamples() has
// them.
TEST_P(SampledLights, Shadows) {
    writeWhite();
    const std::string card =
        "AttributeBegin\nSurface \"constant\"\nColor 0 0 0\nAttribute \"visibility\" \"camera\" 0 \"transmission\" \"opaque\"\n"
        "Polygon \"P\" [-5 1 -5  -5 1 5  5 1 5  5 1 -5]\nAttributeEnd\n";
    Scene s(inWorld(facingDown("LightSource \"shape\" 1 \"n\" 4\n") + card + kWhite + kFloor), withShaders(GetParam()));
    EXPECT_EQ(s.one(kView), Color(0));
    const std::string light = above("LightSource \"onepoint\" 1 \"intensity\" 9.42477796\n");
    Scene open(inWorld(light + card + kWhite + kFloor), withShaders(GetParam()));
    EXPECT_NEAR(open.one(kView)[0], GetParam() == Hider::Path ? 0 : .75, 1e-5);
}

// Samples with a density of zero are none: they do not count among the n.
TEST_P(SampledLights, RejectedSamples) {
    writeWhite();
    writeShader("some", R"(class some() {
        public void generateSamples(string integrationdomain; output __radiancesample samples[]) {
            vector to = point "shader" (0, 0, 0) - Ps;
            uniform float i;
            for (i = 0; i < 3; i += 1) {
                __radiancesample one;
                one->direction = normalize(to);
                one->distance = length(to);
                one->setLightRadiance(PI, i == 1 ? 0 : 1 + i);
                push(samples, one);
            }
        }
    }
)");
    // Densities 1 and 3: (1 + 1/3) / 2.
    EXPECT_NEAR(Scene(inWorld(above("LightSource \"some\" 1\n") + std::string("Surface \"loops\"\n") + kFloor), under(GetParam()))
                    .one(kView)[0],
                2. / 3, 1e-5);
}

// A light() that does more than say zero is asked as ever, and so are surfaces with generateSamples().
TEST_P(SampledLights, LightsThatAreNoSuch) {
    writeWhite();
    writeShader("two", R"(class two() {
        public void light(output vector L; output color Cl) { illuminate(point "shader" (0, 0, 0)) Cl = 4 / (L . L); }
        public void generateSamples(string integrationdomain; output __radiancesample samples[]) {
            resize(samples, 1);
            samples[0]->setLightRadiance(9, 1);
        }
    }
)");
    EXPECT_NEAR(Scene(inWorld(above("LightSource \"two\" 1\n") + kWhite + kFloor), under(GetParam())).one(kView)[0], 1, 1e-5);
}

// A layer of a material has methods of these names, too.
TEST_P(SampledLights, LayersAreNoLights) {
    writeShader("layer", R"(class layer(float k = .5) {
        public void generateSamples(string type; output __radiancesample samples[]) { resize(samples, 1); }
        public float gives() { return k; }
    }
)");
    writeShader("layered", "class layered() { public void surface(output color Ci, Oi) { shader l = getshader(\"one\"); Oi = 1; "
                           "Ci = l->gives(); } }\n");
    EXPECT_EQ(Scene(inWorld("Shader \"layer\" \"one\" \"k\" .25\nSurface \"layered\"\n" + std::string(kFloor)), under(GetParam()))
                  .one(kView)[0],
              .25f);
}

INSTANTIATE_TEST_SUITE_P(Hiders, SampledLights, ::testing::Values(Hider::Hidden, Hider::Path),
                         [](const auto& i) { return i.param == Hider::Path ? "Path" : "Hidden"; });

} // namespace

} // namespace sampledlights_test
