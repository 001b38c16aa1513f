// Outputs that light reaches, displayed together with Ci: the beauty is what it is without them, to the bit, and they have all of
// their light.
#include "integrator/box.h"
#include "integrator/floorscene.h"
#include <cstring>

namespace lightoutputs_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

struct Shown {
    std::vector<SampleResult> samples;
    std::string messages;
    double mean(size_t at) const {
        double s = 0;
        for (const SampleResult& r : samples) s += r.aovs[at];
        return s / double(samples.size());
    }
    double beauty(int k) const {
        double s = 0;
        for (const SampleResult& r : samples) s += r.color[k];
        return s / double(samples.size());
    }
};

Shown show(const std::string& rib, const std::vector<CameraRay>& rays, const std::vector<std::string>& outputs,
           Hider h = Hider::Path, int lanes = 16) {
    Settings set = withShaders(h);
    set.outputs = outputs;
    set.lanes = lanes;
    Scene s(rib, set);
    return {s.trace(rays), s.messages()};
}

/// The box whose walls and spheres have another shader, for which the last words give parameters.
std::string boxWith(const std::string& shader, bool spheres = true) {
    std::string rib = boxRib(spheres);
    for (size_t at = 0; (at = rib.find("Surface \"", at)) != std::string::npos; at += 9) {
        const size_t end = rib.find('\n', at);
        const size_t next = rib.find_first_not_of(" \n", end);
        const bool more = next != std::string::npos && rib[next] == '"'; // its parameters go on in the next line
        rib.replace(at, (more ? rib.find('\n', next) : end) - at, "Surface \"" + shader + "\"");
    }
    return rib;
}

void expectSameBeauty(const Shown& a, const Shown& b, const std::string& what) {
    ASSERT_EQ(a.samples.size(), b.samples.size());
    int differ = 0;
    for (size_t i = 0; i < a.samples.size(); ++i)
        differ += std::memcmp(&a.samples[i].color, &b.samples[i].color, sizeof(Color)) != 0;
    EXPECT_EQ(differ, 0) << what << ": of " << a.samples.size() << " samples";
}

/// What the lamp sends to the eye is the light's, and in no output of a surface.
bool seesLamp(const SampleResult& r) { return r.color == Color(7); }

/// Every sample of an output is that of Ci, up to rounding.
void expectIsBeauty(const Shown& a, size_t at, const std::string& what) {
    double worst = 0;
    for (const SampleResult& r : a.samples)
        for (int k = 0; k < 3 && !seesLamp(r); ++k)
            worst =
                std::max(worst, std::fabs(double(r.aovs[at + size_t(k)]) - r.color[k]) / (1e-3 + std::fabs(double(r.color[k]))));
    EXPECT_LT(worst, 2e-6) << what;
}

const char* const kParts =
    R"(surface parts(output varying color d = 0; output varying color gloss = 0; output varying color none = 0;
                     output varying float red = 0;) {
    normal Nf = faceforward(normalize(N), I);
    d = Cs * diffuse(Nf);
    gloss = 0.3 * Cs * specular(Nf, -normalize(I), 0.3);
    none = diffuse(-Nf) + diffuse(Nf);
    red = 2 * comp(d, 0);
    Oi = Os; Ci = Oi * (d + gloss);
})";

TEST(LightOutputs, AnOutputThatIsCi) {
    writeShader(
        "isci",
        "surface isci(output varying color d = 0;) { d = Cs * diffuse(faceforward(normalize(N), I)); Oi = Os; Ci = d; }\n");
    const auto rays = boxRays(24, 3);
    const std::string rib = boxWith("isci");
    const Shown plain = show(rib, rays, {});
    for (int lanes : {4, 8, 16}) {
        const Shown with = show(rib, rays, {"d"}, Hider::Path, lanes);
        expectSameBeauty(plain, with, "lanes " + std::to_string(lanes));
        expectIsBeauty(with, 0, "lanes " + std::to_string(lanes));
        EXPECT_EQ(with.messages, "");
    }
}

