// occlusion() and indirectdiffuse() against closed forms: a floor beside a wall, balls, disks, maps; every parameter and output.
#include "integrator/floorscene.h"
#include "integrator/maps.h"
#include <cmath>
#include <limits>

namespace occlusion_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

constexpr Hider kAll[] = {Hider::Hidden, Hider::Raytrace, Hider::Path};
const std::string kSeen = "Attribute \"visibility\" \"integer transmission\" 1 \"integer diffuse\" 1 \"integer specular\" 1\n";

/// A surface whose Ci is `value`, a color, with `up` the normal of the floor.
std::string shows(const std::string& name, const std::string& value, const std::string& before = "") {
    writeShader(name, "surface " + name +
                          "() { vector up = vector \"world\" (0, 1, 0), aside = vector \"world\" (1, 0, 0); color ec = 0; vector "
                          "ed = 0; float oc = -1;\n" +
                          before + "\nCi = " + value + "; Oi = 1; }\n");
    return "Surface \"" + name + "\"\n";
}
/// A wall that shows 1, at x = .5, so high, as good as endless to both sides; seen from the origin on the floor.
std::string wall(double height) {
    const std::string h = std::to_string(height);
    return "AttributeBegin Surface \"constant\" Color 1 1 1 Polygon \"P\" [.5 0 -9000  .5 0 9000  .5 " + h + " 9000  .5 " + h +
           " -9000] AttributeEnd\n";
}
/// What a wall of that height at distance x takes of the hemisphere over the floor, by the cosine.
double ofWall(double x, double h) { return (1 - x / std::sqrt(x * x + h * h)) / 2; }
std::string ball(double r, const std::string& what) {
    const std::string s = std::to_string(r);
    return "AttributeBegin Surface \"constant\" " + what + " Sphere " + s + " -" + s + " " + s + " 360 AttributeEnd\n";
}
const std::string kSmall = "Polygon \"P\" [-.01 0 -.01  -.01 0 .01  .01 0 .01  .01 0 -.01]\n";
/// Meets that small floor from inside of what stands about it.
const CameraRay kNear = rayTo({.03f, .08f, -.04f}, {0, 0, 0});

Moments of(const std::string& surface, const std::string& scene, Hider h, int n = 400) {
    Scene s(inWorld(kSeen + surface + scene), withShaders(h));
    return s.estimate(kNear, n);
}

TEST(Occlusion, OfAWall) {
    for (const Hider h : kAll) {
        const Moments m = of(shows("occwall", "color occlusion(P, up, 64)"), kFloor + wall(1), h);
        expectMean(m, ofWall(.5, 1), .01, "hider " + std::to_string(int(h)));
    }
    // Not affine, in a product: the same.
    const Moments m =
        of(shows("occwall2", "color (sqrt(occlusion(P, up, 64) * occlusion(P, up, 64)))"), kFloor + wall(1), Hider::Path);
    EXPECT_NEAR(m.mean(), ofWall(.5, 1), .01);
}

TEST(Occlusion, NeedsNoWaitingKernel) {
    Scene s(inWorld(kSeen + shows("occaffine", "Cs * (1 - occlusion(P, up, 16))") + kFloor), withShaders(Hider::Path));
    EXPECT_EQ(s.world->facts().suspending, 0);
    EXPECT_EQ(s.one(kNear), Color(1));
}

TEST(Occlusion, CountsOpacityByItsMean) {
    for (const Hider h : kAll) {
        const Moments m = of(shows("occclear", "color occlusion(P, up, 4)"), kSmall + ball(2, "Opacity .25 .5 .9"), h, 16);
        EXPECT_NEAR(m.mean(), .55, 1e-6);
        EXPECT_NEAR(m.mean(2), .55, 1e-6);
    }
}

TEST(Occlusion, FallsOff) {
    struct Case {
        const char* pairs;
        double want;
    };
    for (const Case& c :
         {Case{"\"falloff\", .7", std::exp(-.7 * 2)},
          Case{"\"falloff\", 3, \"falloffmode\", 1, \"maxdist\", 8", std::pow(.75, 3)},
          Case{"\"falloff\", 3, \"falloffmode\", 1", 1}, Case{"\"maxdist\", 1.9", 0}, Case{"\"maxdist\", 2.1", 1}})
        for (const char* opacity : {"", "Opacity .5 .5 .5"}) {
            const Moments m = of(shows("occfall", std::string("color occlusion(P, up, 4, ") + c.pairs + ")"),
                                 kSmall + ball(2, opacity), Hider::Path, 16);
            EXPECT_NEAR(m.mean(), c.want * (*opacity ? .5 : 1), 1e-3) << c.pairs; // the floor is .01 wide
        }
}

