// What estimators count, once and in full: light that a shader asks for in two ways, rays that must tell what is in their way,
// lights that take light away, surfaces that give back more than they receive.
#include "integrator/floorscene.h"

namespace estimators_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

constexpr Hider kTracers[] = {Hider::Raytrace, Hider::Path};

/// A surface of the floor: `up` is its normal; `value` a color.
std::string shows(const std::string& value, const std::string& before = "") {
    static int number = 0;
    const std::string name = "estimate" + std::to_string(number++);
    writeShader(name, "surface " + name +
                          "() {\n    vector up = vector \"world\" (0, 1, 0), aside = vector \"world\" (1, 0, 0);\n" +
                          "    normal n = normal \"world\" (0, 1, 0);\n    color sum = 0, t = 0;\n" + before +
                          "\n    Ci = " + value + ";\n    Oi = 1;\n}\n");
    return "Surface \"" + name + "\"\n";
}
/// A black disk of that radius and radiance, facing down.
std::string disk(double height, double radius, double radiance) {
    writeShader("steady", "light steady(float radiance = 1) { illuminate(P, N, PI / 2) Cl = radiance; }\n");
    return "AttributeBegin\nAttribute \"visibility\" \"trace\" 1\nAttribute \"light\" \"string units\" \"radiance\"\n"
           "AreaLightSource \"steady\" 7 \"radiance\" " +
           std::to_string(radiance) + "\nSurface \"constant\"\nColor 0 0 0\nTranslate 0 " + std::to_string(height) +
           " 0\nRotate 90 1 0 0\nDisk 0 " + std::to_string(radius) + " 360\nAttributeEnd\nIlluminate 7 1\n";
}
/// The part of the hemisphere that such a disk fills, by the cosine.
double ofDisk(double height, double radius) { return radius * radius / (radius * radius + height * height); }
/// A shell about everything that shows `colour`, and is no light.
std::string shell(double colour, double radius = 20) {
    const std::string r = std::to_string(radius), c = " " + std::to_string(colour);
    return "AttributeBegin\nAttribute \"visibility\" \"trace\" 1 \"transmission\" 1\nSurface \"constant\"\nColor" + c + c + c +
           "\nSphere " + r + " -" + r + " " + r + " 360\nAttributeEnd\n";
}
const CameraRay kNear = rayTo({.2f, .3f, -.1f}, {0, 0, 0});

Moments of(const std::string& surface, const std::string& others, Settings s, int n) {
    return Scene(inWorld(others + surface + kFloor), std::move(s)).estimate(kNear, n);
}
Settings traced(Hider h, bool suspend = false) {
    Settings s = withShaders(h);
    s.suspend = suspend;
    return s;
}

const std::string kLoop = "illuminance (P, n, PI / 2) sum += Cl * (normalize(L) . n);";

} // namespace

// Half of direct and half of indirect light: a lamp counts as direct, a wall as indirect light, whatever finds them.
TEST(IndirectApart, ALampInsideOfAShell) {
    const double lamp = ofDisk(2, .7), wall = .8;
    const std::string others = disk(2, .7, 5) + shell(wall);
    const std::string apart[] = {shows(".5 * (diffuse(n) + indirectdiffuse(P, up, 16))"),
                                 shows(".5 * (sum + indirectdiffuse(P, up, 16))", kLoop)};
    for (const std::string& surface : apart)
        for (const bool suspend : {false, true})
            for (const Hider h : kTracers)
                expectMean(of(surface, others, traced(h, suspend), samples(h == Hider::Path ? 12000 : 1500)),
                           .5 * (5 * lamp + wall * (1 - lamp)), .02, surface + std::to_string(int(h)));
}
// The same under a sky, which light samples do not know: it is direct light.
TEST(IndirectApart, ASky) {
    const std::string sky = "LightSource \"envlight\" 1 \"intensity\" 1\n";
    for (const bool suspend : {false, true}) {
        const Settings s = traced(Hider::Path, suspend);
        expectMean(of(shows(".5 * (diffuse(n) + indirectdiffuse(P, up, 16))"), sky, s, samples(5000)), .5, .02, "diffuse");
        expectMean(of(shows(".5 * (sum + indirectdiffuse(P, up, 16))", kLoop), sky, s, samples(5000)), .5, .02, "loop");
        // Alone it brings all, as highlights of the same surface do not ask for what it finds.
        expectMean(of(shows(".5 * indirectdiffuse(P, up, 16)"), sky, s, samples(5000)), .5, .02, "alone");
        expectMean(of(shows(".5 * indirectdiffuse(P, up, 16) + 0 * specular(n, up, .1)"), sky, s, samples(2000)), .5, .02,
                   "together with a highlight");
    }
}
// A parameter that switches indirectdiffuse() off leaves diffuse() all light.
TEST(IndirectApart, SwitchedOff) {
    writeShader("switched", "surface switched(float Ki = 0) { normal n = faceforward(normalize(N), I); Ci = .5 * diffuse(n); if "
                            "(Ki > 0) Ci += Ki * indirectdiffuse(P, vector(n), 16); Oi = 1; }\n");
    const Settings s = traced(Hider::Path);
    expectMean(of("Surface \"switched\"\n", shell(.8), s, samples(2000)), .4, .02, "off");
    expectMean(of("Surface \"switched\" \"Ki\" .25\n", shell(.8), s, samples(8000)), .2, .02, "on");
}

