// T8 (docs/proof.md): the structure of the samples.
#include "../statistics/chisquare.h"
#include "base/sampler.h"
#include <algorithm>
#include <bit>
#include <gtest/gtest.h>

namespace sampler_test {

using namespace alpenglow;
using namespace alpenglow::teststat;

namespace {

// Each of the 2^m intervals of every shape 2^-a x 2^-(m-a) holds exactly one of the points.
void expectNet(const std::vector<Vec2>& points, int m) {
    ASSERT_EQ(points.size(), size_t(1) << m);
    for (int a = 0; a <= m; ++a) {
        std::vector<int> hits(points.size(), 0);
        for (Vec2 p : points) hits[(size_t(p.x * float(1 << a)) << (m - a)) + size_t(p.y * float(1 << (m - a)))]++;
        for (int h : hits) ASSERT_EQ(h, 1) << "m " << m << " a " << a;
    }
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
    double sa = 0, sb = 0, saa = 0, sbb = 0, sab = 0, n = double(a.size());
    for (size_t i = 0; i < a.size(); ++i) { sa += a[i], sb += b[i], saa += a[i] * a[i], sbb += b[i] * b[i], sab += a[i] * b[i]; }
    return (sab - sa * sb / n) / std::sqrt((saa - sa * sa / n) * (sbb - sb * sb / n));
}

} // namespace

TEST(Sampler, SobolIsTheKnownSequence) {
    // First points of the (0,2)-sequence: (0,0) (1/2,1/2) (1/4,3/4) (3/4,1/4) (1/8,5/8) (5/8,1/8) (3/8,3/8) (7/8,7/8).
    const double x[8] = {0, .5, .25, .75, .125, .625, .375, .875}, y[8] = {0, .5, .75, .25, .625, .125, .375, .875};
    for (uint32_t i = 0; i < 8; ++i) {
        EXPECT_EQ(sobol0(i) * 0x1p-32, x[i]) << i;
        EXPECT_EQ(sobol1(i) * 0x1p-32, y[i]) << i;
    }
}

TEST(Sampler, EveryElementaryIntervalOnce) {
    for (uint64_t seed : {0ull, 1ull, 77ull})
        for (uint32_t replica : {0u, 1u})
            for (uint32_t site : {0u, 5u}) {
                Sampler s(seed, 12 + int(site), -3);
                for (int m = 0; m <= 12; ++m) {
                    std::vector<Vec2> p;
                    for (uint32_t i = 0; i < 1u << m; ++i) p.push_back(s.get2(2, site, 1, i * kReplicas + replica));
                    expectNet(p, m);
                }
            }
}

TEST(Sampler, EveryAlignedBlockIsANet) {
    Sampler s(9, 100, 200);
    for (uint32_t block = 0; block < 64; ++block) {
        std::vector<Vec2> p;
        for (uint32_t i = 0; i < 64; ++i) p.push_back(s.get2(0, 1, 0, (block * 64 + i) * kReplicas + 1));
        expectNet(p, 6);
    }
}

TEST(Sampler, SingleNumbersAreStratified) {
    Sampler s(4, 7, 8);
    for (uint32_t replica = 0; replica < kReplicas; ++replica) {
        std::vector<int> hits(1024, 0);
        for (uint32_t i = 0; i < 1024; ++i) hits[size_t(s.get1(3, 2, 1, i * kReplicas + replica) * 1024)]++;
        EXPECT_EQ(std::count(hits.begin(), hits.end(), 1), 1024);
    }
}

TEST(Sampler, BelowOne) {
    EXPECT_LT(unitFloat(~0u), 1.0f);
    EXPECT_EQ(unitFloat(0), 0.0f);
}

// A nested scramble: values that agree in their first k bits agree there after it, and differ in the next bit as before.
TEST(Sampler, ScrambleIsNested) {
    for (uint32_t t = 0; t < 20000; ++t) {
        const uint32_t a = uint32_t(mix64(t)), k = t % 32;
        uint32_t b = uint32_t(mix64(t + 1000000));
        b = k ? (a & ~(~0u >> k)) | (b & (~0u >> k)) : b;
        const uint64_t words = mix64(t / 100);
        auto scrambled = [&](uint32_t v) {
            const uint32_t low = uint32_t(words), high = uint32_t(words >> 32), r = reverseBits<uint32_t>(v);
            return reverseBits<uint32_t>(t % 2 ? owenReversed<uint32_t>(r, low, high)
                                               : scrambleReversed<uint32_t>(r, low, high, ~low));
        };
        const uint32_t diff = a ^ b, flipped = scrambled(a) ^ scrambled(b);
        if (diff) EXPECT_EQ(__builtin_clz(diff), __builtin_clz(flipped)) << a << " " << b;
        else EXPECT_EQ(flipped, 0u);
    }
}

// A one-to-one map of 128 bits: each step undone.
TEST(Sampler, WordsAreMixedOneToOne) {
    for (uint64_t t = 0; t < 1000; ++t) {
        const Words4<uint32_t> in{uint32_t(mix64(t)), uint32_t(t), uint32_t(mix64(t) >> 32), uint32_t(t * t)};
        Words4<uint32_t> v = mixWords(in);
        auto back = [&] { v.w -= v.y * v.z, v.z -= v.x * v.y, v.y -= v.z * v.x, v.x -= v.y * v.w; };
        back();
        v = {v.x ^ v.x >> 16, v.y ^ v.y >> 16, v.z ^ v.z >> 16, v.w ^ v.w >> 16};
        back();
        v = {v.x ^ v.x >> 16, v.y ^ v.y >> 16, v.z ^ v.z >> 16, v.w ^ v.w >> 16};
        back();
        const uint32_t inverse = 4276115653u; // of 1664525 modulo 2^32
        static_assert(1664525u * 4276115653u == 1u);
        EXPECT_EQ((v.x - 1013904223u) * inverse, in.x);
        EXPECT_EQ((v.y - 1013904223u) * inverse, in.y);
        EXPECT_EQ((v.z - 1013904223u) * inverse, in.z);
        EXPECT_EQ((v.w - 1013904223u) * inverse, in.w);
    }
}

// Each bit of the inputs changes each bit of the words in half of the cases: of 4,000 within 5 deviations of a fair coin's 2,000.
TEST(Sampler, EveryInputBitChangesEveryWord) {
    for (int bit = 0; bit < 160; ++bit) {
        if (bit == 127) continue; // the highest of the site, which is not used
        int changed[32 * 4] = {};
        for (uint64_t t = 0; t < 4000; ++t) {
            uint32_t in[5] = {uint32_t(mix64(t)), uint32_t(mix64(t) >> 32), uint32_t(t % 20), uint32_t(t / 20 % 20),
                              uint32_t(t / 400)};
            const auto a = streamWords(in[0], in[1], in[2], in[3], in[4]);
            in[bit / 32] ^= 1u << bit % 32;
            const auto b = streamWords(in[0], in[1], in[2], in[3], in[4]);
            const uint32_t d[4] = {a.x ^ b.x, a.y ^ b.y, a.z ^ b.z, a.w ^ b.w};
            for (int k = 0; k < 128; ++k) changed[k] += d[k / 32] >> k % 32 & 1;
        }
        for (int k = 0; k < 128; ++k) EXPECT_NEAR(changed[k], 2000, 5 * 32) << "input bit " << bit << ", output bit " << k;
    }
}

// The flips along one path, and the flips of eight sibling nodes at one depth, are each eight fair independent coins: of both
// coordinates and of the order, deep down too (nodes at depth 12 of an order are those that the first million samples part at),
// and the first flips of a coordinate against those of the order.
TEST(Sampler, OwenBitsUniform) {
    const int n = 1'000'000;
    std::vector<double> expected(256, n / 256.0);
    std::vector<std::vector<double>> hits(12, std::vector<double>(256, 0));
    for (int i = 0; i < n; ++i) {
        const uint64_t key = mix64(uint64_t(i / 1000));
        const Scrambles<uint32_t> s(streamWords<uint32_t>(uint32_t(key), uint32_t(key >> 32), 1, uint32_t(i % 1000), 0));
        auto first = [&](uint32_t v) { return s.first(reverseBits<uint32_t>(v)) ^ v; };
        auto second = [&](uint32_t v) {
            return s.second(sobol1Reversed<uint32_t>(reverseBits<uint32_t>(v))) ^ v;
        }; // its own inverse
        auto order = [&](uint32_t v) { return s.shuffledIndex(reverseBits<uint32_t>(v)) ^ v; };
        auto siblings = [&](auto flips, int depth, uint32_t path) { // of eight nodes that part three digits above `depth`
            uint32_t bits = 0;
            for (uint32_t k = 0; k < 8; ++k) bits = bits << 1 | ((flips(path | k << (32 - depth)) >> (31 - depth)) & 1);
            return bits;
        };
        hits[0][first(0xa5000000u) >> 24]++;
        hits[1][second(0x3c000000u) >> 24]++;
        hits[2][(order(0x000a5000u) >> 12) & 255]++;
        hits[3][siblings(first, 3, 0)]++;
        hits[4][siblings(second, 3, 0)]++;
        hits[5][siblings(order, 31, 0)]++;
        hits[6][siblings(first, 12, 0x5a000000u)]++;
        hits[7][siblings(order, 20, 0)]++;
        hits[8][(first(0) >> 28) << 4 | (second(0) >> 28)]++;
        hits[10][(first(0) >> 23) & 255]++; // from the fifth digit, a coin, to hashed ones
        hits[11][(second(0x60000000u) >> 22 & 15) << 4 | (second(0x64000000u) >> 22 & 15)]++; // behind the sixth, where they part
        hits[9][(siblings(first, 4, 0x80000000u) & 15) << 4 | (siblings(order, 31, 0) & 15)]++;
    }
    for (size_t k = 0; k < hits.size(); ++k) EXPECT_GE(chiSquareP(hits[k], expected), kAlpha) << "series " << k;
}

// Whatever the index: blocks that begin near 2^16, 2^20 and 2^30 samples are nets, and their numbers are not those of the first.
TEST(Sampler, LateSamplesAreNetsToo) {
    Sampler s(3, 5, 6);
    for (uint32_t begin : {1u << 16, (1u << 20) - 256, 1u << 20, (1u << 30) - 256}) {
        std::vector<Vec2> p;
        int same = 0;
        for (uint32_t i = 0; i < 256; ++i) {
            p.push_back(s.get2(1, 2, 3, (begin + i) * kReplicas));
            same += p.back().x == s.get2(1, 2, 3, i * kReplicas).x;
        }
        expectNet(p, 8);
        EXPECT_EQ(same, 0);
    }
}

// The n draws that one sample makes alike are as well spread as n samples are; so are those of several samples together.
TEST(Sampler, DrawsOfOneSampleAreANet) {
    Sampler s(9, 1, 2);
    for (uint32_t n : {4u, 16u, 64u})
        for (uint32_t sample : {0u, 1u, 6u, 100001u}) {
            std::vector<Vec2> p;
            std::vector<int> line(n, 0);
            for (uint32_t k = 0; k < n; ++k) {
                p.push_back(SampleNumbers(s, sample).draw(k, n).get2(1, 2, 3));
                line[size_t(SampleNumbers(s, sample).draw(k, n).get1(1, 2, 3) * float(n))]++;
            }
            expectNet(p, std::countr_zero(n));
            EXPECT_EQ(std::count(line.begin(), line.end(), 1), n);
        }
    // Eight draws of each of 32 samples of one replica: 256 points; and three draws, whose 256 first points are spread as well.
    for (uint32_t n : {8u, 3u}) {
        std::vector<Vec2> p;
        for (uint32_t i = 0; p.size() < 256; ++i)
            for (uint32_t k = 0; k < n && p.size() < 256; ++k)
                p.push_back(SampleNumbers(s, i * kReplicas + 1).draw(k, n).get2(1, 2, 3));
        expectNet(p, 8);
    }
    EXPECT_EQ(SampleNumbers(s, 7).draw(0, 1).get2(1, 2, 3).x, s.get2(1, 2, 3, 7).x);
    EXPECT_NE(SampleNumbers(s, 0).draw(0, 2).get2(1, 2, 3).x, SampleNumbers(s, 0).draw(0, 4).get2(1, 2, 3).x);
}

TEST(Sampler, EachPointIsUniform) {
    // One point of a scrambled sequence is uniform over the scrambles: 16 x 16 cells, sample 5 of one million pixels.
    std::vector<double> hits(256, 0), expected(256, 1e6 / 256);
    for (int i = 0; i < 1'000'000; ++i) {
        Vec2 p = Sampler(3, i % 1000, i / 1000).get2(1, 4, 0, 5 * kReplicas);
        hits[size_t(p.x * 16) * 16 + size_t(p.y * 16)]++;
    }
    EXPECT_GE(chiSquareP(hits, expected), kAlpha);
}

TEST(Sampler, TenMillionKeysNoCollision) {
    std::vector<uint64_t> keys;
    keys.reserve(10'000'000);
    for (int y = 0; y < 250; ++y)
        for (int x = -250; x < 250; ++x) {
            Sampler s(1, x, y);
            for (uint32_t r = 0; r < kReplicas; ++r)
                for (uint32_t vertex = 0; vertex < 4; ++vertex)
                    for (uint32_t site = 0; site < 10; ++site) keys.push_back(s.streamKey(r, vertex, site, 0));
        }
    ASSERT_EQ(keys.size(), 10'000'000u);
    std::sort(keys.begin(), keys.end());
    EXPECT_EQ(std::adjacent_find(keys.begin(), keys.end()), keys.end());
    // Occurrences, vertices and sites of one pixel, and neighbouring seeds.
    keys.clear();
    for (uint64_t seed = 0; seed < 4; ++seed)
        for (uint32_t vertex = 0; vertex < 50; ++vertex)
            for (uint32_t site = 0; site < 100; ++site)
                for (uint32_t o = 0; o < 100; ++o) keys.push_back(Sampler(seed, 0, 0).streamKey(0, vertex, site, o));
    std::sort(keys.begin(), keys.end());
    EXPECT_EQ(std::adjacent_find(keys.begin(), keys.end()), keys.end());
}

TEST(Sampler, SerialCorrelation) {
    const int n = 1'000'000;
    std::vector<double> here, nextPixel, nextVertex, nextSite, nextOccurrence, nextReplica, other, single, nextSeed;
    for (int i = 0; i < n; ++i) {
        int x = i % 1000, y = i / 1000;
        uint32_t k = uint32_t(i % 8);
        Sampler s(5, x, y);
        Vec2 p = s.get2(1, 1, 1, k);
        here.push_back(p.x);
        other.push_back(p.y);
        nextPixel.push_back(Sampler(5, x + 1, y).get2(1, 1, 1, k).x);
        nextVertex.push_back(s.get2(2, 1, 1, k).x);
        nextSite.push_back(s.get2(1, 2, 1, k).x);
        nextOccurrence.push_back(s.get2(1, 1, 2, k).x);
        nextReplica.push_back(s.get2(1, 1, 1, k ^ 1).x);
        single.push_back(s.get1(1, 1, 1, k));
        nextSeed.push_back(Sampler(6, x, y).get2(1, 1, 1, k).x);
    }
    double bound = 4.75 / std::sqrt(double(n));
    for (auto* v : {&other, &nextPixel, &nextVertex, &nextSite, &nextOccurrence, &nextReplica, &single, &nextSeed})
        EXPECT_LE(std::fabs(correlation(here, *v)), bound) << "series " << (v - &here);
}

// Pairs are shuffled against each other: without it the first bits of two pairs would be locked together in every pixel.
TEST(Sampler, PairsArePadded) {
    int full = 0;
    std::vector<double> a, b;
    for (int pixel = 0; pixel < 500; ++pixel) {
        Sampler s(2, pixel, 0);
        std::vector<int> cells(16, 0);
        for (uint32_t i = 0; i < 256; ++i) {
            Vec2 p = s.get2(0, 0, 0, i * kReplicas), q = s.get2(0, 1, 0, i * kReplicas);
            cells[size_t(p.x * 4) * 4 + size_t(q.x * 4)]++;
            a.push_back(p.x);
            b.push_back(q.y);
        }
        full += std::count(cells.begin(), cells.end(), 0) == 0;
    }
    EXPECT_GE(full, 490); // 256 points in 16 cells, 16 expected each
    EXPECT_LE(std::fabs(correlation(a, b)), 4.75 / std::sqrt(double(a.size())));
}

// One number and a pair of the same key walk the sequence in orders of their own (a light of two shapes draws both at one key:
// where the orders are locked together its error never falls). The first bit of point 2k against that of point 0, for the number
// and for each coordinate of the pair: whether they flip together is a fair coin for each k, so eight of them are 256 equal
// cells. Finds a lock in 3 % of the streams: cell 0 of 20,000 streams then has .03 * 20,000 more than its 78, noncentrality 4,600
// against 7.1 sqrt(2 * 255) = 160.
TEST(Sampler, OneNumberAgainstThePairOfItsKey) {
    std::vector<double> with[2] = {std::vector<double>(256, 0), std::vector<double>(256, 0)};
    const int streams = 20000;
    const std::vector<double> expected(256, streams / 256.0);
    int full = 0;
    for (int pixel = 0; pixel < streams; ++pixel) {
        Sampler s(11, pixel % 200, pixel / 200);
        auto bits = [&](uint32_t i) {
            Vec2 p = s.get2(3, 1u << 21, 0, i * kReplicas);
            int one = s.get1(3, 1u << 21, 0, i * kReplicas) < .5f;
            return std::pair<int, int>{(p.x < .5f) ^ one, (p.y < .5f) ^ one};
        };
        const auto first = bits(0);
        int cell[2] = {0, 0};
        for (uint32_t k = 1; k <= 8; ++k) {
            auto b = bits(2 * k);
            cell[0] = cell[0] * 2 + (b.first ^ first.first);
            cell[1] = cell[1] * 2 + (b.second ^ first.second);
        }
        for (int c = 0; c < 2; ++c) with[c][size_t(cell[c])]++;
        if (pixel >= 500) continue;
        // And all of 16 cells are met by 256 points, 16 expected each (as PairsArePadded asks of two pairs).
        std::vector<int> met(16, 0);
        for (uint32_t i = 0; i < 256; ++i)
            met[size_t(s.get2(3, 1u << 21, 0, i * kReplicas).x * 4) * 4 + size_t(s.get1(3, 1u << 21, 0, i * kReplicas) * 4)]++;
        full += std::count(met.begin(), met.end(), 0) == 0;
    }
    for (int c = 0; c < 2; ++c) EXPECT_GE(chiSquareP(with[c], expected), kAlpha) << "coordinate " << c;
    EXPECT_GE(full, 490);
}

// Stratification pays: the mean of a smooth function over N points of a replica has an error well below that of N random points.
TEST(Sampler, ErrorFallsFasterThanRandom) {
    double square = 0;
    const int pixels = 400, n = 256;
    for (int p = 0; p < pixels; ++p) {
        Sampler s(8, p, 1);
        double sum = 0;
        for (uint32_t i = 0; i < n; ++i) {
            Vec2 u = s.get2(0, 0, 0, i * kReplicas);
            sum += 4.0 * u.x * u.y;
        }
        square += (sum / n - 1) * (sum / n - 1);
    }
    double random = (16.0 / 9 - 1) / n; // variance of the mean of 256 random values of 4 x y
    EXPECT_LT(square / pixels, random / 100);
}

} // namespace sampler_test
