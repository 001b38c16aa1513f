// Sixteen lookups at a time give the bits of one, at every width that the processor has, and what does not fit into memory is
// looked up in scratch files with the same bits.
#include "base/limits.h"
#include "base/memory.h"
#include "pictures.h"
#include "texture/lookup.h"
#include "texture/scratch.h"
#include <cstring>
#include <limits>
#include <random>
#include <thread>

namespace lanes_test {

using namespace alpenglow;
using namespace alpenglow::texture;
using namespace alpenglow::display::test;
using namespace alpenglow::texture::test;
using display::Image;

namespace {

uint32_t bitsOf(float v) { return std::bit_cast<uint32_t>(v); }

/// Footprints from a thousandth of a texel to many maps, now and then numbers that are none.
struct Footprints {
    std::mt19937 random{7};
    float number(float low, float high) { return std::uniform_real_distribution<float>(low, high)(random); }
    float size() { return std::exp2(number(-16, 3)); }
    void fill(LookupLanes& l) {
        l.mask = random() & 0xffff;
        l.squeeze = random() % 2 ? 0 : 1 / (1 + number(0, 90));
        constexpr float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
        for (int i = 0; i < LookupLanes::kLanes; ++i) {
            l.s[i] = number(-3, 3), l.t[i] = number(-3, 3);
            const float a = size(), b = size();
            l.dsdx[i] = a * number(-1, 1), l.dtdx[i] = a * number(-1, 1);
            l.dsdy[i] = b * number(-1, 1), l.dtdy[i] = b * number(-1, 1);
            l.swidth[i] = number(0, 2), l.twidth[i] = number(0, 2);
            l.sblur[i] = random() % 3 ? 0 : size(), l.tblur[i] = random() % 3 ? 0 : size();
            l.filter[i] = Filter(random() % 5 ? random() % 3 : random() % unsigned(kFilters));
            l.fill[i] = number(0, 1);
            if (random() % 40 == 0) l.dsdx[i] = inf;
            if (random() % 40 == 0) l.s[i] = random() % 2 ? nan : -inf;
            if (random() % 40 == 0) l.t[i] = 1e30f;
            if (random() % 40 == 0) l.sblur[i] = nan;
            if (random() % 20 == 0) l.s[i] = std::trunc(l.s[i]);
            if (random() % 20 == 0) l.dsdx[i] = l.dtdx[i] = l.dsdy[i] = l.dtdy[i] = 0;
        }
    }
};

/// Compares a batch with lookups one by one.
void compare(Handle h, int first, int count, bool asLight, LookupLanes l) {
    LookupLanes found = l;
    for (auto& row : found.out)
        for (float& v : row) v = -7;
    lookup2DLanes(h, first, count, asLight, found);
    for (int i = 0; i < LookupLanes::kLanes; ++i) {
        float v[4] = {-7, -7, -7, -7};
        if (l.mask >> i & 1) {
            LookupOptions o;
            o.swidth = l.swidth[i], o.twidth = l.twidth[i], o.sblur = l.sblur[i], o.tblur = l.tblur[i];
            o.filter = l.filter[i], o.fill = l.fill[i], o.asLight = asLight, o.squeeze = l.squeeze;
            lookup2D(h, first, count, l.s[i], l.t[i], l.dsdx[i], l.dtdx[i], l.dsdy[i], l.dtdy[i], o, v);
        }
        for (int c = 0; c < count; ++c)
            ASSERT_TRUE(bitsOf(found.out[c][i]) == bitsOf(v[c]) || (v[c] == 0 && found.out[c][i] == 0)) // signs of zeros aside
                << "lane " << i << " channel " << c << ": " << found.out[c][i] << " and " << v[c];
    }
}

Image picture(int w, int h, int channels, bool floats, unsigned seed) {
    Image m = display::makeImage(w, h, display::defaultChannels(channels));
    std::mt19937 random(seed);
    for (float& v : m.data) v = float(random() % 256) / 255.0f * (floats ? 3.7f : 1.0f);
    m.floating = floats;
    m.bits = floats ? 32 : 8;
    return m;
}

} // namespace

TEST(Lanes, AreTheSameAsOne) {
    Footprints f;
    TextureSettings light;
    light.light = true;
    for (auto [w, h] : {std::pair{64, 64}, {50, 30}, {1, 1}, {3, 200}, {257, 2}})
        for (int channels : {1, 2, 3, 4, 6})
            for (bool floats : {false, true})
                for (const char* wrap : {"black", "clamp", "periodic", "mirror"}) {
                    const auto t =
                        makeTextureFrom(withWrap(picture(w, h, channels, floats, unsigned(w + channels)), wrap), light);
                    for (int trial = 0; trial < 6; ++trial) {
                        LookupLanes l;
                        f.fill(l);
                        compare(t.get(), trial % 3, 1 + trial % 4, trial & 1, l);
                        if (HasFatalFailure()) return;
                    }
                }
}

TEST(Lanes, EveryWidthGivesTheSameBits) {
    Footprints f;
    const auto t = makeTextureFrom(withWrap(picture(64, 40, 3, true, 3), "periodic"));
    std::vector<LaneLevel> levels;
    for (const Level& l : t->levels) levels.push_back({l.values.data(), nullptr, {}, l.width, l.height, l.channels});
    static LaneProbes probes;
    for (auto& byFilter : probes.position)
        for (auto& n : byFilter)
            for (float& v : n) v = f.number(-2, 2);
    for (auto& byFilter : probes.weight)
        for (auto& n : byFilter)
            for (float& v : n) v = f.number(0, .1f);
    const LaneJob job{levels.data(),       int(levels.size()) - 1, 0,      3, 64, 40, int(Wrap::Periodic),
                      int(Wrap::Periodic), {.1f, .15f, .2f},       &probes};
    int widths = 0;
    for (int trial = 0; trial < 50; ++trial) {
        LookupLanes l;
        f.fill(l);
        float one[64] = {}, other[64] = {};
        lookUpLanes(4)(job, l, one);
        for (int lanes : {8, 16})
            if (const LookUpLanes look = lookUpLanes(lanes)) {
                ++widths;
                look(job, l, other);
                EXPECT_EQ(std::memcmp(one, other, sizeof one), 0) << lanes;
            }
    }
    RecordProperty("compared", widths);
}

TEST(Lanes, TilesMissingMapsAndChannels) {
    Footprints f;
    auto set = std::make_shared<Texture>();
    set->channels = display::defaultChannels(3);
    for (int number : {1001, 1002, 1011}) set->tiles[number] = makeTextureFrom(picture(16, 8, 3, true, unsigned(number)));
    for (int trial = 0; trial < 100; ++trial) {
        LookupLanes l;
        f.fill(l);
        compare(set.get(), 0, 3, false, l);
        compare(nullptr, 0, 3, false, l);
        for (int first : {-4, -1, 2, 3}) compare(set->tiles[1001].get(), first, 3, false, l);
    }
}

TEST(Lanes, InfinityInOneTexelStaysThere) {
    Image m = constant(4, 4, 1, 1);
    m.pixel(3, 3)[0] = std::numeric_limits<float>::infinity();
    const auto t = makeTextureFrom(m);
    LookupLanes l{};
    l.set({});
    l.mask = 3;
    l.s[0] = l.t[0] = 0.625f; // beside it, weight 0
    l.s[1] = l.t[1] = 0.875f;
    lookup2DLanes(t.get(), 0, 1, false, l);
    EXPECT_EQ(l.out[0][0], 1);
    EXPECT_EQ(l.out[0][1], std::numeric_limits<float>::infinity());
}

TEST(Scratch, MapsBeyondTheLimitGiveTheSameBitsWithinIt) {
    Scratch s;
    for (int k = 0; k < 4; ++k)
        save(s, "map" + std::to_string(k) + ".tif", withWrap(picture(512, 350, 3, k & 1, unsigned(k)), "periodic"),
             display::Format::Tiff, k & 1 ? display::Sample::Float : display::Sample::UInt8);
    Diagnostics d;
    TextureSettings small, large;
    small.memory = size_t(3) << 20; // one map of floats has 2.9 MB with its levels
    TextureSystem little(d, small), enough(d, large);
    Footprints f;
    size_t most = 0;
    for (int round = 0; round < 10; ++round)
        for (int k = 0; k < 4; ++k) {
            const std::string name = s / ("map" + std::to_string(k) + ".tif");
            Handle a = little.open(name), b = enough.open(name);
            ASSERT_TRUE(a && b) << messages(d);
            for (int trial = 0; trial < 20; ++trial) {
                LookupLanes l, m;
                f.fill(l);
                m = l;
                lookup2DLanes(a, 0, 3, false, l);
                lookup2DLanes(b, 0, 3, false, m);
                little.keepWithinLimit();
                for (int i = 0; i < LookupLanes::kLanes; ++i)
                    for (int c = 0; c < 3 && (l.mask >> i & 1); ++c) ASSERT_EQ(bitsOf(l.out[c][i]), bitsOf(m.out[c][i]));
            }
            most = std::max(most, little.bytes());
        }
    EXPECT_EQ(d.errors() + d.warnings(), 0) << messages(d);
    EXPECT_GT(enough.bytes(), size_t(7) << 20);       // two of floats, and two of codes with levels of floats
    EXPECT_LE(most, small.memory + small.memory / 4); // a quarter may come between two looks at the pages
    EXPECT_TRUE(little.open(s / "map3.tif")->levels[0].values.mapped());
}

TEST(Scratch, ThreadsReadWhilePagesAreGivenBack) {
    Scratch s;
    save(s, "a.tif", withWrap(picture(600, 400, 3, true, 1), "periodic"), display::Format::Tiff, display::Sample::Float);
    Diagnostics d;
    TextureSettings small;
    small.memory = size_t(1) << 20;
    TextureSystem little(d, small), enough(d);
    Handle a = little.open(s / "a.tif"), b = enough.open(s / "a.tif");
    ASSERT_TRUE(a && b && a->levels[0].values.mapped() && !b->levels[0].values.mapped());
    std::vector<std::thread> threads;
    std::atomic<int> wrong{0};
    for (unsigned k = 0; k < 4; ++k)
        threads.emplace_back([&, k] {
            Footprints f;
            f.random.seed(k);
            for (int trial = 0; trial < 150; ++trial) {
                LookupLanes l, m;
                f.fill(l);
                m = l;
                lookup2DLanes(a, 0, 3, false, l);
                lookup2DLanes(b, 0, 3, false, m);
                little.keepWithinLimit();
                for (int i = 0; i < LookupLanes::kLanes; ++i)
                    for (int c = 0; c < 3 && (l.mask >> i & 1); ++c) wrong += bitsOf(l.out[c][i]) != bitsOf(m.out[c][i]);
            }
        });
    for (std::thread& t : threads) t.join();
    EXPECT_EQ(wrong, 0);
}

TEST(Scratch, AFullDiskIsSaidAndTheMapStaysInMemory) {
    Scratch s;
    save(s, "a.tif", picture(300, 300, 3, true, 1), display::Format::Tiff, display::Sample::Float);
    const char* before = std::getenv("TMPDIR");
    const std::string kept = before ? before : "";
    setenv("TMPDIR", (s / "nowhere").c_str(), 1);
    Diagnostics d;
    TextureSettings small;
    small.memory = 1000;
    TextureSystem little(d, small);
    Handle h = little.open(s / "a.tif");
    before ? setenv("TMPDIR", kept.c_str(), 1) : unsetenv("TMPDIR");
    ASSERT_TRUE(h);
    EXPECT_EQ(d.warnings(), 1) << messages(d);
    EXPECT_NE(messages(d).find("TMPDIR"), std::string::npos);
    EXPECT_FALSE(h->levels[0].values.mapped());
}

} // namespace lanes_test