TEST(Occlusion, OfADiskInACone) {
    // A disk of radius 1 at height 2.
    const std::string disk = "AttributeBegin Translate 0 2 0 Rotate 90 1 0 0 Surface \"constant\" Disk 0 1 360 AttributeEnd\n";
    const double sine2 = 1 / 5., a = .9;
    struct Case {
        const char* pairs;
        double want;
    };
    for (const Case& c :
         {Case{"", sine2}, Case{", \"coneangle\", .9", sine2 / (std::sin(a) * std::sin(a))},
          Case{", \"coneangle\", .9, \"distribution\", \"uniform\"", (1 - std::sqrt(1 - sine2)) / (1 - std::cos(a))},
          Case{", \"coneangle\", .1", 1}, Case{", \"coneangle\", 0", 1}})
        expectMean(of(shows("occdisk", std::string("color occlusion(P, up, 64") + c.pairs + ")"), kSmall + disk, Hider::Path),
                   c.want, .01, c.pairs);
    // AIR's form: the half angle, and the mean direction.
    expectMean(of(shows("occair", "occlusion(P, up, .9, ed)"), kSmall + disk, Hider::Path, 2000),
               sine2 / (std::sin(a) * std::sin(a)), .01, "AIR");
}

TEST(Occlusion, OfTheHalfThatTheAxisSees) {
    // Right beside a very high wall half of all is blocked: all of what lies toward it.
    const std::string scene = kFloor + std::string("AttributeBegin Surface \"constant\" Polygon \"P\" [-.0004 0 -9000  -.0004 0 "
                                                   "9000  -.0004 9000 9000  -.0004 9000 -9000] AttributeEnd\n");
    EXPECT_NEAR(of(shows("occaxis", "color occlusion(P, up, 64, \"axis\", -aside)"), scene, Hider::Path).mean(), 1, 2e-3);
    EXPECT_NEAR(of(shows("occaxis2", "color occlusion(P, up, 64, \"axis\", aside)"), scene, Hider::Path).mean(), 0, 2e-3);
    EXPECT_NEAR(of(shows("occaxis3", "color occlusion(P, up, 64, \"axis\", up)"), scene, Hider::Path).mean(), .5, .01);
    EXPECT_NEAR(of(shows("occaxis4", "color occlusion(P, up, 64, \"axis\", vector(0))"), scene, Hider::Path).mean(), .5, .01);
    // The mean free direction is that of a quarter of a ball: 1/3 up, 2/(3 PI) away from the wall.
    for (const char* op : {"occlusion", "indirectdiffuse"}) {
        const Moments m = of(shows("occdir", "color(ed . aside, ed . up, oc)",
                                   std::string(op) + "(P, up, 1024, \"environmentdir\", ed, \"occlusion\", oc);"),
                             scene, Hider::Path, 60);
        const double l = std::sqrt(1 / 9. + 4 / (9 * M_PI * M_PI));
        EXPECT_NEAR(m.mean(0), 2 / (3 * M_PI) / l, .01) << op;
        EXPECT_NEAR(m.mean(1), 1 / 3. / l, .01) << op;
        EXPECT_NEAR(m.mean(2), .5, .01) << op;
    }
}

TEST(Occlusion, AsksTheMapOfTheSky) {
    writeMap("occsky.exr", 16, 8, Color(.25f, .5f, .75f));
    for (const char* op : {"occlusion", "indirectdiffuse"})
        for (const Hider h : kAll) {
            const std::string name = shaderFolder() + "/occsky.exr";
            const Moments m =
                of(shows("occmap", "ec",
                         std::string(op) + "(P, up, 64, \"environmentmap\", \"" + name + "\", \"environmentcolor\", ec);"),
                   kFloor + wall(1), h);
            for (int k = 0; k < 3; ++k) EXPECT_NEAR(m.mean(k), (1 - ofWall(.5, 1)) * .25 * (k + 1), .005) << op << int(h);
        }
    // What indirectdiffuse() gives is that and the wall, which shows 1.
    const Moments m = of(shows("indmap", "indirectdiffuse(P, up, 64, \"environmentmap\", \"" + shaderFolder() + "/occsky.exr\")"),
                         kFloor + wall(1), Hider::Raytrace);
    EXPECT_NEAR(m.mean(), (1 - ofWall(.5, 1)) * .25 + ofWall(.5, 1), .005);
}

