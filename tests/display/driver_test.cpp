// Modes, quantisation, drivers, comparison of pictures.
#include "display/diff.h"
#include "display/driver.h"
#include "display/mode.h"
#include "support.h"
#include <bit>
#include <cmath>
#include <limits>
#include <set>

namespace driver_test {

using namespace alpenglow;
using namespace alpenglow::display;
using namespace alpenglow::display::test;
using V = std::vector<std::string>;

namespace {

V namesOf(const std::string& mode, int warnings = 0, int errors = 0, const std::map<std::string, scene::Param>& channels = {}) {
    Diagnostics d;
    auto m = parseMode(mode, d, {}, channels);
    EXPECT_EQ(d.warnings(), warnings) << mode << messages(d);
    EXPECT_EQ(d.errors(), errors) << mode << messages(d);
    return channelNames(m);
}

DriverSetup setupFor(const Scratch& s, const std::string& type, const std::string& name, const Image& m) {
    DriverSetup u;
    u.type = type;
    u.name = name;
    u.width = m.width;
    u.height = m.height;
    u.channels = m.channels;
    u.rgba = {0, 255, 0, 255, 0};
    u.policy = s.policy();
    return u;
}

} // namespace

TEST(Mode, StandardModes) {
    EXPECT_EQ(namesOf("rgb"), (V{"r", "g", "b"}));
    EXPECT_EQ(namesOf("rgba"), (V{"r", "g", "b", "a"}));
    EXPECT_EQ(namesOf("rgbz"), (V{"r", "g", "b", "z"}));
    EXPECT_EQ(namesOf("rgbaz"), (V{"r", "g", "b", "a", "z"}));
    EXPECT_EQ(namesOf("a"), V{"a"});
    EXPECT_EQ(namesOf("z"), V{"z"});
    EXPECT_EQ(namesOf("az"), (V{"a", "z"}));
    EXPECT_EQ(namesOf("RGBA"), (V{"r", "g", "b", "a"}));
    EXPECT_EQ(namesOf("A").size(), 3u); // a variable
    EXPECT_EQ(namesOf(""), (V{"r", "g", "b", "a"}));
}

TEST(Mode, LightPaths) {
    EXPECT_EQ(namesOf("a,lpe:C<RD>L"), (V{"a", "lpe:C<RD>L.r", "lpe:C<RD>L.g", "lpe:C<RD>L.b"}));
    EXPECT_EQ(namesOf(" lpe:C<RD>{2,4}<L.['a,b' 'c']> ,z"),
              (V{"lpe:C<RD>{2,4}<L.['a,b' 'c']>.r", "lpe:C<RD>{2,4}<L.['a,b' 'c']>.g", "lpe:C<RD>{2,4}<L.['a,b' 'c']>.b", "z"}));
}

TEST(Mode, OutputVariables) {
    EXPECT_EQ(namesOf("N"), (V{"N.x", "N.y", "N.z"}));
    EXPECT_EQ(namesOf("varying color mycolor"), (V{"mycolor.r", "mycolor.g", "mycolor.b"}));
    EXPECT_EQ(namesOf("float depth2"), V{"depth2"});
    EXPECT_EQ(namesOf("rgba,N,varying float k"), (V{"r", "g", "b", "a", "N.x", "N.y", "N.z", "k"}));
    EXPECT_EQ(namesOf("float[2] pair"), (V{"pair.000", "pair.001"}));
    EXPECT_EQ(namesOf("uniform hpoint q").size(), 4u);
    EXPECT_EQ(namesOf("matrix m").size(), 16u);
    EXPECT_EQ(namesOf("s"), V{"s"});
    EXPECT_EQ(namesOf("Ci,alpha"), (V{"r", "g", "b", "a"}));
}

TEST(Mode, ElementsOfArrays) {
    EXPECT_EQ(namesOf("varying float list[1]"), V{"list[1]"});
    EXPECT_EQ(namesOf("rgb,color tones[12]"), (V{"r", "g", "b", "tones[12].r", "tones[12].g", "tones[12].b"}));
    EXPECT_EQ(namesOf("list[1],list[2]").size(), 6u); // colours, as long as nobody says more
    scene::Param p;
    p.name = "list";
    p.type = scene::Type::Float;
    p.arrayLength = 3;
    EXPECT_EQ(namesOf("list[1]", 0, 0, {{"list", p}}), V{"list[1]"});
    EXPECT_EQ(namesOf("rgb,list[x]", 0, 1), (V{"r", "g", "b"}));
    EXPECT_EQ(namesOf("rgb,list[", 0, 1), (V{"r", "g", "b"}));
}

TEST(Mode, TypesComeFromDisplayChannel) {
    scene::Param p;
    p.name = "occ";
    p.type = scene::Type::Float;
    EXPECT_EQ(namesOf("occ", 0, 0, {{"occ", p}}), V{"occ"});
    Diagnostics d;
    auto m = parseMode("occ", d);
    ASSERT_EQ(m.size(), 1u);
    EXPECT_FALSE(m[0].declared);
    EXPECT_EQ(m[0].type, scene::Type::Color);
}

TEST(Mode, NonsenseIsReported) {
    EXPECT_EQ(namesOf("rgb,rgb", 1), (V{"r", "g", "b"}));
    EXPECT_EQ(namesOf("!?", 0, 2), (V{"r", "g", "b", "a"})); // not understood, and nothing left
    EXPECT_EQ(namesOf("rgb,float[0] x", 0, 1), (V{"r", "g", "b"}));
    EXPECT_EQ(namesOf(", ,"), (V{"r", "g", "b", "a"}));
}

TEST(Quantise, ClosedForms) {
    Quantization q{0, 255, 0, 255, 0};
    EXPECT_EQ(quantise(q, 0, 0), 0);
    EXPECT_EQ(quantise(q, 1, 0), 255);
    EXPECT_EQ(quantise(q, 0.5f, 0), 128); // floor(127.5 + 0.5)
    EXPECT_EQ(quantise(q, 127.4f / 255, 0), 127);
    EXPECT_EQ(quantise(q, -3, 0), 0);
    EXPECT_EQ(quantise(q, 7, 0), 255);
    EXPECT_EQ(quantise(q, std::numeric_limits<float>::quiet_NaN(), 0), 0);
    EXPECT_EQ(quantise(q, std::numeric_limits<float>::infinity(), 0), 255);
    EXPECT_EQ(quantise({16, 235, 0, 255, 0}, 0.5f, 0), 126);   // 16 + 0.5 * 219 = 125.5
    EXPECT_EQ(quantise({0, 0, 0, 0, 0}, 0.123f, 1), 0.123f);   // one = 0: as it is
    EXPECT_EQ(quantise({0, 100, 0, 255, 2}, 0.5f, -0.5f), 49); // 50 + 2 * -0.5
}

TEST(Quantise, DitherOfOneHalfKeepsCodesAndMakesMeans) {
    Quantization q{0, 255, 0, 255, 0.5f};
    double sum = 0;
    const int n = 256;
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) {
            float noise = ditherNoise(x, y, 0);
            ASSERT_GT(noise, -1.0f);
            ASSERT_LT(noise, 1.0f);
            ASSERT_EQ(quantise(q, 100 / 255.0f, noise), 100);
            sum += quantise(q, 100.25f / 255.0f, noise);
        }
    // P(101) = 1/4; the mean of n^2 = 65536 trials has standard deviation sqrt(3/16)/256 = 0.0017.
    EXPECT_NEAR(sum / (n * n), 100.25, 5 * 0.0017);
    EXPECT_EQ(ditherNoise(5, 7, 1), ditherNoise(5, 7, 1));
    EXPECT_NE(ditherNoise(5, 7, 1), ditherNoise(7, 5, 1));
    EXPECT_NE(ditherNoise(5, 7, 1), ditherNoise(5, 7, 2));
}