// trace() that samples area lights sees them where no light is sampled: along a mirrored ray, from another point than P.
TEST(TraceSeesLights, WhereNoneAreSampled) {
    const std::string lamp = disk(2, .7, 5), asks = ", \"samplearealights\", 1";
    const std::string mirror = shows("trace(P, up" + asks + ")"), ownOrigin = shows("trace(P + .5 * up, up" + asks + ")"),
                      cosine = shows("trace(P + up, up, \"distribution\", \"cosine\", \"samplecone\", PI / 2" + asks + ")"),
                      past = shows("trace(P, aside" + asks + ")"), silent = shows("trace(P, up)");
    for (const Hider h : {Hider::Hidden, Hider::Raytrace, Hider::Path})
        for (const bool suspend : {false, true}) {
            const Settings s = traced(h, suspend);
            expectMean(of(mirror, lamp, s, 16), 5, 1e-6, "mirror");
            expectMean(of(ownOrigin, lamp, s, 16), 5, 1e-6, "mirror, elsewhere");
            expectMean(of(cosine, lamp, s, samples(10000)), 5 * ofDisk(1, .7), .02, "cosine, elsewhere");
            EXPECT_EQ(of(past, lamp, s, 4).mean(), 0);
            if (h != Hider::Path) EXPECT_EQ(of(silent, lamp, s, 4).mean(), 0);
        }
}

// A surface that would give back twice what it receives gives all of the light of lights, and of what surfaces send it so much
// that the sum is no more than it receives. The disks fill 1, 80 and 99 % of the hemisphere.
TEST(EnergyRule, LightsInFull) {
    const std::string surface = shows("2 * diffuse(n)");
    for (const double radius : {.05, 1., 5.})
        for (int mode = 0; mode < 3; ++mode)
            for (const bool suspend : {false, true}) {
                Settings s = traced(Hider::Path, suspend);
                s.bsdfOnly = mode == 1;
                s.lightOnly = mode == 2;
                const int n = samples(mode == 1 && radius < 1 ? 200000 : 10000);
                expectMean(of(surface, disk(.5, radius, 1), s, n), 2 * ofDisk(.5, radius), .03,
                           "radius " + std::to_string(radius) + " mode " + std::to_string(mode));
            }
    Settings s = traced(Hider::Path);
    const std::string sky = "LightSource \"envlight\" 1 \"intensity\" 1\n";
    expectMean(of(surface, sky, s, 400), 2, 1e-5, "sky");
    s.maxDepth = 0; // where the depth ends a path, too, and with an indirectdiffuse() that then brings nothing
    expectMean(of(surface, sky, s, 400), 2, 1e-5, "sky at the last vertex");
    expectMean(of(shows(".5 * (diffuse(n) + indirectdiffuse(P, up, 16))"), sky, s, 400), .5, 1e-5, "apart at the last vertex");
    s = traced(Hider::Path);
    expectMean(of(surface, shell(.5), s, 400), .5, 1e-5, "shell");
    expectMean(of(surface, disk(2, .7, 5) + shell(.5), s, samples(10000)), 10 * ofDisk(2, .7) + .5 * (1 - ofDisk(2, .7)), .01,
               "lamp in a shell");
}
// A pane that all light passes and that shines besides: its highlight is a mirror of the sky, as dark as it makes what it lights.
TEST(EnergyRule, AHighlightOnWhatIsClear) {
    writeShader("pane", "surface pane() { Oi = 0; Ci = .5 * diffuse(normal \"world\" (0, 1, 0)); }\n");
    const std::string below =
        "AttributeBegin\nSurface \"constant\"\nColor .25 .25 .25\nTranslate 0 -1 0\n" + std::string(kFloor) + "AttributeEnd\n";
    expectMean(of("Surface \"pane\"\n", below + "LightSource \"envlight\" 1 \"intensity\" 1\n", traced(Hider::Path), 400), .75,
               1e-5, "pane");
}

