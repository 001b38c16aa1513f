// gather: its rays, what they tell, its turns, and closed forms that it shares with trace(), diffuse() and indirectdiffuse().
#include "integrator/gatherscene.h"
#include "integrator/maps.h"
#include <cmath>

namespace gather_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;
using namespace alpenglow::integrator::gatherscene;

namespace {

std::string ball(double r, const std::string& what) {
    const std::string s = std::to_string(r);
    return "AttributeBegin Surface \"constant\" " + what + " Sphere " + s + " -" + s + " " + s + " 360 AttributeEnd\n";
}
std::string wall(double height) {
    const std::string h = std::to_string(height);
    return "AttributeBegin Surface \"constant\" Color 1 1 1 Polygon \"P\" [.5 0 -9000  .5 0 9000  .5 " + h + " 9000  .5 " + h +
           " -9000] AttributeEnd\n";
}
double ofWall(double x, double h) { return (1 - x / std::sqrt(x * x + h * h)) / 2; }

Moments of(const std::string& surface, const std::string& scene, Hider h = Hider::Path, int n = 1) {
    Scene s(inWorld(kSeen + surface + scene), withShaders(h));
    return s.estimate(kNear, n);
}

TEST(Gather, CountsHitsAndMisses) {
    const std::string loop =
        "gather(\"illuminance\", P, up, PI / 2, 256, \"distribution\", \"cosine\") hits += 1; else misses += 1;";
    for (const Hider h : kAll) {
        const Moments m = of(runs("gcount", loop, "color(hits / 256, misses / 256, hits + misses)"), kFloor + wall(1), h, 100);
        EXPECT_NEAR(m.mean(0), ofWall(.5, 1), .005) << int(h);
        EXPECT_NEAR(m.mean(1), 1 - ofWall(.5, 1), .005);
        EXPECT_EQ(m.mean(2), 256);
    }
    // Evenly over the solid angle, the default: a ball about all, and the half of it that a plane leaves.
    EXPECT_EQ(of(runs("gall", "gather(\"\", P, up, PI / 2, 100) hits += 1;", "color(hits)"), kSmall + ball(2, "")).mean(), 100);
    EXPECT_NEAR(of(runs("gmean",
                        "gather(\"\", P, up, PI / 2, 4096, \"ray:direction\", d) { } else sum += color(d . up, abs(d . aside), "
                        "length(d)) / 4096;",
                        "sum"),
                   kSmall)
                    .mean(0),
                .5, .01);
}

TEST(Gather, BringsLight) {
    for (const char* distribution : {"cosine", "uniform"})
        for (const Hider h : kAll) {
            const std::string loop =
                std::string(
                    "gather(\"illuminance\", P, up, PI / 2, 128, \"surface:Ci\", c, \"ray:direction\", d, \"distribution\", \"") +
                distribution + "\") sum += c * " + (distribution[0] == 'c' ? "1" : "2 * (d . up)") + " / 128;";
            expectMean(of(runs("glight", loop, "sum"), kFloor + wall(1), h, 200), ofWall(.5, 1), .02, distribution);
        }
}

TEST(Gather, AgreesWithOtherWaysToSumUpLight) {
    // Under a ball that shows .5 all of them give .5: gather, trace, indirectdiffuse; diffuse under path adds them up, too.
    for (const char* value : {"sum", "trace(P, up, \"distribution\", \"cosine\", \"samplecone\", PI / 2, \"samples\", 16)",
                              "indirectdiffuse(P, up, 16)", "diffuse(normal up)"}) {
        const std::string loop =
            value == std::string("sum")
                ? "gather(\"\", P, up, PI / 2, 16, \"surface:Ci\", c, \"distribution\", \"cosine\") sum += c / 16;"
                : "";
        EXPECT_NEAR(of(runs("gagree", loop, value), kSmall + ball(2, "Color .5 .25 .125"), Hider::Path, 4).mean(), .5, 1e-4)
            << value;
    }
}

TEST(Gather, TellsOfRaysAndPrimitives) {
    const std::string in = "Attribute \"identifier\" \"string name\" \"shell\" Color .25 .5 .75 ";
    const std::string scene = kSmall + ball(2, in);
    EXPECT_NEAR(of(runs("glength", "gather(\"\", P, up, 1, 8, \"ray:length\", f) sum += f / 8;", "sum"), scene).mean(), 2, .02);
    EXPECT_EQ(
        of(runs("gfar", "gather(\"\", P, up, 1, 8, \"ray:length\", f, \"maxdist\", 1.5) { } else sum += step(1e30, f);", "sum"),
           scene)
            .mean(),
        8);
    EXPECT_NEAR(of(runs("gplace",
                        "gather(\"\", P, up, 1, 8, \"ray:origin\", o, \"ray:direction\", d, \"ray:length\", f, \"primitive:P\", "
                        "c) sum += length(point(c) - (o + f * d));",
                        "sum"),
                   scene)
                    .mean(),
                0, 1e-4);
    const Moments m =
        of(runs("gcolor",
                "normal n = 0; gather(\"\", P, up, 0, 3, \"primitive:Cs\", c, \"primitive:N\", n, \"attribute:identifier:name\", "
                "text, \"primitive:none\", f) sum += c * ((text == \"shell\") ? 1 : 0) + f;",
                "sum"),
           scene);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(m.mean(k), .75 * (k + 1), 1e-5);
    // What is there for no ray stays as it was; a miss leaves all but the ray.
    EXPECT_EQ(of(runs("gstays",
                      "f = 7; c = 3; gather(\"\", P, up, .1, 2, \"primitive:none\", f, \"surface:Ci\", c, \"maxdist\", 1) f = 0;",
                      "color(f) + c"),
                 scene)
                  .mean(),
              10);
}

// What a displacement writes, and the variables of the surface that are no parameters of its shader.
TEST(Gather, AsksDisplacementsAndVariablesAtTheHit) {
    writeShader("gmoves", "displacement gmoves(float given = 2; output float own = 0; output varying color list[2] = {0, 0}) { "
                          "own = 3 * given; list[1] = color(u, 1, 3); P += 0; }\n");
    writeShader("gplain", "surface gplain() { Ci = Cs; Oi = Os; }\n");
    const std::string scene = kSmall + std::string("AttributeBegin Surface \"gplain\" ShadingRate 90000 Displacement \"gmoves\" "
                                                   "\"given\" 4 Sphere 2 -2 2 360 AttributeEnd\n");
    for (const Hider h : kAll) {
        Moments m = of(runs("gdisplaced",
                            "color l[2] = {0, 0}; gather(\"\", P, up, .3, 4, \"displacement:given\", f, \"displacement:own\", g, "
                            "\"displacement:list\", l, \"primitive:u\", hits) sum += color(f, g, comp(l[1], 2) + abs(comp(l[1], "
                            "0) - hits)) / 4;",
                            "sum"),
                       scene, h);
        EXPECT_NEAR(m.mean(0), 4, 1e-4) << int(h);
        EXPECT_NEAR(m.mean(1), 12, 1e-4) << int(h);
        EXPECT_NEAR(m.mean(2), 3, 1e-4) << int(h);
        m = of(runs("gvariables",
                    "vector i = 0, n = 0; float u0 = 7, v0 = 7; point p = 0; gather(\"\", P, up, .3, 4, \"surface:I\", i, "
                    "\"surface:Ng\", n, \"surface:P\", p, \"surface:u\", f, \"primitive:u\", u0, \"surface:t\", g, "
                    "\"primitive:t\", v0)"
                    " sum += color(length(p - P - i), abs(normalize(n) . normalize(p)), abs(f - u0) + abs(g - v0)) / 4;",
                    "sum"),
               scene, h);
        EXPECT_NEAR(m.mean(0), 0, 1e-3) << int(h);
        EXPECT_NEAR(m.mean(1), 1, 1e-3) << int(h);
        EXPECT_NEAR(m.mean(2), 0, 1e-5) << int(h);
    }
}

TEST(Gather, AsksShadersAtTheHit) {
    writeShader("gtells", "surface gtells(float given = 2; output varying float own = 0; output varying color list[2] = {0, 0};) "
                          "{ own = 5 * v; list[1] = color(u, v, 3); Ci = Cs; Oi = Os; }\n");
    const std::string scene =
        kSmall +
        std::string(
            "AttributeBegin Surface \"gtells\" \"given\" 4 Color 1 .5 .25 Opacity .5 .5 .5 Sphere 2 -2 2 360 AttributeEnd\n");
    for (const Hider h : kAll) {
        const Moments m = of(runs("gask",
                                  "float w = 0; color l[2] = {0, 0}; gather(\"\", P, up, .3, 4, \"surface:given\", f, "
                                  "\"surface:own\", g, \"primitive:v\", w, \"surface:list\", l, \"surface:Oi\", c) sum += "
                                  "color(f, g - 5 * w, comp(l[1], 2) + 10 * comp(c, 0)) / 4;",
                                  "sum"),
                             scene, h);
        EXPECT_NEAR(m.mean(0), 4, 1e-4) << int(h);
        EXPECT_NEAR(m.mean(1), 0, 1e-4);
        EXPECT_NEAR(m.mean(2), 3 + 5, 1e-3);
    }
}

TEST(Gather, RunsShadersOnlyWhereAsked) {
    writeShader("gprints", "surface gprints() { printf(\"ran\\n\"); Ci = 1; Oi = 1; }\n");
    const std::string scene = kSmall + std::string("AttributeBegin Surface \"gprints\" Sphere 2 -2 2 360 AttributeEnd\n");
    for (const char* pair : {"\"ray:length\", f", "\"primitive:Cs\", c", "\"surface:Ci\", c"}) {
        Scene s(inWorld(kSeen + runs("gshade", std::string("gather(\"\", P, up, 1, 8, ") + pair + ") hits += 1;", "color(hits)") +
                        scene),
                withShaders(Hider::Path));
        Counters n;
        const CameraRay ray = kNear;
        EXPECT_EQ(s.trace({&ray, 1}, &n)[0].color.x, 8);
        EXPECT_EQ(n.points, pair[1] == 's' ? 9u : 1u) << pair;
    }
}

// One bounce on few of 8 rays are followed under path, but what the hits tell, and how many there are, is as it is.
TEST(Gather, TellsAllOfHitsWhoseLightIsNotFollowed) {
    writeShader("gsends", "surface gsends() { Ci = trace(P, vector \"world\" (0, 1, 0)); Oi = 1; }\n");
    writeShader("gdeeper", "surface gdeeper(float given = 4; output varying float own = 0) { color c = 0, o = 0, sum = 0; float "
                           "f = 0, g = 0, hits = 0; own = 5 * v;"
                           "gather(\"\", P, -P, .5, 8, \"surface:given\", f, \"surface:own\", g, \"primitive:v\", c, "
                           "\"surface:Oi\", o) { hits += f / 8; sum += o / 8; }"
                           "Ci = color(hits, comp(sum, 0), 0); Oi = 1; }\n");
    const std::string shell = "AttributeBegin Surface \"gdeeper\" Sphere 2 -2 2 360 AttributeEnd\n";
    Scene told(inWorld(kSeen + "Surface \"gsends\"\n" + kSmall + shell),
               withShaders(Hider::Path)); // elsewhere 8 to the depth are followed
    const Moments n = told.estimate(kNear, 4);
    EXPECT_NEAR(n.mean(0), 4, 1e-4);
    EXPECT_NEAR(n.mean(1), 1, 1e-5);
    EXPECT_LT(n.se(0), 1e-5);
    // Light is followed by chance, and right in the mean.
    writeShader("glit", "surface glit() { color c = 0, sum = 0; float lit = .25; rayinfo(\"depth\", lit); gather(\"\", P, -P, "
                        ".5, 8, \"surface:Ci\", c) sum += c / 8; Ci = (lit < 2) ? sum : color(.25); Oi = 1; }\n");
    Scene s(inWorld(kSeen + "Surface \"gsends\"\n" + kSmall + "AttributeBegin Surface \"glit\" Sphere 2 -2 2 360 AttributeEnd\n"),
            withShaders(Hider::Path));
    expectMean(s.estimate(kNear, 4000), .25, .02, "light behind the second hit");
}

// Outputs of hits whose shaders gather too: the rays of a point grow as their number does, not as its square, and what the
// outputs tell is right in the mean. Inside a ball each ray meets it; of those about an axis, one half goes to one side of it.
TEST(Gather, GathersForOutputsStayLinear) {
    writeShader("gsends", "surface gsends() { Ci = trace(P, vector \"world\" (0, 1, 0)); Oi = 1; }\n");
    double rays[2];
    for (const int n : {16, 64}) {
        const std::string name = "gtelling" + std::to_string(n), count = std::to_string(n);
        writeShader(
            name,
            "surface " + name +
                "(output varying float bright = 0) { float f = 0, sum = 0, hits = 0; uniform float depth = 0; rayinfo(\"depth\", "
                "depth);"
                " color c = 0; vector d = 0, aside = P ^ vector(.3, .5, .8);\n"
                "gather(\"\", P, -P, PI / 2, " +
                count +
                ", \"ray:direction\", d, \"surface:bright\", f) { hits += 1; sum += (depth == 1) ? f : 2 * step(0, d . aside); }"
                "bright = sum / " +
                count + "; Ci = color(bright, hits / " + count + ", 0); Oi = 1; }\n");
        Scene s(inWorld(kSeen + "Surface \"gsends\"\n" + kSmall + "AttributeBegin Surface \"" + name +
                        "\" Sphere 2 -2 2 360 AttributeEnd\n"),
                withShaders(Hider::Path));
        Counters c;
        const Moments m = s.estimate(kNear, 1000, &c);
        expectMean(m, 1, .03, count);
        EXPECT_EQ(m.mean(1), 1);
        rays[n == 64] = double(c.diffuse + c.specular) / double(c.camera);
        EXPECT_LT(rays[n == 64], 12. * n);
    }
    EXPECT_LT(rays[1], 8 * rays[0]); // the square would be 16
}

// Kernels that wait ask for several rays at each vertex: a wall that shines .3 and gives back .4 of all about it shows .3 / (1 -
// .4). The tree of rays ends by chance. Behind the camera's hit, where all n go on, three go on in the mean at two more vertices,
// or all where they are fewer; from there on each vertex has s < 1 followers, so 1 / (1 - s) come of each: s is .8 for two and
// three rays and .7 for more. A loop does not say how many it will ask for; what its first rays meet learns that again.
TEST(Gather, RaysOfWaitingKernelsEnd) {
    const std::string loop =
        "float k; for (k = 0; k < N; k += 1) { c = trace(P, direct(k)); sum += (comp(c, 0) >= 0 ? c : color 0) / N; }";
    const std::string gathers = "gather(\"\", P, -P, PI / 2, N, \"surface:Ci\", c, \"distribution\", \"cosine\") sum += c / N;";
    const std::string several = "c = trace(P, -P, \"distribution\", \"cosine\", \"samplecone\", PI / 2, \"samples\", N); sum = "
                                "comp(c, 0) >= 0 ? c : color 0;";
    for (const auto& [name, body] : {std::pair<std::string, std::string>{"gends", gathers}, {"tends", several}, {"lends", loop}})
        for (const int n : {1, 2, 3, 8}) {
            if (name == "lends" && n == 8 && !nightly()) continue; // as many points as all the others together
            const std::string count = std::to_string(n), called = name + count;
            std::string text = body;
            for (size_t at; (at = text.find('N')) != std::string::npos;) text.replace(at, 1, count);
            writeShader(called, "vector direct(float k) { return -P + .4 * vector(sin(k), cos(k), sin(2 * k)); }\n"
                                "surface " +
                                    called + "() { color c = 0, sum = 0; " + text + " Ci = .3 + .4 * sum; Oi = 1; }\n");
            Scene s(inWorld(kSeen + "Surface \"" + called + "\" Sphere 2 -2 2 360\n"), withShaders(Hider::Path));
            Counters counters;
            const Moments m = s.estimate(rayTo({0, 0, 0}, {.7f, .5f, .3f}), 400, &counters);
            expectMean(m, .5, .02, called);
            const double at = std::min(n, 3), chances = n < 2 ? .5 : n < 4 ? .8 : .7;
            const double ends = 1 + n * (1 + at + at * at / (1 - chances)); // where all is known
            const double points = double(counters.points) / double(counters.camera);
            // Found: within 3 % of it; 173 for three calls in a loop and 1129 for eight.
            EXPECT_LT(points, (name == "lends" && n > 2 ? n : 1.2) * ends) << called;
        }
}

// Rays of one statement are spread among each other: the part that a wall takes is met far better than by as many drawn freely.
TEST(Gather, SpreadsItsRays) {
    const double p = ofWall(.5, 1);
    const Moments m =
        of(runs("gspread", "gather(\"\", P, up, PI / 2, 64, \"distribution\", \"cosine\") hits += 1 / 64;", "color(hits)"),
           kFloor + wall(1), Hider::Raytrace, 1000);
    expectMean(m, p, .01, "wall");
    EXPECT_LT(m.se() * m.se() * m.n, p * (1 - p) / 64 / 4);
}

TEST(Gather, Jumps) {
    const std::string scene = kSmall + ball(2, "");
    EXPECT_EQ(
        of(runs("gbreak", "gather(\"\", P, up, 1, 200) { hits += 1; if (hits == 70) break; }", "color(hits)"), scene).mean(), 70);
    EXPECT_EQ(
        of(runs("gcontinue", "gather(\"\", P, up, 1, 130) { hits += 1; if (mod(hits, 2) == 0) continue; f += 1; }", "color(f)"),
           scene)
            .mean(),
        65);
    EXPECT_EQ(
        of(runs("gelse", "gather(\"\", P, up, 1, 9, \"maxdist\", 1) hits += 100; else { misses += 1; if (misses == 4) break; }",
                "color(misses + hits)"),
           scene)
            .mean(),
        4);
    EXPECT_EQ(of(runs("greturn", "sum = count(P, up);", "sum",
                      "float count(point p; vector n) { float k = 0; gather(\"\", p, n, 1, 90) { k += 1; if (k == 66) return k; "
                      "} return -1; }\n"),
                 scene)
                  .mean(),
              66);
    // One in another, and two calls of a function: each has rays of its own.
    EXPECT_EQ(
        of(runs("gnested", "gather(\"\", P, up, 1, 70) { gather(\"\", P, up, 1, 3) hits += 1; }", "color(hits)"), scene).mean(),
        210);
    EXPECT_EQ(of(runs("gtwice", "f = count(P, up) + count(P, -up);", "color(f)",
                      "float count(point p; vector n) { float k = 0; gather(\"\", p, n, .5, 5) k += 1; return k; }\n"),
                 scene)
                  .mean(),
              10);
}

TEST(Gather, CountsThatMakeNoSense) {
    const std::string scene = kSmall + ball(2, "");
    for (const auto& [count, turns] :
         {std::pair<const char*, double>{"0", 0}, {"-1", 0}, {"sqrt(-1) * 0 / 0", 0}, {"1.9", 1}, {"1e9", 4096}}) {
        Scene s(inWorld(kSeen + runs("gcounts", std::string("gather(\"\", P, up, 1, ") + count + ") hits += 1;", "color(hits)") +
                        scene),
                withShaders(Hider::Path));
        EXPECT_EQ(s.one(kNear).x, turns) << count;
        EXPECT_EQ(s.messages().find("4096") != std::string::npos, turns == 4096) << s.messages();
    }
}

TEST(Gather, SubsetsSidesBiasAndThreshold) {
    const std::string in = "Attribute \"grouping\" \"string membership\" \"shell\" ";
    for (const auto& [pairs, want] : {std::pair<const char*, double>{"\"subset\", \"shell\"", 4},
                                      {"\"subset\", \"-shell\"", 0},
                                      {"\"excludesubset\", \"shell\"", 0},
                                      {"\"bias\", 2.5", 0},
                                      {"\"bias\", 1", 4},
                                      {"\"maxdist\", 1.9", 0},
                                      {"\"hitsides\", \"both\", \"samplebase\", 1", 4},
                                      {"\"type\", \"diffuse\", \"label\", \"l\", \"hitmode\", \"primitive\"", 4},
                                      {"\"raytype\", \"specular\", \"raylabel\", \"l\", \"maxhitdist\", 1", 0}})
        EXPECT_EQ(of(runs("gset", std::string("gather(\"\", P, up, 1, 4, ") + pairs + ") hits += 1;", "color(hits)"),
                     kSmall + ball(2, in))
                      .mean(),
                  want)
            << pairs;
    // Three balls in each other that let half of the light through: together .5, .75, .875.
    const std::string balls = ball(1, "Opacity .5 .5 .5") + ball(2, "Opacity .5 .5 .5") + ball(3, "Opacity .5 .5 .5");
    for (const auto& [t, want] : {std::pair<const char*, double>{"0", 1}, {".5", 1}, {".6", 2}, {".8", 3}, {".9", 0}})
        EXPECT_NEAR(
            of(runs("gthrough",
                    std::string("gather(\"\", P, up, 0, 1, \"othreshold\", color(") + t + "), \"ray:length\", f) sum += f;",
                    "sum"),
               kSmall + balls)
                .mean(),
            want, .02)
            << t;
}

TEST(Gather, DirectionsAlone) {
    EXPECT_EQ(of(runs("gpattern",
                      "gather(\"samplepattern\", P, up, .5, 100, \"ray:direction\", d) hits += 1; else { misses += "
                      "step(cos(.501), d . up); }",
                      "color(hits, misses, 0)"),
                 kSmall + ball(2, ""))
                  .mean(1),
              100);
    EXPECT_EQ(of(runs("gpattern", "gather(\"samplepattern\", P, up, .5, 100) hits += 1; else misses += 1;", "color(hits)"),
                 kSmall + ball(2, ""))
                  .mean(),
              0);
}

TEST(Gather, DirectionsOfAMap) {
    // Bright in one place, dim elsewhere: the sum of colour times solid angle is the integral, and most samples go to the bright
    // place.
    writeMap("gsky.exr", 64, 32, [](int x, int y, int) { return x >= 16 && x < 20 && y >= 8 && y < 12 ? 100.f : .1f; });
    double want = 0;
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 64; ++x)
            want += (x >= 16 && x < 20 && y >= 8 && y < 12 ? 100 : .1) *
                    (std::cos(M_PI * y / 32) - std::cos(M_PI * (y + 1) / 32)) * 2 * M_PI / 64;
    const std::string loop =
        "vector e = 0; gather(\"environment:" + shaderFolder() +
        "/gsky.exr\", 0, 0, 0, 64, \"environment:color\", c, \"environment:solidangle\", f, \"environment:direction\", e, "
        "\"ray:direction\", d) { sum += c * f; hits += step(50, comp(c, 0)); g += length(d - e); }";
    const Moments m = of(runs("gsky", loop, "color(comp(sum, 0), hits, g)"), kSmall, Hider::Raytrace, 400);
    EXPECT_NEAR(m.mean(0), want, .03 * want);
    EXPECT_GT(m.mean(1), 40);
    EXPECT_EQ(m.mean(2), 0);
}

