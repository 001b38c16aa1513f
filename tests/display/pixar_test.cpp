// Pixar's native textures: files by a writer of our own in every coding, the published samples, and damage to both.
#include "pixar_writer.h"
#include "support.h"
#include <array>
#include <cmath>
#include <random>

namespace pixar_test {

using namespace alpenglow;
using namespace alpenglow::display;
using namespace alpenglow::display::test;

namespace {

const std::string samples = std::string(ALPENGLOW_SOURCE_DIR) + "/../shared/pixar_textures/";

/// Codes 0..255: even areas, ramps, and few values in places, so that every coding has something to do.
Image codePicture(int w, int h, int channels) {
    Image m = makeImage(w, h, defaultChannels(channels));
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x)
            for (int c = 0; c < channels; ++c)
                m.pixel(x, y)[c] =
                    float(x * 2 < w ? (y * 2 < h ? 17 + c : (x + y) & 255) : (x / 3 % 5) * 40 + c + (y * 2 < h ? y * x % 7 : 0));
    return m;
}

Image depthPicture(int w, int h) {
    Image m = makeImage(w, h, {"z"});
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x) m.pixel(x, y)[0] = x * 2 < w ? 1e30f : 3 + 0.25f * float(x) + 0.001f * float(y * y);
    return m;
}

std::optional<Image> decoded(const ByteList& b, Diagnostics& d, bool levels = true) {
    ReadOptions o;
    o.levels = levels;
    return decodeImage(b, "a.tx", d, o);
}

/// What the reader shall give for what the writer was given.
void expectPixels(const Image& got, const Image& codes, bool floats) {
    ASSERT_EQ(got.width, codes.width);
    ASSERT_EQ(got.height, codes.height);
    ASSERT_EQ(got.channels, codes.channels);
    size_t wrong = 0;
    for (size_t i = 0; i < codes.data.size(); ++i) wrong += got.data[i] != (floats ? codes.data[i] : codes.data[i] / 255.0f);
    EXPECT_EQ(wrong, 0u);
}

/// RFC 1321, section 3.
std::string md5(ByteList b) {
    static constexpr int turns[4][4] = {{7, 12, 17, 22}, {5, 9, 14, 20}, {4, 11, 16, 23}, {6, 10, 15, 21}};
    std::array<uint32_t, 4> state{0x67452301, 0xefcdab89, 0x98badcfe, 0x10325476};
    const uint64_t bits = uint64_t(b.size()) * 8;
    b.push_back(0x80);
    while (b.size() % 64 != 56) b.push_back(0);
    for (int k = 0; k < 8; ++k) b.push_back(uint8_t(bits >> 8 * k));
    for (size_t at = 0; at < b.size(); at += 64) {
        auto [A, B, C, D] = state;
        for (uint32_t i = 0; i < 64; ++i) {
            const uint32_t f = i < 16 ? (B & C) | (~B & D) : i < 32 ? (D & B) | (~D & C) : i < 48 ? B ^ C ^ D : C ^ (B | ~D);
            const uint32_t g = (i < 16 ? i : i < 32 ? 5 * i + 1 : i < 48 ? 3 * i + 5 : 7 * i) % 16;
            uint32_t word = 0;
            for (uint32_t k = 0; k < 4; ++k) word |= uint32_t(b[at + 4 * g + k]) << 8 * k;
            const uint32_t sum = A + f + word + uint32_t(std::floor(std::fabs(std::sin(double(i + 1))) * 4294967296.0));
            A = D;
            D = C;
            C = B;
            B += std::rotl(sum, turns[i / 16][i % 4]);
        }
        state = {state[0] + A, state[1] + B, state[2] + C, state[3] + D};
    }
    std::string text;
    for (uint32_t s : state)
        for (int k = 0; k < 4; ++k) {
            char two[3];
            std::snprintf(two, sizeof two, "%02x", s >> 8 * k & 255);
            text += two;
        }
    return text;
}