TEST(Occlusion, SamplesAreThoseOfTheAttribute) {
    struct Case {
        const char* call;
        uint64_t rays;
    };
    for (const Case& c : {Case{"occlusion(P, up)", 23}, Case{"occlusion(P, up, 0)", 23}, Case{"occlusion(P, up, -1)", 23},
                          Case{"occlusion(P, up, 5)", 5}, Case{"occlusion(P, up, \"samples\", 6)", 6},
                          Case{"occlusion(P, up, sqrt(-1) * 0 / 0)", 23}, Case{"occlusion(P, up, 1e9)", 4096}}) {
        Scene s(inWorld(kSeen + "Attribute \"irradiance\" \"integer nsamples\" 23\n" +
                        shows("occcount", std::string("color ") + c.call) + kFloor),
                withShaders(Hider::Path));
        Counters n;
        const CameraRay ray = kNear;
        s.trace({&ray, 1}, &n);
        EXPECT_EQ(n.shadow, c.rays) << c.call;
        EXPECT_EQ(s.messages().find("4096") != std::string::npos, c.rays == 4096) << s.messages();
    }
    Scene s(inWorld(kSeen + shows("occcount2", "color occlusion(P, up)") + kFloor), withShaders(Hider::Path));
    Counters n;
    const CameraRay ray = kNear;
    s.trace({&ray, 1}, &n);
    EXPECT_EQ(n.shadow, 64u);
}

TEST(Occlusion, SubsetsSidesAndBias) {
    const std::string in = "Attribute \"grouping\" \"string membership\" \"shell\"\n";
    struct Case {
        const char* pairs;
        double want;
    };
    for (const Case& c : {Case{"\"subset\", \"shell\"", 1}, Case{"\"subset\", \"-shell\"", 0},
                          Case{"\"excludesubset\", \"shell\"", 0}, Case{"\"bias\", 2.5", 0}, Case{"\"bias\", 1", 1}})
        EXPECT_NEAR(
            of(shows("occset", std::string("color occlusion(P, up, 4, ") + c.pairs + ")"), kSmall + ball(2, in), Hider::Path, 8)
                .mean(),
            c.want, 1e-6)
            << c.pairs;
}

TEST(Occlusion, InALight) {
    writeShader(
        "occlight",
        "light occlight() { vector up = vector \"world\" (0, 1, 0); solar(-up, 0) { Cl = 1 - occlusion(Ps, up, 64); } }\n");
    for (const Hider h : kAll) {
        Scene s(inWorld(kSeen + "LightSource \"occlight\" 1\nSurface \"matte\" \"Ka\" 0\n" + kFloor + wall(1)), withShaders(h));
        s.world->facts();
        Settings direct = withShaders(h);
        direct.indirect = false;
        Scene d(inWorld(kSeen + "LightSource \"occlight\" 1\nSurface \"matte\" \"Ka\" 0\n" + kFloor + wall(1)), direct);
        expectMean(d.estimate(kNear, 400), 1 - ofWall(.5, 1), .01, "hider " + std::to_string(int(h)));
    }
}

TEST(IndirectDiffuse, OfAWallThatShines) {
    for (const char* value :
         {"indirectdiffuse(P, up, 64)", "indirectdiffuse(\"\", P, up, 64)",
          "trace(P, up, \"distribution\", \"cosine\", \"samplecone\", PI / 2, \"samples\", 64, \"type\", \"diffuse\")"})
        for (const Hider h : kAll) // under path one of the rays goes on
            expectMean(of(shows("indwall", value), kFloor + wall(1), h, h == Hider::Path ? 8000 : 400), ofWall(.5, 1), .03,
                       value);
    EXPECT_NEAR(of(shows("indball", "indirectdiffuse(P, up, 4)"), kSmall + ball(2, "Color .5 .25 .125"), Hider::Path).mean(1),
                .25, 1e-5);
}

