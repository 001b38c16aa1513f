// The distributions that trace() has in common with bsdf(): what is drawn against what the functions say, and traced scenes
// against integrals.
#include "bsdf/lobe.h"
#include "bsdf/sampling.h"
#include "integrator/harness.h"
#include "integrator/maps.h"
#include "shadeops/descriptor.h"
#include <random>

namespace distributions_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

struct Case {
    const char* name;
    float roughness, roughnessv;
    Color eta;
    float view;
    int part;
};
void PrintTo(const Case& c, std::ostream* o) {
    *o << c.name << " " << c.roughness << " " << c.roughnessv << " from " << c.view << " part " << c.part;
}

LobeParams paramsOf(const Case& c) {
    auto m = std::make_shared<DistributionParams>();
    m->roughness = c.roughness;
    m->roughnessv = c.roughnessv;
    m->udir = Vec3(1, .2f, .1f);
    m->eta = c.eta;
    m->part = c.part;
    m->absorption = Color(.2f, .4f, .8f);
    LobeParams p;
    p.axis = normalize(Vec3(.3f, -.2f, .9f));
    const Basis b(p.axis);
    p.wo = b.toWorld({std::sin(c.view) * .6f, std::sin(c.view) * .8f, std::cos(c.view)});
    p.more = m;
    return p;
}

class Distribution : public ::testing::TestWithParam<Case> {};

// The density integrates to the share of draws that give a direction, and the mean of value / density is the integral of the
// value: both over a grid of the sphere, by the midpoint rule.
TEST_P(Distribution, DrawsWhatItSays) {
    const Case c = GetParam();
    const LobeKind& k = *findLobe(c.name);
    const LobeParams p = paramsOf(c);
    double density = 0;
    Vec3d value(0, 0, 0);
    const int nz = 400, nt = 200;
    const Basis frame(p.axis);
    for (int i = 0; i < nz; ++i)
        for (int j = 0; j < nt; ++j) {
            const double z = -1 + 2 * (i + .5) / nz, t = 2 * kPi * (j + .5) / nt, s = std::sqrt(1 - z * z),
                         area = 4 * kPi / nz / nt;
            const Vec3 w = frame.toWorld({float(s * std::cos(t)), float(s * std::sin(t)), float(z)});
            density += k.pdf(p, w) * area;
            value = value + Vec3d(lobeValue(k, p, w)) * area;
        }
    std::mt19937_64 rng(5);
    std::uniform_real_distribution<float> u01(0, 1);
    Moments m, given;
    for (int i = 0, n = samples(30000); i < n; ++i) {
        Vec3 w;
        const bool drawn = k.sample(p, {u01(rng), u01(rng)}, w);
        given.add(Color(drawn));
        if (drawn) {
            EXPECT_NEAR(length(w), 1, 1e-4);
            ASSERT_GT(k.pdf(p, w), 0);
        }
        m.add(drawn ? lobeValue(k, p, w) / k.pdf(p, w) : Color(0));
    }
    EXPECT_NEAR(given.mean(), density, kZ * given.se() + 2e-3 * density);
    for (int ch = 0; ch < 3; ++ch) EXPECT_NEAR(m.mean(ch), value[ch], kZ * m.se(ch) + 4e-3 * value[ch]) << "channel " << ch;
    EXPECT_GT(value.x, .02);
    EXPECT_LT(value.x, 1.01);
}
INSTANTIATE_TEST_SUITE_P(
    All, Distribution,
    ::testing::Values(Case{"oren-nayar", 0, 0, Color(0), .7f, -1}, Case{"oren-nayar", .8f, .8f, Color(0), .9f, -1},
                      Case{"blinn", .4f, .4f, Color(0), .5f, -1}, Case{"blinn", .6f, .6f, Color(1.5f, 1.3f, 2), .9f, -1},
                      Case{"ashikhmin-shirley", .4f, .6f, Color(0), .5f, -1},
                      Case{"ashikhmin-shirley", .7f, .5f, Color(1.5f, 1.3f, 2), .9f, -1},
                      Case{"cook-torrance", .3f, .3f, Color(0), .5f, -1},
                      Case{"cook-torrance", .5f, .5f, Color(1.5f, 1.3f, 2), .9f, -1}, Case{"ward", .2f, .4f, Color(0), .5f, -1},
                      Case{"ward", .4f, .3f, Color(0), .9f, -1}, Case{"ggx", .3f, .3f, Color(0), .5f, -1},
                      Case{"ggx", .7f, .2f, Color(1.5f, 1.3f, 2), 1.2f, -1}, Case{"beckmann", .3f, .3f, Color(0), .5f, -1},
                      Case{"beckmann", .7f, .2f, Color(1.5f, 1.3f, 2), 1.2f, -1},
                      Case{"glass-ggx", .3f, .4f, Color(1.5f), .5f, -1}, Case{"glass-ggx", .3f, .3f, Color(1.5f), 2.5f, -1},
                      Case{"glass-ggx", .3f, .4f, Color(1.5f), .5f, 0}, Case{"glass-ggx", .3f, .4f, Color(1.5f), .5f, 1},
                      Case{"hair", 0, 0, Color(1.55f), .5f, -1}, Case{"hair", 0, 0, Color(1.55f), 1.2f, 0},
                      Case{"hair", 0, 0, Color(1.55f), 1.2f, 1}));

