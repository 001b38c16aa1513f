// RIS: connected parameters begin with what patterns give, and lights have the closed forms of their units (docs/ris.md).
#include "integrator/harness.h"
#include "integrator/maps.h"

namespace risscene_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

const char* kSquare = "Polygon \"P\" [-1 -1 2  1 -1 2  1 1 2  -1 1 2]\n";

Settings path() {
    Settings s;
    s.hider = Hider::Path;
    return s;
}
void writeShaders() {
    writeShader("showcolor", "surface showcolor(varying color c = color(.1, .2, .3);) { Oi = 1; Ci = c; }\n");
    writeShader("shownumber", "surface shownumber(varying float x = .25;) { Oi = 1; Ci = color(x, 0, 0); }\n");
    writeShader("shownormal",
                "surface shownormal(varying normal n = 0;) { Oi = 1; Ci = color(xcomp(n), ycomp(n), zcomp(n)); }\n");
    writeShader("paint", "surface paint(varying color diffuseColor = .5;) { Oi = 1; Ci = diffuseColor * "
                         "diffuse(faceforward(normalize(N), I)); }\n");
    writeShader("fixed",
                "surface fixed(color a = 0; output varying color resultRGB = 0; output varying float resultF = 0;) { resultRGB "
                "= a; resultF = 7; Ci = 5; }\n");
}
Color shown(const std::string& requests, int errors = 0) {
    writeShaders();
    Scene s("WorldBegin\n" + requests + kSquare + "WorldEnd\n", path(), errors);
    return s.one(rayTo({0, 0, 0}, {.25f, .5f, 2}));
}

TEST(RisNetwork, AParameterBeginsWithWhatThePatternGives) {
    const Color c = shown("Pattern \"PxrMix\" \"m\" \"color color1\" [.2 .4 .6] \"color color2\" [.6 .8 1] \"float mix\" .25\n"
                          "Bxdf \"showcolor\" \"b\" \"reference color c\" [\"m:resultRGB\"]\n");
    EXPECT_NEAR(c.x, .3f, 1e-6);
    EXPECT_NEAR(c.y, .5f, 1e-6);
    EXPECT_NEAR(c.z, .7f, 1e-6);
}

TEST(RisNetwork, PatternsTakeOutputsOfPatternsAndOneMayServeSeveral) {
    const Color c =
        shown("Pattern \"fixed\" \"f\" \"color a\" [.2 .4 .8]\n"
              "Pattern \"PxrInvert\" \"i\" \"reference color inputRGB\" [\"f:resultRGB\"]\n"
              "Pattern \"PxrMix\" \"m\" \"reference color color1\" [\"f:resultRGB\"] \"reference color color2\" "
              "[\"i:resultRGB\"] \"float mix\" .5\nBxdf \"showcolor\" \"b\" \"reference color c\" [\"m:resultRGB\"]\n");
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(c[k], .5f, 1e-6);
}

TEST(RisNetwork, NumbersAreGreysAndColorsGiveTheirMean) {
    const Color grey = shown("Pattern \"fixed\" \"f\"\nBxdf \"showcolor\" \"b\" \"reference color c\" [\"f:resultF\"]\n");
    EXPECT_EQ(grey, Color(7, 7, 7));
    const Color mean = shown(
        "Pattern \"fixed\" \"f\" \"color a\" [.3 .6 .9]\nBxdf \"shownumber\" \"b\" \"reference float x\" [\"f:resultRGB\"]\n");
    EXPECT_NEAR(mean.x, .6f, 1e-6);
}

TEST(RisNetwork, WhatIsNotThereLeavesTheParameterItsOwnValue) {
    EXPECT_NEAR(shown("Pattern \"NoSuchPattern\" \"f\"\nBxdf \"showcolor\" \"b\" \"reference color c\" [\"f:resultRGB\"] ").y,
                .2f, 1e-6);
    EXPECT_NEAR(shown("Pattern \"fixed\" \"f\"\nBxdf \"showcolor\" \"b\" \"reference color c\" [\"f:resultX\"]\n").z, .3f, 1e-6);
    EXPECT_NEAR(shown("Bxdf \"showcolor\" \"b\" \"reference color c\" [\"f:resultX\"]\n", 1).x, .1f, 1e-6);
}

