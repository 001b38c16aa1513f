// Outputs by light path and figures of pixels: how displays ask for them, and what images hold.
#include "render/outputs.h"
#include "scene/scene.h"
#include <gtest/gtest.h>

namespace lightchannels_test {

using namespace alpenglow;
using namespace alpenglow::render;
using Source = OutputVariable::Source;

namespace {

scene::Options asking(const std::string& mode, const std::vector<std::array<std::string, 2>>& channels,
                      scene::Type type = scene::Type::Color) {
    scene::Options o;
    scene::Display d;
    d.name = "x.exr", d.type = "openexr", d.mode = mode;
    o.displays.push_back(d);
    for (const auto& [name, source] : channels) {
        scene::Param p, from;
        p.name = name, p.type = type, p.declared = true;
        from.name = "source", from.type = scene::Type::String, from.strings = {source};
        o.displayChannels[name] = p;
        if (!source.empty()) o.displayChannelParams[name] = {from};
    }
    return o;
}

TEST(LightChannels, NamesAndSources) {
    Diagnostics d;
    RenderSettings s;
    OutputPlan plan = planOutputs(
        asking("rgba,key,direct,variance,shown", {{"key", "color lpe:C.*<L.'key'>"}, {"shown", "color other"}}), s, true, "", d);
    const auto& v = plan.pictures[0].variables;
    ASSERT_EQ(v.size(), 6u);
    EXPECT_EQ(v[2].source, Source::Light);
    EXPECT_EQ(v[2].channels, (std::vector<std::string>{"key.r", "key.g", "key.b"}));
    EXPECT_EQ(v[3].source, Source::Engine); // a shader may have it
    EXPECT_EQ(v[5].source, Source::Light);
    plan.resolve({3, 1}, d, {"direct", "variance"});
    EXPECT_EQ(plan.pictures[0].variables[3].source, Source::Light);
    EXPECT_EQ(plan.pictures[0].variables[4].source, *computedOutput("variance"));
    EXPECT_EQ(plan.pictures[0].variables[4].channels, std::vector<std::string>{"variance"});
    EXPECT_EQ(d.all().size(), 0u);
    const auto back = planFromText(planToText(plan, {}), "x", d);
    ASSERT_TRUE(back);
    EXPECT_EQ(filmChannels(back->first), filmChannels(plan));
    EXPECT_EQ(back->first.lightParts, plan.lightParts);
}

// Outside of path a name that path computes is a shader's, if one has it; else it is an error.
TEST(LightChannels, NamesThatAShaderHas) {
    Diagnostics d;
    OutputPlan plan = planOutputs(asking("albedo,normal", {}), {}, false, "", d);
    EXPECT_EQ(d.all().size(), 0u);
    plan.resolve({3, 3}, d, {"normal"});
    ASSERT_EQ(d.all().size(), 1u);
    EXPECT_NE(d.all()[0].message.find("\"normal\""), std::string::npos);
    EXPECT_EQ(plan.pictures[0].variables[0].source, Source::Engine);
    EXPECT_EQ(plan.pictures[0].variables[0].channels, (std::vector<std::string>{"albedo.r", "albedo.g", "albedo.b"}));
}

TEST(LightChannels, ExpressionsInAMode) {
    Diagnostics d;
    const OutputPlan plan = planOutputs(asking("a,lpe:C<RD>L,lpe:C<L.'key light'>", {}), {}, true, "", d);
    const auto& v = plan.pictures[0].variables;
    ASSERT_EQ(v.size(), 3u);
    EXPECT_EQ(v[1].source, Source::Light);
    EXPECT_EQ(v[2].channels[0], "lpe:C<L.'key light'>.r");
    ASSERT_EQ(plan.lights.size(), 2u);
    EXPECT_EQ(plan.lights[0].expression, "C<RD>L");
    EXPECT_EQ(d.all().size(), 0u);
}

TEST(LightChannels, AnotherNameForAnOutputOfAShader) {
    Diagnostics d;
    const OutputPlan plan = planOutputs(asking("mine", {{"mine", "color Kdiffuse"}}), {}, true, "", d);
    EXPECT_EQ(plan.engineOutputs, std::vector<std::string>{"Kdiffuse"});
    EXPECT_EQ(plan.pictures[0].variables[0].channels[0], "mine.r");
}

TEST(LightChannels, WhatCannotBeIsSaid) {
    Diagnostics d;
    planOutputs(asking("key", {{"key", "lpe:CL"}}), {}, false, "", d);
    ASSERT_EQ(d.all().size(), 1u);
    EXPECT_NE(d.all()[0].message.find("Hider \"path\""), std::string::npos);
    Diagnostics e;
    planOutputs(asking("key", {{"key", "lpe:CL"}}, scene::Type::Float), {}, true, "", e);
    ASSERT_EQ(e.all().size(), 1u);
    EXPECT_NE(e.all()[0].message.find("has 1 numbers; its source has 3"), std::string::npos);
}

TEST(LightChannels, PixelsOfAFilm) {
    Diagnostics d;
    OutputPlan plan = planOutputs(asking("rgba,key,direct,samples,variance", {{"key", "lpe:C<RD>L"}}), {}, true, "", d);
    plan.resolve({3, 1, 1}, d, {"direct", "samples", "variance"});
    FilmDescription f;
    f.width = f.height = 1;
    f.window = {0, 0, 1, 1};
    f.channels = filmChannels(plan);
    Film film(f);
    ASSERT_EQ(d.all().size(), 0u) << d.all()[0].message;
    ASSERT_EQ(plan.lightParts.size(), 2u);
    ASSERT_EQ(plan.pictures[0].variables.size(), 6u);
    ASSERT_FALSE(plan.lightParts[0].empty());
    const int key = plan.lightParts[0][0];
    for (uint32_t s = 0; s < 4; ++s) { // luminance 1 in one scramble, 3 in the other
        integrator::SampleResult r;
        r.color = Color(s % 2 ? 3 : 1);
        r.parts.assign(size_t(plan.parts), Color(0));
        r.parts[size_t(key)] = r.color * .25f;
        r.parts[0] = r.color * .75f;
        std::vector<float> values;
        filmValues(plan, r, &values);
        EXPECT_EQ(values.size(), f.channels.size());
        film.add(0, 0, s, {.radiance = r.color, .alpha = 1, .aovs = values});
    }
    const Image image = filmImage(film, plan, DepthFilter::Min);
    const auto at = [&](const OutputVariable& v) { return image.data[8 + size_t(plan.engineFloats()) + lightFloat(plan, v)]; };
    const auto& v = plan.pictures[0].variables;
    EXPECT_EQ(at(v[2]), .5f); // a quarter of 2
    EXPECT_EQ(at(v[4]), 4);
    EXPECT_NEAR(at(v[5]), 1, 1e-6); // ((1 - 3) / 2)^2
}

} // namespace

} // namespace lightchannels_test