TEST(IndirectDiffuse, OfAMapAlone) {
    writeMap("indwhite.exr", 16, 8, Color(1));
    writeMap("indtop.exr", 256, 128, [](int, int y, int c) { return y < 64 ? float(c + 1) : 0.f; });
    const std::string& dir = shaderFolder();
    EXPECT_NEAR(of(shows("indwhite", "indirectdiffuse(\"" + dir + "/indwhite.exr\", up)"), kFloor, Hider::Hidden, 1).mean(), 1,
                1e-4);
    // Half a ball of light about +z: a plane that is turned away from it by a sees (1 + cos a) / 2 of it.
    for (const double a : {0., .6, 1.57, 2.5}) {
        const std::string n = "vector(" + std::to_string(std::sin(a)) + ", 0, " + std::to_string(std::cos(a)) + ")";
        const Moments m = of(shows("indtop", "indirectdiffuse(\"" + dir + "/indtop.exr\", " + n + ")"), kFloor, Hider::Hidden, 1);
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(m.mean(k), (k + 1) * (1 + std::cos(a)) / 2, .01 * (k + 1)) << a;
    }
    EXPECT_EQ(of(shows("indzero", "indirectdiffuse(\"" + dir + "/indwhite.exr\", vector(0))"), kFloor, Hider::Hidden, 1).mean(),
              0);
}

// Inside of a ball of radius 2 that shows .5, under a sky that would show .25, .5 and .75.
TEST(IndirectDiffuse, FallsOff) {
    writeMap("fallsky.exr", 16, 8, Color(.25f, .5f, .75f));
    struct Case {
        const char* pairs;
        double kept;
    };
    for (const Case& c :
         {Case{"\"falloff\", .7", std::exp(-.7 * 2)},
          Case{"\"falloff\", 3, \"falloffmode\", 1, \"maxdist\", 8", std::pow(.75, 3)}, Case{"\"falloff\", 0", 1}})
        for (const double opacity : {1., .5})
            for (const Hider h : kAll) {
                const std::string call = std::string("indirectdiffuse(P, up, 4, ") + c.pairs;
                const std::string shell = ball(2, opacity < 1 ? "Opacity .5 .5 .5 Color .5 .5 .5" : "Color .5 .5 .5");
                EXPECT_NEAR(of(shows("indfall", call + ")"), kSmall + shell, h, 16).mean(), .5 * opacity * c.kept, 2e-3)
                    << c.pairs;
                const std::string map =
                    ", \"environmentmap\", \"" + shaderFolder() + "/fallsky.exr\", \"environmentcolor\", ec, \"occlusion\", oc)";
                const Moments all = of(shows("indfallmap", call + map), kSmall + shell, h, 16);
                const double open = 1 - opacity * c.kept;
                for (int k = 0; k < 3; ++k)
                    EXPECT_NEAR(all.mean(k), .5 * opacity * c.kept + .25 * (k + 1) * open, 4e-3) << c.pairs << int(h);
                const Moments parts = of(shows("indfallparts", "ec + oc", call + map + ";"), kSmall + shell, h, 16);
                EXPECT_NEAR(parts.mean(), .25 * open + 1 - open, 4e-3) << c.pairs << int(h);
            }
}

// It is no parameter of trace(), as the compiler says: nothing comes of it.
TEST(IndirectDiffuse, AloneFallsOff) {
    for (const Hider h : kAll)
        EXPECT_NEAR(of(shows("tracefall", "trace(P, up, \"falloff\", .7)"), kSmall + ball(2, "Color .5 .5 .5"), h, 16).mean(), .5,
                    1e-5)
            << int(h);
}

TEST(Occlusion, SendsFewerRaysWhereTheyAgree) {
    const auto rays = [](const std::string& scene, const std::string& pairs, double want) {
        Scene s(inWorld(kSeen + shows("occadapt", "color occlusion(P, up, 64" + pairs + ")") + scene), withShaders(Hider::Path));
        Counters n;
        const CameraRay ray = kNear;
        const float got = s.trace({&ray, 1}, &n)[0].color.x;
        if (want >= 0) EXPECT_NEAR(got, want, 1e-6) << pairs;
        return n.shadow;
    };
    const std::string shell = kSmall + ball(2, "");
    EXPECT_EQ(rays(shell, "", 1), 64u);
    EXPECT_EQ(rays(shell, ", \"adaptive\", 0, \"minsamples\", 8", 1), 64u);
    EXPECT_EQ(rays(shell, ", \"adaptive\", 1", 1), 16u);
    EXPECT_EQ(rays(shell, ", \"adaptive\", 1, \"minsamples\", 8", 1), 8u);
    EXPECT_EQ(rays(shell, ", \"minsamples\", 8", 1), 8u);
    EXPECT_EQ(rays(kSmall, ", \"minsamples\", 8", 0), 8u);
    EXPECT_EQ(rays(kSmall + ball(2, "Opacity .5 .5 .5"), ", \"minsamples\", 8", .5), 8u);
    EXPECT_EQ(rays(shell, ", \"minsamples\", 1e9", 1), 64u);
    EXPECT_EQ(rays(shell, ", \"minsamples\", -1", 1), 64u);
    EXPECT_EQ(rays(kFloor + wall(1), ", \"minsamples\", 32", -1), 64u); // some meet the wall
    // Where the first disagree nothing is left out: the mean is right. Its other outputs, too.
    for (const Hider h : kAll)
        expectMean(of(shows("occadapt2", "color occlusion(P, up, 64, \"minsamples\", 48)"), kFloor + wall(1), h), ofWall(.5, 1),
                   .01, "adaptive");
    EXPECT_NEAR(of(shows("occadapt3", "color(ed . up, oc, 0)",
                         "oc = occlusion(P, up, 1024, \"minsamples\", 512, \"environmentdir\", ed);"),
                   kSmall, Hider::Path, 4)
                    .mean(),
                1, .01);
}