/// Samples as the list of checksums has them: codes, or floats little-endian.
void append(ByteList& to, const Image& m) {
    for (float v : m.data) {
        if (m.bits == 8) to.push_back(uint8_t(std::lround(v * 255)));
        else
            for (int k = 0; k < 4; ++k) to.push_back(uint8_t(std::bit_cast<uint32_t>(v) >> 8 * k));
    }
}

std::optional<Image> sample(const char* name) {
    Diagnostics d;
    ReadOptions o;
    o.levels = true;
    auto m = readImage(samples + name, d, o);
    EXPECT_TRUE(m) << messages(d);
    EXPECT_TRUE(d.all().empty()) << messages(d);
    return m;
}

std::vector<ByteList> damageSeeds() {
    std::vector<ByteList> seeds;
    for (Coding how : {Coding::Raw, Coding::Constant, Coding::Runs, Coding::Lzw, Coding::Huffman, Coding::Zlib}) {
        PixarFile f;
        f.coding = [how](int) { return how; };
        f.big = how != Coding::Runs;
        f.levels = withCodeLevels(codePicture(32, 16, 2));
        seeds.push_back(f.bytes());
    }
    PixarFile shadow;
    shadow.floats = true;
    shadow.type = 2;
    shadow.levels = {depthPicture(32, 32)};
    shadow.matrices.assign(32, 0.5f);
    shadow.coding = [](int) { return Coding::Zlib; };
    seeds.push_back(shadow.bytes());
    PixarFile old;
    old.version = 2;
    old.big = false;
    old.levels = withCodeLevels(codePicture(16, 16, 1), 4);
    seeds.push_back(old.bytes());
    for (const char* name : {"rmemboss.tx", "shad17.shd"})
        if (std::filesystem::exists(samples + name)) seeds.push_back(bytesOf(samples + name));
    return seeds;
}

} // namespace

TEST(PixarNative, EveryCodingInBothByteOrders) {
    for (bool big : {true, false})
        for (bool floats : {false, true})
            for (Coding how : {Coding::Raw, Coding::Runs, Coding::Lzw, Coding::Huffman, Coding::Zlib})
                for (auto [w, h] : {std::pair(128, 128), {16, 16}, {256, 64}, {1, 8}}) {
                    SCOPED_TRACE(testing::Message() << big << floats << int(how) << " " << w << "x" << h);
                    PixarFile f;
                    f.big = big;
                    f.floats = floats;
                    f.coding = [how](int) { return how; };
                    f.levels = withCodeLevels(codePicture(w, h, 3));
                    Diagnostics d;
                    auto m = decoded(f.bytes(), d);
                    ASSERT_TRUE(m) << messages(d);
                    expectPixels(*m, f.levels[0], floats);
                    EXPECT_EQ(m->bits, floats ? 32 : 8);
                    EXPECT_EQ(m->floating, floats);
                    ASSERT_EQ(m->levels.size() + 1, f.levels.size());
                    for (size_t i = 1; i < f.levels.size(); ++i) expectPixels(m->levels[i - 1], f.levels[i], floats);
                    EXPECT_EQ(m->metadata["textureformat"], "Plain Texture");
                    EXPECT_EQ(m->metadata["wrapmodes"], "black,black");
                    EXPECT_TRUE(decoded(f.bytes(), d, false)->levels.empty());
                }
}

TEST(PixarNative, ConstantTilesAndMixedCodings) {
    for (bool big : {true, false})
        for (bool floats : {false, true}) {
            PixarFile f;
            f.big = big;
            f.floats = floats;
            Image m = codePicture(256, 128, 2);
            for (int y = 0; y < 64; ++y) // whole tiles of one value
                for (int x = 0; x < 64; ++x) m.pixel(x, y)[0] = 99, m.pixel(x, y)[1] = 7;
            f.levels = {m};
            const int across = floats ? 8 : 4, tiles = across * (floats ? 4 : 2);
            f.coding = [=](int n) {
                const int x = n % tiles % across, y = n % tiles / across, even = floats ? 2 : 1;
                static constexpr Coding others[] = {Coding::Zlib, Coding::Huffman, Coding::Runs, Coding::Raw, Coding::Lzw};
                return x < even && y < even ? Coding::Constant : others[n % 5];
            };
            Diagnostics d;
            auto got = decoded(f.bytes(), d);
            ASSERT_TRUE(got) << messages(d);
            expectPixels(*got, m, floats);
        }
}