TEST(Gather, NestedWithoutEndStaysSmall) {
    // Every hit gathers again, 256 rays at a time: depth ends it, and so does chance under path.
    writeShader(
        "gdeep",
        "surface gdeep() { color c = 0, sum = 0; normal n = faceforward(normalize(N), I); gather(\"illuminance\", P, n, PI / 2, "
        "256, \"surface:Ci\", c, \"distribution\", \"cosine\") sum += c / 256; else sum += .5; Ci = .5 * sum + .1; Oi = 1; }\n");
    for (const Hider h : {Hider::Path}) {
        Scene s(inWorld(kSeen +
                        "Attribute \"trace\" \"integer maxdiffusedepth\" 3 \"integer maxspeculardepth\" 3\nSurface \"gdeep\"\n" +
                        std::string(kFloor) + "Sphere 1 -1 1 360\n"),
                withShaders(h));
        Counters n;
        const CameraRay ray = rayTo({3, 4, -5}, {0, 0, 0});
        const Color c = s.trace({&ray, 1}, &n)[0].color;
        EXPECT_GT(c.x, 0);
        EXPECT_LT(n.peakFrameBytes, size_t(128) << 20);
        EXPECT_EQ(n.overLimit, 0u);
    }
}

TEST(Gather, InALight) {
    writeShader("glightopen",
                "light glightopen() { vector up = vector \"world\" (0, 1, 0); float open = 0; gather(\"\", Ps, up, PI / 2, 256, "
                "\"distribution\", \"cosine\") { } else open += 1 / 256; solar(-up, 0) { Cl = open; } }\n");
    Settings direct = withShaders(Hider::Path);
    direct.indirect = false;
    Scene s(inWorld(kSeen + "LightSource \"glightopen\" 1\nSurface \"matte\" \"Ka\" 0\n" + kFloor + wall(1)), direct);
    EXPECT_NEAR(s.estimate(kNear, 50).mean(), 1 - ofWall(.5, 1), .01);
}

