#include "render/partfile.h"
#include <cstring>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <random>
#include <unistd.h>
#include <zlib.h>

namespace partfile_test {

using namespace alpenglow;
using namespace alpenglow::render;
namespace fs = std::filesystem;

namespace {

struct PartFile : testing::Test {
    fs::path dir;
    OutputPolicy policy;
    void SetUp() override {
        dir = fs::temp_directory_path() / ("alpenglow_part_" + std::to_string(getpid()) + "_" +
                                           testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::create_directories(dir);
        policy.root = dir.string();
    }
    void TearDown() override { fs::remove_all(dir); }
    std::string path(const std::string& name) const { return (dir / name).string(); }
    std::vector<uint8_t> bytes(const std::string& name) const {
        std::ifstream in(dir / name, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
};

Film makeFilm(uint32_t first, uint32_t last, int w = 3, int h = 2) {
    FilmDescription d;
    d.width = w + 2;
    d.height = h + 1;
    d.window = {1, 1, w + 1, h + 1};
    d.seed = 42;
    d.scene = "digest";
    d.channels = {{"N.x"}, {"z", ChannelRule::Min}};
    Film f(d);
    for (int y = 1; y <= h; ++y)
        for (int x = 1; x <= w; ++x)
            for (uint32_t i = first; i < last; ++i) {
                Vec2 u = Sampler(1, x, y).get2(0, 0, 0, i), v = Sampler(1, x, y).get2(1, 0, 0, i);
                float aov[2] = {u.x - 0.5f, 10 * v.y};
                f.add(x, y, i, {Color(u.x, u.y, v.x * 100), 1, aov});
            }
    f.add(1, 1, first, {Color(0.0f / 0.0f, 0, 0), 1, {}});
    f.addRange({first, last});
    f.metadata["display"] = "out.exr";
    return f;
}

void fixHeaderCrc(std::vector<uint8_t>& b) {
    uint32_t size;
    std::memcpy(&size, &b[12], 4);
    uint32_t c = uint32_t(crc32(crc32(0, nullptr, 0), &b[20], size));
    std::memcpy(&b[16], &c, 4);
}

} // namespace

TEST_F(PartFile, RoundTrip) {
    Film f = makeFilm(4, 20);
    Diagnostics diag;
    ASSERT_TRUE(savePart(f, "a.part", policy, diag));
    auto g = loadPart(path("a.part"), diag);
    ASSERT_TRUE(g);
    EXPECT_EQ(diag.errors(), 0);
    EXPECT_EQ(g->digest(), f.digest());
    EXPECT_EQ(g->description(), f.description());
    EXPECT_EQ(g->ranges(), f.ranges());
    EXPECT_EQ(g->metadata, f.metadata);
    EXPECT_EQ(g->nonFinite(), 1u);
    ASSERT_TRUE(g->firstDropped());
    EXPECT_EQ(g->firstDropped()->sample, 4u);
    EXPECT_EQ(g->aov(2, 2, 1), f.aov(2, 2, 1));
    // A resumed render: the loaded film takes further samples like the original.
    for (Film* p : {&f, g.get()}) p->add(2, 1, 20, {Color(3.0f), 1, {}});
    EXPECT_EQ(g->digest(), f.digest());
}

// Of a film whose pixels have different numbers of samples: all that is needed to go on; damage is noticed as ever.
TEST_F(PartFile, RatesComeBack) {
    Film f = makeFilm(0, 4);
    ASSERT_TRUE(f.spread({64, 256, 512, 32, 256, 1024}));
    for (int y = 1; y <= 2; ++y)
        for (int x = 1; x <= 3; ++x) {
            const SampleRange r = f.samplesOfSteps(x, y, 5);
            for (uint32_t i = r.begin; i < r.end; ++i) f.add(x, y, i, {Color(float(i)), 1, {}});
        }
    ASSERT_TRUE(f.addSteps(5));
    Diagnostics diag;
    ASSERT_TRUE(savePart(f, "a.part", policy, diag));
    auto g = loadPart(path("a.part"), diag);
    ASSERT_TRUE(g && g->spread());
    EXPECT_EQ(g->digest(), f.digest());
    EXPECT_EQ(g->spread()->rates, f.spread()->rates);
    EXPECT_EQ(g->spread()->steps, 5u);
    EXPECT_EQ(g->samples().most, 40u); // 1024 / 256 (4 / 8 + 2 5)
    const auto good = bytes("a.part");
    for (size_t i = 0; i < good.size(); i += 3) {
        auto b = good;
        b[i] ^= 0x41;
        Diagnostics quiet;
        ASSERT_FALSE(parsePart(b, "a", quiet)) << "byte " << i;
    }
    auto b = good; // a header that says more steps than there can be, its sum made right
    uint32_t size;
    std::memcpy(&size, &b[12], 4);
    std::memset(&b[20 + size - 4], 0xff, 4);
    fixHeaderCrc(b);
    Diagnostics quiet;
    EXPECT_FALSE(parsePart(b, "a", quiet));
    EXPECT_EQ(quiet.errors(), 1);
}

TEST_F(PartFile, SevenPartsInAnyOrderEqualOneRender) {
    Diagnostics diag;
    const uint32_t cut[8] = {0, 8, 9, 16, 30, 31, 40, 64};
    std::vector<std::string> names;
    for (int i = 0; i < 7; ++i) {
        std::string n = "p" + std::to_string(i);
        ASSERT_TRUE(savePart(makeFilm(cut[i], cut[i + 1]), n, policy, diag));
        names.push_back(path(n));
    }
    std::mt19937 g(1);
    uint64_t digest = 0;
    for (int t = 0; t < 8; ++t) {
        std::shuffle(names.begin(), names.end(), g);
        auto whole = mergeParts(names, diag);
        ASSERT_TRUE(whole);
        EXPECT_EQ(whole->samplesPerPixel(), 64u);
        if (!t) digest = whole->digest();
        EXPECT_EQ(whole->digest(), digest);
        // One render of all samples; only the counter of dropped samples differs (each part dropped one).
        Film one = makeFilm(0, 64);
        EXPECT_EQ(whole->mean(2, 2), one.mean(2, 2));
        EXPECT_EQ(whole->moments(3, 1).variance, one.moments(3, 1).variance);
        EXPECT_EQ(whole->nonFinite(), 7u);
    }
    names.push_back(names[0]);
    EXPECT_FALSE(mergeParts(names, diag));
    EXPECT_EQ(diag.errors(), 1);
    EXPECT_FALSE(mergeParts({}, diag));
}

TEST_F(PartFile, EveryChangedByteIsNoticed) {
    Diagnostics quiet;
    ASSERT_TRUE(savePart(makeFilm(0, 3), "a.part", policy, quiet));
    auto good = bytes("a.part");
    ASSERT_GT(good.size(), 100u);
    ASSERT_TRUE(parsePart(good, "a", quiet));
    for (size_t i = 0; i < good.size(); ++i)
        for (uint8_t flip : {0x01, 0x80, 0xff}) {
            auto b = good;
            b[i] ^= flip;
            Diagnostics diag;
            ASSERT_FALSE(parsePart(b, "a", diag)) << "byte " << i;
            ASSERT_EQ(diag.errors(), 1) << "byte " << i;
            ASSERT_EQ(diag.all()[0].place.file, "a");
        }
}

TEST_F(PartFile, EveryTruncationAndTrailingGarbageIsNoticed) {
    Diagnostics quiet;
    ASSERT_TRUE(savePart(makeFilm(0, 3), "a.part", policy, quiet));
    auto good = bytes("a.part");
    for (size_t n = 0; n < good.size(); ++n) {
        Diagnostics diag;
        ASSERT_FALSE(parsePart({good.data(), n}, "a", diag)) << n;
        ASSERT_EQ(diag.errors(), 1) << n;
    }
    good.push_back(0);
    EXPECT_FALSE(parsePart(good, "a", quiet));
}

// Damage that a checksum does not show, because it was made on purpose: every header byte changed, checksum put right.
TEST_F(PartFile, HostileHeadersDoNoHarm) {
    Diagnostics quiet;
    ASSERT_TRUE(savePart(makeFilm(0, 3), "a.part", policy, quiet));
    auto good = bytes("a.part");
    uint32_t size;
    std::memcpy(&size, &good[12], 4);
    int accepted = 0;
    for (size_t i = 20; i < 20 + size; ++i)
        for (uint8_t value : {0x00, 0x01, 0x7f, 0x80, 0xff}) {
            auto b = good;
            b[i] = value;
            fixHeaderCrc(b);
            Diagnostics diag;
            auto f = parsePart(b, "a", diag);
            accepted += f != nullptr;
            EXPECT_EQ(f == nullptr, diag.errors() > 0) << "byte " << i;
        }
    EXPECT_GT(accepted, 0); // names and counters may be anything
    // A small file that claims a huge picture must not cost its memory.
    auto b = good;
    for (int v = 0; v < 6; ++v) {
        uint32_t side = v == 2 || v == 3 ? 0 : 65536;
        std::memcpy(&b[20 + size_t(v) * 4], &side, 4);
    }
    fixHeaderCrc(b);
    Diagnostics diag;
    EXPECT_FALSE(parsePart(b, "a", diag));
    EXPECT_NE(diag.all().at(0).message.find("too short"), std::string::npos);
}

TEST_F(PartFile, WrongFilesAreNamed) {
    Diagnostics diag;
    EXPECT_FALSE(loadPart(path("missing"), diag));
    EXPECT_EQ(diag.errors(), 1);
    std::vector<uint8_t> text(100, 'x');
    EXPECT_FALSE(parsePart(text, "picture.exr", diag));
    EXPECT_EQ(diag.all().back().message, "not a part file");
    EXPECT_FALSE(parsePart({}, "empty", diag));
    ASSERT_TRUE(savePart(makeFilm(0, 1), "a.part", policy, diag));
    auto b = bytes("a.part");
    for (const auto& [version, word] : {std::pair{1, "older"}, {99, "newer"}}) {
        b[8] = uint8_t(version);
        EXPECT_FALSE(parsePart(b, "other", diag));
        EXPECT_EQ(diag.all().back().code, Rie::Version);
        EXPECT_NE(diag.all().back().message.find(word), std::string::npos);
    }
}

TEST_F(PartFile, AFullDiskKeepsTheOldFile) {
    Diagnostics diag;
    ASSERT_TRUE(savePart(makeFilm(0, 2), "a.part", policy, diag));
    auto old = bytes("a.part");
    OutputPolicy full = policy;
    full.failAfterBytes = 60;
    EXPECT_FALSE(savePart(makeFilm(0, 9), "a.part", full, diag));
    EXPECT_GE(diag.errors(), 1);
    EXPECT_EQ(bytes("a.part"), old);
}

} // namespace partfile_test
