#include "base/limits.h"
#include "base/parallel.h"
#include "render/film.h"
#include <algorithm>
#include <gtest/gtest.h>
#include <limits>
#include <numeric>
#include <random>
#include <tbb/global_control.h>

namespace film_test {

using namespace alpenglow;
using namespace alpenglow::render;

namespace {

FilmDescription describe(int w, int h, std::vector<Channel> channels = {}) {
    FilmDescription d;
    d.width = w;
    d.height = h;
    d.window = {0, 0, w, h};
    d.channels = std::move(channels);
    return d;
}

struct Item {
    int x, y;
    uint32_t index;
    Color c;
    float alpha;
    float aov[3];
};

std::vector<Item> randomItems(int w, int h, uint32_t spp, uint32_t seed) {
    std::mt19937 g(seed);
    std::vector<Item> items;
    for (uint32_t i = 0; i < spp; ++i)
        for (int y = 0; y < h; ++y)
            for (int x = 0; x < w; ++x) {
                auto r = [&] { return float(std::ldexp(double(g()) - 2e9, int(g() % 90) - 60)); }; // 27 decades, both signs
                items.push_back({x, y, i, {r(), r(), r()}, r(), {r(), r(), r()}});
            }
    return items;
}

const std::vector<Channel> kChannels = {{"a"}, {"near", ChannelRule::Min}, {"far", ChannelRule::Max}};

void add(Film& f, const Item& i) { f.add(i.x, i.y, i.index, {i.c, i.alpha, i.aov}); }

} // namespace

TEST(Film, ShuffledOrdersGiveTheSameBits) {
    auto items = randomItems(5, 4, 40, 1);
    Film a(describe(5, 4, kChannels));
    for (auto& i : items) add(a, i);
    ASSERT_TRUE(a.addRange({0, 40}));
    std::mt19937 g(2);
    for (int trial = 0; trial < 10; ++trial) {
        std::shuffle(items.begin(), items.end(), g);
        Film b(describe(5, 4, kChannels));
        for (auto& i : items) add(b, i);
        b.addRange({0, 40});
        EXPECT_EQ(a.digest(), b.digest());
        for (int y = 0; y < 4; ++y)
            for (int x = 0; x < 5; ++x) {
                EXPECT_EQ(a.mean(x, y), b.mean(x, y));
                EXPECT_EQ(a.moments(x, y).variance, b.moments(x, y).variance);
            }
    }
}

TEST(Film, SevenRangesInAnyOrder) {
    const uint32_t cut[8] = {0, 3, 4, 11, 20, 21, 30, 48};
    auto items = randomItems(4, 3, 48, 3);
    Film whole(describe(4, 3, kChannels));
    for (auto& i : items) add(whole, i);
    ASSERT_TRUE(whole.addRange({0, 48}));
    std::vector<Film> parts;
    for (int p = 0; p < 7; ++p) {
        parts.emplace_back(describe(4, 3, kChannels));
        for (auto& i : items)
            if (i.index >= cut[p] && i.index < cut[p + 1]) add(parts.back(), i);
        ASSERT_TRUE(parts.back().addRange({cut[p], cut[p + 1]}));
    }
    std::vector<int> order(7);
    std::iota(order.begin(), order.end(), 0);
    std::mt19937 g(4);
    Diagnostics diag;
    for (int trial = 0; trial < 50; ++trial) {
        std::shuffle(order.begin(), order.end(), g);
        Film sum = parts[size_t(order[0])];
        for (int i = 1; i < 7; ++i) ASSERT_TRUE(sum.merge(parts[size_t(order[size_t(i)])], diag));
        EXPECT_EQ(sum.digest(), whole.digest());
        EXPECT_EQ(sum.ranges(), (std::vector<SampleRange>{{0, 48}}));
    }
    EXPECT_EQ(diag.errors(), 0);
}

TEST(Film, SumsAreExact) {
    // 2^60 + 2^-40 - 2^60: a float or double sum would lose the small term.
    Film f(describe(1, 1));
    f.add(0, 0, 0, {Color(0x1p59f), 1, {}});
    f.add(0, 0, 1, {Color(0x1p-39f), 1, {}});
    f.add(0, 0, 2, {Color(-0x1p59f), 1, {}});
    f.add(0, 0, 3, {Color(0.0f), 0, {}});
    EXPECT_EQ(f.mean(0, 0), Color(0x1p-41f));
    EXPECT_EQ(f.alpha(0, 0), 0.75f);
    EXPECT_EQ(f.saturated(), 0u);
    EXPECT_EQ(f.count(0, 0), 4u);
}

TEST(Film, MomentsByHand) {
    // Grey samples 1, 2, 3, 6: S1 = 12, S2 = 50, variance = (50 - 36) / 3. The weights of Y add up to 1.
    Film f(describe(1, 1));
    uint32_t i = 0;
    for (float v : {1.0f, 2.0f, 3.0f, 6.0f}) f.add(0, 0, i++, {Color(v), 1, {}});
    Moments m = f.moments(0, 0);
    EXPECT_EQ(m.n, 4u);
    EXPECT_NEAR(m.s1, 12, 1e-10);
    EXPECT_NEAR(m.s2, 50, 1e-9);
    EXPECT_NEAR(m.variance, 14.0 / 3, 1e-9);
    double sum;
    uint32_t n;
    f.replica(0, 0, 1, &sum, &n); // samples 1 and 3
    EXPECT_NEAR(sum, 8, 1e-10);
    EXPECT_EQ(n, 2u);
}

// Every sample is counted and summed, whatever its index: 3,000 samples in three ranges, sums in integers that float holds
// exactly.
TEST(Film, EverySampleOfThousandsIsCounted) {
    Film f(describe(2, 1));
    double s1 = 0, s2 = 0;
    for (uint32_t i = 0; i < 3000; ++i) {
        const double v = double(i * 7919 % 4096);
        s1 += v, s2 += v * v;
        for (int x = 0; x < 2; ++x) EXPECT_TRUE(f.add(x, 0, i, {Color(float(v)), 1, {}}));
        if (i == 998 || i == 1000) EXPECT_TRUE(f.addRange({i == 998 ? 0u : 999u, i + 1}));
    }
    EXPECT_TRUE(f.addRange({1001, 3000}));
    EXPECT_EQ(f.samplesPerPixel(), 3000u);
    for (int x = 0; x < 2; ++x) {
        EXPECT_EQ(f.count(x, 0), f.samplesPerPixel());
        const Moments m = f.moments(x, 0);
        EXPECT_EQ(m.n, 3000u);
        EXPECT_NEAR(m.s1, s1, 1e-6 * s1);
        EXPECT_NEAR(m.s2, s2, 1e-6 * s2);
        uint32_t all = 0;
        for (uint32_t r = 0; r < kReplicas; ++r) {
            double sum;
            uint32_t n;
            f.replica(x, 0, r, &sum, &n);
            EXPECT_EQ(n, 3000 / kReplicas) << "replica " << r;
            all += n;
        }
        EXPECT_EQ(all, 3000u);
    }
}

TEST(Film, EqualSamplesHaveNoVarianceAtAll) {
    for (float v : {0.1f, 1e-7f, 12345.678f, 3e15f}) {
        Film f(describe(1, 1));
        for (uint32_t i = 0; i < 1000; ++i) f.add(0, 0, i, {Color(v, v / 3, v / 7), 1, {}});
        EXPECT_EQ(f.moments(0, 0).variance, 0.0) << v;
    }
}

TEST(Film, NonFiniteIsCountedAndDropped) {
    const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    Film f(describe(3, 3, {{"a"}, {"z", ChannelRule::Min}}));
    float aov[2] = {2, 5};
    EXPECT_TRUE(f.add(1, 1, 0, {Color(1.0f), 1, aov}));
    EXPECT_FALSE(f.add(2, 1, 9, {Color(1, nan, 1), 1, aov}));
    EXPECT_FALSE(f.add(1, 1, 7, {Color(inf, 0, 0), 1, aov}));
    EXPECT_FALSE(f.add(1, 0, 7, {Color(0.0f), -inf, aov}));
    EXPECT_EQ(f.nonFinite(), 3u);
    EXPECT_EQ(f.count(1, 1), 1u);
    EXPECT_EQ(f.mean(1, 1), Color(1.0f));
    EXPECT_EQ(f.mean(2, 1), Color(0.0f));
    auto first = f.firstDropped();
    ASSERT_TRUE(first);
    EXPECT_EQ(first->sample, 7u);
    EXPECT_EQ(first->x, 1);
    EXPECT_EQ(first->y, 0);
    float badAov[2] = {nan, inf};
    EXPECT_TRUE(f.add(1, 1, 1, {Color(1.0f), 1, badAov}));
    EXPECT_EQ(f.nonFiniteAovs(), 1u); // infinite depth is "no hit", not a fault
    EXPECT_EQ(f.aov(1, 1, 0), 1.0f);
    EXPECT_EQ(f.aov(1, 1, 1), 5.0f);
    EXPECT_EQ(f.aov(0, 0, 1), inf);
}

TEST(Film, SaturationIsCounted) {
    Film f(describe(1, 1));
    f.add(0, 0, 0, {Color(1e30f), 1, {}});
    EXPECT_EQ(f.saturated(), 1u);
    EXPECT_EQ(f.mean(0, 0), Color(0x1p60f));
    EXPECT_EQ(f.moments(0, 0).s2, 0x1p120);
}

TEST(Film, LargestSumsDoNotOverflow) {
    // 2^27 samples at the limit would need 128 and 256 bits; check the integers at the largest values of few samples by hand.
    UInt256 s = square(Int128(1) << 100);
    EXPECT_EQ(s, (UInt256{{0, 0, 0, 1ull << 8}}));
    s *= limits::kSamplesPerPixel;
    EXPECT_EQ(s, (UInt256{{0, 0, 0, 1ull << 35}}));
    Int128 v = (Int128(0x123456789abcdefull) << 64) | 0xfedcba9876543210ull;
    EXPECT_EQ(square(v), square(-v));
    // (2^64 + 1)^2 = 2^128 + 2^65 + 1
    EXPECT_EQ(square((Int128(1) << 64) + 1), (UInt256{{1, 2, 1, 0}}));
    UInt256 d = square((Int128(1) << 64) + 1);
    d -= square(Int128(1) << 64);
    EXPECT_EQ(d, (UInt256{{1, 2, 0, 0}}));
}

TEST(Film, Ranges) {
    Film f(describe(1, 1));
    EXPECT_TRUE(f.addRange({10, 20}));
    EXPECT_TRUE(f.addRange({0, 5}));
    EXPECT_FALSE(f.addRange({4, 6}));
    EXPECT_FALSE(f.addRange({5, 11}));
    EXPECT_FALSE(f.addRange({12, 13}));
    EXPECT_FALSE(f.addRange({0, 100}));
    EXPECT_FALSE(f.addRange({7, 7}));
    EXPECT_TRUE(f.addRange({5, 10}));
    EXPECT_EQ(f.ranges(), (std::vector<SampleRange>{{0, 20}}));
    EXPECT_EQ(f.samplesPerPixel(), 20u);
    EXPECT_FALSE(f.addRange({20, 20 + limits::kSamplesPerPixel}));
    EXPECT_TRUE(f.addRange({20, limits::kSamplesPerPixel}));
}

TEST(Film, MergeRefusesWhatDoesNotBelong) {
    auto refused = [](FilmDescription d, SampleRange r) {
        Film a(describe(2, 2, {{"n"}})), b(std::move(d));
        a.addRange({0, 8});
        b.addRange(r);
        uint64_t before = a.digest();
        Diagnostics diag;
        bool ok = a.merge(b, diag, {"part", 0, 0});
        EXPECT_EQ(ok, diag.errors() == 0);
        if (!ok) EXPECT_EQ(a.digest(), before);
        return !ok;
    };
    EXPECT_FALSE(refused(describe(2, 2, {{"n"}}), {8, 9}));
    EXPECT_TRUE(refused(describe(2, 2, {{"n"}}), {7, 9}));
    EXPECT_TRUE(refused(describe(2, 3, {{"n"}}), {8, 9}));
    EXPECT_TRUE(refused(describe(2, 2, {{"m"}}), {8, 9}));
    EXPECT_TRUE(refused(describe(2, 2, {{"n", ChannelRule::Min}}), {8, 9}));
    auto other = describe(2, 2, {{"n"}});
    other.seed = 1;
    EXPECT_TRUE(refused(other, {8, 9}));
    other = describe(2, 2, {{"n"}});
    other.scene = "x";
    EXPECT_TRUE(refused(other, {8, 9}));
    other = describe(2, 2, {{"n"}});
    other.window.x1 = 1;
    EXPECT_TRUE(refused(other, {8, 9}));
}

TEST(Film, CheckKnowsTheLimits) {
    Diagnostics diag;
    EXPECT_TRUE(Film::check(describe(2, 2), diag));
    EXPECT_FALSE(Film::check(describe(0, 2), diag));
    EXPECT_FALSE(Film::check(describe(limits::kImageSide + 1, 1), diag));
    EXPECT_FALSE(Film::check(describe(2, 2, std::vector<Channel>(limits::kFilmChannels + 1)), diag));
    auto d = describe(4, 4);
    d.window = {2, 2, 5, 3};
    EXPECT_FALSE(Film::check(d, diag));
    d.window = {2, 2, 2, 3};
    EXPECT_FALSE(Film::check(d, diag));
    EXPECT_EQ(diag.errors(), 5);
}

// T10 in the small: threads, tile sizes and tile orders.
TEST(Film, ThreadsAndTilesChangeNothing) {
    const int w = 61, h = 37, spp = 12;
    auto sample = [](int x, int y, uint32_t i) {
        Sampler s(1, x, y);
        Vec2 a = s.get2(0, 0, 0, i), b = s.get2(1, 0, 0, i);
        return Color(a.x, a.y * 1e4f, b.x / (b.y + 1e-4f));
    };
    uint64_t expected = 0;
    for (int threads : {1, 2, 3, 7, 16})
        for (int tile : {1, 5, 16, 64}) {
            tbb::global_control limit(tbb::global_control::max_allowed_parallelism, size_t(threads));
            Film f(describe(w, h));
            int tx = (w + tile - 1) / tile, ty = (h + tile - 1) / tile;
            std::vector<int> order(size_t(tx * ty));
            std::iota(order.begin(), order.end(), 0);
            std::shuffle(order.begin(), order.end(), std::mt19937(unsigned(threads * 100 + tile)));
            parallelFor(0, tx * ty, [&](int t) {
                int ox = order[size_t(t)] % tx * tile, oy = order[size_t(t)] / tx * tile;
                for (int y = oy; y < std::min(h, oy + tile); ++y)
                    for (int x = ox; x < std::min(w, ox + tile); ++x)
                        for (uint32_t i = 0; i < spp; ++i) f.add(x, y, i, {sample(x, y, i), 1, {}});
            });
            f.addRange({0, spp});
            if (!expected) expected = f.digest();
            EXPECT_EQ(f.digest(), expected) << threads << " threads, tile " << tile;
        }
}

} // namespace film_test