TEST(RisNetwork, AManifoldIsTakenMemberByMember) {
    // s = x, so so both waves of the checker are known.
    const Color c =
        shown("Pattern \"PxrManifold2D\" \"m\" \"float scaleS\" .001 \"float scaleT\" .001 \"float offsetS\" .7\n"
              "Pattern \"PxrChecker\" \"k\" \"color colorA\" [1 0 0] \"color colorB\" [0 0 1] \"reference struct manifold\" "
              "[\"m:result\"]\nBxdf \"showcolor\" \"b\" \"reference color c\" [\"k:resultRGB\"]\n");
    EXPECT_NEAR(c.x, 0, 1e-3); // .7 is in the upper half of a wave, .0005 in the lower
    EXPECT_NEAR(c.z, 1, 1e-3);
}

TEST(RisNetwork, DerivativesGoThroughConnections) {
    // A height of .5 s over the square, where s is x: the normal leans by (.5, 0) to 1.
    const Color n =
        shown("Pattern \"PxrVariable\" \"v\" \"string variable\" [\"s\"]\nPattern \"PxrBump\" \"b\" \"float scale\" .5 "
              "\"reference float inputBump\" [\"v:resultF\"]\nBxdf \"shownormal\" \"b2\" \"reference normal n\" "
              "[\"b:resultN\"]\n");
    EXPECT_NEAR(std::fabs(n.x / n.z), .5, 1e-4);
    EXPECT_NEAR(n.y, 0, 1e-5);
}

TEST(RisNetwork, MaterialsWithPatternsDoNotWait) {
    writeShaders();
    Scene s(std::string(
                "WorldBegin\nLight \"PxrDomeLight\" \"l\"\nPattern \"PxrChecker\" \"k\"\nBxdf \"paint\" \"b\" \"reference color "
                "diffuseColor\" [\"k:resultRGB\"]\n") +
                kSquare + "WorldEnd\n",
            path());
    EXPECT_EQ(s.world->facts().suspending, 0);
}

TEST(RisNetwork, OslAndSeExprGiveWhatTheyCompute) {
    std::ofstream(shaderFolder() + "/oslcount.osl")
        << "float twice(float x, output float half) { half = x / 2; return 2 * x; }\n"
           "surface oslcount(int n = 3, float s = 0 [[int lockgeom = 0]], output color Cout = 0, output float resultF = 0)\n{\n"
           "  for (int i = 0; i < n; i++) resultF += i / 2;\n  float h;\n  Cout = color(twice(s, h), h, (int)(s * 10.5) + "
           "fmod(-5, 3));\n}\n";
    // 0 / 2 + 1 / 2 + 2 / 2 + 3 / 2 of whole numbers are 0, 0, 1, 1.
    EXPECT_EQ(
        shown("Pattern \"oslcount\" \"o\" \"int n\" 4\nBxdf \"shownumber\" \"b\" \"reference float x\" [\"o:resultF\"]\n").x, 2);
    const Color c =
        shown("Pattern \"oslcount\" \"o\" \"float s\" .4\nBxdf \"showcolor\" \"b\" \"reference color c\" [\"o:Cout\"]\n");
    EXPECT_NEAR(c.x, .8f, 1e-6);
    EXPECT_NEAR(c.y, .2f, 1e-6);
    EXPECT_NEAR(c.z, 4 - 2, 1e-5);
    const Color e =
        shown("Pattern \"PxrSeExpr\" \"e\" \"color c1\" [.1 .2 .3] \"float k\" 3 \"string expression\" [\"$a = c1 * k; if (k "
              "> 2) { $a += [0, 0, 1]; } $a ^ 2 / (a[0] > 5 ? 1 : 2)\"]\nBxdf \"showcolor\" \"b\" \"reference color "
              "c\" [\"e:resultRGB\"]\n");
    EXPECT_NEAR(e.x, .3 * .3 / 2, 1e-6);
    EXPECT_NEAR(e.y, .6 * .6 / 2, 1e-6);
    EXPECT_NEAR(e.z, 1.9 * 1.9 / 2, 1e-5);
}

