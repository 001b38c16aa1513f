// Texture files: opened once, reported once, UDIM sets, declared gamma.
#include "pictures.h"
#include <limits>
#include <thread>

namespace system_test {

using namespace alpenglow;
using namespace alpenglow::texture;
using namespace alpenglow::display::test;
using namespace alpenglow::texture::test;
using display::Image;
using display::makeImage;

TEST(TextureSystem, OpensOnceAndReportsOnce) {
    Scratch s;
    save(s, "Wood.tif", pattern(32, 16, {"r", "g", "b"}));
    Diagnostics d;
    TextureSystem sys(d);
    Handle h = sys.open("Wood.tif", {s.dir.string()});
    ASSERT_TRUE(h) << messages(d);
    EXPECT_EQ(h, sys.open("Wood.tif", {s.dir.string()}));
    EXPECT_EQ(h, sys.open(s / "Wood.tif"));
    EXPECT_TRUE(d.all().empty());
    EXPECT_EQ(h, sys.open("wood.TIF", {s.dir.string()})); // said
    EXPECT_EQ(d.warnings(), 1);
    EXPECT_FALSE(sys.open("stone.tif", {s.dir.string()}));
    EXPECT_FALSE(sys.open("stone.tif", {s.dir.string()}));
    EXPECT_EQ(d.errors(), 1);
    EXPECT_EQ(d.all().back().code, Rie::NoFile);
    auto i = sys.info(h);
    ASSERT_TRUE(i);
    EXPECT_EQ(i->width, 32);
    EXPECT_EQ(i->height, 16);
    EXPECT_EQ(i->channels, 3);
    EXPECT_EQ(i->bits, 8);
    EXPECT_EQ(i->type, "texture");
    EXPECT_FALSE(sys.info(nullptr));
    EXPECT_GT(sys.bytes(), 32u * 16 * 3);
    float v;
    lookup(h, 1, 1, 3.5f / 32, 2.5f / 16, {}, {}, &v);
    EXPECT_EQ(v, float(7 * 3 + 13 * 2 + 31) / 255.0f); // 8-bit data as given
}

TEST(TextureSystem, DamagedFilesAreReportedOnce) {
    Scratch s;
    putBytes(s / "bad.tif", {'I', 'I', 42, 0, 8});
    Diagnostics d;
    TextureSystem sys(d);
    for (int i = 0; i < 3; ++i) EXPECT_FALSE(sys.open("bad.tif", {s.dir.string()}));
    EXPECT_FALSE(sys.open(s / "bad.tif"));
    EXPECT_EQ(d.errors(), 1) << messages(d);
}

// A lamp that saw nothing casts no shadow: said once for a map, however often it is read.
TEST(TextureSystem, EmptyShadowMapsAreSaidOnce) {
    Scratch s;
    Image nothing = makeImage(8, 8, {"z"}), something = nothing;
    nothing.metadata["textureformat"] = something.metadata["textureformat"] = "Shadow";
    for (float& z : nothing.data) z = 1e38f;
    something.data = nothing.data;
    something.data[17] = 5;
    save(s, "nothing.exr", nothing, display::Format::Exr, display::Sample::Float);
    save(s, "something.exr", something, display::Format::Exr, display::Sample::Float);
    Diagnostics d;
    TextureSystem sys(d);
    for (int i = 0; i < 3; ++i) {
        EXPECT_TRUE(sys.open("nothing.exr", {s.dir.string()}));
        EXPECT_TRUE(sys.open("something.exr", {s.dir.string()}));
    }
    ASSERT_EQ(d.all().size(), 1u) << messages(d);
    EXPECT_EQ(d.all()[0].severity, Severity::Warning);
    EXPECT_NE(d.all()[0].message.find("nothing.exr\" is empty"), std::string::npos) << messages(d);
}

TEST(TextureSystem, ManyThreadsOneLoad) {
    Scratch s;
    save(s, "a.tif", pattern(200, 100, {"r", "g", "b"}));
    Diagnostics d;
    TextureSystem sys(d);
    std::vector<std::thread> threads;
    std::vector<Handle> handles(8);
    std::vector<float> values(8);
    for (size_t i = 0; i < 8; ++i)
        threads.emplace_back([&, i] {
            handles[i] = sys.open("a.tif", {s.dir.string()});
            lookup2D(handles[i], 0, 1, 0.3f, 0.4f, 0.1f, 0.02f, 0.01f, 0.05f, {}, &values[i]);
        });
    for (auto& t : threads) t.join();
    for (size_t i = 1; i < 8; ++i) {
        EXPECT_EQ(handles[i], handles[0]);
        EXPECT_EQ(values[i], values[0]);
    }
    EXPECT_TRUE(handles[0]);
}

TEST(TextureSystem, ForgetReadsAgain) {
    Scratch s;
    save(s, "a.tif", constant(4, 4, 0));
    Diagnostics d;
    TextureSystem sys(d);
    float v = -1;
    lookup(sys.open("a.tif", {s.dir.string()}), 0, 1, 0.5f, 0.5f, {}, {}, &v);
    EXPECT_EQ(v, 0);
    save(s, "a.tif", constant(4, 4, 1));
    sys.forget();
    lookup(sys.open("a.tif", {s.dir.string()}), 0, 1, 0.5f, 0.5f, {}, {}, &v);
    EXPECT_EQ(v, 1);
}

TEST(TextureSystem, Udim) {
    Scratch s;
    save(s, "skin.1001.tif", constant(4, 4, 0.2f));
    save(s, "skin.1012.tif", constant(4, 4, 0.8f)); // column 1, row 1
    Diagnostics d;
    TextureSystem sys(d);
    Handle h = sys.open("skin.UDIM.tif", {s.dir.string()});
    ASSERT_TRUE(h) << messages(d);
    LookupOptions o;
    o.fill = 7;
    float v;
    lookup(h, 0, 1, 0.5f, 0.5f, {}, o, &v);
    EXPECT_NEAR(v, 0.2f, 1e-6f);
    lookup(h, 0, 1, 1.5f, 1.5f, {}, o, &v);
    EXPECT_NEAR(v, 0.8f, 1e-6f);
    lookup(h, 0, 1, 1.5f, 0.5f, {}, o, &v);
    EXPECT_EQ(v, 7);
    lookup(h, 0, 1, -0.5f, std::numeric_limits<float>::quiet_NaN(), {}, o, &v);
    EXPECT_EQ(v, 7);
    EXPECT_EQ(sys.info(h)->width, 4);
    EXPECT_TRUE(sys.open("skin.<UDIM>.tif", {s.dir.string()}));
    EXPECT_FALSE(sys.open("hair.UDIM.tif", {s.dir.string()}));
    EXPECT_EQ(d.errors(), 1);
}

TEST(TextureSystem, DeclaredGammaBecomesLinear) {
    Scratch s;
    Image m = constant(4, 4, 0, 4);
    for (size_t i = 0; i < m.data.size(); ++i) m.data[i] = i % 4 == 3 ? 128 / 255.0f : 64 / 255.0f;
    save(s, "plain.png", m, display::Format::Png);
    // The same file with a gAMA chunk (1/2 * 100000) after the 8 + 25 bytes of signature and IHDR.
    std::vector<uint8_t> b = bytesOf(s / "plain.png"), chunk{'g', 'A', 'M', 'A', 0, 0, 0xc3, 0x50};
    uint32_t crc = 0xffffffff; // CRC-32 of PNG, appendix D
    for (uint8_t c : chunk) {
        crc ^= c;
        for (int k = 0; k < 8; ++k) crc = crc & 1 ? crc >> 1 ^ 0xedb88320 : crc >> 1;
    }
    crc = ~crc;
    chunk.insert(chunk.begin(), {0, 0, 0, 4});
    for (int k = 24; k >= 0; k -= 8) chunk.push_back(uint8_t(crc >> k));
    b.insert(b.begin() + 33, chunk.begin(), chunk.end());
    putBytes(s / "half.png", b);
    Diagnostics d;
    TextureSystem sys(d), raw(d, {Wrap::Clamp, false, {}});
    auto value = [&](TextureSystem& system, const char* name, int c) {
        float v;
        lookup(system.open(name, {s.dir.string()}), c, 1, 0.4f, 0.4f, {}, {}, &v);
        return v;
    };
    EXPECT_NEAR(value(sys, "plain.png", 0), 64 / 255.0f, 1e-6f);
    EXPECT_NEAR(value(sys, "half.png", 0), (64 / 255.0f) * (64 / 255.0f), 1e-6f); // v^(1 / 0.5)
    EXPECT_NEAR(value(sys, "half.png", 3), 128 / 255.0f, 1e-6f);                  // alpha is linear as it is
    EXPECT_NEAR(value(raw, "half.png", 0), 64 / 255.0f, 1e-6f);
    EXPECT_TRUE(d.all().empty()) << messages(d);
}

} // namespace system_test