Settings under(Hider h, int mode = 0) {
    Settings s;
    s.hider = h;
    s.bsdfOnly = mode == 1;
    s.lightOnly = mode == 2;
    return s;
}
const char* kFloor = "Polygon \"P\" [-60 0 -60  -60 0 60  60 0 60  60 0 -60]\n";
const CameraRay kView = rayTo({.3f, .8f, -.4f}, {0, 0, 0});
std::string scene(const std::string& lights, const std::string& surface) {
    return "WorldBegin\nSides 2\n" + lights + "AttributeBegin\nSurface \"" + surface + "\"\n" + kFloor +
           "AttributeEnd\nWorldEnd\n";
}
const char* kDisk = "AttributeBegin\nAttribute \"visibility\" \"trace\" 1\nAttribute \"light\" \"string units\" \"radiance\" "
                    "AreaLightSource \"arealight\" 7 \"intensity\" 5\nSurface \"constant\"\nColor 0 0 0\n"
                    "Translate 0 2 0\nRotate 90 1 0 0\nDisk 0 .7 360\nAttributeEnd\nIlluminate 7 1\n";
void tracer(const std::string& name, const std::string& pairs, const std::string& about = "vector(Nf)") {
    writeShader(name, "surface " + name + "() { normal Nf = faceforward(normalize(N), I); Oi = 1; Ci = trace(P, " + about + ", " +
                          pairs + ", \"wo\", -normalize(I), \"samplearealights\", 1, \"type\", \"diffuse\"); }\n");
}