// In a closed shell everything is in the way, outside of it nothing, also of draws that bring no light.
TEST(TraceTransmission, OfDrawsThatBringNothing) {
    const std::string lobes[] = {"\"cook-torrance\", \"roughness\", .7", "\"ashikhmin-shirley\", \"roughness\", .7",
                                 "\"blinn\", \"roughness\", .7", "\"ward\", \"roughness\", .6",
                                 "\"cosine\", \"samplecone\", PI / 2, \"horizon\", aside"};
    for (const std::string& lobe : lobes)
        for (const Hider h : kTracers) {
            const std::string wo = lobe[1] == 'c' && lobe[3] == 's' ? "" : ", \"wo\", normalize(up + 2 * aside)";
            const std::string s = shows("t", "sum = trace(P, up, \"distribution\", " + lobe + wo + ", \"transmission\", t);");
            EXPECT_NEAR(of(s, shell(.5), traced(h), 400).mean(), 0, 1e-6) << lobe;
            EXPECT_EQ(of(s, "", traced(h), 400).mean(), 1) << lobe;
        }
    // Glass sends rays to both sides: the floor is not in its own way.
    const std::string glass =
        shows("t", "sum = trace(P, up, \"distribution\", \"glass-ggx\", \"roughness\", .5, \"wo\", normalize(up + 2 * aside), "
                   "\"transmission\", t);");
    EXPECT_NEAR(of(glass, shell(.5), traced(Hider::Raytrace), 400).mean(), 0, 1e-6);
    // Half of the sky behind a wall, and of the directions above a tilted plane a part that is known: of those between the wall's
    // foot and straight up, all are blocked.
    const std::string wall = "AttributeBegin\nAttribute \"visibility\" \"trace\" 1\nSurface \"constant\"\nPolygon \"P\" [-.001 0 "
                             "-9000  -.001 9000 -9000  -.001 9000 9000  -.001 0 9000]\nAttributeEnd\n";
    const std::string half = "\"distribution\", \"cosine\", \"samplecone\", PI / 2, \"samples\", 16, \"transmission\", t";
    for (const auto& [horizon, want] : {std::pair<std::string, double>{"", .5}, {", \"horizon\", aside", 1}})
        EXPECT_NEAR(of(shows("t", "sum = trace(P, up, " + half + horizon + ");"), wall, traced(Hider::Raytrace), 400).mean(),
                    want, .01);
    EXPECT_NEAR(
        of(shows("t", "sum = trace(P, up, " + half + ", \"horizon\", -aside);"), wall, traced(Hider::Raytrace), 400).mean(), 0,
        .01);
}

