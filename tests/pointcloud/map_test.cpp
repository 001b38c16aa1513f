// Lookups: against the sum over all points that CloudMap::lookup() is described by; levels; brick maps.
#include "pointcloud/make.h"
#include <random>

namespace map_test {

using namespace alpenglow;
using namespace alpenglow::pointcloud;
using namespace alpenglow::pointcloud::test;

namespace {

/// The description, word by word, over all points.
bool slow(const PointCloud& c, const Query& q, std::vector<double>& out) {
    double all = 0;
    out.assign(size_t(c.width()), 0);
    for (size_t i = 0; i < c.size(); ++i) {
        const double r = c.radius[i], h = q.radius + 2 * r, d = length(Vec3d(c.P[i]) - Vec3d(q.P));
        if (d >= h) continue;
        double w = std::pow(1 - d * d / (h * h), 2);
        if (length(q.N) > 0 && length(c.N[i]) > 0)
            w *= std::max(0.0, 1 - (1 - dot(Vec3d(q.N), Vec3d(c.N[i]))) * (1 + 2 * r / (r + q.radius)));
        w *= 2 * r * r;
        all += w;
        for (size_t k = 0; k < out.size(); ++k) out[k] += w * double(c.valuesOf(i)[k]);
    }
    for (double& v : out) v /= all;
    return all > 0;
}

PointCloud scattered(int n, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> u(-1, 1);
    PointCloud c;
    c.channels = {{"a", ChannelType::Float}, {"b", ChannelType::Vector}};
    for (int i = 0; i < n; ++i) {
        Vec3 v(u(random), u(random), u(random));
        c.add({u(random), u(random), u(random)}, i % 5 ? normalize(v) : Vec3(0.f), .05f * (1 + u(random)),
              std::vector<float>{u(random), v.x, v.y, v.z});
    }
    return c;
}

// Radii below the finest level's cells: nothing coarser is read.
TEST(CloudMaps, LookupIsTheSumThatIsDescribed) {
    const PointCloud c = scattered(3000, 1);
    const auto map = mapOf(c);
    std::mt19937 random(2);
    std::uniform_real_distribution<float> u(-1, 1);
    int found = 0;
    for (int i = 0; i < 300; ++i) {
        const Query q{
            {u(random), u(random), u(random)}, i % 3 ? normalize(Vec3(u(random), u(random), u(random))) : Vec3(0.f), 1e-6f, -1};
        std::vector<double> want;
        std::vector<float> have(4, -1);
        const bool any = slow(c, q, want);
        ASSERT_EQ(map->lookup(q, have), any);
        found += any;
        for (size_t k = 0; k < 4; ++k) {
            if (any) EXPECT_NEAR(have[k], want[k], 1e-6) << "float's rounding of the mean";
            else EXPECT_EQ(have[k], -1) << "as it was";
        }
    }
    EXPECT_GT(found, 100);
}

TEST(CloudMaps, SidesOfAWallAreApart) {
    PointCloud both[2] = {square(16, 0, 1), square(16, .001f, -1)};
    for (float& v : both[1].values) v = -100;
    PointCloud wall;
    ASSERT_EQ(merge(both, wall), "");
    std::vector<float> out(20);
    ASSERT_TRUE(mapOf(wall)->lookup({{.5f, .5f, 0}, {0, 0, 1}, .01f, -1}, out));
    EXPECT_NEAR(out[0], .5, 1e-5);
    ASSERT_TRUE(mapOf(wall)->lookup({{.5f, .5f, 0}, {0, 0, -1}, .01f, -1}, out));
    EXPECT_NEAR(out[0], -100, 1e-4);
}

// A linear channel is its own mean in the middle, whatever the filter; the mean of all at the coarsest level.
TEST(CloudMaps, LevelsKeepMeans) {
    const PointCloud c = square(64);
    const auto map = mapOf(c);
    std::vector<float> out(20);
    for (const float radius : {0.f, .02f, .1f, .3f}) {
        ASSERT_TRUE(map->lookup({{.5f, .5f, 0}, {0, 0, 1}, radius, -1}, out)) << radius;
        EXPECT_NEAR(out[0], .5, 1e-4) << radius;
    }
    for (int depth = 0; depth < 8; ++depth) {
        ASSERT_TRUE(map->lookup({{.5f, .5f, 0}, {0, 0, 1}, 0, depth}, out)) << depth;
        EXPECT_NEAR(out[0], .5, 1e-4) << depth;
    }
    ASSERT_TRUE(map->lookup({{0, 1, 0}, {0, 0, 1}, 0, 0}, out));
    EXPECT_NEAR(out[0], .5, 1e-4) << "the mean of all";
}

TEST(CloudMaps, CoarserKeepsAreaAndSums) {
    const PointCloud c = scattered(2000, 3);
    const auto sums = [](const PointCloud& x) {
        double area = 0, a = 0;
        for (size_t i = 0; i < x.size(); ++i) {
            const double r2 = double(x.radius[i]) * x.radius[i];
            area += r2, a += r2 * double(x.valuesOf(i)[0]);
        }
        return std::pair(area, a);
    };
    for (int depth = 0; depth < 6; ++depth) {
        const PointCloud few = coarser(c, {-1, -1, -1}, 2, depth);
        EXPECT_NEAR(sums(few).first, sums(c).first, 1e-5 * sums(c).first) << depth;
        EXPECT_NEAR(sums(few).second, sums(c).second, 1e-5) << depth;
        if (depth == 0) EXPECT_EQ(few.size(), 7u) << "six sides, and none";
    }
}

TEST_F(Clouds, BrickMapsGiveWhatCloudsGive) {
    const PointCloud c = square(128);
    Diagnostics d;
    ASSERT_TRUE(saveBrickMap(path("a.bkm"), c, policy(), d)) << said(d);
    const auto bricks = openMap(path("a.bkm"), d);
    const auto few = openBrickMap(path("a.bkm"), d, {}, 1); // room for one brick at a time
    ASSERT_TRUE(bricks && few) << said(d);
    EXPECT_EQ(bricks->channels(), c.channels);
    const auto cloud = mapOf(c);
    std::vector<float> a(20), b(20), e(20);
    for (float x = .1f; x < .95f; x += .1f)
        for (const float radius : {0.f, .01f, .05f, .2f}) {
            const Query q{{x, 1 - x, 0}, {0, 0, 1}, radius, -1};
            ASSERT_TRUE(cloud->lookup(q, a));
            ASSERT_TRUE(bricks->lookup(q, b));
            ASSERT_TRUE(few->lookup(q, e));
            EXPECT_EQ(b, e) << "whatever is kept";
            // Cells of a level move points by less than half a cell; a filter has cells of half its radius at most.
            EXPECT_NEAR(a[0], b[0], 3 * std::max(radius / 4, 1 / 128.f)) << x << " " << radius;
        }
    for (int depth = 0; depth < 7; ++depth) {
        ASSERT_TRUE(bricks->lookup({{.5f, .5f, 0}, {0, 0, 1}, 0, depth}, b));
        EXPECT_NEAR(b[0], .5, 1e-4) << depth;
    }
}

TEST_F(Clouds, ABrickThatChangedIsSaidOnce) {
    Diagnostics d;
    ASSERT_TRUE(saveBrickMap(path("a.bkm"), square(64), policy(), d));
    const auto map = openMap(path("a.bkm"), d);
    ASSERT_TRUE(map);
    const std::string all = bytes("a.bkm");
    std::fstream f(path("a.bkm"), std::ios::in | std::ios::out | std::ios::binary);
    f.seekp(long(all.size()) - 5000);
    f << std::string(5000, 'x');
    f.close();
    std::vector<float> out(20);
    for (float x = 0; x < 1; x += .01f) map->lookup({{x, x, 0}, {0, 0, 1}, 0, -1}, out);
    EXPECT_EQ(d.errors(), 1) << said(d);
}

} // namespace

} // namespace map_test