TEST(Occlusion, EveryParameter) {
    // Inside of a ball of radius 2 that shows .5: all rays that are let go so far are blocked there.
    writeShader("occparams", R"(surface occparams() {
    vector up = vector "world" (0, 1, 0), d1 = 0, d2 = 0;
    color e1 = 0, e2 = 0;
    float o1 = -1, o2 = -1;
    float a = occlusion("raytrace", P, up, 4, "label", "l", "subset", "", "bias", -1, "hitmode", "shader", "hitsides", "both",
                        "maxdist", 9, "samplecone", 1, "samples", 3, "type", "transmission", "weight", color(1), "minsamples", 1,
                        "samplebase", 0.5, "excludesubset", "none", "raytype", "transmission", "raylabel", "m", "maxhitdist", 9,
                        "axis", up, "adaptive", 1, "distribution", "uniform", "falloffmode", 0, "falloff", 0, "maxvariation", 0,
                        "maxerror", 0.5, "maxpixeldist", 20, "brightnesswarp", 1, "environmentmap", "",
                        "environmentspace", "world", "environmentcolor", e1, "environmentdir", d1, "occlusion", o1,
                        "filename", "", "filenames", {"", ""}, "maxsolidangle", 0.1, "clamp", 1, "sortbleeding", 0,
                        "coordsystem", "world", "pointbased", 0) + occlusion(P, up, "coneangle", 0.5) + occlusion(P, up, 2);
    color b = indirectdiffuse("raytrace", P, up, 4, "label", "l", "subset", "", "bias", -1, "hitmode", "shader",
                              "hitsides", "both", "maxdist", 9, "samplecone", 1, "samples", 3, "type", "diffuse",
                              "weight", color(1), "minsamples", 1, "samplebase", 0.5, "excludesubset", "none",
                              "raytype", "diffuse", "raylabel", "m", "maxhitdist", 9, "axis", up, "adaptive", 1,
                              "distribution", "uniform", "falloffmode", 0, "falloff", 0, "maxvariation", 0, "maxerror", 0.5,
                              "maxpixeldist", 20, "brightnesswarp", 1, "environmentmap", "", "environmentspace", "world",
                              "environmentcolor", e2, "environmentdir", d2, "occlusion", o2, "filename", "",
                              "filenames", {"", ""}, "maxsolidangle", 0.1, "clamp", 1, "sortbleeding", 0, "coordsystem", "world",
                              "pointbased", 0) + indirectdiffuse(P, up, "coneangle", 0.5) + indirectdiffuse(P, up, 2)
        + indirectdiffuse("", up);
    color c = occlusion(P, up, 0.5, d1);
    Ci = color(a + o1 + comp(c, 0), comp(b, 0), o2 + length(d1) + length(d2) + comp(e1, 0) + comp(e2, 0)); Oi = 1;
})");
    for (const Hider h : kAll) {
        const Moments m = of("Surface \"occparams\"\n", kSmall + ball(2, "Color .5 .5 .5"), h, 4);
        EXPECT_NEAR(m.mean(0), 5, 1e-5) << int(h);
        EXPECT_NEAR(m.mean(1), 1.5, 1e-5);
        EXPECT_NEAR(m.mean(2), 1, 1e-5);
    }
}

} // namespace

} // namespace occlusion_test