TEST(PixarNative, VersionTwoAndUncompressedVersionThree) {
    for (bool big : {true, false})
        for (int version : {2, 3})
            for (bool floats : {false, true}) {
                PixarFile f;
                f.big = big;
                f.version = version;
                f.floats = floats;
                f.compressedFlag = false;
                f.wrap[0] = 3;
                f.wrap[1] = 2;
                f.levels = withCodeLevels(codePicture(128, 64, 4), 4); // the tables of version 2 end at 4
                Diagnostics d;
                auto m = decoded(f.bytes(), d);
                ASSERT_TRUE(m) << messages(d);
                expectPixels(*m, f.levels[0], floats);
                ASSERT_EQ(m->levels.size(), 4u);
                expectPixels(m->levels[3], f.levels[4], floats);
                EXPECT_EQ(m->metadata["wrapmodes"], "periodic,clamp");
            }
}

TEST(PixarNative, WorkedExamplesOfTheCodings) {
    // Tiles of published files, as the description of the layout prints them. Runs: 03 67 03 92 03 c5 03 f0.
    PixarFile f;
    f.levels = {codePicture(4, 4, 1)};
    ByteList b = f.bytes();
    const size_t tile = b.size() - 16; // its code lies before it
    const auto with = [&](int mode, const ByteList& body) {
        ByteList file(b.begin(), b.begin() + std::ptrdiff_t(tile));
        file.insert(file.end(), body.begin(), body.end());
        const unsigned code = unsigned(mode) << 13 | unsigned(body.size());
        file[tile - 2] = uint8_t(code >> 8);
        file[tile - 1] = uint8_t(code);
        return file;
    };
    Diagnostics d;
    auto m = decoded(with(2, {0x03, 0x67, 0x03, 0x92, 0x03, 0xc5, 0x03, 0xf0}), d);
    ASSERT_TRUE(m) << messages(d);
    for (size_t i = 0; i < 16; ++i) EXPECT_EQ(m->data[i], float(std::array{0x67, 0x92, 0xc5, 0xf0}[i / 4]) / 255.0f) << i;
    // LZW: codes c5 ff 102 103 fa f3 fc, nine bits each: c5 ff ff ff ff ff ff fa f3 fc.
    m = decoded(with(3, {0xc5, 0xfe, 0x09, 0x1c, 0xa8, 0x6f, 0x1e, 0x3f, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00}), d);
    ASSERT_TRUE(m) << messages(d);
    const int values[] = {0xc5, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xfa, 0xf3, 0xfc};
    for (size_t i = 0; i < 10; ++i) EXPECT_EQ(m->data[i], float(values[i]) / 255.0f) << i;
    EXPECT_TRUE(d.all().empty()) << messages(d);
}

TEST(PixarNative, ShadowMapsHaveTheirMatrices) {
    for (bool big : {true, false})
        for (int version : {2, 3}) {
            PixarFile f;
            f.big = big;
            f.version = version;
            f.floats = true;
            f.type = 2;
            f.coding = [](int n) { return n % 2 ? Coding::Zlib : Coding::Runs; };
            f.levels = {depthPicture(64, 32)};
            for (int i = 0; i < 32; ++i) f.matrices.push_back(float(i) * 0.5f - 3);
            Diagnostics d;
            auto m = decoded(f.bytes(), d);
            ASSERT_TRUE(m) << messages(d);
            expectPixels(*m, f.levels[0], true);
            EXPECT_EQ(m->metadata["textureformat"], "Shadow");
            ASSERT_TRUE(m->worldToCamera && m->worldToNDC);
            for (int i = 0; i < 16; ++i) {
                EXPECT_EQ(m->worldToCamera->m[i / 4][i % 4], double(i + 16) * 0.5 - 3);
                // NDC is x / 2 + w / 2, w / 2 - y / 2 of the screen.
                const auto screen = [&](int column) { return double(i / 4 * 4 + column) * 0.5 - 3; };
                const double ndc[4] = {(screen(0) + screen(3)) / 2, (screen(3) - screen(1)) / 2, screen(2), screen(3)};
                EXPECT_NEAR(m->worldToNDC->m[i / 4][i % 4], ndc[i % 4], 1e-12);
            }
        }
}