// Two parts add up to Ci in every sample; a part that Ci does not have, and a number made of components, have the means of closed
// forms.
TEST(LightOutputs, PartsOfCi) {
    writeShader("parts", kParts);
    const auto rays = boxRays(24, 5);
    const std::string rib = boxWith("parts");
    const Shown plain = show(rib, rays, {});
    std::vector<std::vector<float>> first;
    for (int lanes : {4, 8, 16}) {
        const Shown with = show(rib, rays, {"d", "gloss", "none", "red"}, Hider::Path, lanes);
        expectSameBeauty(plain, with, "lanes " + std::to_string(lanes));
        double worst = 0;
        for (const SampleResult& r : with.samples) {
            if (seesLamp(r)) continue;
            for (size_t k = 0; k < 3; ++k)
                worst = std::max(worst, std::fabs(double(r.aovs[k]) + r.aovs[3 + k] - r.color[int(k)]) /
                                            (1e-3 + std::fabs(double(r.color[int(k)]))));
            worst = std::max(worst, std::fabs(double(r.aovs[9]) - 2 * double(r.aovs[0])) / (1e-3 + std::fabs(double(r.aovs[0]))));
        }
        EXPECT_LT(worst, 3e-6);
        for (size_t i = 0; i < with.samples.size(); ++i) {
            if (lanes == 4) first.push_back(with.samples[i].aovs);
            else EXPECT_EQ(with.samples[i].aovs, first[i]) << "sample " << i << ", lanes " << lanes;
        }
    }
}

/// A white floor under an even sky, whose shader writes outputs: means over n samples of one ray.
std::vector<Moments> underASky(const std::string& surface, const std::vector<std::string>& outputs, Hider h, int n,
                               bool suspend = false, std::string* said = nullptr) {
    Settings set = withShaders(h);
    set.outputs = outputs;
    set.suspend = suspend;
    Scene s(inWorld("LightSource \"envlight\" 1\n" + surface + kFloor), set);
    std::vector<CameraRay> rays(size_t(n), kView);
    for (int i = 0; i < n; ++i) rays[size_t(i)].px = i;
    std::vector<Moments> m;
    for (const SampleResult& r : s.trace(rays)) {
        m.resize(r.aovs.size() / 3 + 1);
        m[0].add(r.color);
        for (size_t k = 0; k + 1 < m.size(); ++k) m[k + 1].add(Color(r.aovs[3 * k], r.aovs[3 * k + 1], r.aovs[3 * k + 2]));
    }
    if (said) *said = s.messages();
    return m;
}

// diffuse() under a sky of radiance 1 is 1. Outputs that Ci does not have, or has with another weight, through transparent layers
// too.
TEST(LightOutputs, ClosedForms) {
    writeShader("tells", R"(surface tells(output varying color a = 0; output varying color b = 0; output varying color c = 0;) {
    normal Nf = faceforward(normalize(N), I);
    color d = diffuse(Nf);
    a = d; b = color(0, 3, 0.25) * d + 0.5; c = 100 * d;
    Oi = Os; Ci = Oi * (color(0.25, 0, 0.5) * d + 0.125);
})");
    const std::string pane =
        "Opacity [.5 .5 .5]\nSurface \"tells\"\nPolygon \"P\" [-1 .3 -1  -1 .3 1  1 .3 1  1 .3 -1]\nOpacity [1 1 1]\n";
    for (bool suspend : {false, true}) {
        const auto m = underASky("Surface \"tells\"\n", {"a", "b", "c"}, Hider::Path, 4096, suspend);
        ASSERT_EQ(m.size(), 4u);
        const double want[4][3] = {{.375, .125, .625}, {1, 1, 1}, {.5, 3.5, .75}, {100, 100, 100}};
        for (size_t o = 0; o < 4; ++o)
            for (int k = 0; k < 3; ++k)
                EXPECT_LE(std::fabs(m[o].mean(k) - want[o][k]), kZ * m[o].se(k) + 1e-5 * want[o][k])
                    << o << " " << k << " " << m[o].mean(k);
    }
    // The pane shows half of its outputs, and half of the floor's: .5 of a on the pane (with half its sky), and of the floor's.
    const auto one = underASky("Surface \"tells\"\n" + pane, {"a"}, Hider::Path, 4096);
    EXPECT_GT(one[1].mean(), 1.0);
    EXPECT_LT(one[1].mean(), 1.5);
}

