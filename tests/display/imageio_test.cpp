// Pictures survive writing and reading; damaged ones are refused without harm.
#include "base/limits.h"
#include "support.h"
#include <bit>
#include <cmath>
#include <limits>
#include <set>

namespace imageio_test {

using namespace alpenglow;
using namespace alpenglow::display;
using namespace alpenglow::display::test;

namespace {

Image roundTrip(const Scratch& s, const Image& m, WriteOptions o, const std::string& name = "a.pic") {
    Diagnostics d;
    o.policy = s.policy();
    EXPECT_TRUE(writeImage(name, m, o, d)) << messages(d);
    auto r = readImage(s / name, d);
    EXPECT_TRUE(r) << messages(d);
    EXPECT_TRUE(d.all().empty()) << messages(d);
    EXPECT_EQ(s.files(), 1u);
    return r ? *r : Image{};
}

WriteOptions as(Format f, Sample sample, bool quantised = false, const std::string& compression = "zip") {
    WriteOptions o;
    o.format = f;
    o.sample = sample;
    o.quantised = quantised;
    o.compression = compression;
    return o;
}

void expectSame(const Image& a, const Image& b) {
    EXPECT_EQ(a.width, b.width);
    EXPECT_EQ(a.height, b.height);
    EXPECT_EQ(a.channels, b.channels);
    EXPECT_EQ(a.data, b.data);
}

using V = std::vector<std::string>;

} // namespace

TEST(ImageIo, FloatFormatsAreExact) {
    Scratch s;
    Image m = pattern(37, 19, {"r", "g", "b", "a"});
    m.pixel(3, 2)[0] = 1e30f;
    m.pixel(4, 2)[1] = -2.5f;
    m.pixel(5, 2)[2] = std::numeric_limits<float>::infinity();
    m.pixel(6, 2)[3] = std::numeric_limits<float>::denorm_min();
    for (const char* c : {"none", "rle", "zips", "zip", "piz"})
        expectSame(roundTrip(s, m, as(Format::Exr, Sample::Float, false, c)), m);
    for (const char* c : {"none", "zip", "lzw", "packbits"}) {
        Image r = roundTrip(s, m, as(Format::Tiff, Sample::Float, false, c));
        expectSame(r, m);
        EXPECT_TRUE(r.floating);
        EXPECT_EQ(r.bits, 32);
    }
}

TEST(ImageIo, HalfRoundsToElevenBits) {
    Scratch s;
    Image m = pattern(16, 16, {"r", "g", "b"});
    Image r = roundTrip(s, m, as(Format::Exr, Sample::Half));
    EXPECT_EQ(r.bits, 16);
    for (size_t i = 0; i < m.data.size(); ++i)
        EXPECT_NEAR(r.data[i], m.data[i], m.data[i] / 2048 + 1e-7f); // half: 11 significant bits
    m.pixel(0, 0)[0] = 2048;                                         // exact in half
    EXPECT_EQ(roundTrip(s, m, as(Format::Exr, Sample::Half)).pixel(0, 0)[0], 2048.0f);
}

TEST(ImageIo, IntegerFormatsKeepEveryCode) {
    Scratch s;
    for (Format f : {Format::Tiff, Format::Png})
        for (int n = 1; n <= 4; ++n) {
            Image m = pattern(33, 17, defaultChannels(n)); // k/255: exact in 8 bits, and k*257/65535 in 16
            Image r = roundTrip(s, m, as(f, Sample::UInt8));
            expectSame(r, m);
            EXPECT_FALSE(r.floating);
            EXPECT_EQ(r.bits, 8);
            r = roundTrip(s, m, as(f, Sample::UInt16));
            EXPECT_EQ(r.bits, 16);
            for (size_t i = 0; i < m.data.size(); ++i) EXPECT_EQ(r.data[i], std::round(m.data[i] * 65535.0f) / 65535.0f);
        }
}

TEST(ImageIo, CodesAreWrittenAsTheyAre) {
    Scratch s;
    for (Format f : {Format::Tiff, Format::Png}) {
        Image m = makeImage(3, 1, {"y"});
        m.data = {0, 127, 300}; // the last is clamped
        Image r = roundTrip(s, m, as(f, Sample::UInt8, true));
        EXPECT_EQ(r.data, (std::vector<float>{0, 127 / 255.0f, 1}));
        m.data = {1, 40000, std::numeric_limits<float>::quiet_NaN()};
        r = roundTrip(s, m, as(f, Sample::UInt16, true));
        EXPECT_EQ(r.data, (std::vector<float>{1 / 65535.0f, 40000 / 65535.0f, 0}));
    }
}

TEST(ImageIo, TopRowFirst) {
    Scratch s;
    Image m = makeImage(2, 3, {"r", "g", "b"});
    m.pixel(1, 0)[0] = 1; // top right is red
    for (const auto& o : {as(Format::Exr, Sample::Float), as(Format::Tiff, Sample::UInt8), as(Format::Png, Sample::UInt8)})
        expectSame(roundTrip(s, m, o), m);
}

TEST(ImageIo, NamedChannelsInNaturalOrder) {
    Scratch s;
    V names{"r", "g", "b", "a", "z", "N.x", "N.y", "N.z", "spec.r", "spec.g", "spec.b"};
    Image m = pattern(5, 4, names);
    expectSame(roundTrip(s, m, as(Format::Exr, Sample::Float)), m);
    expectSame(roundTrip(s, m, as(Format::Tiff, Sample::Float)), m);
    Image z = pattern(5, 4, {"z"});
    expectSame(roundTrip(s, z, as(Format::Exr, Sample::Float)), z);
    expectSame(roundTrip(s, z, as(Format::Tiff, Sample::Float)), z);
}

TEST(ImageIo, MetadataMatricesAndCrop) {
    Scratch s;
    Image m = pattern(6, 5, {"r", "g", "b"});
    m.metadata = {{"Software", "Alpenglow"}, {"wrapmodes", "periodic,clamp"}};
    m.worldToCamera = translateMatrix(1, 2, 3);
    m.worldToNDC = perspectiveMatrix(90);
    m.originX = 10;
    m.originY = 20;
    m.fullWidth = 64;
    m.fullHeight = 48;
    for (const auto& o : {as(Format::Exr, Sample::Float), as(Format::Tiff, Sample::UInt8)}) {
        Image r = roundTrip(s, m, o);
        EXPECT_EQ(r.metadata["Software"], "Alpenglow");
        EXPECT_EQ(r.metadata["wrapmodes"], "periodic,clamp");
        ASSERT_TRUE(r.worldToCamera && r.worldToNDC);
        EXPECT_EQ(*r.worldToCamera, *m.worldToCamera);
        EXPECT_NEAR(r.worldToNDC->m[0][0], m.worldToNDC->m[0][0], 1e-6);
        EXPECT_EQ(r.originX, 10);
        EXPECT_EQ(r.originY, 20);
        EXPECT_EQ(r.fullWidth, 64);
        EXPECT_EQ(r.fullHeight, 48);
    }
    Image r = roundTrip(s, m, as(Format::Png, Sample::UInt8));
    EXPECT_EQ(r.metadata["Software"], "Alpenglow");
}

TEST(ImageIo, FormatIsRecognisedByContent) {
    Scratch s;
    Image m = pattern(4, 4, {"r", "g", "b"});
    expectSame(roundTrip(s, m, as(Format::Tiff, Sample::UInt8), "wood.tex"), m);
    std::filesystem::remove(s / "wood.tex");
    expectSame(roundTrip(s, m, as(Format::Exr, Sample::Float), "wood.tif"), m);
    EXPECT_EQ(formatOfExtension("a/b.EXR"), Format::Exr);
    EXPECT_EQ(formatOfExtension("x.tiff"), Format::Tiff);
    EXPECT_FALSE(formatOfExtension("x.pic"));
    EXPECT_FALSE(formatOfExtension("x"));
}

TEST(ImageIo, PngLeavesOutWhatItCannotHoldAndSaysSo) {
    Scratch s;
    Diagnostics d;
    auto o = as(Format::Png, Sample::UInt8);
    o.policy = s.policy();
    EXPECT_TRUE(writeImage("a.png", pattern(3, 3, {"r", "g", "b", "z"}), o, d));
    EXPECT_EQ(d.warnings(), 1);
    EXPECT_NE(messages(d).find('z'), std::string::npos);
    auto r = readImage(s / "a.png", d);
    ASSERT_TRUE(r);
    EXPECT_EQ(r->channels, (V{"r", "g", "b"}));
}

TEST(ImageIo, ZfileBothByteOrders) {
    Scratch s;
    for (bool big : {true, false}) {
        std::vector<uint8_t> b;
        auto put = [&](uint32_t v, int n) {
            for (int i = 0; i < n; ++i) b.push_back(uint8_t(v >> 8 * (big ? n - 1 - i : i)));
        };
        put(0x2f0867ab, 4);
        put(2, 2);
        put(1, 2);
        for (int i = 0; i < 32; ++i) put(std::bit_cast<uint32_t>(float(i)), 4);
        put(std::bit_cast<uint32_t>(7.5f), 4);
        put(std::bit_cast<uint32_t>(1e30f), 4);
        Diagnostics d;
        auto m = decodeImage(b, "z", d);
        ASSERT_TRUE(m) << messages(d);
        EXPECT_EQ(m->channels, V{"z"});
        EXPECT_EQ(m->data, (std::vector<float>{7.5f, 1e30f}));
        EXPECT_EQ(m->worldToNDC->m[1][2], 6);
        EXPECT_EQ(m->worldToNDC->m[0][0], 1.5); // x' = (x + w) / 2 with the file's row 0 1 2 3
        EXPECT_EQ(m->worldToNDC->m[0][1], 1);   // y' = (w - y) / 2
        EXPECT_EQ(m->worldToCamera->m[0][1], 17);
        b.pop_back();
        EXPECT_FALSE(decodeImage(b, "z", d));
        EXPECT_EQ(d.errors(), 1);
    }
}

TEST(ImageIo, Radiance) {
    std::string head = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n";
    std::vector<uint8_t> b(head.begin(), head.end());
    for (int v : {128, 64, 0, 129, 0, 0, 0, 0}) b.push_back(uint8_t(v));
    Diagnostics d;
    auto m = decodeImage(b, "probe", d);
    ASSERT_TRUE(m) << messages(d);
    EXPECT_EQ(m->data, (std::vector<float>{1, 0.5f, 0, 0, 0, 0})); // mantissa/256 * 2^(129-128)
}

TEST(ImageIo, UnknownAndNativeFilesAreNamed) {
    Diagnostics d;
    EXPECT_FALSE(decodeImage(std::vector<uint8_t>{}, "empty", d));
    EXPECT_FALSE(decodeImage(std::vector<uint8_t>{0xfa, 0xce, 1, 2}, "native.tex", d));
    EXPECT_FALSE(decodeImage(std::vector<uint8_t>{0xce, 0xfa, 1, 2}, "native.tex", d));
    EXPECT_FALSE(decodeImage(std::vector<uint8_t>{'h', 'e', 'l', 'l', 'o'}, "text", d));
    EXPECT_FALSE(readImage("/nonexistent/file.tif", d));
    EXPECT_EQ(d.errors(), 5);
    EXPECT_NE(d.all()[1].message.find("truncated"), std::string::npos);
    EXPECT_NE(d.all()[3].message.find("Pixar"), std::string::npos); // the known formats
    EXPECT_EQ(d.all()[4].code, Rie::NoFile);
}

TEST(ImageIo, WriterRefusesNonsense) {
    Scratch s;
    WriteOptions o;
    o.policy = s.policy();
    Diagnostics d;
    EXPECT_FALSE(writeImage("a.exr", Image{}, o, d));
    Image m = pattern(2, 2, {"r", "r"});
    EXPECT_FALSE(writeImage("a.exr", m, o, d));
    m = pattern(2, 2, {"r"});
    m.data.pop_back();
    EXPECT_FALSE(writeImage("a.exr", m, o, d));
    EXPECT_EQ(d.errors(), 3);
    EXPECT_EQ(s.files(), 0u);
}

TEST(ImageIo, EveryFailingWriteKeepsTheOldFile) {
    Scratch s;
    Image m = pattern(40, 40, {"r", "g", "b"});
    for (auto o : {as(Format::Exr, Sample::Float), as(Format::Tiff, Sample::UInt8), as(Format::Png, Sample::UInt8)}) {
        putBytes(s / "a.pic", {'o', 'l', 'd'});
        o.policy = s.policy();
        o.policy.allowWrite = true; // the old file is no picture
        int failures = 0;
        for (int64_t n = 0; n < 8000; n += 97) {
            Diagnostics d;
            o.policy.failAfterBytes = n;
            if (writeImage("a.pic", m, o, d)) break; // enough room
            ++failures;
            EXPECT_EQ(d.errors(), 1) << messages(d);
            EXPECT_EQ(bytesOf(s / "a.pic").size(), 3u);
            EXPECT_EQ(s.files(), 1u);
        }
        EXPECT_GT(failures, 1);
    }
}

// ---- hostile files ----

namespace {

struct Seed {
    std::string name;
    std::vector<uint8_t> bytes;
};

std::vector<Seed> seeds(const Scratch& s) {
    std::vector<Seed> out;
    Diagnostics d;
    auto add = [&](const std::string& name, const Image& m, WriteOptions o) {
        o.policy = s.policy();
        EXPECT_TRUE(writeImage("seed", m, o, d)) << messages(d);
        out.push_back({name, bytesOf(s / "seed")});
    };
    Image m = pattern(9, 7, {"r", "g", "b"});
    for (const char* c : {"none", "rle", "zip", "piz"}) add(std::string("exr ") + c, m, as(Format::Exr, Sample::Float, false, c));
    auto tiled = as(Format::Exr, Sample::Half);
    tiled.tile = 4;
    Image mip = m;
    for (auto [w, h] : {std::pair{4, 3}, {2, 1}, {1, 1}}) mip.levels.push_back(pattern(w, h, m.channels));
    add("exr mip", mip, tiled);
    for (const char* c : {"none", "zip", "lzw", "packbits"})
        add(std::string("tiff ") + c, m, as(Format::Tiff, Sample::UInt8, false, c));
    add("png", m, as(Format::Png, Sample::UInt8));
    return out;
}

} // namespace

TEST(HostileImage, EveryPrefix) {
    Scratch s;
    ReadOptions levels;
    levels.levels = true;
    for (const Seed& seed : seeds(s)) {
        Diagnostics whole;
        EXPECT_TRUE(decodeImage(seed.bytes, seed.name, whole, levels)) << seed.name << messages(whole);
        for (size_t n = 0; n < seed.bytes.size(); ++n) {
            Diagnostics d;
            std::vector<uint8_t> cut(seed.bytes.begin(),
                                     seed.bytes.begin() + std::ptrdiff_t(n)); // exact size, for the address sanitizer
            auto m = decodeImage(cut, seed.name, d, levels);
            if (!m) EXPECT_EQ(d.errors(), 1) << seed.name << " " << n; // refused means said
        }
        // Half a file never passes for a whole one.
        Diagnostics d;
        EXPECT_FALSE(decodeImage(std::span(seed.bytes).first(seed.bytes.size() / 2), seed.name, d, levels)) << seed.name;
    }
}

TEST(HostileImage, EveryByteDamaged) {
    Scratch s;
    ReadOptions levels;
    levels.levels = true;
    size_t refused = 0;
    for (const Seed& seed : seeds(s))
        for (size_t n = 0; n < seed.bytes.size(); ++n)
            for (uint8_t flip : {uint8_t(0xff), uint8_t(0x01), uint8_t(0x80)}) {
                std::vector<uint8_t> b = seed.bytes;
                b[n] ^= flip;
                Diagnostics d;
                auto m = decodeImage(b, seed.name, d, levels);
                if (!m) {
                    ++refused;
                    EXPECT_GE(d.errors(), 1) << seed.name << " " << n;
                } else {
                    EXPECT_EQ(m->data.size(), m->sampleCount()) << seed.name << " " << n;
                }
            }
    EXPECT_GT(refused, 100u);
}

TEST(HostileImage, HugeDimensionsAreRefusedBeforeAllocation) {
    Scratch s;
    for (const Seed& seed : seeds(s)) {
        // Overwrite every place that holds the width or the height by numbers that would take gigabytes.
        for (uint32_t big : {65000u, 70000u, 0x7fffffffu, 0xffffffffu})
            for (size_t n = 0; n + 4 <= seed.bytes.size(); ++n) {
                std::vector<uint8_t> b = seed.bytes;
                bool little = seed.name != "png";
                for (size_t i = 0; i < 4; ++i) b[n + i] = uint8_t(big >> 8 * (little ? i : 3 - i));
                Diagnostics d;
                auto m = decodeImage(b, seed.name, d);
                if (m) EXPECT_LE(m->data.size() * sizeof(float), limits::kImageSmallBytes) << seed.name << " " << n;
            }
    }
}

TEST(HostileImage, JpegPrefixesAndDamage) {
    // A 1x1 grey baseline JPEG with the standard luminance tables' shape is long to spell; a header alone must be refused.
    std::vector<uint8_t> b{0xff, 0xd8, 0xff, 0xe0, 0,    16, 'J', 'F', 'I',  'F',  0,    1,    1, 0, 0,    1, 0,
                           1,    0,    0,    0xff, 0xc0, 0,  11,  8,   0xff, 0xff, 0xff, 0xff, 1, 1, 0x11, 0};
    for (size_t n = 3; n <= b.size(); ++n) {
        Diagnostics d;
        EXPECT_FALSE(decodeImage(std::span(b).first(n), "j", d));
        EXPECT_EQ(d.errors(), 1);
    }
}

} // namespace imageio_test
