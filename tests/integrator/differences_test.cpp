// Derivatives as grids have them, in scenes: who gets them, what they are, and what becomes of detail finer than a pixel.
#include "integrator/harness.h"
#include <cstring>

namespace differences_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

const std::string kOutputs = "(output varying normal shown = 0; output varying point uv = 0;)";

void writeShaders() {
    writeShader("diffslope",
                "surface diffslope" + kOutputs +
                    " { float f = sin(3000 * u); shown = normal(Du(f), du, dv); uv = point(u, v, 0); Ci = 1; Oi = 1; }\n");
    writeShader("diffnormal",
                "surface diffnormal" + kOutputs + " { shown = normalize(N); uv = point(u, v, du); Ci = dv; Oi = 1; }\n");
    writeShader(
        "diffwaves",
        "displacement diffwaves() { P += 0.001 * sin(3000 * u) * cos(2500 * v) * normalize(N); N = calculatenormal(P); }\n");
    writeShader("diffgrain", "surface diffgrain(float depth = 0) { normal n = faceforward(normalize(calculatenormal(P + depth * "
                             "noise(P * 40000) * normalize(N))), I);\n"
                             "Ci = max(0, n . normalize(vector(0.6, 0.2, -1))); Oi = 1; }\n");
    writeShader(
        "diffgrained",
        "displacement diffgrained(float depth = 0) { P += depth * noise(P * 40000) * normalize(N); N = calculatenormal(P); }\n");
    writeShader("difflit",
                "surface difflit() { Ci = max(0, faceforward(normalize(N), I) . normalize(vector(0.6, 0.2, -1))); Oi = 1; }\n");
}

const std::string kPatch = "Patch \"bilinear\" \"P\" [-1 -1 3  1 -1 3  -1 1 3  1 1 3]\n";

std::string rib(const std::string& what) {
    return "Format 200 200 1\nProjection \"perspective\" \"fov\" 40\nWorldBegin\nSides 2\n" + what + "WorldEnd\n";
}

/// Twenty by twenty rays over the patch, of footprints a pixel wide.
std::vector<CameraRay> manyRays(float spread) {
    std::vector<CameraRay> rays;
    for (int i = 0; i < 400; ++i) {
        rays.push_back(rayTo({0, 0, 0}, {.9f * (float(i % 20) / 10 - .95f), .9f * (float(i / 20) / 10 - .95f), 3}));
        rays.back().spread = spread;
    }
    return rays;
}
std::vector<SampleResult> render(const std::string& what, float spread, Hider hider = Hider::Hidden, int lanes = 16) {
    Settings s;
    s.outputs = {"shown", "uv"};
    s.hider = hider;
    s.lanes = lanes;
    Scene scene(rib(what), s);
    EXPECT_TRUE(scene.world);
    return scene.trace(manyRays(spread));
}

/// How far Du(sin(3000 u)) is, at most, from the exact slope and from the difference. The step makes 18 turns of the wave, so no
/// two places agree by chance; its argument is rounded at 3000, which is 1.2e-4 of the wave over the step.
void expectForm(const std::vector<SampleResult>& all, bool differences, const std::string& what, int least = 300) {
    int hits = 0;
    double exact = 0, difference = 0;
    for (const SampleResult& r : all) {
        if (r.opacity.x < 1) continue;
        ++hits;
        const double u = double(r.aovs[3]), h = double(r.aovs[1]), got = double(r.aovs[0]);
        EXPECT_GT(h, 0.01);
        exact = std::max(exact, std::fabs(got - 3000 * std::cos(3000 * u)));
        difference = std::max(difference, std::fabs(got - (std::sin(3000 * (u + h)) - std::sin(3000 * u)) / h));
    }
    EXPECT_GT(hits, least) << what;
    EXPECT_LT(differences ? difference : exact, differences ? 0.1 : 1.0) << what;
    EXPECT_GT(differences ? exact : difference, 1000) << what;
}

TEST(Differences, TheHiderDecidesAndTheAttributeOverridesIt) {
    writeShaders();
    const std::string plain = "Surface \"diffslope\"\n" + kPatch;
    for (const Hider h : {Hider::Hidden, Hider::Raytrace, Hider::Path}) {
        const std::string what = "hider " + std::to_string(int(h));
        expectForm(render(plain, .02f, h), h != Hider::Path, what);
        expectForm(render("Attribute \"shade\" \"derivatives\" \"exact\"\n" + plain, .02f, h), false, what + ", exact");
        expectForm(render("Attribute \"shade\" \"string derivatives\" \"differences\"\n" + plain, .02f, h), true,
                   what + ", differences");
    }
}

// One shader call, two objects: each has its own form.
TEST(Differences, EachObjectHasItsOwn) {
    writeShaders();
    const auto all = render("Surface \"diffslope\"\nAttributeBegin\nAttribute \"shade\" \"derivatives\" \"exact\"\n"
                            "Patch \"bilinear\" \"P\" [-1 -1 3  0 -1 3  -1 1 3  0 1 3]\nAttributeEnd\n"
                            "Patch \"bilinear\" \"P\" [0 -1 3  1 -1 3  0 1 3  1 1 3]\n",
                            .02f);
    std::vector<SampleResult> left, right;
    for (size_t i = 0; i < all.size(); ++i) (i % 20 < 10 ? left : right).push_back(all[i]);
    expectForm(left, false, "left", 150);
    expectForm(right, true, "right", 150);
}

