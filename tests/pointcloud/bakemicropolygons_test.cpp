// What is baked on primitives without grids, curves here: under hidden once a micropolygon, however many samples see it.
#include "cli/command_folder.h"
#include "pointcloud/cloudfile.h"
#include "pointcloud/make.h"
#include <set>

namespace bakemicropolygons_test {

namespace {

using namespace alpenglow;

class BakeMicropolygons : public cli::testing::CommandFolder {
protected:
    /// Bakes a ribbon of .4 by 1.8 that faces the eye, in a picture of 32 x 32 pixels of 1/16.
    pointcloud::PointCloud ribbon(const std::string& samples, const std::string& rate, const std::string& hider = "hidden",
                                  int threads = 1) {
        write("baker.sl", "surface baker() { Oi = 1; Ci = bake3d(\"c.ptc\", \"\", P, N, \"_du\", gridmax(u) - "
                          "gridmin(u)); }\n");
        write("a.rib",
              "Format 32 32 1\nPixelSamples " + samples + "\nHider \"" + hider +
                  "\"\nDisplay \"a.exr\" \"openexr\" \"rgb\"\nProjection \"orthographic\"\nScreenWindow -1 1 -1 1\n"
                  "WorldBegin\nSurface \"baker\"\nShadingRate " +
                  rate +
                  "\nCurves \"linear\" [2] \"nonperiodic\" \"P\" [0 -.9 5 0 .9 5] \"N\" [0 0 -1 0 0 -1] \"constantwidth\" "
                  "[.4]\nWorldEnd\n");
        std::filesystem::remove(dir / "c.ptc");
        const std::string said = run("render -q -t " + std::to_string(threads) + " a.rib", "2>&1");
        EXPECT_EQ(status, 0) << said;
        Diagnostics d;
        auto c = pointcloud::loadCloud((dir / "c.ptc").string(), d);
        EXPECT_TRUE(c) << pointcloud::test::said(d);
        return c ? std::move(*c) : pointcloud::PointCloud{};
    }
};

} // namespace

// Each point once, on whichever part of the curve rays meet it, by 16 samples a pixel as by 64: these see all of its cells. Their
// parts add up to the ribbon, but for the rounding of steps to quarters of an octave and to whole ones, along both sides.
TEST_F(BakeMicropolygons, SeePointsOnce) {
    for (const char* rate : {"1", "4"}) {
        const pointcloud::PointCloud few = ribbon("4 4", rate), many = ribbon("8 8", rate);
        ASSERT_GT(few.size(), 30u);
        EXPECT_EQ(few.size(), many.size()) << rate;
        std::set<std::pair<float, float>> places;
        double area = 0;
        for (size_t i = 0; i < few.size(); ++i) {
            places.insert({few.P[i].x, few.P[i].y});
            area += double(few.valuesOf(i)[size_t(few.offsetOf("_area"))]);
        }
        EXPECT_EQ(places.size(), few.size()) << rate;
        EXPECT_NEAR(area, .4 * 1.8, .25 * .4 * 1.8) << rate;
    }
}

// gridmin() and gridmax() are of the cell: 1/n of the width, n the number of places across.
TEST_F(BakeMicropolygons, KnowTheirCells) {
    const pointcloud::PointCloud c = ribbon("4 4", "1");
    std::set<float> across;
    for (size_t i = 0; i < c.size(); ++i) across.insert(c.P[i].x);
    for (size_t i = 0; i < c.size(); ++i) EXPECT_NEAR(c.valuesOf(i)[size_t(c.offsetOf("_du"))], 1. / double(across.size()), 1e-6);
}

// The same points from any number of threads, which share no micropolygons.
TEST_F(BakeMicropolygons, SameForAllThreads) {
    const pointcloud::PointCloud one = ribbon("4 4", "1"), three = ribbon("4 4", "1", "hidden", 3);
    ASSERT_EQ(one.size(), three.size());
    for (size_t i = 0; i < one.size(); ++i) {
        EXPECT_EQ(one.P[i], three.P[i]);
        EXPECT_EQ(one.valuesOf(i)[0], three.valuesOf(i)[0]);
    }
}

} // namespace bakemicropolygons_test
