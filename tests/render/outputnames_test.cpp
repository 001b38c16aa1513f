// Names of outputs: numbers in them, which displays are maps, and that no two share a file.
#include "render/outputnames.h"
#include "scene/scene.h"
#include <gtest/gtest.h>

namespace outputnames_test {

using namespace alpenglow;
using namespace alpenglow::render;

namespace {

scene::Options frameNumber(int n) {
    scene::Options o;
    o.frameNumber = n;
    o.inFrame = true;
    return o;
}

} // namespace

TEST(OutputNames, NumbersOfFrames) {
    EXPECT_EQ(numberedName("a.exr", 7), "a.0007.exr");
    EXPECT_EQ(numberedName("a.##.exr", 7), "a.07.exr");
    EXPECT_EQ(numberedName("a.%04d.exr", 7), "a.0007.exr");
    EXPECT_EQ(numberedName("dir.x/a", 12345), "dir.x/a.12345");
    EXPECT_EQ(numberedName("dir.x/a", -3), "dir.x/a.-003");
    EXPECT_EQ(withFrame("fr%04d.tif", 7), "fr0007.tif");
    EXPECT_EQ(withFrame("fr%d.tif", 12), "fr12.tif");
    EXPECT_EQ(withFrame("fr####.tif", 12), "fr0012.tif");
    EXPECT_EQ(withFrame("fr#.tif", 123), "fr123.tif");
    EXPECT_EQ(withFrame("50%#.tif", 3), "50%3.tif");
    EXPECT_EQ(withFrame("a%.b%3d", 5), "a%.b  5");
    for (const char* same : {"plain.tif", "50%", "%s", "%f.exr", "%99d", "%-3d", "a%0"}) {
        EXPECT_EQ(withFrame(same, 5), same);
        EXPECT_FALSE(hasFrameNumber(same)) << same;
    }
}

TEST(OutputNames, WhatIsAMap) {
    const auto display = [](const char* type, const char* mode) { return scene::Display{"x", type, mode, {}, {}}; };
    for (const char* type : {"zfile", "shadow", "deepshad", "ZFILE"})
        for (const char* mode : {"z", "rgbaz"}) EXPECT_TRUE(isMap(display(type, mode))) << type << mode;
    EXPECT_TRUE(isMap(display("openexr", "z")));
    EXPECT_TRUE(isMap(display("file", "z")));
    EXPECT_FALSE(isMap(display("file", "rgbz")));
    EXPECT_FALSE(isMap(display("framebuffer", "z")));
    EXPECT_FALSE(isMap(display("null", "z")));
    scene::Options o;
    EXPECT_FALSE(isMapPass(o)); // ri.pic
    o.displays = {display("zfile", "z")};
    EXPECT_TRUE(isMapPass(o));
    o.displays.push_back(display("null", "rgba"));
    EXPECT_TRUE(isMapPass(o));
    o.displays.push_back(display("framebuffer", "rgb"));
    EXPECT_FALSE(isMapPass(o));
}

TEST(OutputNames, NoTwoShareAFile) {
    OutputNames names;
    Diagnostics d;
    const SourcePlace first{"s.rib", 4, 1}, second{"s.rib", 9, 1};
    names.nextWorld();
    EXPECT_EQ(names.take("display", "f.exr", false, {}, first, &d), "f.exr");
    EXPECT_TRUE(d.all().empty());
    EXPECT_EQ(names.take("display", "./f.exr", true, {}, second, &d), "./f.2.exr");
    EXPECT_EQ(names.take("display", "f.exr", false, {}, second, &d), "f.3.exr");
    ASSERT_EQ(d.warnings(), 2);
    EXPECT_NE(d.all()[0].message.find("s.rib:4"), std::string::npos) << d.all()[0].message;
    EXPECT_EQ(d.all()[0].place.line, 9);
    // A later frame puts its number in; a map is made again under its name.
    names.nextWorld();
    EXPECT_EQ(names.take("display", "f.exr", false, frameNumber(12), {}, &d), "f.0012.exr");
    EXPECT_EQ(names.take("display", "m.z", true, frameNumber(12), {}, &d), "m.z");
    names.nextWorld();
    EXPECT_EQ(names.take("display", "f.exr", false, frameNumber(12), {}, &d), "f.0012.2.exr") << "a second world of the frame";
    const int before = d.warnings();
    EXPECT_EQ(names.take("display", "m.z", true, frameNumber(13), {}, &d), "m.z");
    names.release("f.exr");
    EXPECT_EQ(names.take("display", "f.exr", false, frameNumber(14), {}, &d), "f.exr");
    EXPECT_EQ(names.take("display", "-", false, {}, {}, &d), "-");
    EXPECT_EQ(names.take("display", "-", false, {}, {}, &d), "-");
    EXPECT_EQ(d.warnings(), before);
}

TEST(OutputNames, DisplaysOfTheCommandLineAreNumbered) {
    RenderSettings s;
    s.displays = {{"view.png", "png", "rgb", {}, {}}, {"v%02d.png", "png", "rgb", {}, {}}};
    scene::Options o = frameNumber(7);
    o.displays = {{"+a.tif", "file", "rgba", {}, {}}, {"l.z", "zfile", "z", {}, {}}};
    auto names = [&](bool pictures) {
        std::string all;
        for (const NamedDisplay& d : displaysOf(o, s, pictures)) all += d.display.name + (d.user ? "! " : " ");
        return all;
    };
    EXPECT_EQ(names(true), "a.tif l.z view.0007.png! v07.png! ");
    EXPECT_EQ(names(false), "l.z view.0007.png! v07.png! ");
    o = {};
    s.displays.clear();
    EXPECT_EQ(names(true), "ri.pic ");
    EXPECT_EQ(names(false), "");
}

} // namespace outputnames_test
