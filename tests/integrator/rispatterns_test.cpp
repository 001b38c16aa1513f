// Patterns of RIS one by one: values of the formulas that their manuals give (docs/ris.md).
#include "integrator/harness.h"
#include "integrator/rispattern.h"

namespace rispatterns_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;
using namespace alpenglow::integrator::testing::ris;

namespace {

TEST(RisPatterns, TeeHandsOnAndSidesAreTold) {
    expectColor(given("PxrTee \"color inputRGB\" [.1 .2 .3] \"string aov\" \"\"", "resultRGB", "color"), .1, .2, .3, 1e-6, "tee");
    EXPECT_FLOAT_EQ(number("PxrTee \"float inputF\" 4"), 4);
    const float front = number("PxrShadedSide");
    EXPECT_EQ(number("PxrShadedSide \"int invert\" 1"), 1 - front);
    EXPECT_EQ(number("PxrShadedSide", "resultF", "ReverseOrientation\n"), 1 - front);
}

// Outputs of a float keep one number beside tees of numbers; beside one of colours they are as wide as colours.
TEST(RisPatterns, TeesAndGeometryAreOutputs) {
    writeShader("showsboth",
                "surface showsboth(varying color c = 0; varying float x = 0, aov = 0;) { Oi = 1; Ci = c * x + aov; }\n");
    const std::string mine = "Pattern \"PxrTee\" \"t\" \"color inputRGB\" [.1 .2 .3] \"string aov\" \"mine\"\n";
    const std::string num = "Pattern \"PxrTee\" \"u\" \"float inputF\" .75 \"string aov\" \"num\"\n";
    const auto outputs = [&](const std::string& patterns, const std::string& taken, std::vector<std::string> names) {
        Settings set;
        set.hider = Hider::Path;
        set.outputs = std::move(names);
        Scene s("WorldBegin\n" + patterns + "Pattern \"PxrGeometricAOVs\" \"g\"\nBxdf \"showsboth\" \"b\" " + taken +
                    "\nPolygon \"P\" [-1 1 2  1 1 2  1 -1 2  -1 -1 2] \"st\" [0 0  1 0  1 1  0 1]\nWorldEnd\n",
                set);
        const CameraRay ray = rayTo({0, 0, 0}, {kX, kY, 2});
        return s.trace({&ray, 1})[0].aovs;
    };
    const auto expectNumbers = [](const std::vector<float>& got, const std::vector<float>& want) {
        ASSERT_EQ(got.size(), want.size());
        for (size_t i = 0; i < want.size(); ++i) EXPECT_NEAR(got[i], want[i], 1e-6) << i;
    };
    const std::string c = "\"reference color c\" [\"t:resultRGB\"] ", x = "\"reference float x\" [\"u:resultF\"] ",
                      g = "\"reference float aov\" [\"g:resultAOV\"]";
    expectNumbers(outputs(mine, c, {"mine"}), {.1f, .2f, .3f});
    expectNumbers(outputs(num, x, {"num"}), {.75f});
    expectNumbers(outputs(mine + num, c + x + g, {"mine", "__depth", "__st", "__Pworld"}),
                  {.1f, .2f, .3f, 2, .625f, .25f, 0, kX, kY, 2});
    EXPECT_NEAR(outputs(mine + num, c + x, {"num"}).at(0), .75, 1e-6);
    EXPECT_NEAR(std::fabs(outputs("", g, {"__Nworld"}).at(2)), 1, 1e-6);
}

TEST(RisPatterns, ProductsOfVectors) {
    EXPECT_FLOAT_EQ(number("PxrDot \"vector vector1\" [1 2 3] \"vector vector2\" [4 -5 6]", "result"), 12);
    const std::string two = "PxrCross \"vector vector1\" [1 2 2] \"vector vector2\" [0 0 3]";
    expectColor(given(two, "resultXYZ", "vector"), 2 / std::sqrt(5), -1 / std::sqrt(5), 0, 1e-6, "of unit length");
    expectColor(given(two + " \"int normalizeResult\" 0", "resultXYZ", "vector"), 6, -3, 0, 1e-6, "as it is");
}

TEST(RisPatterns, LayersOfDisplacementAreJoined) {
    const auto joined = [](const std::string& way) {
        return number(
            "PxrDispScalarLayer \"float overallAmount\" 2 \"float baseLayerDispScalar\" .5 \"float layer1DispScalar\" .3 "
            "\"float layer1Amount\" 2 \"float layer1Mask\" .5 \"int layer1Comp\" " +
            way);
    };
    // The layer is .6; half of it counts; twice.
    const double both[] = {.5 + .6, .6, .5 * .6, (.5 + .6) / 2, .5, .6};
    for (int way = 1; way <= 6; ++way) EXPECT_NEAR(joined(std::to_string(way)), .5 + both[way - 1], 1e-6) << way;
    EXPECT_FLOAT_EQ(
        number("PxrDispScalarLayer \"int baseLayerEnabled\" 0 \"float baseLayerDispScalar\" .5 \"int layer1Enabled\" 0 "
               "\"int layer3Enabled\" 1 \"float layer3DispScalar\" .25"),
        .25f);
    expectColor(
        given(
            "PxrDispVectorLayer \"vector baseLayerDispVector\" [1 2 3] \"vector layer1DispVector\" [3 2 1] \"int layer1Comp\" 5 "
            "\"int layer2Enabled\" 1 \"vector layer2DispVector\" [.5 .5 .5] \"float layer2Mask\" .5",
            "resultXYZ", "vector"),
        1.25, 2.25, 1.25, 1e-6, "minimum, then half of a sum");
}

TEST(RisPatterns, ColoursVaryWithTheObjectAndWithinTheirLimits) {
    const auto varied = [](const std::string& more, int id) {
        return given("PxrVary \"color inputRGB\" [.2 .4 .6] " + more, "resultRGB", "color",
                     id ? "Attribute \"identifier\" \"int id\" " + std::to_string(id) + "\n" : "");
    };
    expectColor(varied("\"float hue\" 1 \"float gamma\" 1", 0), .2, .4, .6, 1e-6, "no id");
    expectColor(varied("", 3), .2, .4, .6, 1e-5, "no limits");
    std::set<float> seen;
    for (int id = 1; id <= 6; ++id) {
        const Color up = varied("\"float luminance\" .5 \"int luminanceMode\" 1", id);
        // Lightness, .4, by at most half more, the hue and the saturation of hsl, .5, as they were.
        const float lightness = (std::min({up.x, up.y, up.z}) + std::max({up.x, up.y, up.z})) / 2;
        EXPECT_GE(lightness, .4f - 1e-5f);
        EXPECT_LE(lightness, .6f + 1e-5f);
        EXPECT_NEAR((up.y - up.x) / (up.z - up.x), .5, 1e-4) << id;
        seen.insert(lightness);
    }
    EXPECT_GE(seen.size(), 5u);
    expectColor(varied("\"float hue\" 1 \"float probability\" 0", 3), .2, .4, .6, 1e-6, "never");
    EXPECT_GT(
        length(
            Vec3(varied(
                "\"float luminance\" .5 \"int varySource\" 3 \"string varName\" \"identifier:id\" \"int luminanceMode\" 1", 4)) -
            Vec3(varied("\"float luminance\" .5 \"int luminanceMode\" 1", 4))),
        -1); // both ways find the number
}

TEST(RisPatterns, AThinFilmInterferes) {
    const double eta = 1.4, thickness = 500, spread = .02;
    const double cosine = 2 / std::sqrt(kX * kX + kY * kY + 4);
    double channel[3] = {0, 0, 0};
    for (int i = 0; i < 6; ++i) {
        const double n = eta + spread * (.5 - i / 5.), inside = std::sqrt(1 - (1 - cosine * cosine) / (n * n));
        channel[2 - i / 2] += .5 * (1 - std::cos(4 * M_PI * n * thickness * inside / (425 + 50 * i)));
    }
    // Phases are some 20 radians in float: 2^-24 of that, times six operations.
    expectColor(given("PxrThinFilm \"color inputRGB\" [1 .5 2] \"float eta\" 1.4 \"float spread\" .02 \"float thickness\" 250 "
                      "\"float thicknessScale\" 2",
                      "resultRGB", "color"),
                channel[0], .5 * channel[1], 2 * channel[2], 2e-5, "film");
    expectColor(given("PxrThinFilm \"float thickness\" 0", "resultRGB", "color"), 0, 0, 0, 1e-6,
                "a film of no thickness is black");
}

TEST(RisPatterns, PicturesOfARoundCube) {
    const std::string pictures = "\"string filename0\" " + flatMap("ris0.exr", 1, 0, 0) + " \"string filename1\" " +
                                 flatMap("ris1.exr", 0, 1, 0) + " \"string filename2\" " + flatMap("ris2.exr", 0, 0, 1);
    const auto seen = [&](const std::string& cube, const std::string& turned) {
        return given("PxrMultiTexture \"reference struct manifoldMulti\" [\"c:resultMulti\"] " + pictures, "resultRGB", "color",
                     "Pattern \"PxrRoundCube\" \"c\" " + cube + "\n",
                     "Translate 0 0 2\n" + turned + "Polygon \"P\" [-2 2 0  2 2 0  2 -2 0  -2 -2 0]\n");
    };
    const std::string three = "\"int numberOfTextures\" 3 \"float transitionWidth\" ";
    expectColor(seen("\"int numberOfTextures\" 1", ""), 1, 0, 0, 1e-5, "one picture");
    expectColor(seen(three + "0", ""), 0, 0, 1, 1e-5, "along z");
    // The space of the world: the normal leans by 30 degrees, (0, .5, .866). With a width of 1 faces count by squares.
    expectColor(seen(three + "1 \"string coordsys\" \"world\"", "Rotate 30 1 0 0\n"), 0, .25, .75, 1e-5, "leaning");
    // Beyond half of the largest, .866: .067 and .433.
    const double y = .5 - std::sqrt(3) / 4, z = std::sqrt(3) / 4;
    expectColor(seen(three + ".5 \"string coordsys\" \"world\"", "Rotate 30 1 0 0\n"), 0, y * y / (y * y + z * z),
                z * z / (y * y + z * z), 1e-5, "a narrower transition");
    expectColor(given("PxrMultiTexture " + pictures, "resultRGB", "color"), 1, 0, 0, 1e-5, "without a manifold");
    expectColor(given("PxrMultiTexture \"reference struct manifoldMulti\" [\"c:resultMulti\"] " + pictures, "resultRGB", "color",
                      "Attribute \"identifier\" \"int id\" 4\nPattern \"PxrRandomTextureManifold\" \"c\" \"int numTextures\" 3 "
                      "\"int textureOrder\" 0\n"),
                0, 1, 0, 1e-5, "4 mod 3");
    // s = .625, t = .25, in tiles of a fifth: 3 + 1 = 4, mod 3.
    expectColor(given("PxrMultiTexture \"reference struct manifoldMulti\" [\"c:resultMulti\"] " + pictures, "resultRGB", "color",
                      "Pattern \"PxrTileManifold\" \"c\" \"int numTextures\" 3 \"int textureOrder\" 0 \"float scaleS\" 5 \"float "
                      "scaleT\" 5\n"),
                0, 1, 0, 1e-5, "tiles");
}

TEST(RisPatterns, ManifoldsAndFieldsOfDirections) {
    EXPECT_FLOAT_EQ(number("PxrManifold3DN \"float scale\" 3", "resultX"), 3 * kX);
    EXPECT_FLOAT_EQ(number("PxrManifold3DN \"float scale\" 3", "resultZ"), 6);
    EXPECT_NEAR(std::fabs(given("PxrManifold3DN", "resultN", "vector").z), 1, 1e-6);
    EXPECT_NEAR(number("PxrBumpManifold2D \"float scaleS\" 2 \"int invertT\" 0", "resultS"), 2 * .625, 1e-6);
    EXPECT_NEAR(number("PxrBumpManifold2D \"int invertT\" 1", "resultT"), .75, 1e-6);
    // dPdu of this square is +x or +y by the order of its corners; turned by a quarter it is orthogonal to where it was.
    const Color T = given("PxrTangentField", "resultXYZ", "vector"),
                B = given("PxrTangentField \"float inputRotation\" .25", "resultXYZ", "vector");
    const Color half = given("PxrTangentField \"float rotationOffset\" 180", "resultXYZ", "vector");
    const Color red = given("PxrTangentField \"color inputVector\" [.5 1 0]", "resultXYZ", "vector");
    EXPECT_NEAR(length(Vec3(T)), 1, 1e-5);
    EXPECT_NEAR(dot(Vec3(T), Vec3(B)), 0, 1e-5);
    EXPECT_NEAR(dot(Vec3(T), Vec3(half)), -1, 1e-5);
    EXPECT_NEAR(dot(Vec3(B), Vec3(red)), 1, 1e-5);
}

TEST(RisPatterns, WhatBakesIsHandedOn) {
    for (const char* name : {"PxrBakeTexture", "PxrBakePointCloud"}) {
        expectColor(
            given(std::string(name) + " \"color inputRGB\" [.1 .2 .3] \"string filename\" \"b.tex\"", "resultRGB", "color"), .1,
            .2, .3, 1e-6, name);
        EXPECT_FLOAT_EQ(number(std::string(name) + " \"float inputF\" .75"), .75f);
    }
}

TEST(RisPatterns, LayersOfColours) {
    // From below: (.5, 0, 0); layer 3 multiplies by (.5, 1, 1); layer 1 adds (0, .25, 0), half; layer 0 is off.
    expectColor(
        given(
            "PxrLayeredBlend \"color backgroundRGB\" [.5 0 0] \"int enable_3\" 1 \"int operation_3\" 1 \"color RGB_3\" [.5 1 1] "
            "\"int enable_1\" 1 \"int operation_1\" 0 \"color RGB_1\" [0 .25 0] \"float A_1\" .5 \"color RGB_0\" [9 9 9]",
            "resultRGB", "color"),
        .25, .125, 0, 1e-6, "layers");
    expectColor(given("PxrLayeredBlend \"int enable_7\" 1 \"color RGB_7\" [3 .5 0]", "resultRGB", "color"), 1, .5, 0, 1e-6,
                "clamped");
    const std::string three = "PxrSwitch \"color[3] inputsRGB\" [1 0 0  0 1 0  0 0 1] \"float index\" ";
    expectColor(given(three + ".4", "resultRGB", "color"), 1, 0, 0, 1e-6, "first");
    expectColor(given(three + "1.6", "resultRGB", "color"), 0, 0, 1, 1e-6, "third");
    expectColor(given(three + "4", "resultRGB", "color"), 0, 1, 0, 1e-6, "over again");
    expectColor(given("PxrSwitch \"color[2] inputsRGB\" [0 0 0  0 0 0] \"reference color[2] inputsRGB\" [\"\" \"e:resultRGB\"] "
                      "\"float index\" 1",
                      "resultRGB", "color", "Pattern \"PxrExposure\" \"e\" \"color inputRGB\" [.1 .2 .3] \"float stops\" 1\n"),
                .2, .4, .6, 1e-6, "connected");
}

// Names and defaults of RenderMan 23.
TEST(RisPatterns, ColoursAreChanged) {
    expectColor(given("PxrExposure \"color inputRGB\" [.1 .2 .3] \"float stops\" -1", "resultRGB", "color"), .05, .1, .15, 1e-6,
                "stops");
    expectColor(
        given("PxrClamp \"color inputRGB\" [-1 .5 2] \"color min\" [.1 .2 .3] \"color max\" [.4 .4 .9]", "resultRGB", "color"),
        .1, .4, .9, 1e-6, "kept");
    expectColor(given("PxrClamp \"color inputRGB\" [-.25 .5 2.75] \"int modulus\" 1", "resultRGB", "color"), .75, .5, .75, 1e-6,
                "modulus");
    EXPECT_NEAR(number("PxrToFloat \"color input\" [.1 .2 .6]"), .1, 1e-6);
    EXPECT_NEAR(number("PxrToFloat \"color input\" [.1 .2 .6] \"int mode\" 3"), .3, 1e-6);
    const std::string threshold =
        "PxrThreshold \"color inputRGB\" [.1 .55 .9] \"float transitionWidth\" .2 \"int channel\" 1 \"int transitionProfile\" ";
    EXPECT_NEAR(number(threshold + "0"), .75, 1e-5);
    EXPECT_NEAR(number(threshold + "1"), 3 * .75 * .75 - 2 * .75 * .75 * .75, 1e-5);
    // Bias b of x is x^(ln b / ln 1/2): of .5 it is b.
    expectColor(given("PxrRemap \"color inputRGB\" [1 2 5] \"float inputMax\" 4 \"color bias\" [.5 .25 .5] \"float outputMax\" 2",
                      "resultRGB", "color"),
                .5, .5, 2, 1e-5, "bias of each channel, clamped");
    expectColor(given("PxrRemap \"color inputRGB\" [3 3 3] \"int clampInput\" 0 \"int clampOutput\" 0", "resultRGB", "color"), 3,
                3, 3, 1e-5, "as it is");
    expectColor(
        given("PxrColorCorrect \"color inputRGB\" [.2 .4 .6] \"float exposure\" 1 \"float inputMask\" .5 \"float mixMask\" .5",
              "resultRGB", "color"),
        .25, .5, .75, 1e-5, "a quarter");
    EXPECT_FLOAT_EQ(number("PxrManifold3D \"float scale\" 2", "resultY"), 2 * kY);
}

TEST(RisPatterns, FacingRatios) {
    const double c = 2 / std::sqrt(kX * kX + kY * kY + 4);
    EXPECT_NEAR(number("PxrFacingRatio"), c, 1e-6);
    EXPECT_NEAR(number("PxrFacingRatio \"float gamma\" 2 \"int invert\" 1"), std::sqrt(1 - c), 1e-5);
    EXPECT_NEAR(number("PxrFacingRatio \"int use\" 1 \"vector direction\" [3 0 4] \"string coordSys\" \"world\""), .8, 1e-6);
    // Fresnel's equations for unpolarised light from air into 1.5.
    const double s = std::sqrt(1 - c * c), t = std::sqrt(1 - s * s / 2.25);
    const double rs = (c - 1.5 * t) / (c + 1.5 * t), rp = (t - 1.5 * c) / (t + 1.5 * c);
    EXPECT_NEAR(number("PxrFacingRatio \"int mode\" 1"), (rs * rs + rp * rp) / 2, 1e-6);
}

TEST(RisPatterns, ABumpOfAMap) {
    // A height of .3 s: s is (x + 1) / 2, so the normal leans by .15 to 1.
    const std::string map = writeMap("risbump.exr", 256, 256, [](int x, int, int) { return (float(x) + .5f) / 256; });
    const Color n = given("PxrBump \"float scale\" .3 \"string filename\" " + map, "resultN", "vector");
    EXPECT_NEAR(std::fabs(n.x / n.z), .15, 2e-3);
    EXPECT_NEAR(n.y, 0, 1e-3);
}

TEST(RisPatterns, NormalsAreAdjustedAndFlakesLean) {
    const double lean = std::atan(.5);
    const std::string given45 = "PxrAdjustNormal \"normal inputNormal\" [0 .5 -1] ";
    const auto angle = [&](const std::string& more) {
        const Color n = given(given45 + more, "resultN", "vector");
        return std::atan2(std::fabs(n.y), std::fabs(n.z));
    };
    EXPECT_NEAR(angle(""), lean, 1e-5);
    EXPECT_NEAR(angle("\"float surfaceNormalMix\" 1"), 0, 1e-5);
    EXPECT_NEAR(angle("\"float adjustAmount\" 0"), 0, 1e-5);
    EXPECT_NEAR(angle("\"float surfaceNormalMix\" .5"), lean / 2, 1e-5); // of two unit vectors the middle is half way
    const Color flat = given("PxrFlakes \"float flakeAmount\" 0", "resultN", "vector"),
                none = given("PxrFlakes \"float density\" 0", "resultN", "vector");
    EXPECT_NEAR(std::fabs(flat.z), 1, 1e-6);
    EXPECT_NEAR(std::fabs(none.z), 1, 1e-6);
    EXPECT_EQ(number("PxrFlakes", "resultA"), 1);
    EXPECT_EQ(number("PxrFlakes \"float density\" 0", "resultA"), 0);
    const Color leaning = given("PxrFlakes \"float flakeAmount\" 1", "resultN", "vector");
    EXPECT_NEAR(length(Vec3(leaning)), 1, 1e-5);
    EXPECT_LT(std::fabs(leaning.z), 1 - 1e-4f);
}

TEST(RisPatterns, HairHasTheAbsorptionOfItsMelanin) {
    const double quantity = -std::log(1 - .2);
    const double a[3] = {.419, .697, 1.37};
    expectColor(given("PxrHairColor", "resultDiff", "color"), std::exp(-quantity * a[0]), std::exp(-quantity * a[1]),
                std::exp(-quantity * a[2]), 1e-5, "melanin");
    expectColor(given("PxrHairColor", "resultTT", "color"), std::exp(-quantity * a[0] / 2), std::exp(-quantity * a[1] / 2),
                std::exp(-quantity * a[2] / 2), 1e-5, "once");
    expectColor(given("PxrHairColor \"int mode\" 1 \"color color\" [.2 .4 .6] \"color dye\" [1 .5 0]", "resultDiff", "color"), .2,
                .2, 0, 1e-6, "dyed");
}

} // namespace
} // namespace rispatterns_test