// A disk on the axis, radiance 5 (pi intensity / area of arealight is measured by the first case): roughness 0 of "oren-nayar" is
// Lambert's law, L R^2 / (R^2 + h^2). The others: drawn by the lobe, by the light, and by both they are the same integral.
TEST(TraceDistributions, ADisk) {
    writeShader("shine", "light shine() { illuminate(P, N, PI / 2) Cl = 5; }\n");
    std::string disk = kDisk;
    disk.replace(disk.find("\"arealight\" 7 \"intensity\" 5"), 27, "\"shine\" 7");
    tracer("tron", "\"distribution\", \"oren-nayar\"");
    tracer("trct", "\"distribution\", \"cook-torrance\", \"roughness\", .4, \"eta\", color(1.5, 1.4, 2)");
    tracer("trggx",
           "\"distribution\", \"ggx\", \"roughness\", .4, \"roughnessv\", .2, \"eta\", {color(.2, .9, 1.5), color(3.9, 2.4, "
           "1.9)}");
    tracer("trbeckmann", "\"distribution\", \"beckmann\", \"roughness\", .4");
    tracer("trward", "\"distribution\", \"ward\", \"roughness\", .3, \"roughnessv\", .5, \"udir\", vector(1, 0, 0)");
    tracer("trglass", "\"distribution\", \"glass-ggx\", \"roughness\", .4");
    tracer("trhair", "\"distribution\", \"hair\"", "vector(.6, 0, .8)");
    for (const char* name : {"tron", "trct", "trggx", "trbeckmann", "trward", "trglass", "trhair"}) {
        Moments of[3];
        for (int mode : {0, 1, 2}) {
            Scene s(scene(disk, name), under(Hider::Path, mode));
            of[mode] = s.estimate(kView, samples(20000));
            EXPECT_EQ(s.diagnostics.warnings(), 0) << s.messages();
            if (std::string(name) == "tron") expectMean(of[mode], 5 * .49 / 4.49, .03, name);
            EXPECT_GT(of[mode].mean(), .003) << name;
        }
        for (int mode : {1, 2})
            for (int ch = 0; ch < 3; ++ch)
                EXPECT_NEAR(of[mode].mean(ch), of[0].mean(ch), kZ * std::hypot(of[mode].se(ch), of[0].se(ch)) + 1e-6)
                    << name << " channel " << ch << " mode " << mode;
    }
}
// The parts of glass: reflection sees the disk above, refraction does not; together they are the whole.
TEST(TraceDistributions, Parts) {
    writeShader("shine", "light shine() { illuminate(P, N, PI / 2) Cl = 5; }\n");
    std::string disk = kDisk;
    disk.replace(disk.find("\"arealight\" 7 \"intensity\" 5"), 27, "\"shine\" 7");
    auto parts = [](const char* name, const char* result) {
        writeShader(name, std::string("surface ") + name + R"(() {
    normal Nf = faceforward(normalize(N), I);
    color part[2], sum[2];
    part = trace(P, vector(Nf), "distribution", "glass-ggx", "roughness", .4, "wo", -normalize(I), "samplearealights", 1,
                 "type", "specular", "arealightcontribution", sum);
    Oi = 1;
    Ci = )" + result + ";\n}\n");
    };
    parts("reflected", "part[0]");
    parts("refracted", "part[1]");
    parts("fromlights", "sum[0] + sum[1]");
    tracer("trglass", "\"distribution\", \"glass-ggx\", \"roughness\", .4");
    auto of = [&](const char* name) {
        Scene s(scene(disk, name), under(Hider::Path));
        EXPECT_EQ(s.diagnostics.warnings(), 0) << s.messages();
        return s.estimate(kView, samples(20000));
    };
    const Moments whole = of("trglass"), first = of("reflected"), lights = of("fromlights");
    EXPECT_NEAR(first.mean(), whole.mean(), kZ * std::hypot(first.se(), whole.se()));
    EXPECT_NEAR(lights.mean(), whole.mean(), kZ * std::hypot(lights.se(), whole.se()));
    EXPECT_EQ(of("refracted").mean(), 0);
}
// A map of one colour over a floor, half of the sky behind an endless black wall: what reaches the floor is tint times half of
// it; without the wall all. A pane of opacity a quarter before all of it leaves three.
TEST(TraceDistributions, EnvironmentMap) {
    const std::string map = writeMap("even.exr", 8, 4, Color(.5f, 1, 2));
    auto shader = [&](const char* name, const char* result) {
        writeShader(name,
                    std::string("surface ") + name + R"(() {
    normal Nf = faceforward(normalize(N), I);
    color reached = 0, open = 0, through = 0;
    float d = 0;
    color c = trace(P, vector(Nf), d, "distribution", "cosine", "samplecone", PI / 2, "type", "diffuse", "samples", 64,
                    "environmentmap", )" +
                        map +
                        R"(, "environmenttint", color(2, 1, .5), "environmentspace", "world", "environmentcontribution", reached,
                    "unshadowedenvironment", open, "transmission", through);
    Oi = 1;
    Ci = )" + result + ";\n}\n");
    };
    shader("lit", "c");
    shader("reached", "reached");
    shader("open", "open");
    shader("through", "through");
    shader("nearest", "color(d)");
    const std::string wall = "AttributeBegin\nAttribute \"visibility\" \"trace\" 1\nSurface \"constant\"\nColor 0 0 0\nPolygon "
                             "\"P\" [-.01 0 -900  -.01 900 -900  -.01 900 900  -.01 0 900]\nAttributeEnd\n";
    const std::string pane = "AttributeBegin\nAttribute \"visibility\" \"trace\" 1\nSurface \"constant\"\nColor 0 0 0\nOpacity "
                             ".25 .25 .25\nTranslate 0 1 0\nRotate 90 1 0 0\nDisk 0 900 360\nAttributeEnd\n";
    auto of = [&](const std::string& things, const char* name) {
        return Scene(scene(things, name), under(Hider::Raytrace)).estimate(kView, samples(400));
    };
    for (const char* name : {"lit", "reached", "open"})
        for (const auto& [things, share] : std::vector<std::pair<std::string, double>>{{"", 1}, {wall, .5}, {pane, .75}}) {
            const Moments m = of(things, name);
            const double part = std::string(name) == "open" ? 1 : share;
            for (int ch = 0; ch < 3; ++ch) EXPECT_NEAR(m.mean(ch), part, kZ * m.se(ch) + 2e-3) << name << " " << share;
        }
    EXPECT_NEAR(of(pane, "through").mean(), .75, 2e-3);
    const Moments half = of(wall, "through");
    EXPECT_NEAR(half.mean(), .5, kZ * half.se() + 2e-3);
    const Moments nearest = of(pane, "nearest"); // of 64 the one that goes up most steeply
    EXPECT_GT(nearest.mean(), .99);
    EXPECT_LT(nearest.mean(), 1.05);
}
// What an area light would give and what it gives behind a card.
TEST(TraceDistributions, Unshadowed) {
    writeShader("shine", "light shine() { illuminate(P, N, PI / 2) Cl = 5; }\n");
    std::string disk = kDisk;
    disk.replace(disk.find("\"arealight\" 7 \"intensity\" 5"), 27, "\"shine\" 7");
    auto shader = [&](const char* name, const char* result) {
        writeShader(name, std::string("surface ") + name + R"(() {
    normal Nf = faceforward(normalize(N), I);
    color gives = 0, would = 0;
    color c = trace(P, vector(Nf), "distribution", "cosine", "samplecone", PI / 2, "type", "diffuse", "samplearealights", 1,
                    "arealightcontribution", gives, "unshadowedarealight", would);
    Oi = 1;
    Ci = )" + result + ";\n}\n");
    };
    shader("gives", "gives");
    shader("would", "would");
    const std::string card = "AttributeBegin\nAttribute \"visibility\" \"trace\" 1\nSurface \"constant\"\nColor .5 .5 "
                             ".5\nPolygon \"P\" [-9 1 -9  -9 1 9  9 1 9  9 1 -9]\nAttributeEnd\n";
    const double want = 5 * .49 / 4.49;
    for (Hider h : {Hider::Raytrace, Hider::Path}) {
        expectMean(Scene(scene(disk, "gives"), under(h)).estimate(kView, samples(20000)), want, .03, "gives");
        expectMean(Scene(scene(disk, "would"), under(h)).estimate(kView, samples(20000)), want, .03, "would");
        EXPECT_EQ(Scene(scene(disk + card, "gives"), under(h)).estimate(kView, 500).mean(), 0);
        expectMean(Scene(scene(disk + card, "would"), under(h)).estimate(kView, samples(20000)), want, .03,
                   "would behind the card");
    }
}
// Rays begin where the call says; a bias moves them on.
TEST(TraceDistributions, WhereRaysBegin) {
    writeShader("far", R"(surface far(vector off = vector(0, 0, 0); float by = -1;) {
    float d = 0;
    color c = trace(P + off, vector(0, 1, 0), d, "bias", by);
    Oi = 1;
    Ci = color(d);
}
)");
    const std::string card = "AttributeBegin\nAttribute \"visibility\" \"trace\" 1\nSurface \"constant\"\nPolygon \"P\" [-9 3 -9 "
                             " -9 3 9  9 3 9  9 3 -9]\nAttributeEnd\n";
    auto of = [&](const std::string& more) {
        std::string rib = scene(card, "far");
        rib.replace(rib.find("Surface \"far\""), 13, "Surface \"far\" " + more);
        return Scene(rib, under(Hider::Raytrace)).one(kView).x;
    };
    EXPECT_NEAR(of(""), 3, 1e-4);
    EXPECT_NEAR(of("\"vector off\" [0 .5 0]"), 2.5, 1e-4);
    EXPECT_GT(of("\"vector off\" [20 .5 0]"), 1e17); // what no sum holds
    EXPECT_NEAR(of("\"float by\" .25"), 2.75, 1e-4);
}
// Names that are known only when the shader runs: of each point its own, and an error where there is none of that name.
TEST(TraceDistributions, NamesThatAreKnownLate) {
    writeShader("late", R"(surface late(string other = "cosine"; float reflects = 0;) {
    normal Nf = faceforward(normalize(N), I);
    string name = (u < .5) ? "ward" : other;
    Oi = 1;
    if (reflects > 0)
        Ci = bsdf(vector(Nf), Nf, "distribution", name, "roughness", .5, "wo", vector(Nf));
    else
        Ci = trace(P, vector(Nf), "distribution", name, "samplecone", PI / 2, "type", "diffuse", "samples", 4);
}
)");
    const std::string shell =
        "AttributeBegin\nAttribute \"visibility\" \"trace\" 1\nSurface \"constant\"\nColor .5 .5 .5\nSphere "
        "40 -40 40 360\nAttributeEnd\n";
    const CameraRay second = rayTo({10.3f, .8f, -.4f}, {10, 0, 0}), first = rayTo({-10.3f, .8f, -.4f}, {-10, 0, 0});
    for (const Hider h : {Hider::Raytrace, Hider::Path})
        for (const bool known : {true, false}) {
            std::string rib = scene(shell, "late");
            if (!known) rib.replace(rib.find("Surface \"late\""), 14, "Surface \"late\" \"other\" \"shiny\"");
            Scene s(rib, under(h));
            const double a = s.one(first).x, b = s.one(second).x;
            EXPECT_GT(std::min(a, b) + std::max(a, b), .1); // one half of the floor has "ward"
            if (known) EXPECT_NEAR(std::max(a, b), .5, 1e-5);
            const bool said = s.messages().find("trace(): there is no distribution \"shiny\"") != std::string::npos;
            EXPECT_EQ(said, !known) << s.messages();
            EXPECT_EQ(s.diagnostics.errors(), known ? 0 : 1);
            if (!known) EXPECT_EQ(std::min(a, b), 0);
            if (!known) EXPECT_NE(s.messages().find("ggx, beckmann, glass-ggx"), std::string::npos) << s.messages();
        }
    std::string rib = scene("", "late");
    rib.replace(rib.find("Surface \"late\""), 14, "Surface \"late\" \"other\" \"shiny\" \"reflects\" 1");
    Scene s(rib, under(Hider::Raytrace));
    const double a = s.one(first).x, b = s.one(second).x;
    EXPECT_NEAR(std::max(a, b), 1 / kPi, 1e-5);
    EXPECT_EQ(std::min(a, b), 0);
    EXPECT_NE(s.messages().find("bsdf(): there is no distribution \"shiny\""), std::string::npos) << s.messages();
}
// What is not followed is said.
TEST(TraceDistributions, WordsThatAreNotKnown) {
    writeShader("words", "surface words() { Oi = 1; Ci = trace(P, vector(0, 1, 0), \"type\", \"ghost\", \"hitsides\", \"top\", "
                         "\"hitmode\", \"guess\"); }\n");
    const std::string m = Scene(scene("", "words"), under(Hider::Raytrace)).messages();
    for (const char* what :
         {"\"type\" \"ghost\" is not known", "\"hitsides\" \"top\" is not known", "\"hitmode\" \"guess\" is not known"})
        EXPECT_NE(m.find(what), std::string::npos) << m;
    writeShader("allwords", "surface allwords() { Oi = 1; Ci = trace(P, vector(0, 1, 0), \"subset\", \"some\", \"hitsides\", "
                            "\"front\", \"hitmode\", \"primitive\", \"label\", \"l\"); }\n");
    EXPECT_EQ(Scene(scene("", "allwords"), under(Hider::Raytrace)).messages(), "");
}

} // namespace

} // namespace distributions_test