TEST(Quantise, DisplayParametersOverride) {
    Diagnostics d;
    scene::Quantize ri{255, 0, 255, 0.5f, false};
    bool asked = true;
    Quantization q = quantizationOf(ri, {}, d, &asked);
    EXPECT_EQ(q, (Quantization{0, 255, 0, 255, 0.5f}));
    EXPECT_FALSE(asked);
    scene::Param p, dither;
    p.name = "quantize";
    p.numbers = {0, 65535, 0, 65535};
    dither.name = "dither";
    dither.numbers = {0};
    EXPECT_EQ(quantizationOf(ri, {p, dither}, d, &asked), (Quantization{0, 65535, 0, 65535, 0}));
    EXPECT_TRUE(asked);
    p.numbers = {1, 2};
    EXPECT_EQ(quantizationOf(ri, {p}, d), (Quantization{0, 255, 0, 255, 0.5f}));
    EXPECT_EQ(d.errors(), 1);
}

TEST(Drivers, EachIsDescribedAndFound) {
    std::set<std::string> names;
    for (auto* d : drivers()) {
        EXPECT_FALSE(d->names.empty());
        EXPECT_FALSE(d->doc.empty());
        EXPECT_TRUE(d->make());
        for (auto& n : d->names) EXPECT_TRUE(names.insert(n).second) << n;
    }
    for (const char* t : {"openexr", "exr", "tiff", "TIFF", "file", "png", "framebuffer", "it", "idisplay", "null", "zfile",
                          "shadow", "Targa", "bmp"})
        EXPECT_TRUE(findDriver(t)) << t;
    EXPECT_FALSE(findDriver("nonesuch"));
}