// "axis" of indirectdiffuse() as of occlusion(): the mean over the directions on its side.
TEST(IndirectDiffuseAxis, IsTheMeanOfItsSide) {
    const std::string wall = "AttributeBegin\nAttribute \"visibility\" \"trace\" 1\nSurface \"constant\"\nColor 1 1 1\nPolygon "
                             "\"P\" [-.0004 0 -9000  -.0004 0 9000  -.0004 9000 9000  -.0004 9000 -9000]\nAttributeEnd\n";
    for (const Hider h : kTracers) {
        const Settings s = traced(h);
        EXPECT_NEAR(of(shows("indirectdiffuse(P, up, 64, \"axis\", -aside)"), wall, s, 400).mean(), 1, 2e-3);
        EXPECT_NEAR(of(shows("indirectdiffuse(P, up, 64, \"axis\", aside)"), wall, s, 400).mean(), 0, 2e-3);
        EXPECT_NEAR(of(shows("indirectdiffuse(P, up, 64, \"axis\", up)"), wall, s, samples(4000)).mean(), .5, .03);
        EXPECT_EQ(of(shows("indirectdiffuse(P, up, 4, \"axis\", -up)"), wall, s, 4).mean(), 0); // there are none
        expectMean(of(shows("indirectdiffuse(P, up, 16, \"axis\", up + aside)"), shell(.5), s, 400), .5, 1e-5, "shell");
    }
}
TEST(IndirectDiffuseAxis, InALight) {
    writeShader("besideaxis", "light besideaxis() { vector up = vector \"world\" (0, 1, 0), aside = vector \"world\" (1, 0, 0); "
                              "solar(-up, 0) { Cl = indirectdiffuse(Ps, up, 16, \"axis\", aside); } }\n");
    Settings s = traced(Hider::Raytrace);
    expectMean(of("Surface \"matte\" \"Ka\" 0\n", "LightSource \"besideaxis\" 1\n" + shell(.5), s, 16), .5, 1e-4, "light");
}

// Lights that take light away: an old way to keep places dark.
TEST(NegativeLights, TakeLightAway) {
    const std::string sun = "LightSource \"distantlight\" ", down = " \"from\" [0 1 0] \"to\" [0 0 0]\n";
    const std::string two = sun + "1 \"intensity\" 1" + down + sun + "2 \"intensity\" -.4" + down;
    const std::string lamps =
        disk(2, .7, 5) + "LightSource \"distantlight\" 8 \"intensity\" -.25 \"from\" [.8 .6 0] \"to\" [0 0 0]\n";
    for (const Hider h : {Hider::Hidden, Hider::Raytrace, Hider::Path})
        for (const std::string& surface : {shows("diffuse(n)"), shows("sum", kLoop)})
            for (const bool suspend : {false, true}) {
                expectMean(of(surface, two, traced(h, suspend), 16), .6, 1e-5, "suns");
                if (h == Hider::Path)
                    expectMean(of(surface, lamps, traced(h, suspend), samples(10000)), 5 * ofDisk(2, .7) - .25 * .6, .02, "lamp");
            }
    // As an emitter, by light samples and by rays that meet it; and one of many.
    for (int mode = 0; mode < 3; ++mode) {
        Settings s = traced(Hider::Path);
        s.bsdfOnly = mode == 1;
        s.lightOnly = mode == 2;
        expectMean(of(shows("diffuse(n)"), disk(2, .7, -5), s, samples(20000)), -5 * ofDisk(2, .7), .03,
                   "emitter, mode " + std::to_string(mode));
    }
    std::string many;
    for (int i = 0; i < 20; ++i) many += sun + std::to_string(i + 1) + " \"intensity\" " + (i % 4 ? ".2" : "-.4") + down;
    expectMean(of(shows("diffuse(n)"), many, traced(Hider::Path), samples(4000)), 15 * .2 - 5 * .4, .02, "many");
}

// n samples of a light and n rays: of a lamp that a half-plane hides to one half, in the middle of its shadow's edge, n
// samples have an n-th of the variance at most, since each sees the lamp or does not.
TEST(LightSamples, AsManyAsRays) {
    const std::string half =
        "AttributeBegin\nAttribute \"visibility\" \"trace\" 1 \"transmission\" 1\nSurface \"constant\"\nColor 0 0 "
        "0\nPolygon \"P\" [0 1 -90  0 1 90  90 1 90  90 1 -90]\nAttributeEnd\n";
    for (const Hider h : kTracers) {
        double variance[2];
        for (const int n : {1, 40}) {
            const std::string floor =
                shows("trace(P, up, \"distribution\", \"cosine\", \"samplecone\", PI / 2, \"samplearealights\", 1, "
                      "\"samples\", " +
                      std::to_string(n) + ")");
            const Moments m = of(floor, disk(2, .7, 5) + half, traced(h, true), samples(n == 1 ? 6000 : 1000));
            expectMean(m, .5 * 5 * ofDisk(2, .7), .02, "samples " + std::to_string(n));
            variance[n > 1] = m.se() * m.se() * m.n;
        }
        EXPECT_LT(variance[1], variance[0] / 30) << int(h);
    }
}

} // namespace estimators_test
