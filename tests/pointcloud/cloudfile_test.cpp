// Files of point clouds: what is written comes back; what is cut short or damaged is refused with a reason.
#include "../nightly.h"
#include "pointcloud/bakefile.h"
#include "pointcloud/limits.h"
#include "pointcloud/make.h"
#include <random>

namespace cloudfile_test {

using namespace alpenglow;
using namespace alpenglow::pointcloud;
using namespace alpenglow::pointcloud::test;

namespace {

TEST_F(Clouds, ComeBackAsTheyWere) {
    const PointCloud c = square(20);
    for (const char* name : {"a.ptc", "a.ply"}) {
        Diagnostics d;
        ASSERT_TRUE(saveCloud(path(name), c, policy(), d)) << said(d);
        ASSERT_TRUE(saveCloud(path(name), c, policy(), d)) << "over itself " << said(d);
        const auto back = loadCloud(path(name), d);
        ASSERT_TRUE(back) << said(d);
        expectSame(c, *back);
    }
}

TEST_F(Clouds, EmptyOnesToo) {
    Diagnostics d;
    PointCloud none;
    for (const char* name : {"a.ptc", "a.ply"}) {
        ASSERT_TRUE(saveCloud(path(name), none, policy(), d));
        const auto back = loadCloud(path(name), d);
        ASSERT_TRUE(back) << said(d);
        EXPECT_EQ(back->size(), 0u);
    }
    ASSERT_TRUE(saveBrickMap(path("a.bkm"), none, policy(), d));
    const auto map = openMap(path("a.bkm"), d);
    ASSERT_TRUE(map) << said(d);
    std::vector<float> out;
    EXPECT_FALSE(map->lookup({{0, 0, 0}, {0, 0, 0}, 1, -1}, out));
}

TEST_F(Clouds, CutShortAtEvery64thByte) {
    Diagnostics made;
    const PointCloud c = square(6);
    saveCloud(path("a.ptc"), c, policy(), made);
    saveCloud(path("a.ply"), c, policy(), made);
    saveBrickMap(path("a.bkm"), c, policy(), made);
    Baked flat{ChannelType::Color, {0, 0, 1, 2, 3, 1, 1, 4, 5, 6}};
    saveBaked(path("a.bake&binary"), flat, policy(), made);
    ASSERT_EQ(made.errors(), 0) << said(made);
    for (const char* name : {"a.ptc", "a.ply", "a.bake"}) {
        const std::string all = bytes(name);
        for (size_t n = 0; n < all.size(); n += 64) {
            write("cut", all.substr(0, n));
            Diagnostics d;
            const bool read =
                std::string(name) == "a.bake" ? loadBaked(path("cut"), d).has_value() : loadCloud(path("cut"), d).has_value();
            EXPECT_FALSE(read) << name << " at " << n;
            EXPECT_EQ(d.errors(), 1) << said(d);
        }
    }
    const std::string all = bytes("a.bkm");
    for (size_t n = 0; n < all.size(); n += 64) {
        write("cut", all.substr(0, n));
        Diagnostics d;
        EXPECT_EQ(openMap(path("cut"), d), nullptr) << n;
        EXPECT_EQ(d.errors(), 1) << said(d);
    }
}

// Bytes changed by chance: what is read at all is as large as its header says and finite.
TEST_F(Clouds, Damaged) { // each kind of file 500 times nightly
    Diagnostics made;
    const PointCloud c = square(5);
    saveCloud(path("a.ptc"), c, policy(), made);
    saveCloud(path("a.ply"), c, policy(), made);
    saveBrickMap(path("a.bkm"), c, policy(), made);
    saveBaked(path("a.bake"), {ChannelType::Float, {0, 0, 1, 1, 1, 4}}, policy(), made);
    std::mt19937 random(7);
    for (const char* name : {"a.ptc", "a.ply", "a.bkm", "a.bake"}) {
        const std::string all = bytes(name);
        for (int turn = 0; turn < (nightly() ? 500 : 125); ++turn) {
            std::string hurt = all;
            for (int k = 0; k < 1 + turn % 4; ++k)
                hurt[random() % (turn % 2 ? std::min<size_t>(hurt.size(), 300) : hurt.size())] = char(random());
            write("hurt", hurt);
            Diagnostics d;
            if (isBaked(path("hurt"))) {
                if (const auto b = loadBaked(path("hurt"), d)) EXPECT_LE(pictureOf(*b).pixels.size(), 1u << 12);
            } else if (const auto map = openMap(path("hurt"), d)) {
                std::vector<float> out(size_t(map->width()));
                for (const float r : {0.f, .1f, 3.f})
                    if (map->lookup({{.5f, .5f, 0}, {0, 0, 1}, r, -1}, out))
                        for (const float v : out) EXPECT_TRUE(std::isfinite(v));
            }
        }
    }
}

TEST_F(Clouds, AHeaderThatPromisesTooMuch) {
    Diagnostics d;
    saveCloud(path("a.ptc"), square(3), policy(), d);
    std::string many = "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty float x\nproperty float "
                       "y\nproperty float z\nend_header\n";
    write("b.ply", many);
    EXPECT_FALSE(loadCloud(path("b.ply"), d));
    EXPECT_NE(said(d).find("more than " + std::to_string(limits::kCloudPoints)), std::string::npos) << said(d);
    many.replace(many.find("4000000000"), 10, "100000000");
    write("b.ply", many);
    EXPECT_FALSE(loadCloud(path("b.ply"), d));
    EXPECT_NE(said(d).find("cut short"), std::string::npos);
    PointCloud wide;
    for (int i = 0; i <= limits::kCloudChannels; ++i) wide.channels.push_back({"c" + std::to_string(i), ChannelType::Float});
    saveCloud(path("w.ptc"), wide, policy(), d);
    EXPECT_FALSE(loadCloud(path("w.ptc"), d));
    EXPECT_NE(said(d).find("more than " + std::to_string(limits::kCloudChannels) + " channels"), std::string::npos) << said(d);
    EXPECT_GT(limits::kCloudBytes, limits::kCloudPoints * 28); // a cloud of positions alone fits
}

TEST_F(Clouds, PlyOfOthers) {
    Diagnostics d;
    write("a.ply",
          "ply\r\nformat ascii 1.0\r\ncomment by hand\r\nelement vertex 2\r\nproperty double x\r\nproperty float y\r\nproperty "
          "int z\r\n"
          "property uchar red\r\nproperty uchar green\r\nproperty uchar blue\r\nproperty float heat\r\nelement face 1\r\n"
          "property list uchar int vertex_indices\r\nend_header\r\n1 2 3 255 0 51 .5\r\n-1 -2.5 -3 0 0 0 1e2\r\n3 0 1 1\r\n");
    const auto c = loadCloud(path("a.ply"), d);
    ASSERT_TRUE(c) << said(d);
    EXPECT_EQ(c->channels, (std::vector<Channel>{{"color", ChannelType::Color}, {"heat", ChannelType::Float}}));
    EXPECT_EQ(c->P[1].y, -2.5f);
    EXPECT_EQ(c->values, (std::vector<float>{1, 0, .2f, .5f, 0, 0, 0, 100}));
    EXPECT_EQ(length(c->N[0]), 0);
}

TEST_F(Clouds, BakedTextIsReadable) {
    Diagnostics d;
    const Baked b{ChannelType::Color, {.25f, .5f, 1, 0, .1f, 1, 0, 2, 3, 4}};
    ASSERT_TRUE(saveBaked(path("a.bake"), b, policy(), d));
    EXPECT_EQ(bytes("a.bake"), "# bake 1 color\n0.25 0.5 1 0 0.1\n1 0 2 3 4\n");
    ASSERT_TRUE(saveBaked(path("b.bake&binary"), b, policy(), d));
    for (const char* name : {"a.bake", "b.bake"}) {
        const auto back = loadBaked(path(name), d);
        ASSERT_TRUE(back) << said(d);
        EXPECT_EQ(back->rows, b.rows);
        EXPECT_EQ(back->type, b.type);
    }
    for (const char* wrong : {"# bake 1 string\n0 0 1\n", "# bake 1 float\n0 0\n", "# bake 1 float\n0 0 1 2\n",
                              "# bake 1 float\n0 0 x\n", "# bake 1 float\n0 0 nan\n", "# bake 1 float\n0 0 1"}) {
        write("w.bake", wrong);
        Diagnostics w;
        EXPECT_FALSE(loadBaked(path("w.bake"), w)) << wrong;
        EXPECT_EQ(w.errors(), 1);
    }
}

// Points by chance: a linear function comes back to rounding, also between them; holes are filled with what is near.
TEST_F(Clouds, PicturesOfWhatWasBaked) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> u(0, 1);
    Baked b{ChannelType::Float, {}};
    for (int i = 0; i < 4000; ++i) {
        const float s = u(random), t = u(random);
        b.rows.insert(b.rows.end(), {s, t, 3 * s - 2 * t + .5f});
    }
    b.rows.insert(b.rows.end(), {1.5f, 0, 100});
    const BakedPicture p = pictureOf(b);
    EXPECT_EQ(p.side, 64);
    EXPECT_EQ(p.outside, 1u);
    for (int y = 0; y < p.side; ++y)
        for (int x = 0; x < p.side; ++x) {
            const double s = (x + .5) / p.side, t = (y + .5) / p.side;
            EXPECT_NEAR(p.pixels[size_t(y * p.side + x)], 3 * s - 2 * t + .5, 1e-5);
        }
    EXPECT_LE(p.side, limits::kBakedSide);
    Baked half{ChannelType::Float, {}};
    for (int i = 0; i < 1000; ++i) half.rows.insert(half.rows.end(), {u(random) / 2, u(random), 7});
    for (const float v : pictureOf(half).pixels) EXPECT_NEAR(v, 7, 1e-5);
}

} // namespace

} // namespace cloudfile_test
