// What class lights and materials of PRMan make their samples of: generateSamplesEnv(), generateSamplesAS() and what evaluates
// them, areashadow() in shadowSamples(), emit() in prelighting().
#include "integrator/floorscene.h"
#include "integrator/maps.h"
#include <cmath>

namespace plausiblesamples_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

/// A surface class that runs `body` and shows `value`.
std::string shows(const std::string& name, const std::string& body, const std::string& value) {
    writeShader(
        name,
        "class " + name +
            "() { public void surface(output color Ci, Oi) { normal up = normalize(faceforward(N, I)); __radiancesample s[];\n" +
            "uniform float i; float a = 0, b = 0, c = 0;\n" + body + "\nCi = " + value + "; Oi = 1; } }\n");
    return "Surface \"" + name + "\"\n" + kFloor;
}

Moments of(const std::string& scene, int n, Hider h = Hider::Hidden) {
    Scene s(inWorld(scene), withShaders(h));
    const Moments m = s.estimate(kView, n);
    EXPECT_EQ(s.messages(), "");
    return m;
}

/// Bright in one place over the horizon, dim elsewhere.
std::string sky() {
    return writeMap("plausiblesky.exr", 64, 32,
                    [](int x, int y, int c) { return x >= 30 && x < 34 && y >= 12 && y < 15 ? 60.f + 10 * float(c) : .02f; });
}

const double kCone = 2 * M_PI * (1 - std::cos(.6)); // steradians within .6 of the normal

// The mean of one over the density, over the directions within a cone, is its solid angle: what is said of the density is true.
TEST(PlausibleSamples, DensityOfDirectionsToAnEnvironment) {
    for (const char* how : {"", ", \"distribution\", \"cosine\"", ", \"distribution\", \"uniform\""})
        for (const char* domain : {"", ", \"integrationdomain\", \"sphere\""})
            for (const std::string& map : {std::string("\"\""), sky()}) {
                const std::string call = "Env(" + map + ", P, up";
                const Moments m = of(shows("density",
                                           "generateSamples" + call + ", 64, s" + how + domain +
                                               "); for (i = 0; i < 64; i += 1) {"
                                               " if (s[i]->direction . up > cos(.6)) a += 1 / (64 * s[i]->lightPdf);"
                                               " b += abs(length(s[i]->direction) - 1); }"
                                               "__radiancesample t[]; resize(t, 64); for (i = 0; i < 64; i += 1) t[i]->direction "
                                               "= 3 * s[i]->direction;"
                                               "evaluateSamples" +
                                               call + ", t" + how + domain +
                                               "); for (i = 0; i < 64; i += 1) {"
                                               " c = max(c, abs(t[i]->lightPdf / s[i]->lightPdf - 1), "
                                               "length(vector(t[i]->radiance - s[i]->radiance)) / 100);"
                                               " c = max(c, abs(t[i]->distance - s[i]->distance)); }",
                                           "color(a, b, c)"),
                                     2000);
                expectMean(m, kCone, .03, how + (domain + map));
                EXPECT_LT(m.mean(1), 64e-5);
                // Rounding leads across the edge of a cell of the table now and then: in the mean nothing remains of it.
                EXPECT_LT(m.mean(2), 2e-3) << how << domain << map;
            }
}

std::string envLight(const std::string& arguments) {
    writeShader("envsamples", "class envsamples(uniform float n = 8; string map = \"\"; string distribution = \"importance\"; "
                              "color tint = 1; string __category = \"sky\") {\n"
                              "    public void generateSamples(string integrationdomain; output __radiancesample samples[]) {\n"
                              "        generateSamplesEnv(map, Ps, normalize(Ns), n, samples, \"distribution\", distribution, "
                              "\"scale\", tint, \"integrationdomain\", integrationdomain, \"radius\", 500);\n"
                              "    }\n    public void shadowSamples(output __radiancesample samples[]) { filterregion f; "
                              "f->calculate3d(Ps); areashadow(\"\", f, samples, \"raytrace\", 1); }\n}\n");
    return "LightSource \"envsamples\" 1 " + arguments + "\n";
}

