// Brick maps of clouds that do not fit into memory.
#include "pointcloud/brickstream.h"
#include "pointcloud/make.h"
#include <random>

namespace brickstream_test {

namespace {

using namespace alpenglow;
using namespace alpenglow::pointcloud;
using alpenglow::pointcloud::test::Clouds;

PointCloud scattered(size_t n) {
    PointCloud c;
    c.channels = {{"x", ChannelType::Float}, {"c", ChannelType::Color}};
    std::mt19937 random(3);
    std::uniform_real_distribution<float> u(0, 1);
    for (size_t i = 0; i < n; ++i) {
        const Vec3 p(u(random), 2 * u(random), .5f + .1f * u(random));
        const float v[4] = {p.x, p.y, p.z, 1};
        c.add(p, i % 3 ? Vec3(0, 0, 1) : Vec3(0, 1, 0), .01f, v);
    }
    return c;
}

/// Looks up 2,000 places in both and expects the same; how many found something.
size_t sameAnswers(const CloudMap& one, const CloudMap& other, size_t numbers) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> u(0, 1);
    size_t found = 0;
    for (int i = 0; i < 2000; ++i) {
        Query q;
        q.P = {u(random), 2 * u(random), .5f + .1f * u(random)};
        q.N = {0, 0, 1};
        q.radius = i % 2 ? .02f : u(random);
        q.maxDepth = i % 5 - 1;
        std::vector<float> a(numbers), b(numbers);
        const bool there = one.lookup(q, a);
        EXPECT_EQ(there, other.lookup(q, b));
        found += there;
        for (size_t k = 0; k < numbers; ++k) EXPECT_NEAR(a[k], b[k], 1e-5) << i;
    }
    return found;
}

// With room for a fiftieth of the points the map answers as the one that is made in memory.
TEST_F(Clouds, BrickMapsOfCloudsThatDoNotFit) {
    const PointCloud c = scattered(60000);
    Diagnostics d;
    ASSERT_TRUE(saveCloud(path("a.ptc"), c, policy(), d));
    ASSERT_TRUE(saveBrickMap(path("whole.bkm"), c, policy(), d));
    ASSERT_TRUE(brickMapOfFiles(std::vector{path("a.ptc")}, path("parts.bkm"), policy(), d, {}, size_t(200) << 10));
    const auto whole = openMap(path("whole.bkm"), d), parts = openMap(path("parts.bkm"), d);
    ASSERT_TRUE(whole && parts);
    EXPECT_EQ(bytes("whole.bkm").size(), bytes("parts.bkm").size());
    EXPECT_GT(sameAnswers(*whole, *parts, 4), 1000u);
    EXPECT_EQ(d.errors(), 0u);
}

// MakeBrickMap takes several: channels of all, 0 where a cloud has none of a name.
TEST_F(Clouds, BrickMapsOfSeveralCloudsThatDoNotFit) {
    PointCloud from[2] = {scattered(30000), {}};
    from[1].channels = {{"y", ChannelType::Float}, {"x", ChannelType::Float}};
    for (size_t i = 0; i < 20000; ++i) {
        const Vec3 p = from[0].P[i] + Vec3(.2f, .3f, 0);
        const float v[2] = {p.y, p.x};
        from[1].add(p, {0, 0, 1}, .01f, v);
    }
    Diagnostics d;
    PointCloud all;
    ASSERT_EQ(merge(from, all), "");
    ASSERT_TRUE(saveCloud(path("a.ptc"), from[0], policy(), d) && saveCloud(path("b.ptc"), from[1], policy(), d));
    ASSERT_TRUE(saveBrickMap(path("whole.bkm"), all, policy(), d));
    ASSERT_TRUE(
        brickMapOfFiles(std::vector{path("a.ptc"), path("b.ptc")}, path("parts.bkm"), policy(), d, {}, size_t(200) << 10));
    const auto whole = openMap(path("whole.bkm"), d), parts = openMap(path("parts.bkm"), d);
    ASSERT_TRUE(whole && parts);
    EXPECT_EQ(whole->channels(), parts->channels());
    EXPECT_GT(sameAnswers(*whole, *parts, 5), 1000u);
    EXPECT_EQ(d.errors(), 0u);

    from[1].channels[0].name = "c"; // a color in the other
    ASSERT_TRUE(saveCloud(path("b.ptc"), from[1], policy(), d));
    EXPECT_FALSE(brickMapOfFiles(std::vector{path("a.ptc"), path("b.ptc")}, path("none.bkm"), policy(), d, {}, 1000));
    EXPECT_EQ(d.errors(), 1u);
}

TEST_F(Clouds, CloudsThatDoNotFitAndAreDamaged) {
    Diagnostics d;
    ASSERT_TRUE(saveCloud(path("a.ptc"), scattered(5000), policy(), d));
    const std::string b = bytes("a.ptc");
    for (size_t n = 0; n < b.size(); n += 997) {
        std::ofstream(path("cut.ptc"), std::ios::binary) << b.substr(0, n);
        Diagnostics said;
        EXPECT_FALSE(brickMapOfFiles(std::vector{path("cut.ptc")}, path("cut.bkm"), policy(), said, {}, 1000));
        EXPECT_GT(said.errors(), 0u) << n;
    }
    EXPECT_FALSE(std::filesystem::exists(path("cut.bkm")));
}

} // namespace

} // namespace brickstream_test