// Of many lights some are sampled, by how bright they were found to be before there was anything to gather from.
TEST(Gather, OfALightThatIsMeasured) {
    writeShader("gatheropen",
                "light gatheropen(float open = 0) { float seen = open; vector up = vector \"world\" (0, 1, 0); if (open == "
                "0) gather(\"\", Ps, up, PI / 2, 16, \"distribution\", \"cosine\") { } else seen += 1 / 16; "
                "illuminate(point \"shader\" (0, 0, 0)) Cl = seen; }\n");
    const auto lit = [&](const std::string& open) {
        std::string lights;
        for (int i = 0; i < 12; ++i)
            lights += "TransformBegin Translate " + std::to_string(.3 * i - 1.5) + " 3 0 LightSource \"gatheropen\" " +
                      std::to_string(i + 1) + " \"open\" " + open + " TransformEnd\n";
        Settings direct = withShaders(Hider::Path);
        direct.indirect = false;
        return Scene(inWorld(kSeen + lights + "Surface \"matte\" \"Ka\" 0\n" + kFloor), direct).estimate(kNear, 2000);
    };
    const Moments gathered = lit("0"), known = lit("1");
    EXPECT_GT(known.mean(), 0);
    EXPECT_NEAR(gathered.mean(), known.mean(), kZ * std::hypot(gathered.se(), known.se()) + 1e-5);
}

