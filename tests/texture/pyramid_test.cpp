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