TEST(RisNetwork, FunctionsOfSeExprHaveTheirValues) {
    const auto value = [](const std::string& text) {
        return shown("Pattern \"PxrSeExpr\" \"e\" \"string expression\" [\"" + text +
                     "\"]\nBxdf \"shownumber\" \"b\" \"reference float x\" [\"e:resultF\"]\n")
            .x;
    };
    EXPECT_NEAR(value("fmod(7.5, 2)"), 1.5, 1e-6);
    EXPECT_NEAR(value("fmod(-7.5, 2)"), -1.5, 1e-6);
    EXPECT_NEAR(value("gaussstep(.5, 0, 1)"), std::pow(2, -2), 1e-6);
    EXPECT_NEAR(value("remap(.7, .5, .1, .2, 0)"), .5, 1e-5);
    EXPECT_NEAR(value("contrast(.25, .25)"), .5 * std::pow(.5, std::log(.75) / std::log(.5)), 1e-5);
    EXPECT_NEAR(value("gamma(.25, 2) + sind(30) + trunc(-1.5) + hypot(3, 4) + log10(100)"), .5 + .5 - 1 + 5 + 2, 1e-5);
    EXPECT_NEAR(value("compress(.25, 1, 3) + expand(.25, .2, .3) + invert(.25)"), 1.5 + .5 + .75, 1e-5);
    EXPECT_NEAR(value("angle([1, 0, 0], [0, 2, 0]) + cbrt(27)"), M_PI / 2 + 3, 1e-5);
    // Without jitter sites are in the middles of cells.
    EXPECT_NEAR(value("voronoi([.5, .5, .75], 2, 0)"), .25, 1e-5);
    EXPECT_NEAR(value("voronoi([.5, .5, .75], 3, 0)"), .75, 1e-5);
    EXPECT_NEAR(value("voronoi([.5, .5, .75], 4, 0)"), .5, 1e-5);
    EXPECT_NEAR(value("pvoronoi([1.4, .5, .75], 0)"), 1.5, 1e-5);
}

TEST(RisNetwork, OslTakesVariablesOfThePrimitiveWhereItSaysSo) {
    std::ofstream(shaderFolder() + "/OslBound.osl")
        << "shader OslBound(color Cs = 1 [[int lockgeom = 0]], output color Cout = 0) { Cout = Cs; }\n";
    const Color c =
        shown("Color [.2 .4 .6]\nPattern \"oslbound\" \"o\"\nBxdf \"showcolor\" \"b\" \"reference color c\" [\"o:Cout\"]\n");
    EXPECT_NEAR(c.x, .2f, 1e-6); // and is found in other case
    EXPECT_NEAR(c.z, .6f, 1e-6);
}