// An even sky of radiance c on white gives c; a map gives what its irradiance is, which indirectdiffuse() integrates without
// noise.
TEST(PlausibleSamples, SkyOfSamples) {
    writeShader("white", "surface white() { Oi = Os; Ci = Os * diffuse(normalize(N)); }\n");
    for (const Hider h : {Hider::Hidden, Hider::Path}) {
        const Moments even = of(envLight("\"tint\" [1 .5 .25]") + "Surface \"white\"\n" + kFloor, 8000, h);
        expectMean(even, 1, .02, "even");
        EXPECT_NEAR(even.mean(1) / even.mean(0), .5, 1e-5);
        const Color want = Scene(inWorld(shows("wanted", "", "indirectdiffuse(" + sky() + ", up)")), withShaders(h)).one(kView);
        const Moments mapped = of(envLight("\"map\" " + sky()) + "Surface \"white\"\n" + kFloor, 4000, h);
        const Moments evenly =
            of(envLight("\"distribution\" \"uniform\" \"map\" " + sky()) + "Surface \"white\"\n" + kFloor, 4000, h);
        for (int k = 0; k < 3; ++k) {
            // The table's cells are some degrees wide; the bright place stands well over the horizon.
            EXPECT_NEAR(mapped.mean(k), want[k], 4 * mapped.se(k) + .01 * want[k]) << k;
            EXPECT_NEAR(evenly.mean(k), want[k], 4 * evenly.se(k) + .01 * want[k]) << k;
        }
        if (h == Hider::Hidden) EXPECT_LT(mapped.se(), evenly.se() / 3) << "in proportion to the light";
    }
}

// A wall hides half of the sky, a card that lets half through all of it: once, under every hider.
TEST(PlausibleSamples, ShadowsOfSamples) {
    writeShader("white", "surface white() { Oi = Os; Ci = Os * diffuse(normalize(N)); }\n");
    const std::string seen = "Attribute \"visibility\" \"camera\" 0 \"transmission\" \"opaque\"\n";
    const std::string wall = "AttributeBegin\nSurface \"constant\"\nColor 0 0 0\n" + seen +
                             "Polygon \"P\" [.05 -900 -900  .05 -900 900  .05 900 900  .05 900 -900]\nAttributeEnd\n";
    const std::string card = "AttributeBegin\nSurface \"constant\"\nColor 0 0 0\nOpacity .5 .5 .5\nAttribute \"visibility\" "
                             "\"camera\" 0 \"transmission\" \"Os\"\n"
                             "Polygon \"P\" [-900 1 -900  -900 1 900  900 1 900  900 1 -900]\nAttributeEnd\n";
    for (const Hider h : {Hider::Hidden, Hider::Raytrace, Hider::Path}) {
        expectMean(of(envLight("") + wall + "Surface \"white\"\n" + kFloor, 4000, h), .5, .04, "wall");
        expectMean(of(envLight("") + card + "Surface \"white\"\n" + kFloor, 4000, h), .5, .04, "card");
    }
}