TEST(Gather, AsksShadersFromALight) {
    writeShader("gtold", "surface gtold(float given = 2; output varying float own = 0) { own = given + 1; Ci = Cs; Oi = Os; }\n");
    writeShader("glightasks",
                "light glightasks() { vector up = vector \"world\" (0, 1, 0); color c = 0, sum = 0; float f = 0, g = 0;"
                "gather(\"\", Ps, up, .5, 16, \"surface:Ci\", c, \"surface:given\", f, \"surface:own\", g) sum += color(comp(c, "
                "0), f, g) / 16; solar(-up, 0) { Cl = sum; } }\n");
    const std::string shell = "AttributeBegin Attribute \"visibility\" \"integer transmission\" 0 Surface \"gtold\" \"given\" 4 "
                              "Color .25 1 1 Sphere 2 -2 2 360 AttributeEnd\n";
    for (const Hider h : kAll) {
        Settings direct = withShaders(h);
        direct.indirect = false;
        Scene s(inWorld(kSeen + "LightSource \"glightasks\" 1\nSurface \"matte\" \"Ka\" 0\n" + kSmall + shell), direct);
        const Moments m = s.estimate(kNear, 4);
        EXPECT_NEAR(m.mean(0), .25, 1e-4) << int(h) << s.messages();
        EXPECT_NEAR(m.mean(1), 4, 1e-3);
        EXPECT_NEAR(m.mean(2), 5, 1e-3);
    }
}