TEST(RisNetwork, APictureThatIsMissingIsSaidAndHasItsColourForThat) {
    const auto seen = [](const std::string& requests, int errors) {
        writeShaders();
        Scene s("WorldBegin\n" + requests + kSquare + "WorldEnd\n", path());
        const Color c = s.one(rayTo({0, 0, 0}, {.25f, .5f, 2}));
        EXPECT_EQ(s.diagnostics.errors(), errors) << s.messages();
        return c;
    };
    const std::string show = "\nBxdf \"showcolor\" \"b\" \"reference color c\" [\"t:resultRGB\"]\n",
                      texture = "Pattern \"PxrTexture\" \"t\" \"color missingColor\" [.1 .2 .3] \"string filename\" ";
    const Color there = seen(texture + writeMap("risthere.exr", 4, 4, Color(.5f, .25f, 1)) + show, 0);
    EXPECT_NEAR(there.x, .5f, 1e-3);
    EXPECT_NEAR(there.y, .25f, 1e-3);
    const Color missing = seen(texture + "\"risnowhere.exr\"" + show, 1);
    EXPECT_NEAR(missing.x, .1f, 1e-6);
    EXPECT_NEAR(missing.z, .3f, 1e-6);
    const Color bent = seen("Pattern \"PxrNormalMap\" \"t\" \"string filename\" \"risnowhere.exr\"\nBxdf \"shownormal\" "
                            "\"b\" \"reference normal n\" [\"t:resultN\"]\n",
                            1);
    EXPECT_NEAR(std::fabs(bent.z), 1, 1e-6); // the surface's own
}

TEST(RisNetwork, VariablesOfThePrimitiveAndAttributesAreRead) {
    const Color c =
        shown("Attribute \"user\" \"float gain\" .5\nPattern \"PxrAttribute\" \"a\" \"string varname\" [\"user:gain\"]\n"
              "Pattern \"PxrPrimvar\" \"p\" \"string varname\" [\"nobody\"] \"string type\" [\"color\"] \"color "
              "defaultColor\" [.2 .4 .6]\nPattern \"PxrMix\" \"m\" \"reference color color2\" [\"p:resultRGB\"] \"color "
              "color1\" [0 0 0] \"reference float mix\" [\"a:resultF\"]\nBxdf \"showcolor\" \"b\" \"reference color "
              "c\" [\"m:resultRGB\"]\n");
    EXPECT_NEAR(c.x, .1f, 1e-6);
    EXPECT_NEAR(c.z, .3f, 1e-6);
    writeShaders();
    Scene s(
        "WorldBegin\nPattern \"PxrPrimvar\" \"p\" \"string varname\" [\"tint\"] \"string type\" [\"color\"]\nBxdf \"showcolor\" "
        "\"b\" \"reference color c\" [\"p:resultRGB\"]\nPolygon \"P\" [-1 -1 2  1 -1 2  1 1 2  -1 1 2] \"vertex color tint\" [0 "
        "0 0  1 "
        "0 0  1 0 0  0 0 0]\nWorldEnd\n",
        path());
    EXPECT_NEAR(s.one(rayTo({0, 0, 0}, {.5f, .25f, 2})).x, .75f, 1e-5);
}

TEST(RisNetwork, DisplacementTakesPatternsToo) {
    writeShaders();
    writeShader("showdepth", "surface showdepth() { Oi = 1; Ci = color(zcomp(transform(\"world\", P)), 0, 0); }\n");
    Scene s(std::string("WorldBegin\nAttribute \"displacementbound\" \"float sphere\" [2]\nPattern \"fixed\" \"f\"\nDisplace "
                        "\"PxrDisplace\" \"d\" \"float dispAmount\" [.1] \"reference float dispScalar\" [\"f:resultF\"]\nBxdf "
                        "\"showdepth\" \"b\"\n") +
                kSquare + "WorldEnd\n",
            path());
    const double z = s.one(rayTo({0, 0, 0}, {.1f, .1f, 2})).x;
    EXPECT_NEAR(std::fabs(z - 2), .7, 1e-4);
}