// Facets of Ashikhmin and Shirley: of their normals the square of the cosine of the azimuth has the mean sqrt(v + 1) / (sqrt(u +
// 1) + sqrt(v + 1)), and the mean of one over the density within a cone is its solid angle.
TEST(PlausibleSamples, FacetsOfTheLobe) {
    const std::string mean = "h = normalize(s[i]->direction + v); a += pow(h . x, 2) / max(1e-12, 1 - pow(h . z, 2)) / 64;"
                             " if (s[i]->direction . z > cos(.6)) b += 1 / (64 * max(1e-9, s[i]->materialPdf));";
    const std::string axes = "vector z = vector(up), x = normalize(vector \"world\" (1, 0, 0)), v = vector(up), h; ";
    const Moments own = of(
        shows("lobe",
              axes + "generateSamplesAS(color(1, .5, 0), 64, 100, 10, z, 7 * x + z, v, s); for (i = 0; i < 64; i += 1) {" + mean +
                  " c = max(c, abs(comp(s[i]->materialResponse, 0) - 2 * comp(s[i]->materialResponse, 1)) + "
                  "comp(s[i]->materialResponse, 2)); }"
                  "color was = s[9]->materialResponse; float pdf = s[9]->materialPdf; evaluateSamplesAS(color(1, .5, 0), 100, "
                  "10, z, x, v, s);"
                  "if (pdf > 0) c = max(c, abs(comp(was, 0) / comp(s[9]->materialResponse, 0) - 1), abs(pdf / s[9]->materialPdf "
                  "- 1));",
              "color(a, b, c)"),
        2000);
    expectMean(own, std::sqrt(11.) / (std::sqrt(11.) + std::sqrt(101.)), .01, "azimuth");
    EXPECT_NEAR(own.mean(1), kCone, 4 * own.se(1) + .01 * kCone);
    EXPECT_LT(own.mean(2), 1e-4);
    // The shipped stdrsl/SpecularAS.h draws them likewise.
    writeShader("shipped", "#include <stdrsl/ShadingContext.h>\n#include <stdrsl/SpecularAS.h>\nclass shipped() {\n "
                           "stdrsl_ShadingContext m; stdrsl_Fresnel f; stdrsl_SpecularAS l;\n"
                           "public void surface(output color Ci, Oi) { m->construct(); m->init(); l->m_roughValueU = 100; "
                           "l->m_roughValueV = 10; l->m_sampleCount = 64;\n"
                           "vector z = vector(m->m_Ns), x = m->m_Tangent, v = m->m_Vn, h; uniform float i; float a = 0, b = 0; "
                           "__radiancesample s[64]; __radiancesample got[];\n"
                           "l->genSpecularSamps(m, f, \"specular\", got); for (i = 0; i < 64; i += 1) s[i] = got[i];\n"
                           "for (i = 0; i < 64; i += 1) { h = normalize(s[i]->direction + v); a += pow(h . x, 2) / max(1e-12, 1 "
                           "- pow(h . z, 2)) / 64; }\n"
                           "Ci = color(a, b, 0); Oi = 1; } }\n");
    const Moments shipped = of("Surface \"shipped\"\n" + std::string(kFloor), 2000);
    expectMean(shipped, std::sqrt(11.) / (std::sqrt(11.) + std::sqrt(101.)), .01, "stdrsl");
}

// Counts that make no sense: none, or as many as an array holds.
TEST(PlausibleSamples, CountsThatMakeNoSense) {
    for (const char* count : {"0", "-1", "0 * sqrt(-1)", "-1e30"})
        EXPECT_EQ(of(shows("counts",
                           std::string("generateSamplesEnv(\"\", P, up, ") + count + ", s); generateSamplesAS(1, " + count +
                               ", 10, 10, vector(up), dPdu, vector(up), s);",
                           "arraylength(s)"),
                     1)
                      .mean(),
                  0)
            << count;
    Scene s(inWorld(shows("many", "generateSamplesEnv(\"\", P, up, 1e9, s); a = arraylength(s); b = s[a - 1]->lightPdf;",
                          "color(a, b, 0)")),
            withShaders(Hider::Hidden));
    const Color c = s.one(kView);
    EXPECT_GE(c.x, 64);
    EXPECT_LE(c.x, 4096);
    EXPECT_GT(c.y, 0);
}

// emit() in prelighting() of a class without a light of its own: a square of radiance 2 above the floor, and the same from
// behind.
TEST(PlausibleSamples, EmissionOfAPrimitive) {
    writeShader("white", "surface white() { Oi = Os; Ci = Os * diffuse(normalize(N)); }\n");
    writeShader("geo",
                "class geo(float intensity = 1; color tint = 1;) {\n"
                "    public void prelighting(output color Ci, Oi) { color c = intensity * tint; Oi = 1; if (intensity > 0) "
                "emit(c * .5, \"raytraceshadows\", 1); emit(0.5 * c, \"shadowbias\", .01, \"specularcontribution\", 100); }\n"
                "    public void surface(output color Ci, Oi) { Ci = intensity * tint; Oi = 1; }\n}\n");
    const double a = .25, r = std::sqrt(1 + a * a), factor = 4 / (2 * M_PI) * 2 * (a / r) * std::atan(a / r);
    const auto lamp = [](const char* points) {
        return std::string("AttributeBegin\nAreaLightSource \"geo\" 1 \"intensity\" 2 \"tint\" [1 .5 0]\nSurface "
                           "\"constant\"\nColor 0 0 0\nPolygon \"P\" [") +
               points + "]\nAttributeEnd\nIlluminate 1 1\n";
    };
    for (const Hider h : {Hider::Hidden, Hider::Path}) {
        const Moments down = of(lamp("-.5 2 -.5  .5 2 -.5  .5 2 .5  -.5 2 .5") + "Surface \"white\"\n" + kFloor, 8000, h);
        expectMean(down, 2 * factor, .02, "down");
        EXPECT_NEAR(down.mean(1) / down.mean(0), .5, 1e-5);
        EXPECT_EQ(down.mean(2), 0);
        EXPECT_EQ(of(lamp("-.5 2 .5  .5 2 .5  .5 2 -.5  -.5 2 -.5") + "Surface \"white\"\n" + kFloor, 16, h).mean(), 0) << "up";
    }
}

