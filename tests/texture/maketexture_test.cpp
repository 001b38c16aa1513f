// Files that MakeTexture and its like write, read back.
#include "pictures.h"
#include "texture/maketexture.h"
#include "texture/shadow.h"

namespace maketexture_test {

using namespace alpenglow;
using namespace alpenglow::texture;
using namespace alpenglow::display::test;
using namespace alpenglow::texture::test;
using display::Image;
using display::makeImage;

TEST(MakeTexture, LevelsAreReadAsTheyAre) {
    Scratch s;
    Image m = pattern(48, 20, {"r", "g", "b"});
    save(s, "in.tif", m);
    Diagnostics d;
    MakeOptions o;
    o.swrap = "periodic";
    o.twrap = "clamp";
    o.policy = s.policy();
    o.searchPath = {s.dir.string()};
    ASSERT_TRUE(makeTexture("in.tif", "out.tx", o, d)) << messages(d);
    display::ReadOptions levels;
    levels.levels = true;
    auto r = display::readImage(s / "out.tx", d, levels);
    ASSERT_TRUE(r) << messages(d);
    EXPECT_EQ(r->data, m.data);
    EXPECT_EQ(storedLevels(*r), 5u);
    EXPECT_EQ(r->levels.size(), 5u); // 24x10 12x5 6x2 3x1 1x1
    EXPECT_EQ(r->metadata["wrapmodes"], "periodic,clamp");
    TextureSystem sys(d);
    Handle h = sys.open("out.tx", {s.dir.string()});
    ASSERT_TRUE(h);
    EXPECT_EQ(h->swrap, Wrap::Periodic);
    EXPECT_EQ(h->twrap, Wrap::Clamp);
    Image marked = *r; // prove that stored levels are used: change one
    for (float& v : marked.levels.back().data) v = 42;
    display::WriteOptions w;
    w.tile = 16;
    w.policy = s.policy();
    ASSERT_TRUE(display::writeImage("marked.tx", marked, w, d));
    float v;
    lookup(sys.open("marked.tx", {s.dir.string()}), 0, 1, 0.5f, 0.5f, {}, blurred(50), &v);
    EXPECT_EQ(v, 42);
    EXPECT_TRUE(d.all().empty()) << messages(d);
}

TEST(MakeTexture, BadArgumentsAreReportedAndMended) {
    Scratch s;
    save(s, "in.tif", constant(8, 8, 0.5f));
    Diagnostics d;
    MakeOptions o;
    o.swrap = "wrapped";
    o.filter = "fuzzy";
    o.swidth = -1;
    o.policy = s.policy();
    o.searchPath = {s.dir.string()};
    EXPECT_TRUE(makeTexture("in.tif", "out.tx", o, d));
    EXPECT_EQ(d.errors(), 3) << messages(d);
    EXPECT_FALSE(makeTexture("none.tif", "out2.tx", o, d));
    EXPECT_FALSE(std::filesystem::exists(s / "out2.tx"));
}

TEST(MakeTexture, LatLongAndShadow) {
    Scratch s;
    save(s, "sky.exr", constant(16, 8, 2), display::Format::Exr, display::Sample::Float);
    Diagnostics d;
    MakeOptions o;
    o.policy = s.policy();
    o.searchPath = {s.dir.string()};
    ASSERT_TRUE(makeLatLongEnvironment("sky.exr", "sky.env", o, d)) << messages(d);
    TextureSystem sys(d);
    EXPECT_EQ(sys.info(sys.open("sky.env", {s.dir.string()}))->type, "environment");

    // A camera at the origin, orthographic over [-1,1]^2: everything at depth 5 but the left half, which is at depth 2.
    Image z = makeImage(64, 64, {"z"});
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) z.pixel(x, y)[0] = x < 32 ? 2.0f : 5.0f;
    z.worldToCamera = Matrix{};
    z.worldToNDC = display::screenToNDC();
    save(s, "light.z", z, display::Format::Exr, display::Sample::Float);
    ASSERT_TRUE(makeShadow("light.z", "light.shd", o, d)) << messages(d);
    Handle h = sys.open("light.shd", {s.dir.string()});
    ASSERT_TRUE(h);
    EXPECT_EQ(sys.info(h)->type, "shadow");
    ASSERT_TRUE(sys.info(h)->projection);
    EXPECT_NEAR(sys.info(h)->projection->m[1][1], 1, 1e-12); // back to screen: y up
    ShadowOptions so;
    EXPECT_EQ(shadowLookup(h, {-0.5, 0, 3}, {}, {}, so).x, 1); // behind the near half
    EXPECT_EQ(shadowLookup(h, {0.5, 0, 3}, {}, {}, so).x, 0);  // before the far half
    EXPECT_EQ(shadowLookup(h, {0.5, 0, 6}, {}, {}, so).x, 1);
    EXPECT_EQ(shadowLookup(h, {-0.5, 0, 2}, {}, {}, so).x, 0);        // on the surface itself
    EXPECT_EQ(shadowLookup(h, {3, 0, 100}, {}, {}, so).x, 0);         // where the map does not look
    EXPECT_NEAR(shadowLookup(h, {0, 0, 3}, {}, {}, so).x, 0.5, 1e-6); // the edge, between two texels
    so.sblur = so.tblur = 0.2f;
    EXPECT_NEAR(shadowLookup(h, {0, 0, 3}, {}, {}, so).x, 0.5, 1e-6);
    so.bias0 = so.bias1 = 2;
    EXPECT_EQ(shadowLookup(h, {-0.5, 0, 3}, {}, {}, so).x, 0);
    EXPECT_EQ(shadowLookup(nullptr, {0, 0, 3}, {}, {}, so).x, 0);
    EXPECT_TRUE(d.all().empty()) << messages(d);
    Image bare = constant(4, 4, 1, 1);
    save(s, "bare.z", bare, display::Format::Exr, display::Sample::Float);
    EXPECT_TRUE(makeShadow("bare.z", "bare.shd", o, d));
    EXPECT_EQ(d.warnings(), 1);
}

} // namespace maketexture_test