TEST(PixarNative, UnknownVariantsAreClearErrors) {
    PixarFile f;
    f.levels = {codePicture(8, 8, 1)};
    const ByteList good = f.bytes();
    const auto messageOf = [&](size_t at, uint8_t value) {
        ByteList b = good;
        b[at] = value;
        Diagnostics d;
        EXPECT_FALSE(decoded(b, d)) << at;
        EXPECT_EQ(d.errors(), 1);
        EXPECT_NE(messages(d).find("a.tx"), std::string::npos);
        return messages(d);
    };
    EXPECT_NE(messageOf(8, 4).find("six pictures"), std::string::npos); // cube faces
    EXPECT_NE(messageOf(3, 4).find("version 4"), std::string::npos);
    EXPECT_NE(messageOf(0x14, 2).find("16 bits"), std::string::npos);
    const size_t code = good.size() - 64 - 2; // of the only tile
    EXPECT_NE(messageOf(code, 4 << 5).find("coding 4"), std::string::npos);
    EXPECT_NE(messageOf(code, 7 << 5).find("coding 7"), std::string::npos);
    EXPECT_NE(messageOf(18, 9).find("damaged"), std::string::npos);  // channels
    EXPECT_NE(messageOf(13, 15).find("damaged"), std::string::npos); // a width beyond the tables
    EXPECT_NE(messageOf(13, 4).find("missing"), std::string::npos);  // a level that is not there
    ByteList wrap = good;
    wrap[16] = 9;
    Diagnostics d;
    auto m = decoded(wrap, d);
    ASSERT_TRUE(m);
    EXPECT_EQ(d.warnings(), 1);
    EXPECT_EQ(m->metadata["wrapmodes"], "black,black");
}

TEST(PixarNative, PublishedSamples) {
    if (!std::filesystem::exists(samples)) GTEST_SKIP() << samples << " is not there";
    const struct {
        const char *name, *level0, *all;
        int side;
    } rows[] = {{"rmemboss.tx", "e2fa961bac45237ae7d01a7522aae93a", "c92a6cb5a6ffc71cfa08edd7ba055d76", 512},
                {"grid2.tx", "8b0dfdeddc3f520ea95e21bb8f8a1878", "09545475dfcb66aac7f81df99e1cb8fe", 512},
                {"shad17.shd", "a55ac97d5fa2a2f9fcfdae64fd352461", "a55ac97d5fa2a2f9fcfdae64fd352461", 128}};
    for (const auto& row : rows) {
        auto m = sample(row.name);
        ASSERT_TRUE(m);
        EXPECT_EQ(m->width, row.side);
        EXPECT_EQ(m->height, row.side);
        ByteList b;
        append(b, *m);
        EXPECT_EQ(md5(b), row.level0) << row.name;
        for (Image& l : m->levels) l.bits = m->bits, append(b, l);
        EXPECT_EQ(md5(b), row.all) << row.name;
        if (m->bits != 8) continue;
        // Every level is the rounded mean of four texels of the one above.
        EXPECT_EQ(m->levels.size(), 9u);
        Image codes = *m;
        for (float& v : codes.data) v = float(std::lround(v * 255));
        codes.levels.clear();
        const std::vector<Image> chain = withCodeLevels(codes);
        for (size_t i = 0; i < m->levels.size(); ++i) expectPixels(m->levels[i], chain[i + 1], false);
    }
}

