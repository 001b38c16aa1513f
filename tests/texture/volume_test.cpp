// Stacks of pictures and grids as texture3d() reads them, and SLProject's gradients against their formulas written out plainly.
#include "pictures.h"
#include "texture/volume.h"
#include <cmath>
#include <cstdlib>

namespace volume_test {

using namespace alpenglow;
using namespace alpenglow::texture;
using namespace alpenglow::display::test;
using namespace alpenglow::texture::test;
using display::Image;

namespace {

float density(int x, int y, int z) { return float(x * 8 + y * 3 + z * 20) / 255.0f; }

void saveSlices(const Scratch& s, int w, int h, int d) {
    for (int z = 0; z < d; ++z) {
        Image m = display::makeImage(w, h, {"y"});
        for (int y = 0; y < h; ++y)
            for (int x = 0; x < w; ++x) m.pixel(x, y)[0] = density(x, y, z);
        char name[32];
        std::snprintf(name, sizeof name, "s%03d.tif", z + 1);
        save(s, name, m);
    }
}

/// Channels of a lookup at the middle of a voxel.
std::vector<float> look(const pointcloud::CloudMap& map, Vec3 p, float radius = 0) {
    std::vector<float> v(size_t(map.width()), -1);
    pointcloud::Query q;
    q.P = p;
    q.radius = radius;
    if (!map.lookup(q, v)) v.clear();
    return v;
}

} // namespace

TEST(Volumes, SlicesAndStripsAreTheSame) {
    Scratch s;
    saveSlices(s, 5, 6, 4);
    Image strip = display::makeImage(5, 24, {"y"});
    for (int y = 0; y < 24; ++y)
        for (int x = 0; x < 5; ++x) strip.pixel(x, y)[0] = density(x, y % 6, y / 6);
    save(s, "strip.tif", strip);
    Diagnostics d;
    const VolumeFiles files{{s.dir.string()}};
    const auto a = loadVolume("s%03d.tif", files, d), b = loadVolume("s###.tif", files, d),
               c = loadVolume("strip.tif*4", files, d);
    ASSERT_TRUE(a && b && c) << messages(d);
    EXPECT_EQ(a->depth, 4);
    EXPECT_EQ(a->values, b->values);
    EXPECT_EQ(a->values, c->values);
    const auto copies = loadVolume("s001.tif*3", files, d); // six rows are no three slices as high as wide
    ASSERT_TRUE(copies);
    EXPECT_EQ(copies->depth, 3);
    EXPECT_EQ(copies->height, 6);
    EXPECT_EQ(copies->at(2, 3, 2)[0], density(2, 3, 0));
    EXPECT_FALSE(loadVolume("t%03d.tif", files, d));
    save(s, "s003.tif", strip);
    EXPECT_FALSE(loadVolume("s%03d.tif", files, d));
    EXPECT_NE(messages(d).find("differs from the first one"), std::string::npos);
}

TEST(Volumes, LookupsInterpolateAndEndAtTheCube) {
    Scratch s;
    saveSlices(s, 8, 8, 8);
    Diagnostics d;
    const auto map = mapOf(*loadVolume("s%03d.tif", {{s.dir.string()}}, d));
    const auto at = [](float x, float y, float z) { return Vec3((x + .5f) / 8, (y + .5f) / 8, (z + .5f) / 8); };
    // A ramp is exact between voxels; "alpha" of grey is the grey.
    for (auto [x, y, z] : {std::tuple{2.f, 3.f, 4.f}, {2.25f, 3.5f, 4.75f}, {6.9f, 0.1f, 6.f}}) {
        const auto v = look(*map, at(x, y, z));
        ASSERT_EQ(v.size(), 8u); // color, alpha, gradient, y
        for (int k : {0, 1, 2, 3, 7}) EXPECT_NEAR(v[size_t(k)], (x * 8 + y * 3 + z * 20) / 255, 1e-5f);
    }
    EXPECT_TRUE(look(*map, {1.01f, .5f, .5f}).empty());
    EXPECT_TRUE(look(*map, {.5f, -.01f, .5f}).empty());
    // A filter as wide as all: the mean.
    const float mean = (3.5f * 8 + 3.5f * 3 + 3.5f * 20) / 255;
    EXPECT_NEAR(look(*map, {.3f, .6f, .2f}, 2)[0], mean, 1e-5f);
    // In between it stays between, and a ramp's middle stays.
    EXPECT_NEAR(look(*map, {.5f, .5f, .5f}, .2f)[0], mean, 1e-5f);
}

TEST(Volumes, GradientsAreThoseOfTheFormula) {
    Volume v{7, 6, 5, {"r", "g", "b"}, {}};
    v.values.resize(7 * 6 * 5 * 3);
    const auto opacity = [](int x, int y, int z) { return .02 * x * x + .01 * y * z; };
    for (int z = 0; z < 5; ++z)
        for (int y = 0; y < 6; ++y)
            for (int x = 0; x < 7; ++x)
                for (int c = 0; c < 3; ++c)
                    v.at(x, y, z)[c] = float(opacity(x, y, z)) + float(c - 1) * .25f; // whose mean is the opacity
    for (int r : {1, 2}) {
        const Volume g = gradientsOf(v, r);
        for (int z = 0; z < 5; ++z)
            for (int y = 0; y < 6; ++y)
                for (int x = 0; x < 7; ++x) {
                    double n[3] = {0, 0, 0};
                    if (x >= r && x < 7 - r && y >= r && y < 6 - r && z >= r && z < 5 - r) {
                        n[0] = opacity(x + r, y, z) - opacity(x - r, y, z);
                        n[1] = opacity(x, y + r, z) - opacity(x, y - r, z);
                        n[2] = opacity(x, y, z + r) - opacity(x, y, z - r);
                        const double l = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
                        for (double& k : n) k = l > 1e-4 ? k / l : 0;
                    }
                    for (int k = 0; k < 3; ++k) EXPECT_NEAR(g.at(x, y, z)[k], .5 * (n[k] + 1), 1e-4);
                    EXPECT_NEAR(g.at(x, y, z)[3], opacity(x, y, z), 1e-6);
                }
        Volume smooth = g;
        smoothGradients(smooth, 1);
        for (auto [x, y, z] : {std::tuple{3, 3, 2}, {0, 0, 0}, {6, 2, 4}})
            for (int k = 0; k < 3; ++k) {
                double sum = 0;
                int count = 0;
                for (int c = std::max(0, z - 1); c <= std::min(4, z + 1); ++c)
                    for (int b = std::max(0, y - 1); b <= std::min(5, y + 1); ++b)
                        for (int a = std::max(0, x - 1); a <= std::min(6, x + 1); ++a, ++count) sum += double(g.at(a, b, c)[k]);
                EXPECT_NEAR(smooth.at(x, y, z)[k], sum / count, 1e-6);
            }
        EXPECT_EQ(smooth.at(3, 3, 2)[3], g.at(3, 3, 2)[3]);
    }
}

TEST(Volumes, MadeGradientsAreReadBack) {
    Scratch s;
    saveSlices(s, 6, 5, 4);
    Diagnostics d;
    MakeOptions o;
    o.searchPath = {s.dir.string()};
    o.policy = s.policy();
    ASSERT_TRUE(makeGradients("s%03d.tif", "g.exr", 1, 0, o, d)) << messages(d);
    EXPECT_TRUE(holdsVolume(s / "g.exr"));
    EXPECT_FALSE(holdsVolume(s / "s001.tif"));
    const auto v = loadVolume("g.exr", {{s.dir.string()}}, d);
    ASSERT_TRUE(v) << messages(d);
    EXPECT_EQ(v->depth, 4);
    const auto at = look(*mapOf(*v), {2.5f / 6, 2.5f / 5, 1.5f / 4});
    const float l = std::sqrt(8.f * 8 + 3 * 3 + 20 * 20);
    EXPECT_NEAR(at[4], 8 / l, 1e-4f); // gradient
    EXPECT_NEAR(at[5], 3 / l, 1e-4f);
    EXPECT_NEAR(at[6], 20 / l, 1e-4f);
    EXPECT_NEAR(at[3], density(2, 2, 1), 1e-6f); // alpha
}

#ifdef ALPENGLOW_MAKE_GRID
TEST(Volumes, GridsOfOpenVdbThroughTheirModule) {
    Scratch s;
    ASSERT_EQ(std::system((std::string(ALPENGLOW_MAKE_GRID) + " '" + (s / "a.vdb") + "'").c_str()), 0);
    Diagnostics d;
    const auto v = loadVolume("a.vdb", {{s.dir.string()}}, d);
    ASSERT_TRUE(v) << messages(d);
    EXPECT_EQ(v->width, 6);
    EXPECT_EQ(v->height, 5);
    EXPECT_EQ(v->depth, 4);
    EXPECT_EQ(v->names, (std::vector<std::string>{"density", "v.x", "v.y", "v.z"}));
    for (auto [x, y, z] : {std::tuple{0, 0, 0}, {5, 4, 3}, {2, 3, 1}}) {
        EXPECT_EQ(v->at(x, y, z)[0], float(x + 10 * y + 100 * z));
        EXPECT_EQ(v->at(x, y, z)[2], float(y));
    }
    auto bytes = bytesOf(s / "a.vdb");
    for (size_t n : {size_t(64), bytes.size() / 2}) { // a child process each
        putBytes(s / "b.vdb", {bytes.begin(), bytes.begin() + std::ptrdiff_t(n)});
        Diagnostics e;
        if (!loadVolume("b.vdb", {{s.dir.string()}}, e)) EXPECT_EQ(e.errors(), 1) << messages(e);
    }
}
#endif

} // namespace volume_test