TEST(RisNetwork, InvertKnowsColourModels) {
    const auto inverted = [](int model, const std::string& channels) {
        return shown("Pattern \"PxrInvert\" \"i\" \"color inputRGB\" [.2 .4 .6] \"int colorModel\" " + std::to_string(model) +
                     channels + "\nBxdf \"showcolor\" \"b\" \"reference color c\" [\"i:resultRGB\"]\n");
    };
    const std::string third = " \"int invertChannel0\" 0 \"int invertChannel1\" 0",
                      second = " \"int invertChannel0\" 0 \"int invertChannel2\" 0";
    // Hue 210 degrees. HSL: saturation .5, lightness .4 > .6: the chroma of .4 stays. HSV: saturation 2/3, value .6 > .4.
    const struct {
        Color got;
        double want[3];
    } all[] = {{inverted(0, ""), {.8, .6, .4}},
               {inverted(1, third), {.4, .6, .8}},
               {inverted(2, third), {.4 / 3, .8 / 3, .4}},
               {inverted(2, second), {.4, .5, .6}}};
    for (const auto& c : all)
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(c.got[k], c.want[k], 1e-5) << &c - all;
}

TEST(RisNetwork, MattesAreChannels) {
    writeShaders();
    Settings s = path();
    s.outputs = {"MatteID0", "MatteID1"};
    Scene scene("WorldBegin\nAttribute \"user\" \"color MatteID0\" [1 0 .5]\nPattern \"PxrMatteID\" \"m\" \"color "
                "matteTexture0\" [.5 1 1]\nBxdf \"PxrSurface\" \"b\" \"reference int[1] utilityPattern\" "
                "[\"m:resultAOV\"]\n" +
                    std::string(kSquare) + "WorldEnd\n",
                s);
    EXPECT_EQ(scene.trace(std::vector<CameraRay>{rayTo({0, 0, 0}, {.25f, .5f, 2})})[0].aovs,
              (std::vector<float>{.5f, 0, .5f, 0, 0, 0}));
}

TEST(RisNetwork, NetworksOfOslGiveWhatTheirLayersCompute) {
    writeShaders();
    std::ofstream(shaderFolder() + "/risscale.osl")
        << "shader risscale(color c = .5, float by = 2, output color Cout = 0) { Cout = c * by; }\n";
    std::ofstream(shaderFolder() + "/risnet.xml")
        << "<RenderManOSLNetwork><Node><NodeId>risscale</NodeId><NodeLayer>A</NodeLayer></Node><Node><NodeId>risscale</NodeId>"
           "<NodeLayer>B</NodeLayer></Node><Connection><Source><NodeLayer>A</NodeLayer><ParameterName>Cout</ParameterName>"
           "</Source><Destination><NodeLayer>B</NodeLayer><ParameterName>c</ParameterName></Destination></Connection>"
           "</RenderManOSLNetwork>";
    Scene s("Option \"searchpath\" \"string shader\" [\"" + shaderFolder() +
                ":@\"]\nWorldBegin\nPattern \"PxrOSL\" \"m\" \"string network\" \"risnet\" \"color A.c\" [.1 .2 .3] \"float "
                "B.by\" 5\nBxdf \"showcolor\" \"b\" \"reference color c\" [\"m:B.Cout\"]\n" +
                kSquare + "WorldEnd\n",
            path());
    const Color c = s.one(rayTo({0, 0, 0}, {.25f, .5f, 2}));
    EXPECT_NEAR(c.x, .1 * 2 * 5, 1e-6) << s.messages();
    EXPECT_NEAR(c.z, .3 * 2 * 5, 1e-6);
}

