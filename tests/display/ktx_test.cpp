// KTX and KTX2 files written by the letter of their specifications: numbers, blocks of BC1 to BC7 against their formulas and
// against OpenImageIO's decoder of the same blocks in a DDS file, levels, cubes, zlib, and damage.
#include "base/half.h"
#include "base/limits.h"
#include "display/formats/blocks.h"
#include "support.h"
#include <cmath>
#include <random>
#include <zlib.h>

namespace ktx_test {

using namespace alpenglow;
using namespace alpenglow::display;
using namespace alpenglow::display::test;

namespace {

using Byte = std::vector<uint8_t>;

void put(Byte& b, uint64_t v, int bytes, bool big = false) {
    for (int i = 0; i < bytes; ++i) b.push_back(uint8_t(v >> (8 * (big ? bytes - 1 - i : i))));
}

struct Levels {
    uint32_t width = 1, height = 1, faces = 1, depth = 0, layers = 0;
    std::string orientation{};
    bool big = false;
};

Byte ktx1(uint32_t type, uint32_t size, uint32_t format, uint32_t internal, const Levels& l, const std::vector<Byte>& levels) {
    Byte b = {0xab, 'K', 'T', 'X', ' ', '1', '1', 0xbb, '\r', '\n', 0x1a, '\n'};
    std::string keys;
    if (!l.orientation.empty()) keys = "KTXorientation" + std::string(1, '\0') + l.orientation + std::string(1, '\0');
    for (const uint32_t v : {0x04030201u, type, size, format, internal, 0x1908u, l.width, l.height, l.depth, l.layers, l.faces,
                             uint32_t(levels.size()), uint32_t(keys.empty() ? 0 : 4 + (keys.size() + 3) / 4 * 4)})
        put(b, v, 4, l.big);
    if (!keys.empty()) {
        put(b, keys.size(), 4, l.big);
        b.insert(b.end(), keys.begin(), keys.end());
        while (b.size() % 4) b.push_back(0);
    }
    for (const Byte& level : levels) { // of a cube: all faces
        put(b, level.size() / l.faces, 4, l.big);
        b.insert(b.end(), level.begin(), level.end());
        while (b.size() % 4) b.push_back(0);
    }
    return b;
}

Byte ktx2(uint32_t format, const Levels& l, const std::vector<Byte>& levels, uint32_t packing = 0, uint8_t transfer = 0) {
    Byte b = {0xab, 'K', 'T', 'X', ' ', '2', '0', 0xbb, '\r', '\n', 0x1a, '\n'};
    for (const uint32_t v :
         {format, 1u, l.width, l.height, l.depth, l.layers, l.faces, uint32_t(levels.size()), packing, 0u, 0u, 0u, 0u})
        put(b, v, 4);
    put(b, 0, 8), put(b, 0, 8);
    const size_t index = b.size();
    b.resize(index + 24 * levels.size());
    const auto set = [&](size_t at, uint64_t v, int bytes) {
        for (int i = 0; i < bytes; ++i) b[at + size_t(i)] = uint8_t(v >> (8 * i));
    };
    set(48, b.size(), 4), set(52, 28, 4);
    const size_t about = b.size();
    b.resize(about + 28);
    b[about + 14] = transfer;
    if (!l.orientation.empty()) {
        set(56, b.size(), 4);
        const std::string key = "KTXorientation" + std::string(1, '\0') + l.orientation + std::string(1, '\0');
        set(60, 4 + key.size(), 4);
        put(b, key.size(), 4);
        b.insert(b.end(), key.begin(), key.end());
    }
    for (size_t i = 0; i < levels.size(); ++i) {
        Byte packed = levels[i];
        if (packing == 3) {
            packed.resize(compressBound(uLong(levels[i].size())));
            uLongf n = uLongf(packed.size());
            compress(packed.data(), &n, levels[i].data(), uLong(levels[i].size()));
            packed.resize(n);
        }
        set(index + 24 * i, b.size(), 8), set(index + 24 * i + 8, packed.size(), 8);
        set(index + 24 * i + 16, levels[i].size(), 8);
        b.insert(b.end(), packed.begin(), packed.end());
    }
    return b;
}

Image read(const Byte& b) {
    Diagnostics d;
    ReadOptions o;
    o.levels = true;
    auto m = decodeImage(b, "a.ktx", d, o);
    EXPECT_TRUE(m) << messages(d);
    return m ? *m : Image();
}

std::string refused(const Byte& b) {
    Diagnostics d;
    EXPECT_FALSE(decodeImage(b, "a.ktx", d));
    EXPECT_EQ(d.errors(), 1);
    return messages(d);
}

Byte counting(size_t n) {
    Byte b;
    for (size_t i = 0; i < n; ++i) b.push_back(uint8_t(7 * i + 3));
    return b;
}

/// Texels of one block by the decoder.
std::vector<std::array<float, 4>> texels(Block k, const Byte& b) {
    float t[16][4] = {};
    decodeBlock(k, b.data(), t);
    std::vector<std::array<float, 4>> all;
    for (const auto& x : t) all.push_back({x[0], x[1], x[2], x[3]});
    return all;
}

/// Writes fields of bits from the lowest on.
struct BitWriter {
    Byte b = Byte(16, 0);
    unsigned at = 0;
    BitWriter& operator()(unsigned v, unsigned n) {
        for (unsigned i = 0; i < n; ++i, ++at) b[at / 8] = uint8_t(b[at / 8] | (v >> i & 1) << (at % 8));
        return *this;
    }
};

} // namespace

TEST(Ktx, NumbersOfBothVersions) {
    const Byte rgb = counting(3 * 2 * 3);
    const auto code = [&](size_t i) { return float(rgb[i]) / 255; };
    const Image two = read(ktx2(23, {3, 2}, {rgb})), srgb = read(ktx2(29, {3, 2}, {rgb})),
                linear = read(ktx2(23, {3, 2}, {rgb}, 0, 1));
    Byte padded; // rows of KTX are multiples of four bytes
    for (size_t y = 0; y < 2; ++y) {
        padded.insert(padded.end(), rgb.begin() + long(9 * y), rgb.begin() + long(9 * y + 9));
        padded.insert(padded.end(), 3, 0);
    }
    const Image one = read(ktx1(0x1401, 1, 0x1907, 0x8051, {3, 2}, {padded}));
    const Image turned = read(ktx1(0x1401, 1, 0x80e0, 0x8051, {3, 2}, {padded}));
    const Image upward = read(ktx1(0x1401, 1, 0x1907, 0x8051, {.width = 3, .height = 2, .orientation = "S=r,T=u"}, {padded}));
    const Image upward2 = read(ktx2(23, {.width = 3, .height = 2, .orientation = "ru"}, {rgb}));
    for (const Image* m : {&one, &two, &srgb, &turned, &upward, &upward2}) {
        ASSERT_EQ(m->channels, (std::vector<std::string>{"r", "g", "b"}));
        EXPECT_EQ(m->bits, 8);
        EXPECT_FALSE(m->floating);
        for (int y = 0; y < 2; ++y)
            for (int x = 0; x < 3; ++x)
                for (int c = 0; c < 3; ++c) {
                    const int row = m == &upward || m == &upward2 ? 1 - y : y, channel = m == &turned ? 2 - c : c;
                    EXPECT_EQ(m->pixel(x, y)[c], code(size_t(9 * row + 3 * x + channel)));
                }
    }
    EXPECT_EQ(srgb.metadata.at("colorspace"), "sRGB");
    EXPECT_EQ(linear.metadata.at("colorspace"), "linear");
    EXPECT_EQ(two.metadata.count("colorspace"), 0u);
    Byte halves, floats, shorts, high;
    for (const float v : {.5f, -2.f, 65504.f, .1f}) put(halves, toHalf(v), 2), put(floats, std::bit_cast<uint32_t>(v), 4);
    for (const unsigned v : {0u, 1u, 32768u, 65535u}) put(shorts, v, 2), put(high, v, 2, true);
    const Image h = read(ktx2(97, {1, 1}, {halves})), f = read(ktx2(109, {1, 1}, {floats})), s = read(ktx2(91, {1, 1}, {shorts})),
                b = read(ktx1(0x1403, 2, 0x1908, 0x805b, {.big = true}, {high}));
    EXPECT_EQ(h.data, (std::vector<float>{.5f, -2.f, 65504.f, ofHalf(toHalf(.1f))}));
    EXPECT_EQ(f.data, (std::vector<float>{.5f, -2.f, 65504.f, .1f}));
    EXPECT_EQ(s.data, (std::vector<float>{0, 1 / 65535.f, 32768 / 65535.f, 1}));
    EXPECT_EQ(b.data, s.data);
    EXPECT_EQ(h.channels.back(), "a");
    EXPECT_TRUE(h.floating);
    EXPECT_EQ(s.bits, 16);
}

TEST(Ktx, LevelsCubesAndZlib) {
    const std::vector<Byte> levels = {counting(4 * 2 * 4), counting(2 * 4), counting(4)};
    for (const uint32_t packing : {0u, 3u}) {
        const Image m = read(ktx2(37, {4, 2}, levels, packing));
        ASSERT_EQ(m.levels.size(), 2u);
        EXPECT_EQ(m.levels[0].width, 2);
        EXPECT_EQ(m.levels[1].height, 1);
        EXPECT_EQ(m.levels[0].data[5], float(levels[1][5]) / 255);
    }
    ASSERT_EQ(read(ktx1(0x1401, 1, 0x1908, 0x8058, {4, 2}, levels)).levels.size(), 2u);
    const Byte faces = counting(6 * 2 * 2 * 4);
    for (const Byte& file : {ktx2(37, {.width = 2, .height = 2, .faces = 6}, {faces}),
                             ktx1(0x1401, 1, 0x1908, 0x8058, {.width = 2, .height = 2, .faces = 6}, {faces})}) {
        const Image m = read(file);
        EXPECT_EQ(m.height, 12);
        EXPECT_EQ(m.metadata.at("textureformat"), "CubeFace Environment");
        for (size_t i = 0; i < faces.size(); ++i) ASSERT_EQ(m.data[i], float(faces[i]) / 255);
    }
}

// S3TC and RGTC: two ends, and what lies between them.
TEST(Ktx, BlocksByTheirFormulas) {
    Byte ramp8 = {200, 40, 0, 0, 0, 0, 0, 0}, ramp6 = {40, 200, 0, 0, 0, 0, 0, 0};
    for (unsigned i = 0; i < 16; ++i) // texel i has index i mod 8
        for (unsigned k = 0; k < 3; ++k)
            for (Byte* b : {&ramp8, &ramp6})
                (*b)[2 + (3 * i + k) / 8] = uint8_t((*b)[2 + (3 * i + k) / 8] | (i % 8 >> k & 1) << ((3 * i + k) % 8));
    const auto eight = texels(Block::Bc4, ramp8), six = texels(Block::Bc4, ramp6);
    for (int i = 0; i < 8; ++i) {
        const float a = 200, b = 40, k = float(i - 1);
        EXPECT_NEAR(255 * eight[size_t(i)][0], i == 0 ? a : i == 1 ? b : ((7 - k) * a + k * b) / 7, 1e-3);
        EXPECT_NEAR(255 * six[size_t(i)][0],
                    i == 0   ? b
                    : i == 1 ? a
                    : i == 6 ? 0
                    : i == 7 ? 255
                             : ((5 - k) * b + k * a) / 5,
                    1e-3);
    }
    Byte colour = {0, 0, 0, 0, 0xe4, 0xe4, 0xe4, 0xe4}; // indices 0 1 2 3 in each row
    const auto ends = [&](unsigned a, unsigned b) {
        colour[0] = uint8_t(a), colour[1] = uint8_t(a >> 8), colour[2] = uint8_t(b), colour[3] = uint8_t(b >> 8);
    };
    ends(31u << 11 | 63u << 5, 31u); // yellow above blue: four colours
    const auto four = texels(Block::Bc1Alpha, colour);
    EXPECT_EQ(four[0], (std::array<float, 4>{1, 1, 0, 1}));
    EXPECT_EQ(four[1], (std::array<float, 4>{0, 0, 1, 1}));
    EXPECT_EQ(four[2], (std::array<float, 4>{170 / 255.f, 170 / 255.f, 85 / 255.f, 1}));
    EXPECT_EQ(four[7], (std::array<float, 4>{85 / 255.f, 85 / 255.f, 170 / 255.f, 1}));
    ends(31u, 31u << 11 | 63u << 5); // the other way round: three, and nothing
    const auto three = texels(Block::Bc1Alpha, colour);
    EXPECT_EQ(three[2], (std::array<float, 4>{128 / 255.f, 128 / 255.f, 128 / 255.f, 1}));
    EXPECT_EQ(three[3], (std::array<float, 4>{0, 0, 0, 0}));
    Byte two(8, 0);
    for (unsigned i = 0; i < 8; ++i) two[i] = uint8_t(2 * i | (2 * i + 1) << 4);
    two.insert(two.end(), colour.begin(), colour.end());
    const auto explicitAlpha = texels(Block::Bc2, two);
    for (size_t i = 0; i < 16; ++i) EXPECT_EQ(explicitAlpha[i][3], float(i) / 15);
    EXPECT_EQ(explicitAlpha[3][0], 170 / 255.f) << "always four colours";
    EXPECT_EQ(texels(Block::Bc4Signed, {129, 127, 0, 0, 0, 0, 0, 0})[0][0], -1.f);
}

// BPTC, mode 6 of BC7 (one subset, ends of 7 bits and one, indices of four bits) and mode 3 of BC6H (ends of ten bits).
TEST(Ktx, BptcBlocksByTheSpecification) {
    BitWriter seven;
    seven(64, 7)(10, 7)(100, 7)(20, 7)(110, 7)(30, 7)(120, 7)(127, 7)(64, 7)(1, 1)(0, 1);
    for (unsigned i = 0; i < 16; ++i) seven(i, i ? 4 : 3);
    const int factor[16] = {0, 4, 9, 13, 17, 21, 26, 30, 34, 38, 43, 47, 51, 55, 60, 64};
    const auto t = texels(Block::Bc7, seven.b);
    for (size_t i = 0; i < 16; ++i)
        for (size_t c = 0; c < 4; ++c) {
            const int a = 2 * std::array{10, 20, 30, 127}[c] + 1, b = 2 * std::array{100, 110, 120, 64}[c];
            EXPECT_EQ(t[i][c], float(((64 - factor[i]) * a + factor[i] * b + 32) >> 6) / 255) << i << " " << c;
        }
    BitWriter six;
    six(3, 5)(0, 10)(512, 10)(1023, 10)(1023, 10)(512, 10)(1, 10);
    for (unsigned i = 0; i < 16; ++i) six(i, i ? 4 : 3);
    const auto spread = [](int x) { return x == 0 ? 0 : x == 1023 ? 0xffff : ((x << 15) + 0x4000) >> 9; };
    const auto f = texels(Block::Bc6, six.b);
    for (size_t i = 0; i < 16; ++i)
        for (size_t c = 0; c < 3; ++c) {
            const int a = spread(std::array{0, 512, 1023}[c]), b = spread(std::array{1023, 512, 1}[c]);
            EXPECT_EQ(f[i][c], ofHalf(uint16_t((((64 - factor[i]) * a + factor[i] * b + 32) >> 6) * 31 >> 6)));
        }
    for (const Block k : {Block::Bc7, Block::Bc6}) // reserved modes
        EXPECT_EQ(texels(k, Byte(16, k == Block::Bc6 ? 19 : 0))[5], (std::array<float, 4>{0, 0, 0, 0}));
}

TEST(Ktx, WhatIsNotReadIsSaid) {
    const Byte four = counting(4);
    EXPECT_NE(refused(ktx2(37, {}, {four}, 2)).find("Zstandard"), std::string::npos);
    EXPECT_NE(refused(ktx2(0, {}, {four}, 1)).find("BasisLZ"), std::string::npos);
    EXPECT_NE(refused(ktx2(157, {}, {four})).find("Vulkan format 157"), std::string::npos);
    EXPECT_NE(refused(ktx2(37, {.depth = 3}, {four})).find("volume"), std::string::npos);
    EXPECT_NE(refused(ktx2(37, {.layers = 3}, {four})).find("array"), std::string::npos);
    EXPECT_NE(refused(ktx2(37, {.width = 2, .height = 1, .faces = 6}, {counting(48)})).find("square"), std::string::npos);
    EXPECT_NE(refused(ktx1(0, 1, 0, 0x93b0, {4, 4}, {counting(16)})).find("glInternalFormat"), std::string::npos);
    EXPECT_NE(refused(ktx1(0x8363, 2, 0x1907, 0x8d62, {}, {four})).find("glType"), std::string::npos);
    EXPECT_NE(refused(ktx2(37, {2, 2}, {four})).find("the size of a level does not match its pixels"), std::string::npos);
    refused(ktx2(37, {0, 1}, {four}));
    refused(ktx2(37, {4000000000u, 4000000000u}, {four}));
    refused(ktx2(131, {65536, 65536}, {four}));
    refused(ktx2(37, {65536, 65536}, {four}, 3));
}

TEST(Ktx, CutAndDamagedFilesAreErrorsOrPictures) {
    std::vector<Byte> files = {
        ktx2(145, {8, 8}, {counting(64), counting(16)}), ktx2(37, {4, 4}, {counting(64), counting(16)}, 3),
        ktx1(0x1401, 1, 0x1908, 0x8058, {.width = 2, .height = 2, .faces = 6, .orientation = "S=r,T=d"}, {counting(96)})};
    std::mt19937 random(1);
    for (const Byte& whole : files) {
        for (size_t n = 12; n + 4 < whole.size(); ++n) {
            Diagnostics d;
            ReadOptions o;
            o.levels = true;
            EXPECT_FALSE(decodeImage(std::span(whole).first(n), "a.ktx", d, o)) << n;
            EXPECT_EQ(d.errors(), 1) << n;
        }
        for (int trial = 0; trial < 1500; ++trial) {
            Byte b = whole;
            for (int k = 0; k < 1 + trial % 4; ++k) b[12 + random() % ((trial % 2 ? 100 : b.size()) - 12)] = uint8_t(random());
            Diagnostics d;
            if (const auto m = decodeImage(b, "a.ktx", d)) EXPECT_EQ(m->data.size(), m->sampleCount());
            else EXPECT_EQ(d.errors(), 1);
        }
    }
}

#ifdef ALPENGLOW_HAS_PICTURES
// The same random blocks in a DDS file, which OpenImageIO decodes.
TEST(Ktx, BlocksAreThoseOfAnotherDecoder) {
    constexpr uint32_t kSide = 64;
    const struct {
        uint32_t vulkan;
        const char* fourCC;
        uint32_t dxgi;
        Block block;
        float tolerance; // decoders of DDS round ends and colours in other ways
    } kinds[] = {{133, "DXT1", 0, Block::Bc1Alpha, 1.01f / 255},
                 {135, "DXT3", 0, Block::Bc2, 1.01f / 255},
                 {137, "DXT5", 0, Block::Bc3, 1.01f / 255},
                 {139, "ATI1", 0, Block::Bc4, 1.01f / 255},
                 {141, "ATI2", 0, Block::Bc5, 1.01f / 255},
                 {143, "DX10", 95, Block::Bc6, 1e-6f},
                 {145, "DX10", 98, Block::Bc7, 1e-6f}};
    std::mt19937 random(9);
    Scratch s;
    for (const auto& k : kinds) {
        Byte blocks;
        while (blocks.size() < bytesOf(k.block) * kSide * kSide / 16) {
            Byte one;
            for (size_t i = 0; i < bytesOf(k.block); ++i) one.push_back(uint8_t(random()));
            // No reserved modes; and modes evenly, of which high ones are rare.
            if (k.block == Block::Bc7) {
                const unsigned mode = random() % 8;
                one[0] = uint8_t((one[0] & ~((2u << mode) - 1)) | 1u << mode);
            } else if (k.block == Block::Bc6 && (one[0] & 3) == 3 && (one[0] & 16)) {
                continue;
            }
            blocks.insert(blocks.end(), one.begin(), one.end());
        }
        Byte dds;
        for (const char c : std::string("DDS ")) dds.push_back(uint8_t(c));
        for (const uint32_t v : {124u, 0x81007u, kSide, kSide, uint32_t(blocks.size()), 0u, 1u}) put(dds, v, 4);
        for (int i = 0; i < 11; ++i) put(dds, 0, 4);
        put(dds, 32, 4), put(dds, 4, 4);
        for (const char c : std::string(k.fourCC)) dds.push_back(uint8_t(c));
        for (int i = 0; i < 5; ++i) put(dds, 0, 4);
        for (const uint32_t v : {0x1000u, 0u, 0u, 0u, 0u}) put(dds, v, 4);
        if (k.dxgi)
            for (const uint32_t v : {k.dxgi, 3u, 0u, 1u, 0u}) put(dds, v, 4);
        dds.insert(dds.end(), blocks.begin(), blocks.end());
        putBytes(s / "a.dds", dds);
        Diagnostics d;
        const auto other = readImage(s / "a.dds", d);
        ASSERT_TRUE(other) << messages(d) << k.fourCC;
        const Image m = read(ktx2(k.vulkan, {kSide, kSide}, {blocks}));
        const int n = std::min(m.channelCount(), other->channelCount());
        float worst = 0;
        for (int y = 0; y < int(kSide); ++y)
            for (int x = 0; x < int(kSide); ++x) {
                const bool clear = m.channelCount() == 4 && m.pixel(x, y)[3] == 0; // of which decoders may forget the colour
                for (int c = clear ? 3 : 0; c < n; ++c)
                    worst = std::max(worst, std::fabs(m.pixel(x, y)[c] - other->pixel(x, y)[c]));
            }
        EXPECT_LE(worst, k.tolerance) << k.vulkan;
    }
}
#endif

} // namespace ktx_test