TEST(Differences, UnknownFormsAreNamed) {
    writeShaders();
    Scene scene(rib("Attribute \"shade\" \"derivatives\" \"smooth\"\nSurface \"diffslope\"\n" + kPatch));
    EXPECT_NE(scene.messages().find("\"derivatives\" cannot be \"smooth\""), std::string::npos) << scene.messages();
    EXPECT_NE(scene.messages().find("\"exact\" or \"differences\""), std::string::npos) << scene.messages();
}

// The plane is flat, so its neighbours are where du and dv lead: the normal is that of three points of the displaced surface.
// Under path, too: displaced surfaces are diced, and have nothing finer.
TEST(Differences, NormalsOfDisplacedSurfaces) {
    writeShaders();
    const auto height = [](double u, double v) { return .001 * std::sin(3000 * u) * std::cos(2500 * v); };
    int hits = 0;
    const std::string waves =
        "Attribute \"displacementbound\" \"sphere\" .1\nDisplacement \"diffwaves\"\nSurface \"diffnormal\"\n";
    std::vector<SampleResult> all = render(waves + kPatch, .01f);
    for (const SampleResult& r : render(waves + kPatch, .01f, Hider::Path)) all.push_back(r);
    for (const SampleResult& r : all) {
        if (r.opacity.x < 1) continue;
        ++hits;
        const double u = double(r.aovs[3]), v = double(r.aovs[4]), du = double(r.aovs[5]), dv = double(r.color.x);
        const Vec3d a(2, 0, (height(u + du, v) - height(u, v)) / du), b(0, 2, (height(u, v + dv) - height(u, v)) / dv);
        const Vec3d n = normalize(cross(a, b)), got(double(r.aovs[0]), double(r.aovs[1]), double(r.aovs[2]));
        // The sign of z is that of the side; 3000 u is rounded to 1.2e-4, so the slopes to 1.2e-7 / du.
        const Vec3d same(n.x, n.y, n.z), other(-n.x, -n.y, n.z);
        EXPECT_LT(std::min({length(same - got), length(same + got), length(other - got), length(other + got)}), 2e-4)
            << u << " " << v;
    }
    EXPECT_GT(hits, 600);
}

struct Brightness {
    double mean = 0, deviation = 0;
};
Brightness brightness(const std::string& what) {
    Brightness b;
    double n = 0, squares = 0;
    for (const SampleResult& r : render(what, .01f)) {
        if (r.opacity.x < 1) continue;
        ++n;
        b.mean += double(r.color.x);
        squares += double(r.color.x) * double(r.color.x);
    }
    EXPECT_GT(n, 300);
    b.mean /= n;
    b.deviation = std::sqrt(std::max(0.0, squares / n - b.mean * b.mean));
    return b;
}

// Grain of a thousandth, 900 turns of noise in a pixel of .02: of its difference, at most .1 and mostly .02, the first power has
// mean 0 and the second is below a thousandth of the light. Its exact slope is about 20: a third of it looks away from the light.
TEST(Differences, DetailFinerThanAPixelIsNotSpeckled) {
    writeShaders();
    const std::string bound = "Attribute \"displacementbound\" \"sphere\" .1\n",
                      exact = "Attribute \"shade\" \"derivatives\" \"exact\"\n";
    const double smooth = 1 / std::sqrt(1 + .36 + .04);
    for (const std::string grain :
         {"Surface \"diffgrain\" \"depth\" .001\n", "Displacement \"diffgrained\" \"depth\" .001\nSurface \"difflit\"\n"}) {
        const Brightness b = brightness(bound + grain + kPatch), was = brightness(bound + exact + grain + kPatch);
        EXPECT_NEAR(b.mean, smooth, .01 * smooth) << grain;
        EXPECT_LT(b.deviation, .05 * smooth) << grain;
        EXPECT_LT(was.mean, .8 * smooth) << grain;
        EXPECT_GT(was.deviation, .2 * smooth) << grain;
    }
}

TEST(Differences, AreTheSameBitsAtEveryWidth) {
    writeShaders();
    const std::string what = "Attribute \"displacementbound\" \"sphere\" .1\nDisplacement \"diffgrained\" \"depth\" .01\nSurface "
                             "\"diffgrain\" \"depth\" .01\n" +
                             kPatch;
    const auto first = render(what, .01f);
    for (const int lanes : {4, 8}) {
        const auto other = render(what, .01f, Hider::Hidden, lanes);
        ASSERT_EQ(other.size(), first.size());
        for (size_t i = 0; i < first.size(); ++i) EXPECT_EQ(std::memcmp(&first[i].color, &other[i].color, sizeof(Color)), 0) << i;
    }
}

} // namespace

} // namespace differences_test