/// diffuse() of white paint at the middle of the square, which faces a light behind the eye.
void expectPaint(const std::string& light, double want, const std::string& what, double precision = .01) {
    writeShaders();
    Scene s("WorldBegin\nAttributeBegin\n" + light + "\nAttributeEnd\nBxdf \"paint\" \"b\" \"color diffuseColor\" [1 1 1]\n" +
                kSquare + "WorldEnd\n",
            path());
    expectMean(s.estimate(rayTo({.5f, 0, 0}, {0, 0, 2}), samples(4000, 200'000)), want, precision, what);
}
/// The form factor of a rectangle of half sides a and b, parallel to an element on its axis at distance h (Siegel and Howell,
/// Thermal Radiation Heat Transfer, B-4, four times).
double ofRectangle(double a, double b, double h) {
    const double x = a / h, y = b / h, p = std::sqrt(1 + x * x), q = std::sqrt(1 + y * y);
    return 2 / M_PI * (x / p * std::atan(y / p) + y / q * std::atan(x / q));
}

TEST(RisLights, ARectangleIsOneAcrossAndShinesAlongZ) {
    expectPaint("Light \"PxrRectLight\" \"l\" \"float intensity\" 3 \"float exposure\" 1", 6 * ofRectangle(.5, .5, 2),
                "unit square");
    expectPaint("Scale 3 2 1\nLight \"PxrRectLight\" \"l\" \"float intensity\" 3", 3 * ofRectangle(1.5, 1, 2), "3 by 2");
    expectPaint("Scale 3 2 1\nLight \"PxrRectLight\" \"l\" \"float intensity\" 3 \"int areaNormalize\" 1",
                .5 * ofRectangle(1.5, 1, 2), "of normalised area");
    writeShaders();
    Scene away(
        std::string("WorldBegin\nAttributeBegin\nRotate 180 1 0 0\nLight \"PxrRectLight\" \"l\"\nAttributeEnd\nBxdf \"paint\" "
                    "\"b\"\n") +
            kSquare + "WorldEnd\n",
        path());
    EXPECT_EQ(away.one(rayTo({.5f, 0, 0}, {0, 0, 2})), Color(0));
}

TEST(RisLights, OthersHaveTheirUnitsToo) {
    expectPaint("Light \"PxrDiskLight\" \"l\" \"float intensity\" 4", 4 * .25 / (.25 + 4), "disk, R^2 / (R^2 + h^2)");
    expectPaint("Light \"PxrSphereLight\" \"l\" \"float intensity\" 4", 4 * .25 / 4, "ball, (R / d)^2", .02);
    const double half = 5 * M_PI / 180;
    expectPaint("Light \"PxrDistantLight\" \"l\" \"float intensity\" 40 \"float angleExtent\" 10",
                40 * std::pow(std::sin(half), 2), "sun, sin^2 of half its extent");
    expectPaint("Light \"PxrDistantLight\" \"l\" \"float intensity\" 2 \"float angleExtent\" 10 \"int areaNormalize\" 1",
                2 / M_PI, "sun of irradiance 2");
    expectPaint("Light \"PxrDomeLight\" \"l\" \"float intensity\" .25 \"float exposure\" 2 \"color lightColor\" [.5 .5 .5]", .5,
                "even sky");
}

TEST(RisLights, AFurnaceUnderADomeIsEven) {
    writeShaders();
    Scene s(
        "WorldBegin\nLight \"PxrDomeLight\" \"l\" \"float intensity\" 2\nBxdf \"paint\" \"b\" \"color diffuseColor\" [1 1 1]\n"
        "Translate 0 0 3\nSphere 1 -1 1 360\nWorldEnd\n",
        path());
    expectMean(s.estimate(rayTo({0, 0, 0}, {.3f, .4f, 2.2f}), 2000), 2, .01, "white ball");
}

TEST(RisLights, TheCameraDoesNotSeeThemUnlessAsked) {
    writeShaders();
    const std::string light = "Translate 0 0 2\nRotate 180 1 0 0\n";
    Scene hidden("WorldBegin\n" + light + "Light \"PxrRectLight\" \"l\" \"float intensity\" 3\nWorldEnd\n", path());
    EXPECT_EQ(hidden.one(rayTo({0, 0, 0}, {.1f, .2f, 2})), Color(0));
    Scene seen("WorldBegin\n" + light +
                   "Attribute \"visibility\" \"int camera\" 1\nLight \"PxrRectLight\" \"l\" \"float intensity\" 3\n"
                   "WorldEnd\n",
               path());
    EXPECT_NEAR(seen.one(rayTo({0, 0, 0}, {.1f, .2f, 2})).x, 3, 1e-5);
}

} // namespace
} // namespace risscene_test
