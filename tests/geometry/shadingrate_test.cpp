// Attribute "shade" "relativeshadingrate" is a factor of ShadingRate.
#include "geometry/dice.h"
#include "scene/shadingrate.h"
#include <gtest/gtest.h>

namespace shadingrate_test {

using namespace alpenglow;

TEST(ShadingRate, TheRelativeOneIsAFactor) {
    scene::Attributes a;
    a.shadingRate = 4;
    EXPECT_EQ(scene::shadedArea(a), 4);
    EXPECT_EQ(geometry::diceEdge(a), 2); // the side of a square of that area
    a.values["shade:relativeshadingrate"].numbers = {.25f};
    EXPECT_EQ(scene::shadedArea(a), 1);
    EXPECT_EQ(geometry::diceEdge(a), 1);
    for (float wrong : {0.f, -1.f}) {
        a.values["shade:relativeshadingrate"].numbers = {wrong};
        EXPECT_EQ(scene::shadedArea(a), 4) << wrong;
    }
}

} // namespace shadingrate_test