TEST(Drivers, WriteTheFormatAsked) {
    Image m = pattern(8, 5, {"r", "g", "b", "a"});
    struct Case {
        const char *type, *name;
        bool exr, floating;
        int bits;
        int said;
    };
    for (auto c : {Case{"openexr", "a.exr", true, true, 32, 0}, Case{"exr", "a", true, true, 32, 0},
                   Case{"tiff", "a.tif", false, false, 8, 0}, Case{"file", "a.exr", true, true, 32, 0},
                   Case{"file", "ri.pic", false, false, 8, 0}, Case{"file", "a.png", false, false, 8, 0},
                   Case{"png", "a.png", false, false, 8, 0}, Case{"framebuffer", "a.tif", false, false, 8, 1},
                   Case{"Targa", "a.tga", false, false, 8, 1}, Case{"bmp", "a.bmp", false, false, 8, 1},
                   Case{"nonesuch", "a.exr", true, true, 32, 1}}) {
        Scratch s;
        Diagnostics d;
        ASSERT_TRUE(writeDisplay(setupFor(s, c.type, c.name, m), m, d)) << messages(d);
        EXPECT_EQ(int(d.all().size()), c.said) << c.type << messages(d);
        EXPECT_EQ(d.errors(), 0);
        auto r = readImage(s / c.name, d);
        ASSERT_TRUE(r);
        EXPECT_EQ(bytesOf(s / c.name)[0] == 0x76, c.exr) << c.type;
        EXPECT_EQ(r->floating, c.floating) << c.type;
        EXPECT_EQ(r->bits, c.bits) << c.type;
        EXPECT_EQ(r->channels, m.channels);
        EXPECT_EQ(r->data, m.data); // the pattern is exact in 8 bits
        EXPECT_EQ(s.files(), 1u);
    }
}

TEST(Drivers, QuantizeChoosesTheSamples) {
    Scratch s;
    Image m = makeImage(2, 1, {"r", "g", "b"});
    m.data = {0, 0.25f, 1, 2, -1, 0.5f};
    DriverSetup u = setupFor(s, "tiff", "a.tif", m);
    u.rgba = {0, 65535, 0, 65535, 0};
    Diagnostics d;
    ASSERT_TRUE(writeDisplay(u, m, d));
    auto r = readImage(s / "a.tif", d);
    EXPECT_EQ(r->bits, 16);
    EXPECT_EQ(r->data, (std::vector<float>{0, 16384 / 65535.0f, 1, 1, 0, 32768 / 65535.0f}));
    u.rgba = {};
    ASSERT_TRUE(writeDisplay(u, m, d));
    r = readImage(s / "a.tif", d);
    EXPECT_TRUE(r->floating);
    EXPECT_EQ(r->data, m.data);
    u.rgba = {0, 127, 0, 127, 0}; // codes stand in the file as they are
    ASSERT_TRUE(writeDisplay(u, m, d));
    r = readImage(s / "a.tif", d);
    EXPECT_EQ(r->bits, 8);
    EXPECT_EQ(r->data[2], 127 / 255.0f);
    EXPECT_TRUE(d.all().empty()) << messages(d);
}

TEST(Drivers, DepthKeepsFloatsAndMatrices) {
    Scratch s;
    Image m = makeImage(2, 1, {"z"});
    m.data = {3.25f, 1e30f};
    DriverSetup u = setupFor(s, "zfile", "light.z", m);
    u.worldToCamera = translateMatrix(0, 0, 5);
    u.worldToNDC = perspectiveMatrix(40);
    Diagnostics d;
    ASSERT_TRUE(writeDisplay(u, m, d));
    auto r = readImage(s / "light.z", d);
    ASSERT_TRUE(r) << messages(d);
    EXPECT_EQ(r->channels, V{"z"});
    EXPECT_EQ(r->data, m.data);
    ASSERT_TRUE(r->worldToCamera && r->worldToNDC);
    EXPECT_EQ(*r->worldToCamera, translateMatrix(0, 0, 5));
    EXPECT_EQ(r->metadata["textureformat"], "Shadow");
    EXPECT_TRUE(d.all().empty()) << messages(d);
}

