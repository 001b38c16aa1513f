// Reduced levels of a picture.
#include "pictures.h"

namespace pyramid_test {

using namespace alpenglow;
using namespace alpenglow::texture;
using namespace alpenglow::display::test;
using namespace alpenglow::texture::test;
using display::Image;
using display::makeImage;

TEST(Pyramid, SizesAndMeans) {
    Image m = pattern(13, 6, {"y"});
    auto levels = reducedLevels(m);
    ASSERT_EQ(levels.size(), 3u); // 6x3, 3x1, 1x1
    EXPECT_EQ(levels[0].width, 6);
    EXPECT_EQ(levels[0].height, 3);
    EXPECT_EQ(levels[2].width, 1);
    m.levels = levels;
    EXPECT_EQ(storedLevels(m), 3u);
    m.levels.pop_back();
    EXPECT_EQ(storedLevels(m), 2u);
    // 3 texels to 1: exact thirds. 2 to 1: halves.
    Image three = makeImage(3, 1, {"y"});
    three.data = {1, 2, 6};
    EXPECT_FLOAT_EQ(reduced(three).data[0], 3);
    // 5 to 2: each covers 2.5 texels.
    Image five = makeImage(5, 1, {"y"});
    five.data = {1, 2, 3, 4, 5};
    EXPECT_FLOAT_EQ(reduced(five).data[0], (1 + 2 + 1.5f) / 2.5f);
}

/// A periodic picture that is turned by two texels is reduced to one that is turned by one, whichever rows are asked for again.
TEST(Pyramid, PeriodicPicturesTurn) {
    const Image m = pattern(16, 24, {"r", "g", "b"});
    for (const char* filter : {"box", "triangle", "lanczos"})
        for (const auto& [dx, dy] : {std::pair(2, 0), std::pair(0, 2), std::pair(6, 10)}) {
            const PictureRows turned{16, 24, m.channels, [&, right = dx, down = dy](int y, float* to) {
                                         for (int x = 0; x < 16; ++x)
                                             std::copy_n(m.pixel((x + right) % 16, (y + down) % 24), 3, to + 3 * x);
                                     }};
            const Image a = reduced(m, {filter}, Wrap::Periodic, Wrap::Periodic),
                        b = reduced(turned, {filter}, Wrap::Periodic, Wrap::Periodic);
            ASSERT_EQ(b.height, 12);
            for (int y = 0; y < 12; ++y)
                for (int x = 0; x < 8; ++x)
                    for (int c = 0; c < 3; ++c)
                        EXPECT_EQ(b.pixel(x, y)[c], a.pixel((x + dx / 2) % 8, (y + dy / 2) % 12)[c]) << filter << x << " " << y;
            EXPECT_EQ(reducedLevels(turned, {filter}).size(), 4u); // 8x12, 4x6, 2x3, 1x1
        }
}

TEST(Pyramid, EveryKernelKeepsAConstant) {
    Image m = constant(20, 15, 0.75f, 1);
    for (const char* f : {"box", "triangle", "gaussian", "catmull-rom", "mitchell", "lanczos", "sinc", "disk", "bessel"}) {
        EXPECT_TRUE(isReductionFilter(f));
        for (float w : {0.1f, 1.0f, 3.0f})
            for (auto& l : reducedLevels(m, {f, w, w}))
                for (float v : l.data) EXPECT_NEAR(v, 0.75f, 1e-5f) << f << " " << w;
    }
    EXPECT_FALSE(isReductionFilter("nonesuch"));
}

} // namespace pyramid_test