// An output that is not affine in light while Ci is: Ci keeps all of it to the bit, the output has direct light, and that is
// said.
TEST(LightOutputs, NotAffine) {
    writeShader("bent", R"(surface bent(output varying color d = 0; output varying color e = 0;) {
    color c = Cs * diffuse(faceforward(normalize(N), I));
    d = max(c, color(0.01)); e = c;
    Oi = Os; Ci = c;
})");
    const auto rays = boxRays(16, 7);
    const std::string rib = boxWith("bent", false);
    const Shown plain = show(rib, rays, {}), with = show(rib, rays, {"d", "e"});
    expectSameBeauty(plain, with, "bent");
    expectIsBeauty(with, 3, "the other output");
    EXPECT_NE(with.messages.find("output \"d\" of shader \"bent\" holds only the direct light of diffuse"), std::string::npos)
        << with.messages;
    EXPECT_GT(with.mean(0), 0.005);
    EXPECT_LT(with.mean(0), with.mean(3)); // no indirect light
}

// trace() whose result is compared: only the kernel of that output waits.
TEST(LightOutputs, WaitsAlone) {
    writeShader("waits", R"(surface waits(output varying color d = 0;) {
    normal Nf = faceforward(normalize(N), I);
    color t = trace(P, Nf, "distribution", "cosine", "samplecone", PI / 2);
    d = comp(t, 0) > 0.5 ? color(2) : color(1);
    Oi = 1; Ci = 0.5 * t;
})");
    const auto with = underASky("Surface \"waits\"\n", {"d"}, Hider::Path, 256),
               plain = underASky("Surface \"waits\"\n", {}, Hider::Path, 256);
    EXPECT_EQ(with[0].s[0], plain[0].s[0]);
    EXPECT_NEAR(with[1].mean(), 2, 1e-6);
    EXPECT_NEAR(with[0].mean(), .5, 1e-5);
}

// Elements of an array, hand-written loops over lights, and lights of all kinds, under every hider.
TEST(LightOutputs, LoopsAndArrays) {
    writeShader("loops", R"(surface loops(output varying color list[2] = {0, 0};) {
    normal Nf = faceforward(normalize(N), I);
    color sum = 0;
    illuminance(P, Nf, PI / 2) sum += Cl * normalize(L) . Nf;
    list[0] = color(1, 2, 3); list[1] = sum;
    Oi = 1; Ci = 0.5 * sum;
})");
    for (Hider h : {Hider::Hidden, Hider::Path}) {
        Settings set = withShaders(h);
        set.outputs = {"list"};
        Scene s(inWorld("LightSource \"pointlight\" 1 \"point from\" [0 2 0] \"intensity\" 8\nSurface \"loops\"\n" +
                        std::string(kFloor)),
                set);
        const SampleResult r = s.trace(std::vector<CameraRay>{kView})[0];
        EXPECT_EQ(s.messages(), "");
        EXPECT_NEAR(r.color.x, 1, 1e-5); // I cos / d^2 / 2
        const float want[6] = {1, 2, 3, 2, 2, 2};
        for (size_t k = 0; k < 6; ++k) EXPECT_NEAR(r.aovs[k], want[k], 1e-5) << k;
    }
}

} // namespace

} // namespace lightoutputs_test