TEST(Drivers, NothingIsVisibleBeforeClose) {
    Scratch s;
    Image m = pattern(4, 4, {"r", "g", "b"});
    Diagnostics d;
    {
        auto driver = makeDriver("openexr", d);
        ASSERT_TRUE(driver->open(setupFor(s, "openexr", "a.exr", m), d));
        ASSERT_TRUE(driver->rows(2, 2, m.pixel(0, 2)));
        EXPECT_EQ(s.files(), 0u);
    }
    EXPECT_EQ(s.files(), 0u);
    auto driver = makeDriver("openexr", d);
    ASSERT_TRUE(driver->open(setupFor(s, "openexr", "a.exr", m), d));
    ASSERT_TRUE(driver->rows(2, 2, m.pixel(0, 2)));
    ASSERT_TRUE(driver->rows(0, 2, m.pixel(0, 0)));
    EXPECT_FALSE(driver->rows(3, 2, m.pixel(0, 0)));
    EXPECT_FALSE(driver->rows(-1, 1, m.pixel(0, 0)));
    ASSERT_TRUE(driver->close(d));
    ASSERT_TRUE(driver->close(d)); // progressive: again
    EXPECT_EQ(readImage(s / "a.exr", d)->data, m.data);
    EXPECT_EQ(s.files(), 1u);
}

TEST(Drivers, NullWritesNothingAndBadSizesAreRefused) {
    Scratch s;
    Image m = pattern(2, 2, {"r"});
    Diagnostics d;
    EXPECT_TRUE(writeDisplay(setupFor(s, "null", "x", m), m, d));
    EXPECT_EQ(s.files(), 0u);
    DriverSetup u = setupFor(s, "tiff", "x", m);
    u.width = 1 << 20;
    EXPECT_FALSE(makeDriver("tiff", d)->open(u, d));
    u.width = 0;
    EXPECT_FALSE(makeDriver("tiff", d)->open(u, d));
    EXPECT_EQ(d.errors(), 2);
}

TEST(Drivers, AnUnknownTypeIsSaidOnceAndWritesAPicture) {
    Scratch s;
    Image m = pattern(2, 2, {"r"});
    Diagnostics d;
    EXPECT_TRUE(writeDisplay(setupFor(s, "itsviewer", "x.tif", m), m, d));
    EXPECT_EQ(s.files(), 1u);
    EXPECT_EQ(d.all().size(), 1u) << messages(d);
    EXPECT_NE(messages(d).find("unknown display type"), std::string::npos);
    Diagnostics known; // a format that is known, but not written here
    EXPECT_TRUE(writeDisplay(setupFor(s, "targa", "y.tga", m), m, known));
    EXPECT_EQ(known.all().size(), 1u) << messages(known);
    EXPECT_NE(messages(known).find("is not available"), std::string::npos);
}

TEST(Drivers, DitherFollowsTheFullPicture) {
    Scratch s;
    Image whole = makeImage(8, 8, {"r"});
    for (float& v : whole.data) v = 100.5f / 255;
    DriverSetup u = setupFor(s, "tiff", "whole.tif", whole);
    u.rgba.dither = 0.5f;
    Diagnostics d;
    ASSERT_TRUE(writeDisplay(u, whole, d));
    Image crop = makeImage(3, 2, {"r"});
    for (float& v : crop.data) v = 100.5f / 255;
    DriverSetup c = setupFor(s, "tiff", "crop.tif", crop);
    c.rgba.dither = 0.5f;
    c.originX = 4;
    c.originY = 5;
    c.fullWidth = c.fullHeight = 8;
    ASSERT_TRUE(writeDisplay(c, crop, d));
    auto a = readImage(s / "whole.tif", d), b = readImage(s / "crop.tif", d);
    ASSERT_TRUE(a && b);
    for (int y = 0; y < 2; ++y)
        for (int x = 0; x < 3; ++x) EXPECT_EQ(b->pixel(x, y)[0], a->pixel(x + 4, y + 5)[0]);
}