TEST(PixarNative, SampleAsTiffIsTheSamePicture) {
    if (!std::filesystem::exists(samples)) GTEST_SKIP() << samples << " is not there";
    auto native = sample("rmemboss.tx");
    auto tiff = sample("rmemboss_tiff.tx");
    ASSERT_TRUE(native && tiff);
    EXPECT_EQ(native->data, tiff->data);
    EXPECT_EQ(native->metadata["wrapmodes"], "black,black"); // as the TIFF's description says
}

TEST(PixarNative, SampleShadowMapSeesTheSpheresOfItsScene) {
    if (!std::filesystem::exists(samples)) GTEST_SKIP() << samples << " is not there";
    auto m = sample("shad17.shd");
    ASSERT_TRUE(m && m->worldToCamera && m->worldToNDC);
    // World to camera of its scene: a turn by 48 degrees about -y after a move by 10 along z.
    const double c = std::cos(48 * M_PI / 180), s = std::sin(48 * M_PI / 180);
    const Matrix& w = *m->worldToCamera;
    EXPECT_NEAR(w.m[0][0], c, 1e-6);
    EXPECT_NEAR(std::fabs(w.m[0][2]), s, 1e-6);
    EXPECT_NEAR(w.m[1][1], 1, 1e-6);
    EXPECT_NEAR(w.m[3][2], 10, 1e-5);
    size_t hits = 0;
    for (float z : m->data) hits += z < 1e29f;
    EXPECT_GT(hits, 100u);
    for (float z : m->data) EXPECT_TRUE(z == 1e30f || (z > 8 && z < 12)) << z;
}

TEST(PixarNative, TruncationGivesAnErrorOrThePicture) {
    for (const ByteList& seed : damageSeeds())
        for (size_t n = 0; n < seed.size(); n += seed.size() > 4096 ? 64 : 1) {
            Diagnostics d;
            auto m = decoded(ByteList(seed.begin(), seed.begin() + std::ptrdiff_t(n)), d);
            if (m) EXPECT_EQ(m->data.size(), m->sampleCount()) << n;
            else EXPECT_EQ(d.errors(), 1) << n;
            // Without its last byte a level is short, unless what it codes needs no more.
            if (n < 0x48) EXPECT_FALSE(m) << n;
        }
}

TEST(PixarNative, RandomDamageGivesAnErrorOrAPicture) {
    std::mt19937 random(7);
    size_t read = 0, refused = 0;
    for (const ByteList& seed : damageSeeds())
        for (int trial = 0; trial < 2000; ++trial) {
            ByteList b = seed;
            for (unsigned i = 0, n = 1 + random() % 8; i < n; ++i) {
                static constexpr uint8_t nasty[] = {0, 1, 0x7f, 0x80, 0xfe, 0xff};
                // The header, the tables and directories, the tiles: each often enough.
                const size_t from = random() % 3 == 0 ? 0 : random() % 2 ? b.size() / 2 : std::min<size_t>(b.size() - 1, 0x48);
                const size_t at = from + random() % std::min<size_t>(b.size() - from, from ? b.size() : 0x48);
                b[at] = random() % 2 ? nasty[random() % 6] : uint8_t(random());
            }
            Diagnostics d;
            auto m = decoded(b, d);
            if (m) EXPECT_EQ(m->data.size(), m->sampleCount());
            else EXPECT_GE(d.errors(), 1);
            ++(m ? read : refused);
        }
    EXPECT_GT(read, 1000u);
    EXPECT_GT(refused, 1000u);
}

TEST(PixarNative, AShortFileCannotAskForMuchMemory) {
    // 16384 x 16384 x 8 floats would be 8 GiB: a few bytes of file cannot hold that, not even as even tiles.
    PixarFile f;
    f.levels = {codePicture(8, 8, 1)};
    ByteList b = f.bytes();
    b[13] = b[15] = 14;
    b[18] = 8;
    std::fill(b.begin() + 0x14, b.begin() + 0x1c, uint8_t(1));
    b.resize(0x48 + 4 * 15 * 15 * 8 + 64, 1);
    Diagnostics d;
    EXPECT_FALSE(decoded(b, d));
    EXPECT_EQ(d.errors(), 1);
}

} // namespace pixar_test
