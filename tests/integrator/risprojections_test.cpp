// Patterns of RIS that project and layer pictures, and those that ask rays (docs/ris.md): values of closed forms.
#include "integrator/harness.h"
#include "integrator/rispattern.h"

namespace risprojections_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;
using namespace alpenglow::integrator::testing::ris;

namespace {

TEST(RisProjections, Arithmetic) {
    const auto put = [](int operation) {
        return given("PxrArithmetic \"color input1\" [3 -2 .5] \"color input2\" [2 4 0] \"int operation\" " +
                         std::to_string(operation),
                     "resultRGB", "color");
    };
    expectColor(put(0), 5, 2, .5, 1e-6, "sum");
    expectColor(put(1), 6, -8, 0, 1e-6, "product");
    expectColor(put(2), 1, -6, .5, 1e-6, "difference");
    expectColor(put(3), 1.5, -.5, 0, 1e-6, "quotient");
    expectColor(put(4), 2, -2, 0, 1e-6, "smaller");
    expectColor(put(5), 3, 4, .5, 1e-6, "larger");
    expectColor(put(6), 9, 0, 1, 1e-5, "power");
    expectColor(put(7), 1, 2, 0, 1e-6, "rest");
    expectColor(put(99), 3, -2, .5, 1e-6, "unknown");
}

constexpr const char* kWorld = " \"string coordsys\" \"world\" \"int invertT\" 0 \"int frontOnly\" 0 ";

TEST(RisProjections, ACameraProjects) {
    const auto at = [](const std::string& more, const char* output) {
        return number("PxrProjector \"float focalLength\" 20" + std::string(kWorld) + more, output);
    };
    // The film is .98 by .735 inches, 4 to 3; the picture 2048 by 1556, which is narrower: it fills the film's height.
    const double x = kX / 2 * 20, y = kY / 2 * 20, wide = 25.4 * .98, high = 25.4 * .735, device = 2048. / 1556;
    EXPECT_NEAR(at("", "resultS"), .5 + x / (high * device), 1e-5);
    EXPECT_NEAR(at("", "resultT"), .5 + y / high, 1e-5);
    EXPECT_NEAR(at("\"int filmFit\" 1", "resultS"), .5 + x / wide, 1e-5);
    EXPECT_NEAR(at("\"int filmFit\" 1", "resultT"), .5 + y / (wide / device), 1e-5);
    EXPECT_NEAR(at("\"int filmFit\" 3", "resultS"), .5 + x / wide, 1e-5);
    EXPECT_NEAR(at("\"int filmFit\" 2 \"int resolutionX\" 778", "resultS"), .5 + x / (high / 2), 1e-5);
    EXPECT_NEAR(number("PxrProjector \"float focalLength\" 20 \"string coordsys\" \"world\"", "resultT"), .5 - y / high, 1e-5);
    EXPECT_NEAR(at("\"float scaleS\" 3 \"float offsetS\" -.25 \"float angle\" 90", "resultS"), -3 * (.5 + y / high) - .25, 1e-5);
    EXPECT_EQ(at("", "resultMask"), 1);
    EXPECT_EQ(at("\"float nearClipPlane\" 2.5", "resultMask"), 0);
    EXPECT_EQ(at("\"float focalLength\" 60", "resultMask"), 0);
    EXPECT_EQ(at("\"float focalLength\" 60 \"int clampTo\" 0", "resultMask"), 1);
}

TEST(RisProjections, SpheresCylindersAndPlanesProject) {
    const auto at = [](int projection, const char* output) {
        return number("PxrProjector \"int projection\" " + std::to_string(projection) + kWorld, output);
    };
    const double turn = .5 + std::atan2(kX, 2) / (2 * M_PI), r = std::sqrt(kX * kX + kY * kY + 4);
    EXPECT_NEAR(at(1, "resultS"), turn, 1e-6);
    EXPECT_NEAR(at(1, "resultT"), .5 + std::asin(kY / r) / M_PI, 1e-6);
    EXPECT_NEAR(at(2, "resultS"), turn, 1e-6);
    EXPECT_NEAR(at(2, "resultT"), .5 + kY / 2, 1e-6);
    EXPECT_NEAR(at(3, "resultS"), .5 + kX / 2, 1e-6);
    EXPECT_NEAR(at(3, "resultT"), .5 + kY / 2, 1e-6);
    // A shape at rest elsewhere: (-1, 0, 1) at all corners, so (kX, kY) does not matter.
    EXPECT_NEAR(given("PxrProjector \"int projection\" 3 \"int use\" 1" + std::string(kWorld), "resultS", "float", "",
                      "Translate 0 0 2\nPolygon \"P\" [-1 1 0  1 1 0  1 -1 0  -1 -1 0] \"vertex point __Pref\" [-.5 0 1  -.5 0 "
                      "1  -.5 0 1  -.5 0 1]\n")
                    .x,
                .25, 1e-6);
}

TEST(RisProjections, MasksOfProjectors) {
    const auto mask = [](const std::string& more, const std::string& before = "", const std::string& beside = "") {
        return sceneOf("PxrProjector \"string coordsys\" \"world\" " + more, "resultMask", "float", before, "", beside)
            .one(rayTo({0, 0, 0}, {kX, kY, 2}))
            .x;
    };
    const double cosine = 2 / std::sqrt(kX * kX + kY * kY + 4);
    // The camera is behind the eye: one side of the square is toward it. Of the sphere about the origin the other one.
    const std::string camera = "\"float focalLength\" 20", sphere = "\"int projection\" 1";
    const bool turned = mask(camera) == 0;
    const std::string toward = turned ? "ReverseOrientation\n" : "", away = turned ? "" : "ReverseOrientation\n";
    EXPECT_EQ(mask(camera, toward), 1);
    EXPECT_EQ(mask(camera, away), 0);
    EXPECT_EQ(mask(sphere, toward), 0);
    EXPECT_EQ(mask(sphere, away), 1);
    const double k = std::min(cosine / 1.25, 1.), soft = k * k * (3 - 2 * k);
    EXPECT_NEAR(mask(camera + " \"float frontFalloff\" 1.25", toward), soft, 1e-5);
    // A ball between the point and the projector, which the camera does not see.
    const std::string ball = "AttributeBegin\nAttribute \"visibility\" \"int camera\" 0\nTranslate .125 .25 1\nSphere .1 -.1 .1 "
                             "360\nAttributeEnd\n";
    EXPECT_EQ(mask(camera + " \"int traceOcclusion\" 1", toward, ball), 0);
    EXPECT_EQ(mask(camera + " \"int traceOcclusion\" 1", toward), 1);
    EXPECT_EQ(mask(camera + " \"int traceOcclusion\" 1 \"float traceMaxDistance\" .5", toward, ball), 1);
    EXPECT_EQ(mask(camera, toward, ball), 1);
}

TEST(RisProjections, LayersOfProjectionsAreStacked) {
    // s from left to right, and how far down t.
    const std::string ramp =
        writeMap("risramp.exr", 256, 256, [](int x, int y, int c) { return (float(c == 0 ? x : y) + .5f) / 256; });
    const std::string manifold = "Pattern \"PxrProjector\" \"p\" \"int projection\" 3 \"string coordsys\" \"world\" \"int "
                                 "frontOnly\" 0\n";
    expectColor(given("PxrProjectionLayer \"reference struct manifold\" [\"p:result\"] \"string filename\" " + ramp, "resultRGB",
                      "color", manifold),
                .5 + kX / 2, .5 - kY / 2, .5 - kY / 2, 2e-3, "t runs downward, as in the picture");
    const std::string red = flatMap("risred.exr", 1, 0, 0), blue = flatMap("risblue.exr", 0, 0, 1);
    const std::string layers = "Pattern \"PxrProjectionLayer\" \"a\" \"string filename\" " + red +
                               "\nPattern \"PxrProjectionLayer\" \"c\" \"float mask\" .25 \"string filename\" " + blue + "\n";
    const std::string stack = "PxrProjectionStack \"color[2] layersRGB\" [0 0 0  0 0 0] \"float[2] layersA\" [1 1] \"reference "
                              "color[2] layersRGB\" [\"a:resultRGB\" \"c:resultRGB\"] \"reference float[2] layersA\" "
                              "[\"a:resultA\" \"c:resultA\"]";
    expectColor(given(stack, "resultRGB", "color", layers), .75, 0, .25, 1e-5, "a quarter of blue over red");
    expectColor(given(stack + " \"int[2] layersMode\" [0 1]", "resultRGB", "color", layers), 0, 0, .25, 1e-5, "red is off");
    EXPECT_NEAR(number(stack + " \"int[2] layersMode\" [0 1]", "resultA", layers), .25, 1e-6);
    EXPECT_EQ(number("PxrProjectionLayer \"float mask\" 0 \"string filename\" " + red, "resultA"), 0);
    expectColor(
        given("PxrProjectionLayer \"float mask\" .5 \"int premultiply\" 1 \"string filename\" " + red, "resultRGB", "color"), .5,
        0, 0, 1e-5, "premultiplied");
    expectColor(given("PxrProjectionLayer", "resultRGB", "color"), 1, 0, 1, 1e-6, "no file");
}

TEST(RisProjections, TexturesLieOnEachOther) {
    const std::string red = flatMap("risred.exr", 1, 0, 0), blue = flatMap("risblue.exr", 0, 0, 1),
                      mask = flatMap("rismask.exr", .5f, .25f, 0);
    const std::string over = "Pattern \"PxrLayeredTexture\" \"o\" \"float maskValue\" .5 \"string maskTexture\" " + mask +
                             " \"int maskChannel\" 1 \"string filename\" " + red + "\n";
    const std::string under = "PxrLayeredTexture \"reference struct textureOverlay\" [\"o:resultOverlay\"] \"string filename\" ";
    expectColor(given(under + blue, "resultRGB", "color", over), .125, 0, .875, 1e-5, "an eighth of red over blue");
    EXPECT_NEAR(number(under + blue, "resultA", over), 1, 1e-6);
    expectColor(given(under + blue + " \"color colorTint\" [1 1 .5] \"color colorOffset\" [0 .25 0]", "resultRGB", "color", over),
                .125, .875 * .25, .875 * .5, 1e-5, "tinted");
    expectColor(given(under + blue + " \"int mute\" 1", "resultRGB", "color", over), .125, 0, 0, 1e-5, "without the lower one");
    EXPECT_NEAR(number(under + blue + " \"int mute\" 1", "resultA", over), .125, 1e-6);
}

TEST(RisProjections, HexagonalTilesAreBlended) {
    const std::string ramp = writeMap(
        "rishex.exr", 256, 256, [](int x, int y, int c) { return (float(c == 0 ? x : y) + .5f) / 256; }, "periodic,periodic");
    const auto seen = [&](const std::string& more, const std::string& pictures) {
        return given("PxrMultiTexture \"reference struct manifoldMulti\" [\"c:resultMulti\"] " + pictures, "resultRGB", "color",
                     "Pattern \"PxrHexTileManifold\" \"c\" " + more + "\n");
    };
    // Tiles that are not moved show the picture as it is: s = .625, and t = .25 from the lower edge.
    expectColor(seen("\"float jitter\" 0", "\"string filename0\" " + ramp), .625, .75, .75, 2e-3, "not moved");
    for (const char* more : {"\"float frequency\" 7", "\"float jitterAngle\" 180 \"float blend\" 1", "\"float blend\" 0"})
        expectColor(seen(more, "\"string filename0\" " + flatMap("risgrey.exr", .2f, .4f, .6f)), .2, .4, .6, 1e-5,
                    "all weights are 1 together");
    // Each of three pictures counts by its weights; somewhere a sharp edge leaves one alone.
    const std::string three = "\"string filename0\" " + flatMap("ris0.exr", 1, 0, 0) + " \"string filename1\" " +
                              flatMap("ris1.exr", 0, 1, 0) + " \"string filename2\" " + flatMap("ris2.exr", 0, 0, 1);
    Scene tiles = sceneOf("PxrMultiTexture \"reference struct manifoldMulti\" [\"c:resultMulti\"] " + three, "resultRGB", "color",
                          "Pattern \"PxrHexTileManifold\" \"c\" \"int numTextures\" 3 \"float blend\" 0\n");
    std::set<int> found;
    for (int i = 0; i < 36; ++i) {
        const Color c = tiles.one(rayTo({0, 0, 0}, {-.9f + .36f * float(i % 6), -.9f + .36f * float(i / 6), 2}));
        EXPECT_NEAR(c.x + c.y + c.z, 1, 1e-5);
        for (int k = 0; k < 3; ++k)
            if (c[k] > .99f) found.insert(k);
    }
    EXPECT_EQ(found.size(), 3u);
}

/// A shape that rays of the camera pass, but no others, at the point of the square.
std::string unseen(const std::string& shape) {
    return "AttributeBegin\nAttribute \"visibility\" \"int camera\" 0 \"int transmission\" 1\nTranslate .25 .5 2\n" + shape +
           "AttributeEnd\n";
}

TEST(RisProjections, DirtGathersWhereRaysAreBlocked) {
    // A ball of radius r in the direction of the normal, d away, hides (r / d)^2 by cosine and 1 - sqrt(1 - (r / d)^2) of
    // directions.
    const std::string ball = unseen("Translate 0 0 -1\nSphere .5 -.5 .5 360\n");
    const auto dirt = [](const std::string& more) { return "PxrDirt \"int numSamples\" 4 " + more; };
    Scene clean = sceneOf("PxrDirt \"color unoccluded\" [.25 .5 .75]", "resultRGB", "color");
    expectColor(clean.one(rayTo({0, 0, 0}, {kX, kY, 2})), .25, .5, .75, 1e-6, "nothing near");
    const auto part = [&](const std::string& more, const std::string& beside) {
        return sceneOf(dirt(more), "resultR", "float", "", "", beside).estimate(rayTo({0, 0, 0}, {kX, kY, 2}), samples(4000));
    };
    expectMean(part("", ball), .25, .02, "cosine");
    expectMean(part("\"int distribution\" 0", ball), 1 - std::sqrt(.75), .03, "uniform");
    expectMean(part("\"float maxDistance\" .4", ball), 0, 0, "farther away");
    // A plane h away: (1 - d / m) at d = h / c, weighted by the cosine c, is (1 - h / m)^2.
    const std::string plane = unseen("Translate 0 0 -.25\nScale 1000 1000 1\nPolygon \"P\" [-1 1 0  1 1 0  1 -1 0  -1 -1 0]\n");
    expectMean(part("\"float maxDistance\" 1 \"float falloff\" 1", plane), .75 * .75, .02, "falloff");
    expectMean(part("\"float maxDistance\" 1 \"float falloff\" -1", plane), 1 - .0625, .02, "a hard edge");
    const std::string behind = unseen("Translate 0 0 1\nSphere .5 -.5 .5 360\n");
    expectMean(part("\"int direction\" 1", behind), .25, .02, "inside");
    expectMean(part("\"int direction\" 2", behind), .125, .03, "both");
    expectMean(part("\"int direction\" 0", behind), 0, 0, "outside");
}

TEST(RisProjections, CurvatureOfABall) {
    // Rays inside of a ball of radius 1 leave it after 2 c, c their cosine to the normal: those below m do with (m / 2)^2. With a
    // weight of 1 - d / m a third of that is left.
    const std::string ball = "Translate 0 0 3\nSphere 1 -1 1 360\n", inside = "Sphere 1 -1 1 360\n";
    const auto curved = [](const std::string& more, const char* output, const std::string& shape) {
        return sceneOf("PxrCurvature \"int numSamples\" 4 \"float maxDistance\" 1 " + more, output, "float", "", shape)
            .estimate(rayTo({0, 0, 0}, {.1f, .2f, 2}), samples(4000));
    };
    expectMean(curved("\"float bias\" 1", "resultConvex", ball), .25, .02, "outside");
    expectMean(curved("", "resultConvex", ball), .25 / 3, .03, "less and less");
    // .8: 1 - d / 4, so 3/4 of all and 1/4 of the last. .2: 1 - 4 d, up to d = 1/4.
    expectMean(curved("\"float bias\" .8", "resultConvex", ball), .25 * (.75 + .25 / 3), .02, "nearly alike");
    expectMean(curved("\"float bias\" .2", "resultConvex", ball), .25 * .25 * .25 / 3, .1, "only the nearest");
    expectMean(curved("\"float bias\" 1", "resultConcave", ball), 0, 0, "a ball is nowhere hollow");
    expectMean(curved("\"float bias\" 1", "resultConcave", inside), .25, .02, "from inside it is");
    expectMean(curved("\"float bias\" 1 \"color convexTint\" [.5 0 0]", "resultR", ball), .125, .02, "tint");
    Scene flat = sceneOf("PxrCurvature \"float maxDistance\" 1", "resultRGB", "color");
    expectColor(flat.one(rayTo({0, 0, 0}, {kX, kY, 2})), 0, 0, 0, 0, "flat");
}

} // namespace
} // namespace risprojections_test
