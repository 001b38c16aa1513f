// Scenes inside worlds: archives with a world of their own, and worlds that were not closed.
#include "collect.h"
#include <filesystem>
#include <fstream>
#include <unistd.h>

namespace innerworld_test {

using namespace alpenglow;
using namespace alpenglow::ri;
namespace fs = std::filesystem;

namespace {

class InnerWorld : public ::testing::Test {
protected:
    void SetUp() override {
        dir = fs::temp_directory_path() / ("alpenglow_inner_" + std::to_string(::getpid()) + "_" +
                                           ::testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::create_directories(dir);
    }
    void TearDown() override { fs::remove_all(dir); }
    void write(const std::string& name, const std::string& text) { std::ofstream(dir / name, std::ios::binary) << text; }
    std::unique_ptr<Collected> readHere(const std::string& text) {
        write("main.rib", text);
        auto c = std::make_unique<Collected>();
        RibReader reader({}, *c, c->diagnostics);
        c->ok = reader.readFile((dir / "main.rib").string());
        return c;
    }
    fs::path dir;
};

constexpr const char* kOuter = "Display \"a.tif\" \"file\" \"rgba\"\nProjection \"perspective\" \"fov\" 30\nWorldBegin\n"
                               "AttributeBegin\nColor 1 0 0\nSphere 1 -1 1 360\nAttributeEnd\n"
                               "AttributeBegin\nReadArchive \"inner.rib\"\nAttributeEnd\nSphere 3 -3 3 360\nWorldEnd\n";

} // namespace

TEST_F(InnerWorld, IsAddedToTheOpenOne) {
    for (const auto& [before, after] : {std::pair{"", ""}, {"FrameBegin 7\n", "FrameEnd\n"}}) {
        write("inner.rib", std::string("Display \"inner.tif\" \"file\" \"rgba\"\nProjection \"perspective\" \"fov\" 60\n") +
                               before + "Format 10 20 1\nWorldBegin\nColor 0 1 0\nSphere 2 -2 2 360\nWorldEnd\n" + after);
        auto c = readHere(kOuter);
        const scene::Frame& f = c->frame();
        EXPECT_EQ(f.options.fov, 30) << before;
        ASSERT_EQ(f.options.displays.size(), 1u);
        EXPECT_EQ(f.options.displays[0].name, "a.tif");
        EXPECT_EQ(f.options.xres, scene::Options().xres);
        EXPECT_EQ(f.options.frameNumber, 0);
        ASSERT_EQ(f.primitives.size(), 3u);
        EXPECT_EQ(c->primitive(1).attributes->color, Color(0, 1, 0));
        EXPECT_EQ(c->primitive(2).attributes->color, Color(1, 1, 1));
        EXPECT_EQ(c->diagnostics.errors(), 0) << c->messages();
        int nested = 0;
        for (const Diagnostic& d : c->diagnostics.all()) {
            if (d.message.find("FrameBegin") != 0) EXPECT_EQ(d.message.find("as if it were"), std::string::npos) << d.message;
            nested += d.message.find("WorldBegin inside a world: what it holds is added to the open one; Display and other "
                                     "options of the archive have no effect") == 0;
        }
        EXPECT_EQ(nested, 1) << c->messages();
    }
}

TEST_F(InnerWorld, IsClosedWithItsArchive) {
    write("inner.rib", "WorldBegin\nColor 0 1 0\nSphere 2 -2 2 360\n");
    auto c = readHere(kOuter);
    ASSERT_EQ(c->frame().primitives.size(), 3u) << c->messages();
    EXPECT_EQ(c->primitive(2).attributes->color, Color(1, 1, 1));
    EXPECT_EQ(c->diagnostics.errors(), 1) << c->messages(); // the archive ends before its WorldBegin is closed
}

// Options of an archive that has no world are meant for the open one.
TEST_F(InnerWorld, OptionsWithoutAWorldAreObeyed) {
    write("inner.rib", "Projection \"perspective\" \"fov\" 60\nSphere 2 -2 2 360\n");
    auto c = readHere(kOuter);
    EXPECT_EQ(c->frame().options.fov, 60);
    EXPECT_EQ(c->only().message, "Projection does not belong inside the world: it is done as if it were in its place");
}

// In the same stream a WorldEnd was forgotten: one message, two pictures.
TEST_F(InnerWorld, OfTheSameStreamEndsTheOpenOne) {
    auto c = readHere("WorldBegin\nSphere 1 -1 1 360\nWorldBegin\nSphere 2 -2 2 360\nWorldEnd\n");
    EXPECT_EQ(c->frames.size(), 2u);
    EXPECT_EQ(c->only().message, "WorldBegin inside a world: the open one ends here");
    // An archive that opens a world itself, and forgets to close it.
    write("inner.rib", "WorldBegin\nSphere 1 -1 1 360\nWorldBegin\nSphere 2 -2 2 360\nWorldEnd\n");
    EXPECT_EQ(readHere("ReadArchive \"inner.rib\"\n")->frames.size(), 2u);
}

} // namespace innerworld_test
