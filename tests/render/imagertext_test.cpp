// What part files keep of an imager's scene: as it was, and whatever is wrong with the text, an error.
#include "render/imagertext.h"
#include "scene/scene.h"
#include <gtest/gtest.h>

namespace imagertext_test {

using namespace alpenglow;
using namespace alpenglow::render;

namespace {

scene::Frame graded() {
    scene::Frame f;
    auto call = std::make_shared<scene::ShaderCall>();
    call->name = "finish";
    call->toWorld.times = {0, 1};
    call->toWorld.keys = {Matrix{}, Matrix{}};
    call->toWorld.keys[1].m[3][0] = 0.1; // no float
    scene::Param words;
    words.name = "words";
    words.type = scene::Type::String;
    words.arrayLength = 2;
    words.strings = {"a \"b\"", "c\n"};
    call->params.push_back(words);
    f.options.imager = call;
    f.options.displays.emplace_back().name = "x.tif";
    f.options.screenWindow = std::vector<float>{-1, 1, -0.1f, 0.1f};
    auto a = std::make_shared<scene::Attributes>();
    a->color = {0.1f, 0.2f, 1e30f};
    a->values["user:x"].numbers = {1, 2, 3};
    a->coshaders["look"] = call;
    f.options.attributes = a;
    f.coordinateSystems["stage"] = call->toWorld;
    return f;
}

TEST(ImagerText, ComesBackAsItWas) {
    const scene::Frame f = graded();
    world::Settings s;
    s.hider = world::Hider::Path;
    s.lanes = 8;
    s.shaderPaths = {"/a/b/../c"};
    Diagnostics d;
    const auto back = imagerFromText(imagerToText(f, s), "p.part", d);
    ASSERT_TRUE(back);
    EXPECT_EQ(d.errors(), 0);
    const scene::Options& o = back->frame->options;
    EXPECT_EQ(o.imager->name, "finish");
    EXPECT_EQ(o.imager->params[0].strings, f.options.imager->params[0].strings);
    EXPECT_EQ(o.imager->params[0].type, scene::Type::String);
    EXPECT_TRUE(o.imager->toWorld.keys == f.options.imager->toWorld.keys);
    EXPECT_EQ(o.displays.at(0).name, "x.tif");
    EXPECT_EQ(o.screenWindow, f.options.screenWindow);
    EXPECT_FALSE(o.frameAspect);
    EXPECT_EQ(o.attributes->color, f.options.attributes->color);
    EXPECT_EQ(o.attributes->values.at("user:x").numbers, (std::vector<float>{1, 2, 3}));
    EXPECT_EQ(o.attributes->coshaders.at("look")->name, "finish");
    EXPECT_TRUE(back->frame->coordinateSystems.at("stage").keys == f.coordinateSystems.at("stage").keys);
    EXPECT_EQ(back->settings.hider, world::Hider::Path);
    EXPECT_EQ(back->settings.lanes, 8);
    EXPECT_EQ(back->settings.shaderPaths, std::vector<std::string>{"/a/c"});
}

TEST(ImagerText, WithoutAnImagerThereIsNone) { EXPECT_EQ(imagerToText(scene::Frame{}, {}), ""); }

TEST(ImagerText, DamagedTextIsAnError) {
    const std::string text = imagerToText(graded(), {});
    for (size_t cut = 0; cut < text.size(); cut += 7) {
        Diagnostics d;
        EXPECT_FALSE(imagerFromText(text.substr(0, cut), "p.part", d)) << cut;
        EXPECT_EQ(d.errors(), 1) << cut;
    }
    for (const char* other : {"[]", "{}", "null", "7", R"({"options":{},"settings":{},"systems":{}})"}) {
        Diagnostics d;
        EXPECT_FALSE(imagerFromText(other, "p.part", d)) << other;
        EXPECT_EQ(d.errors(), 1) << other;
    }
}

} // namespace

} // namespace imagertext_test