TEST(Gather, WhatIsNotKnownIsSaid) {
    Scene s(inWorld(kSeen +
                    runs("gwords", "gather(\"sideways\", P, up, 1, 2, \"distribution\", \"odd\", \"friend:x\", f) hits += 1;",
                         "color(hits)") +
                    kSmall + ball(2, "")),
            withShaders(Hider::Path));
    EXPECT_EQ(s.one(kNear).x, 2);
    for (const char* word : {"sideways", "odd", "friend:x"})
        EXPECT_NE(s.messages().find(word), std::string::npos) << s.messages();
    Scene t(
        inWorld(kSeen +
                runs("gtypes", "gather(\"\", P, up, 1, 2, \"surface:Ci\", f, \"ray:length\", c, \"ray:origin\", o) hits += 1;",
                     "color(hits) + f + c") +
                kSmall + ball(2, "")),
        withShaders(Hider::Path));
    EXPECT_EQ(t.one(kNear).x, 2) << "the variables stay";
    for (const char* word : {"\"surface:Ci\" has another type", "\"ray:length\" has another type"})
        EXPECT_NE(t.messages().find(word), std::string::npos) << t.messages();
    EXPECT_EQ(t.messages().find("ray:origin"), std::string::npos) << t.messages();
}

TEST(Gather, EveryParameter) {
    writeShader("gatherparams", R"(surface gatherparams() {
    vector up = vector "world" (0, 1, 0);
    float hits = 0, misses = 0, far = 0;
    gather("illuminance", P, up, 0.5, 4, "label", "a", "subset", "", "bias", 0.1, "hitmode", "default", "hitsides", "both",
           "maxdist", 9, "type", "diffuse", "samplebase", 0, "excludesubset", "none", "raytype", "diffuse", "raylabel", "b",
           "maxhitdist", 9, "distribution", "cosine", "othreshold", color(0.5), "ray:length", far) hits += 1; else misses += 1;
    Ci = color(hits, misses, far); Oi = 1;
})");
    for (const Hider h : kAll) {
        const Moments m = of("Surface \"gatherparams\"\n", kSmall + ball(2, ""), h);
        EXPECT_EQ(m.mean(0), 4) << int(h);
        EXPECT_EQ(m.mean(1), 0);
        EXPECT_NEAR(m.mean(2), 1.9, .02);
    }
}

} // namespace

} // namespace gather_test
