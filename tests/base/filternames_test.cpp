// Spellings of filters in exporters and other renderers: JPatch writes "catmullrom", bindings of C the functions' names.
#include "base/filternames.h"
#include <gtest/gtest.h>

namespace filternames_test {

using namespace alpenglow;

TEST(FilterNames, SpellingsOfOneFilterAreOne) {
    for (const char* same : {"catmull-rom", "catmullrom", "CatmullRom", "catmull_rom", "RiCatmullRomFilter", "catmull"})
        EXPECT_EQ(filterNameOf(same), "catmull-rom") << same;
    for (const char* same : {"separable-catmull-rom", "separablecatmullrom", "RiSeparableCatmullRomFilter"})
        EXPECT_EQ(filterNameOf(same), "separable-catmull-rom") << same;
    EXPECT_EQ(filterNameOf("Gaussian"), "gaussian");
    EXPECT_EQ(filterNameOf("bspline"), "b-spline");
    EXPECT_EQ(filterNameOf("blackmanharris"), "blackman-harris");
    EXPECT_EQ(filterNameOf("tent"), "triangle");
    EXPECT_EQ(filterNameOf("radial-bspline"), "radial-bspline");
}

TEST(FilterNames, OthersStayAsTheyAre) {
    for (const char* none : {"", "gausian", "rifilter", "-", "Filter", "zmin"}) EXPECT_EQ(filterNameOf(none), none);
}

} // namespace filternames_test
