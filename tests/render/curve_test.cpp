// Which pictures go through the display curve, and which frames keep their own numbers (docs/colour.md).
#include "render/curve.h"
#include "scene/numbers.h"
#include "scene/scene.h"
#include <gtest/gtest.h>

namespace curve_test {

using namespace alpenglow;
using namespace alpenglow::render;

namespace {

scene::Options withDisplay(const std::string& name, const std::string& type, const std::string& mode = "rgb") {
    scene::Options o;
    o.displays = {{name, type, mode, {}, {}}};
    return o;
}

OutputSpec planned(const scene::Options& o, bool path, const RenderSettings& s = {}, const std::string& file = "") {
    Diagnostics d;
    return planOutputs(o, s, path, file, d).pictures.at(0);
}

} // namespace

TEST(Curve, PicturesThatAreLookedAtUnderEveryHider) {
    for (bool path : {false, true}) {
        for (const auto& [name, type] :
             {std::pair{"a.png", "png"}, {"a.jpg", "jpeg"}, {"a.tif", "tiff"}, {"a.png", "file"}, {"a.png", "framebuffer"}}) {
            EXPECT_TRUE(planned(withDisplay(name, type), path).srgb) << type;
            EXPECT_EQ(planned(withDisplay(name, type), path).curve, "sRGB");
        }
        for (const char* file : {"a.png", "a.jpg", "a.tif"}) EXPECT_TRUE(planned({}, path, {}, file).srgb) << file;
        EXPECT_TRUE(planned({}, path).srgb); // ri.pic
        EXPECT_FALSE(planned(withDisplay("a.exr", "openexr"), path).srgb);
        EXPECT_EQ(planned(withDisplay("a.exr", "openexr"), path).curve, "");
        EXPECT_FALSE(planned(withDisplay("a.png", "png", "z"), path).srgb);
        EXPECT_FALSE(planned(withDisplay("a.png", "png", "a"), path).srgb);
        EXPECT_FALSE(planned(withDisplay("a.z", "zfile", "z"), path).srgb);
    }
}

TEST(Curve, WhatIsAskedForGoesFirst) {
    for (bool path : {false, true}) {
        scene::Options o = withDisplay("a.png", "png");
        o.exposureSet = true; // Exposure 1 1
        EXPECT_FALSE(planned(o, path).srgb);
        EXPECT_EQ(planned(o, path).curve, "none, by Exposure");
        o.gamma = 2.2f;
        EXPECT_EQ(planned(o, path).curve, "gamma 2.2, by Exposure");
        o = withDisplay("a.png", "png");
        o.quantizeRgba.set = true;
        EXPECT_EQ(planned(o, path).curve, "none, by Quantize");
        o = withDisplay("a.tif", "tiff");
        o.quantizeRgba = {65535, 0, 65535, 0.5f, true};
        EXPECT_FALSE(planned(o, path).srgb);
        RenderSettings s;
        s.gamma = 1.8f;
        const OutputSpec power = planned(withDisplay("a.png", "png"), path, s);
        EXPECT_FALSE(power.srgb);
        EXPECT_FLOAT_EQ(power.gamma, 1.8f);
        EXPECT_EQ(power.curve, "gamma 1.8, by --gamma");
        s = {};
        s.srgb = true;
        o = withDisplay("a.tif", "file");
        o.gamma = 2.2f;
        o.exposureSet = true;
        const OutputSpec forced = planned(o, path, s);
        EXPECT_TRUE(forced.srgb);
        EXPECT_EQ(forced.gamma, 1);
    }
}

TEST(Curve, OldScenesKeepTheirNumbersUnderHiddenAlone) {
    const scene::Options old = withDisplay("teapot.tiff", "file"), shown = withDisplay("x", "framebuffer");
    for (const scene::Options& o : {old, shown}) {
        EXPECT_TRUE(scene::keepsOwnNumbers(o, false));
        EXPECT_FALSE(scene::keepsOwnNumbers(o, true));
        EXPECT_FALSE(planned(o, false).srgb);
        EXPECT_TRUE(planned(o, true).srgb);
        // The scene decides, not the picture of the command line.
        EXPECT_FALSE(planned(o, false, {}, "a.png").srgb);
        EXPECT_TRUE(planned(o, true, {}, "a.png").srgb);
    }
    EXPECT_FALSE(scene::keepsOwnNumbers({}, false));
    EXPECT_FALSE(scene::keepsOwnNumbers(withDisplay("a.tif", "tiff"), false));
    EXPECT_FALSE(scene::keepsOwnNumbers(withDisplay("a.PNG", "file"), false));
    scene::Options exposed = withDisplay("a.png", "png");
    exposed.exposureSet = true;
    EXPECT_TRUE(scene::keepsOwnNumbers(exposed, false));
}

TEST(Curve, MapsFollowTheSceneUnlessTold) {
    Diagnostics d;
    scene::Options o = withDisplay("teapot.tiff", "file");
    EXPECT_FALSE(scene::readsMapsAsLight(o, false, d));
    EXPECT_TRUE(scene::readsMapsAsLight(o, true, d));
    EXPECT_TRUE(scene::readsMapsAsLight({}, false, d));
    for (const auto& [word, light] : {std::pair{"srgb", true}, {"linear", false}}) {
        scene::Param p;
        p.strings = {word};
        o.values["texture:colorspace"] = p;
        for (bool path : {false, true}) EXPECT_EQ(scene::readsMapsAsLight(o, path, d), light);
    }
    EXPECT_EQ(d.errors(), 0);
    o.values["texture:colorspace"].strings = {"liner"};
    EXPECT_TRUE(scene::readsMapsAsLight(o, true, d));
    EXPECT_EQ(d.errors(), 1);
    EXPECT_NE(d.all().back().hint.find("linear"), std::string::npos);
}

TEST(Curve, TheTableNamesIt) {
    Diagnostics d;
    scene::Options o = withDisplay("a.png", "png");
    EXPECT_EQ(curvesOf(planOutputs(o, {}, true, "", d)), "sRGB");
    o.displays.push_back({"+b.exr", "openexr", "rgb", {}, {}});
    EXPECT_EQ(curvesOf(planOutputs(o, {}, true, "", d)), "sRGB");
    o.displays.push_back({"+c.png", "png", "rgb", {}, {}});
    scene::Param e;
    e.name = "exposure";
    e.numbers = {1, 1};
    o.displays.back().params.push_back(e);
    EXPECT_EQ(curvesOf(planOutputs(o, {}, true, "", d)), "sRGB (a.png); none, by the display's exposure (c.png)");
    EXPECT_EQ(curvesOf(planOutputs(o, {}, true, "x.exr", d)), "none: the numbers are light");
}

} // namespace curve_test
