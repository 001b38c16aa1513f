// world/lightchooser.h: a light is chosen with exactly the probability that is given with it, and that pmf() returns.
#include "lanes/stages.h"
#include "world/lightchooser.h"
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numeric>
#include <random>

namespace lightchooser_test {

using namespace alpenglow;
using world::LightBound;
using world::LightChooser;

namespace {

constexpr int kWanted = 8;

std::vector<LightBound> lightsOf(int n, unsigned seed, const char* kind) {
    std::mt19937 rng(seed);
    std::uniform_real_distribution<float> one(0, 1);
    const std::string how = kind;
    std::vector<LightBound> all;
    for (int i = 0; i < n; ++i) {
        LightBound l;
        l.centre = Vec3(one(rng) * 20 - 10, one(rng) * 4, one(rng) * 20 - 10);
        l.radius = how == "spheres" ? one(rng) : 0;
        l.power = how == "dark" ? 0 : how == "uneven" ? std::exp(12 * one(rng) - 6) : 1;
        if (how == "one place") l.centre = Vec3(1, 2, 3);
        if (how == "facing")
            l.front = {normalize(Vec3(one(rng) - .5f, one(rng) - .5f, one(rng) - .5f)), i % 3 ? 1 : one(rng)},
            l.radius = .3f * one(rng);
        if (how == "line") l.centre = Vec3(float(i), 0, 0);
        if (how == "some far") l.everywhere = i % 5 == 0;
        if (how == "broken") l.power = i % 3 ? std::numeric_limits<float>::infinity() : std::numeric_limits<float>::quiet_NaN();
        all.push_back(l);
    }
    return all;
}

} // namespace

TEST(LightChooser, FrequenciesAreTheProbabilities) {
    const int turns = 4096;
    for (const char* kind : {"plain", "spheres", "dark", "uneven", "one place", "line", "some far", "broken", "facing"})
        for (const int n : {9, 33, 1000}) {
            const auto lights = lightsOf(n, 5, kind);
            const LightChooser chooser(lights, kWanted);
            for (const Vec3& at : {Vec3(0, 0, 0), Vec3(1, 2, 3), lights[3].centre, Vec3(1e4f, 0, 0)}) {
                std::vector<int> often(size_t(n), 0);
                LightChooser::Chosen chosen;
                for (int k = 0; k < turns; ++k) { // the midpoints of equal parts of what u can be
                    chooser.choose(at, (float(k) + .5f) / turns, chosen);
                    std::vector<char> seen(size_t(n), 0);
                    for (auto [light, p] : chosen) {
                        ASSERT_FALSE(seen[size_t(light)]) << kind << ": twice in one choice";
                        seen[size_t(light)] = 1;
                        ++often[size_t(light)];
                        ASSERT_EQ(p, chooser.pmf(light, at)) << kind << n;
                    }
                    ASSERT_GE(chosen.size(), 1u) << kind << n;
                    ASSERT_LE(chosen.size(), size_t(kWanted) + 1) << kind << n;
                }
                // A comb's tooth lies on an interval of length p: at most one midpoint more or less at each of its ends.
                for (int i = 0; i < n; ++i)
                    EXPECT_NEAR(often[size_t(i)] / double(turns), chooser.pmf(i, at), 2.0 / turns) << kind << n << " light " << i;
            }
        }
}

/// Choices sorted by light.
LightChooser::Chosen sorted(LightChooser::Chosen c) {
    std::sort(c.begin(), c.end());
    return c;
}

TEST(LightChooser, BlocksChooseAsPointsDo) {
    std::mt19937 rng(8);
    std::uniform_real_distribution<float> one(0, 1);
    std::vector<lanes::ChosenLight> found(lanes::kBlock * lanes::LightTree::kMostChosen);
    for (const char* kind : {"plain", "spheres", "dark", "uneven", "one place", "line", "some far", "broken", "facing"})
        for (const int n : {1, 9, 33, 1000})
            for (const int wanted : {1, 3, 8, 64}) {
                const auto lights = lightsOf(n, 3, kind);
                const LightChooser chooser(lights, wanted);
                alignas(64) lanes::Row P[3], u;
                for (int i = 0; i < lanes::kBlock; ++i) {
                    const Vec3 near(one(rng) * 20 - 10, one(rng) * 4, one(rng) * 20 - 10);
                    const Vec3 at = i == 0 ? lights[size_t(n / 2)].centre : i == 1 ? near * 1e4f : i == 2 ? near * 1e30f : near;
                    for (int q = 0; q < 3; ++q) P[q][i] = at[q];
                    u[i] = i == 3 ? 0 : i == 4 ? 0x1.fffffep-1f : one(rng);
                }
                const lanes::Lanes asked = uint32_t(rng()) & 0xffffu;
                for (const int lanes : {4, 8, 16}) {
                    const lanes::Stages* s = lanes::stages(lanes);
                    if (!s) continue;
                    std::vector<LightChooser::Chosen> chosen(lanes::kBlock);
                    const int count = s->chooseLights(chooser.tree(), P, u, asked, found.data());
                    for (int k = 0; k < count; ++k)
                        chosen[size_t(found[size_t(k)].lane)].emplace_back(found[size_t(k)].light, found[size_t(k)].chance);
                    for (int i = 0; i < lanes::kBlock; ++i) {
                        LightChooser::Chosen single;
                        if (asked >> i & 1) chooser.choose({P[0][i], P[1][i], P[2][i]}, u[i], single);
                        EXPECT_EQ(sorted(chosen[size_t(i)]), sorted(single)) << kind << n << " " << wanted << " " << i;
                    }
                }
            }
}

TEST(LightChooser, SharesOfPower) {
    // Lights at equal distances: shares of power, whatever the tree is; kBlind of the choice is equal for all.
    std::vector<LightBound> ring(64);
    double total = 0;
    for (int i = 0; i < 64; ++i) {
        ring[size_t(i)].centre = Vec3(std::cos(i * .1f) * 3, std::sin(i * .1f) * 3, 0);
        total += ring[size_t(i)].power = 1 + float(i % 4);
    }
    const LightChooser chooser(ring, kWanted);
    double sum = 0;
    for (int i = 0; i < 64; ++i) sum += chooser.pmf(i, {0, 0, 0});
    EXPECT_NEAR(sum, kWanted, 1e-4); // nobody's reaches 1
    // Opened to single lights only below the cut's size: the mean over a power's sixteen lights is what the share must be, to 10
    // %.
    for (int power = 1; power <= 4; ++power) {
        double mean = 0;
        for (int i = power - 1; i < 64; i += 4) mean += chooser.pmf(i, {0, 0, 0}) / 16.0;
        EXPECT_NEAR(mean, kWanted * (.9 * power / total + .1 / 64), .1 * mean) << power;
    }
    // One that outshines all others is always there.
    ring[17].power = 1e6f;
    EXPECT_EQ(LightChooser(ring, kWanted).pmf(17, {0, 0, 0}), 1);
}

// Of two lights alike that face along x the one that looks away has its blind part alone, one that is seen at 60 degrees half of
// what one has that looks here; how wide its normals lie apart, and how large it is, counts for it.
TEST(LightChooser, LightsThatFaceAway) {
    const auto chance = [](const Vec3& axis, float cosine, float radius) {
        std::vector<LightBound> two(2);
        two[0].centre = Vec3(-3, 0, 0), two[1].centre = Vec3(3, 0, 0);
        two[0].power = two[1].power = 1;
        two[0].front = {Vec3(1, 0, 0), 1};
        two[1].front = {axis, cosine};
        two[1].radius = radius;
        return double(LightChooser(two, 1).pmf(1, {0, 0, 0}));
    };
    const auto share = [](double part) { return .9 * part / (1 + part) + .05; };
    const float half = std::sqrt(3.f) / 2; // of 60 degrees the sine
    EXPECT_NEAR(chance({-1, 0, 0}, 1, 0), .5, 1e-6);
    EXPECT_NEAR(chance({1, 0, 0}, 1, 0), .05, 1e-6);
    EXPECT_NEAR(chance({0, 1, 0}, 1, 0), .05, 1e-6);
    EXPECT_NEAR(chance({-.5f, half, 0}, 1, 0), share(.5), 1e-5);
    EXPECT_NEAR(chance({0, 1, 0}, .5f, 0), share(half), 1e-5); // 60 degrees to all sides
    EXPECT_NEAR(chance({0, 1, 0}, 1, 1.5f), share(.5), 1e-5);  // seen under 30
    EXPECT_NEAR(chance({1, 0, 0}, -1, 0), .5, 1e-6);           // shines everywhere
}

// What holds two cones holds every direction in them, and is no wider than it must be.
TEST(LightChooser, ConesAroundCones) {
    using world::Cone;
    std::mt19937 rng(6);
    std::normal_distribution<float> one;
    const auto unit = [&] { return normalize(Vec3(one(rng), one(rng), one(rng))); };
    for (int i = 0; i < 200; ++i) {
        const Cone a{unit(), std::cos(.01f * float(i % 50))}, b{unit(), std::cos(.02f * float(i % 40))}, c = world::around(a, b);
        const double apart = std::acos(std::clamp(double(dot(a.axis, b.axis)), -1., 1.)), ra = std::acos(double(a.cosine)),
                     rb = std::acos(double(b.cosine)), must = std::max({ra, rb, (ra + rb + apart) / 2});
        if (must >= kPi) {
            EXPECT_TRUE(c.all());
            continue;
        }
        EXPECT_NEAR(std::acos(double(c.cosine)), must, 2e-3);
        for (const Cone& k : {a, b})
            EXPECT_LE(std::acos(std::clamp(double(dot(k.axis, c.axis)), -1., 1.)) + std::acos(double(k.cosine)),
                      std::acos(double(c.cosine)) + 2e-3);
    }
    EXPECT_TRUE(world::around({}, {Vec3(1, 0, 0), 1}).all());
}

TEST(LightChooser, NoLights) {
    LightChooser::Chosen chosen{{1, 1}};
    LightChooser().choose({0, 0, 0}, .5f, chosen);
    EXPECT_TRUE(chosen.empty());
    EXPECT_EQ(LightChooser().pmf(0, {0, 0, 0}), 0);
    EXPECT_TRUE(LightChooser().empty());
}

} // namespace lightchooser_test
