// Pixar's native maps where shaders use them: levels and wrap modes of the file, environments, shadow maps.
#include "../display/pixar_writer.h"
#include "pictures.h"
#include "texture/maketexture.h"
#include "texture/shadow.h"
#include <cmath>

namespace pixar_test {

using namespace alpenglow;
using namespace alpenglow::display::test;
using namespace alpenglow::texture;
using namespace alpenglow::texture::test;

namespace {

display::Image even(int w, int h, float code) {
    display::Image m = display::makeImage(w, h, {"y"});
    for (float& v : m.data) v = code;
    return m;
}

float at(Handle h, float s, float t, float width = 0) {
    float v = -1;
    lookup2D(h, 0, 1, s, t, width, 0, 0, width, {}, &v);
    return v;
}

} // namespace

TEST(PixarMaps, StoredLevelsAndWrapModesAreUsed) {
    Scratch s;
    PixarFile f;
    f.wrap[0] = 3;
    f.wrap[1] = 1;
    // Levels that no filter would make of each other, so that it shows whose they are. The file ends at 4x4.
    f.levels = {even(16, 16, 51), even(8, 8, 102), even(4, 4, 204)};
    putBytes(s / "a.tx", f.bytes());
    Diagnostics d;
    TextureSystem sys(d);
    Handle h = sys.open("a.tx", {s.dir.string()});
    ASSERT_TRUE(h) << messages(d);
    ASSERT_EQ(h->levels.size(), 5u); // 2x2 and 1x1 are made of the last
    EXPECT_FLOAT_EQ(h->levels[4].values[0], 0.8f);
    EXPECT_FLOAT_EQ(at(h, 0.5f, 0.5f), 0.2f);
    EXPECT_FLOAT_EQ(at(h, 7.5f, 0.5f), 0.2f); // periodic
    EXPECT_EQ(at(h, 0.5f, 7.5f), 0);          // black
    const float wide = at(h, 0.5f, 0.5f, 0.5f);
    EXPECT_GT(wide, 0.35f);
    auto info = sys.info(h);
    EXPECT_EQ(info->width, 16);
    EXPECT_EQ(info->bits, 8);
    EXPECT_EQ(info->type, "texture");
    EXPECT_EQ(info->swrap, Wrap::Periodic);
    EXPECT_EQ(info->twrap, Wrap::Black);
    EXPECT_TRUE(d.all().empty()) << messages(d);
}

TEST(PixarMaps, LatLongEnvironment) {
    Scratch s;
    PixarFile f;
    f.type = 3;
    f.big = false;
    f.wrap[0] = 3;
    f.wrap[1] = 2;
    display::Image m = even(64, 32, 0);
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 64; ++x) m.pixel(x, y)[0] = y < 16 ? 255 : 51; // the sky is white
    f.levels = withCodeLevels(m);
    f.coding = [](int) { return Coding::Zlib; };
    putBytes(s / "sky.env", f.bytes());
    Diagnostics d;
    TextureSystem sys(d);
    Handle h = sys.open("sky.env", {s.dir.string()});
    ASSERT_TRUE(h) << messages(d);
    EXPECT_EQ(sys.info(h)->type, "environment");
    EXPECT_EQ(h->levels.size(), 7u); // 64x32 ... 2x1 in the file, 1x1 of it
    float up = -1, down = -1;
    environment(h, sys.latLong(), 0, 1, Vec3(0.1f, 0.2f, 1), {}, {}, {}, &up);
    environment(h, sys.latLong(), 0, 1, Vec3(0.1f, 0.2f, -1), {}, {}, {}, &down);
    EXPECT_FLOAT_EQ(up, 1);
    EXPECT_FLOAT_EQ(down, 0.2f);
}

TEST(PixarMaps, ShadowMap) {
    Scratch s;
    PixarFile f;
    f.type = 2;
    f.floats = true;
    f.coding = [](int) { return Coding::Zlib; };
    display::Image m = even(64, 64, 1e30f);
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 32; ++x) m.pixel(x, y)[0] = 5; // something at depth 5 in the upper left quarter
    f.levels = {m};
    // Parallel projection along z: screen = x / 2, y / 2; the camera is 1 behind the origin.
    f.matrices = {.5f, 0, 0, 0, 0, .5f, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 1, 1};
    putBytes(s / "a.shd", f.bytes());
    Diagnostics d;
    TextureSystem sys(d);
    Handle h = sys.open("a.shd", {s.dir.string()});
    ASSERT_TRUE(h) << messages(d);
    auto info = sys.info(h);
    ASSERT_TRUE(info && info->viewing && info->projection);
    EXPECT_EQ(info->type, "shadow");
    EXPECT_NEAR(info->projection->m[0][0], 0.5, 1e-12);
    EXPECT_NEAR(info->projection->m[1][1], 0.5, 1e-12);
    EXPECT_NEAR(info->viewing->m[3][2], 1, 1e-12);
    EXPECT_EQ(shadowLookup(h, {-1, 1, 4.5}, {}, {}, {}).x, 1);  // depth 5.5, behind it; up is y > 0
    EXPECT_EQ(shadowLookup(h, {-1, 1, 3.5}, {}, {}, {}).x, 0);  // before it
    EXPECT_EQ(shadowLookup(h, {-1, -1, 4.5}, {}, {}, {}).x, 0); // beside it
    EXPECT_EQ(shadowLookup(h, {1, 1, 4.5}, {}, {}, {}).x, 0);
    // MakeShadow takes it as well as a zfile.
    MakeOptions o;
    o.policy = s.policy();
    o.searchPath = {s.dir.string()};
    ASSERT_TRUE(makeShadow("a.shd", "b.shd", o, d)) << messages(d);
    Handle made = sys.open("b.shd", {s.dir.string()});
    ASSERT_TRUE(made);
    EXPECT_EQ(shadowLookup(made, {-1, 1, 4.5}, {}, {}, {}).x, 1);
    EXPECT_TRUE(d.all().empty()) << messages(d);
}

TEST(PixarMaps, SampleAsInputOfMakeTexture) {
    const std::string folder = std::string(ALPENGLOW_SOURCE_DIR) + "/../shared/pixar_textures";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not there";
    Scratch s;
    Diagnostics d;
    MakeOptions o;
    o.policy = s.policy();
    o.searchPath = {folder};
    ASSERT_TRUE(makeTexture("grid2.tx", "grid.exr", o, d)) << messages(d);
    auto native = display::readImage(folder + "/grid2.tx", d), made = display::readImage(s / "grid.exr", d);
    ASSERT_TRUE(native && made) << messages(d);
    EXPECT_EQ(native->data, made->data);
}

} // namespace pixar_test