// Of what is sent Cs has its part, as each primitive and each of its points has it: the light below two squares side by side, by
// the form factor of a rectangle above a corner of which the point lies.
TEST(PlausibleSamples, EmissionAsThePrimitiveIsColoured) {
    writeShader("white", "surface white() { Oi = Os; Ci = Os * diffuse(normalize(N)); }\n");
    writeShader("dark", "surface dark() { Oi = 1; Ci = 0; }\n");
    writeShader("tinted", "class tinted(float intensity = 1;) {\n"
                          "    color sent() { return intensity * Cs; }\n"
                          "    public void prelighting(output color Ci, Oi) { emit(sent() * comp(Os, 0)); }\n"
                          "    public void surface(output color Ci, Oi) { Ci = intensity * Cs; Oi = 1; }\n}\n");
    const auto corner = [](double x, double y) {
        const double a = std::hypot(2, x), b = std::hypot(2, y);
        return (x / a * std::atan(y / a) + y / b * std::atan(x / b)) / (2 * M_PI);
    };
    const double below = 4 * corner(.5, .5), beside = 2 * (corner(1.5, .5) - corner(.5, .5));
    const auto lamp = [](const std::string& shape) {
        return "AttributeBegin\nAreaLightSource \"tinted\" 1 \"intensity\" 4\nSurface \"dark\"\nColor .25 .5 1\nOpacity .5 .5 "
               ".5\n" +
               shape + "\nAttributeEnd\nIlluminate 1 1\nSurface \"white\"\n" + kFloor;
    };
    for (const Hider h : {Hider::Hidden, Hider::Path}) {
        const Moments faces =
            of(lamp("PointsPolygons [4 4] [0 1 4 5 1 2 3 4] \"P\" [-.5 2 -.5  .5 2 -.5  1.5 2 -.5  1.5 2 .5  .5 2 .5  -.5 2 .5] "
                    "\"uniform color Cs\" [1 0 .5  0 1 .5]"),
               20000, h);
        const double want[] = {2 * below, 2 * beside, below + beside};
        for (int k = 0; k < 3; ++k)
            EXPECT_LE(std::fabs(faces.mean(k) - want[k]), kZ * faces.se(k) + 1e-6)
                << k << ": " << faces.mean(k) << ' ' << want[k];
        EXPECT_LE(faces.se(0), .01 * want[0]);
        const std::string square = "Polygon \"P\" [-.5 2 -.5  .5 2 -.5  .5 2 .5  -.5 2 .5] ";
        const Moments across = of(lamp(square + "\"varying color Cs\" [0 1 0  1 1 0  1 1 1  0 1 1]"), 20000, h);
        for (const int k : {0, 2}) // opposite points add up to one
            EXPECT_LE(std::fabs(across.mean(k) - below), kZ * across.se(k)) << k;
        const Moments plain = of(lamp(square), 8000, h);
        expectMean(plain, .5 * below, .02, "Color");
        EXPECT_NEAR(plain.mean(2) / plain.mean(0), 4, 1e-5);
    }
}

// A surface that says what it sends shows it without being a light.
TEST(PlausibleSamples, EmissionOfASurface) {
    writeShader("shining", "class shining(float intensity = 1;) {\n"
                           "    color sent() { return intensity * Cs; }\n"
                           "    public void prelighting(output color Ci, Oi) { emit(sent()); }\n"
                           "    public void surface(output color Ci, Oi) { Ci = Cs; Oi = 1; }\n}\n");
    for (const Hider h : {Hider::Hidden, Hider::Path})
        EXPECT_EQ(Scene(inWorld("Surface \"shining\"\nColor .25 .5 1\n" + std::string(kFloor)), withShaders(h)).one(kView),
                  Color(.25f, .5f, 1));
}

} // namespace

} // namespace plausiblesamples_test
