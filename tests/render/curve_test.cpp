// Which pictures go through the display curve, and how maps of 8 bits are read (docs/colour.md).
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

TEST(Curve, PicturesThatAreLookedAtUnderPathAlone) {
    for (bool path : {false, true}) {
        const std::string said = path ? "sRGB" : "none: numbers are as shaders compute them (--gamma srgb changes that)";
        for (const auto& [name, type] : {std::pair{"a.png", "png"},
                                         {"a.jpg", "jpeg"},
                                         {"a.tif", "tiff"},
                                         {"a.tif", "file"},
                                         {"a.png", "file"},
                                         {"a.png", "framebuffer"}}) {
            EXPECT_EQ(planned(withDisplay(name, type), path).srgb, path) << type;
            EXPECT_EQ(planned(withDisplay(name, type), path).curve, said);
        }
        for (const char* file : {"a.png", "a.jpg", "a.tif"}) EXPECT_EQ(planned({}, path, {}, file).srgb, path) << file;
        EXPECT_EQ(planned({}, path).srgb, path); // ri.pic
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

TEST(Curve, MapsFollowTheHiderUnlessTold) {
    using enum scene::MapColours;
    Diagnostics d;
    scene::Options o = withDisplay("a.png", "png");
    EXPECT_EQ(scene::mapColours(o, false, d), AsTheyAre);
    EXPECT_EQ(scene::mapColours(o, true, d), Srgb);
    o.exposureSet = true;
    EXPECT_EQ(scene::mapColours(o, true, d), Srgb);
    for (const auto& [word, expected] : {std::pair{"srgb", Srgb}, {"linear", Light}}) {
        scene::Param p;
        p.strings = {word};
        o.values["texture:colorspace"] = p;
        for (bool path : {false, true}) EXPECT_EQ(scene::mapColours(o, path, d), expected);
    }
    EXPECT_EQ(d.errors(), 0);
    o.values["texture:colorspace"].strings = {"liner"};
    EXPECT_EQ(scene::mapColours(o, true, d), Srgb);
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
