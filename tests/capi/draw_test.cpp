// Programs in C of 1989 draw the specification's examples: as closed forms say, and to the bit as their RIB is drawn.
#include "../sanitized.h"
#include "folder.h"
#include <cmath>

namespace capi_draw_test {

using namespace alpenglow;

namespace {

class CPrograms : public capi::testing::Folder {
protected:
    void SetUp() override {
        capi::testing::Folder::SetUp();
        if (kSanitized) GTEST_SKIP() << "programs in C are not sanitized, so they cannot load the library";
    }
    /// Pixels of `name` whose alpha is 1, and the sum of all.
    std::pair<int, double> covered(const display::Image& i) {
        const int a = i.channel("a");
        std::pair<int, double> sum{0, 0};
        for (int y = 0; y < i.height; ++y)
            for (int x = 0; x < i.width; ++x) {
                sum.first += i.pixel(x, y)[a] == 1;
                sum.second += double(i.pixel(x, y)[a]);
            }
        return sum;
    }
};

// Screen space is -1 to 1, so a square of side 1 is half the picture wide, and its edges are edges of pixels.
TEST_F(CPrograms, ASquareIsWhereItIsPut) {
    EXPECT_EQ(runC("examples", "square"), "");
    EXPECT_EQ(status, 0);
    const display::Image i = picture("square.exr");
    ASSERT_EQ(i.width, 64);
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
            const bool in = x >= 16 && x < 48 && y >= 16 && y < 48;
            EXPECT_EQ(i.pixel(x, y)[i.channel("r")], in ? 1 : 0) << x << "," << y;
            EXPECT_EQ(i.pixel(x, y)[i.channel("g")], 0);
            EXPECT_EQ(i.pixel(x, y)[i.channel("a")], in ? 1 : 0);
        }
}

// Of a carpet of level 3 (8/9)^3 of the square of side 1.8 remain; a pixel is 1/32 wide.
TEST_F(CPrograms, AProceduralIsSubdivided) {
    EXPECT_EQ(runC("examples", "procedural"), "");
    EXPECT_NEAR(covered(picture("procedural.exr")).second / (32 * 32), 1.8 * 1.8 * std::pow(8.0 / 9, 3), .05);
}

// Three discs of radius .3, red, green and blue from left to right.
TEST_F(CPrograms, ObjectsAreInstances) {
    EXPECT_EQ(runC("examples", "objects"), "");
    const display::Image i = picture("objects.exr");
    EXPECT_NEAR(covered(i).second / (32 * 32), 3 * M_PI * .09, .02);
    for (int k = 0; k < 3; ++k)
        for (int c = 0; c < 3; ++c) {
            const char* names[] = {"r", "g", "b"};
            EXPECT_EQ(i.pixel(32 + int(std::lround(.7 * 32)) * (k - 1), 32)[i.channel(names[c])], k == c ? 1 : 0) << k << c;
        }
}

// A square turned by 45 degrees covers what it covered before; by 90 it is itself.
TEST_F(CPrograms, FramesAreDrawnOneByOne) {
    EXPECT_EQ(runC("examples", "frames"), "");
    EXPECT_NEAR(covered(picture("frames1.exr")).second, 32 * 32, 12);
    EXPECT_EQ(covered(picture("frames2.exr")).first, 32 * 32);
    EXPECT_EQ(run("ls"), "frames1.exr\nframes2.exr\n");
    EXPECT_EQ(runC("examples", "frames", "ALPENGLOW_OPTIONS='--frames 2 -o only.exr'"), "");
    EXPECT_EQ(run("ls"), "frames1.exr\nframes2.exr\nonly.0002.exr\n");
}

TEST_F(CPrograms, TheirRibIsTheSamePicture) {
    for (const std::string scene :
         {"square", "cubes", "quadrics", "motion", "solid", "surfaces", "objects", "frames", "procedural"}) {
        EXPECT_EQ(runC("examples", scene), "") << scene;
        EXPECT_EQ(status, 0) << scene;
        const std::string picture1 = scene == "frames" ? "frames1.exr" : scene + ".exr";
        const display::Image drawn = picture(picture1);
        EXPECT_GT(covered(drawn).second, 100) << scene;
        for (const std::string name : {"ascii.rib", "packed.rib.gz"}) {
            EXPECT_EQ(runC("examples", scene + " " + name), "") << scene;
            std::filesystem::remove(dir / picture1);
            EXPECT_EQ(run("'" ALPENGLOW_PROGRAM "' render -q " + name), "") << scene << " " << name;
            const display::Image read = picture(picture1);
            EXPECT_EQ(drawn.channels, read.channels);
            EXPECT_TRUE(drawn.data == read.data) << scene << " " << name;
        }
        EXPECT_EQ(run("zcat packed.rib.gz | cmp - ascii.rib"), "") << scene;
    }
}

TEST_F(CPrograms, TheEnvironmentHasTheOptionsOfTheProgram) {
    EXPECT_EQ(runC("examples", "square", "ALPENGLOW_OPTIONS='--format 32x32 -o small.exr'"), "");
    EXPECT_EQ(picture("small.exr").width, 32);
    EXPECT_EQ(covered(picture("small.exr")).first, 256);
    const std::string said = runC("examples", "square", "ALPENGLOW_OPTIONS='--no-such'");
    EXPECT_NE(said.find("ALPENGLOW_OPTIONS"), said.npos) << said;
    EXPECT_EQ(picture("square.exr").width, 64); // drawn all the same
    EXPECT_EQ(runC("examples", "square", "RISERVER=other.rib"), "");
    EXPECT_EQ(text("other.rib").substr(0, 33), "##RenderMan RIB-Structure 1.0\nver");
}

TEST_F(CPrograms, OrdersThatNobodyShouldUse) {
    std::string said = runC("orders", "nobody");
    EXPECT_EQ(status, 23) << said; // RIE_NOTSTARTED
    EXPECT_NE(said.find("23 2 RiSphere: nobody takes the call"), said.npos) << said;
    EXPECT_NE(said.find("handled 3"), said.npos) << said;

    said = runC("orders", "abort");
    EXPECT_EQ(status, 1);
    EXPECT_NE(said.find("error: AttributeEnd without AttributeBegin"), said.npos) << said;
    EXPECT_EQ(said.find("still here"), said.npos);

    EXPECT_EQ(runC("orders", "ignore"), "handled 0\n");
    EXPECT_EQ(status, 24); // RIE_NESTING
    said = runC("orders", "print");
    EXPECT_NE(said.find("call:2: error: AttributeEnd without AttributeBegin"), said.npos) << said;
    EXPECT_EQ(runC("orders", "leave"), "left with 24\nhandled 0\n");
    EXPECT_EQ(runC("orders", "open"), "handled 0\n");
    EXPECT_EQ(status, 0);
    said = runC("orders", "command");
    EXPECT_EQ(said.substr(0, 5), "11 2 ") << said; // RIE_INCAPABLE, of RiBegin; then nobody takes RiEnd
    EXPECT_FALSE(std::filesystem::exists(dir / "made"));
}

} // namespace

} // namespace capi_draw_test