TEST(Diff, ClosedForms) {
    Image a = makeImage(2, 2, {"r", "g"}), b = makeImage(2, 2, {"g", "r"});
    // r differs by 0, 3, -4, 0; g by nothing. The second picture has its channels in another order.
    float ra[] = {1, 2, 3, 4}, rb[] = {1, 5, -1, 4};
    for (int i = 0; i < 4; ++i) {
        a.data[size_t(2 * i)] = ra[i];
        b.data[size_t(2 * i + 1)] = rb[i];
        a.data[size_t(2 * i + 1)] = b.data[size_t(2 * i)] = 7;
    }
    Diagnostics d;
    auto r = compareImages(a, b, d);
    ASSERT_TRUE(r);
    EXPECT_DOUBLE_EQ(r->channels[0].meanAbs, 7.0 / 4);
    EXPECT_DOUBLE_EQ(r->channels[0].rmse, 2.5); // sqrt((9 + 16) / 4)
    EXPECT_DOUBLE_EQ(r->channels[0].max, 4);
    EXPECT_EQ(r->channels[0].maxX, 0);
    EXPECT_EQ(r->channels[0].maxY, 1);
    EXPECT_DOUBLE_EQ(r->channels[1].max, 0);
    EXPECT_DOUBLE_EQ(r->all.meanAbs, 7.0 / 8);
    EXPECT_EQ(r->difference.pixel(1, 0)[0], 3);
    EXPECT_TRUE(r->within(4));
    EXPECT_FALSE(r->within(3.9));
    EXPECT_NE(toString(*r).find("max 4 at 0,1"), std::string::npos);
}

TEST(Diff, NonFiniteAndSizes) {
    float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    Image a = makeImage(4, 1, {"y"}), b = a;
    a.data = {nan, inf, nan, 1};
    b.data = {nan, inf, 0, 1.5f};
    Diagnostics d;
    auto r = compareImages(a, b, d);
    ASSERT_TRUE(r);
    EXPECT_EQ(r->all.nonFinite, 1u);
    EXPECT_DOUBLE_EQ(r->all.max, 0.5);
    EXPECT_FALSE(r->within(100));
    EXPECT_FALSE(compareImages(a, makeImage(3, 1, {"y"}), d));
    EXPECT_FALSE(compareImages(a, makeImage(4, 1, {"y", "a"}), d));
    EXPECT_EQ(d.errors(), 2);
}

// The form that Pixar's programs have: magic, two sizes of 16 bits, world to screen, world to camera, depths; screen space is -1
// to 1, upward. What a crop window leaves out is far away.
TEST(Drivers, ZfilesHaveTheirForm) {
    Scratch s;
    Image m = makeImage(2, 1, {"z"});
    m.data = {3.25f, std::numeric_limits<float>::infinity()};
    DriverSetup u = setupFor(s, "zfile", "light.z", m);
    u.originX = 1, u.originY = 2, u.fullWidth = 4, u.fullHeight = 3;
    u.worldToCamera = translateMatrix(0, 0, 5);
    u.worldToNDC = scaleMatrix(0.5, -0.5, 1) * translateMatrix(0.5, 0.5, 0); // of the screen itself
    Diagnostics d;
    ASSERT_TRUE(writeDisplay(u, m, d)) << messages(d);
    std::ifstream in(s / "light.z", std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    ASSERT_EQ(bytes.size(), 8u + 2 * 64 + 4 * 12);
    const auto at = [&]<class T>(size_t i, T) {
        T v;
        std::memcpy(&v, bytes.data() + i, sizeof v);
        return v;
    };
    EXPECT_EQ(at(0, uint32_t(0)), 0x2f0867abu);
    EXPECT_EQ(at(4, uint16_t(0)), 4);
    EXPECT_EQ(at(6, uint16_t(0)), 3);
    for (size_t i = 0; i < 16; ++i) {
        EXPECT_EQ(at(8 + 4 * i, 0.f), i % 5 == 0 ? 1 : 0) << i;
        EXPECT_EQ(at(72 + 4 * i, 0.f), i % 5 == 0 ? 1 : i == 14 ? 5 : 0) << i;
    }
    for (size_t i = 0; i < 12; ++i) EXPECT_EQ(at(136 + 4 * i, 0.f), i == 9 ? 3.25f : 1e30f) << i;
    // OpenEXR where the name or the channels ask for it.
    for (const auto& [type, name] : {std::pair{"zfile", "light.exr"}, {"shadow", "light.shd"}}) {
        ASSERT_TRUE(writeDisplay(setupFor(s, type, name, m), m, d)) << messages(d);
        std::ifstream exr(s / name, std::ios::binary);
        EXPECT_EQ(exr.get(), 0x76) << name;
    }
}

} // namespace driver_test
