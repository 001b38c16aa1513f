// Models as RIB: cameras, lights, materials and parts as text, compared with what the fields of glTF mean.
#include "models/check.h"
#include "models/rib.h"
#include "models/ribparts.h"
#include <cmath>
#include <fmt/format.h>
#include <gtest/gtest.h>

namespace models_rib_test {

using namespace alpenglow;
using namespace alpenglow::models;

namespace {

Model oneTriangle() {
    Model m;
    Part p;
    p.P = {0, 0, 0, 9, 9, 9, 1, 0, 0, 0, 1, 0}; // one vertex that nobody uses
    p.st = {{0, 0, 7, 7, 1, 0, 0, 1}};
    p.corners = {0, 2, 3};
    m.meshes.push_back({"t", {p}, {}, kNone});
    m.nodes.resize(1);
    m.nodes[0].meshes = {0};
    m.roots = {0};
    return m;
}

std::string rib(Model m, const RibOptions& o = {}, std::string* notes = nullptr) {
    check(m);
    std::string text;
    const MapMaker maps = [](const MapWish& w) {
        return MapFile{fmt::format("map{}{}", w.texture->image, w.colour ? "c" : "n"), 4};
    };
    writeRib(
        m, o, maps, [&](std::string_view t) { text += t; },
        [&](const std::string& n) {
            if (notes) *notes += n + "\n";
        });
    return text;
}

bool has(const std::string& text, const std::string& what) { return text.find(what) != text.npos; }
#define EXPECT_HAS(text, what) EXPECT_TRUE(has(text, what)) << what << "\n" << text
#define EXPECT_HAS_NOT(text, what) EXPECT_FALSE(has(text, what)) << what << "\n" << text

} // namespace

TEST(ModelRib, LeavesOutVerticesThatNobodyUses) {
    const std::string t = rib(oneTriangle());
    EXPECT_HAS(t, "PointsPolygons [3 ] [0 1 2 ]");
    EXPECT_HAS(t, "\"P\" [0 0 0 1 0 0 0 1 0 ]");
    EXPECT_HAS(t, "st\" [0 0 1 0 0 1 ]");
    EXPECT_HAS(t, "LightSource \"envlight\""); // there is no light in it
    EXPECT_HAS_NOT(rib(oneTriangle(), {.addLights = false}), "LightSource");
}

TEST(ModelRib, SharesWhatSeveralNodesShow) {
    Model m = oneTriangle();
    m.nodes.push_back(m.nodes[0]);
    m.nodes[1].translation[0] = 3;
    m.roots = {0, 1};
    const std::string t = rib(m);
    EXPECT_HAS(t, "ObjectBegin 1\nPointsPolygons");
    EXPECT_HAS(t, "ConcatTransform [1 0 0 0 0 1 0 0 0 0 1 0 3 0 0 1]\nObjectInstance 1");
    EXPECT_EQ(t.find("PointsPolygons"), t.rfind("PointsPolygons"));
}

TEST(ModelRib, CamerasAndLightsHaveTheirUnits) {
    Model m = oneTriangle();
    m.nodes.resize(4);
    m.roots = {0, 1, 2, 3};
    m.cameras.push_back({"eye", true, 0.5, 2, 1, .1, 0});
    m.nodes[1].camera = 0;
    m.nodes[1].translation[2] = 5;
    m.nodes[1].scale[0] = 7; // cameras have no size
    m.lights.push_back({"lamp", LightKind::Point, {1, .5, 0}, 100 * kPi, 0, 0});
    m.lights.push_back({"sun", LightKind::Sun, {1, 1, 1}, 2 * kPi, 0, 0});
    m.nodes[2].light = 0;
    m.nodes[3].light = 1;
    const std::string t = rib(m);
    EXPECT_HAS(t, "Format 960 480 1");
    EXPECT_HAS(t, fmt::format("\"fov\" [{:.9g}]", .5 * 180 / kPi));
    EXPECT_HAS(t, "ScreenWindow -2 2 -1 1");
    EXPECT_HAS(t, "Scale 1 1 -1\nConcatTransform [1 0 0 0 0 1 0 0 0 0 1 0 0 0 -5 1]");
    EXPECT_HAS(t, "\"pointlight\" \"lamp.1\" \"float intensity\" [100] \"color lightcolor\" [1 0.5 0]"); // I / pi
    EXPECT_HAS(t, "\"distantlight\" \"sun.2\" \"float intensity\" [2]");                                 // E / pi
    EXPECT_HAS_NOT(t, "envlight");
    EXPECT_HAS(rib(m, {.lightScale = .01}), "\"float intensity\" [1]");
}

TEST(ModelRib, MaterialsAreThoseOfStandard) {
    Model m = oneTriangle();
    m.images.resize(3);
    m.materials.emplace_back();
    Material& x = m.materials[0];
    m.meshes[0].parts[0].material = 0;
    x.baseColor[0] = .5, x.baseColor[3] = .25;
    x.metalness = 0, x.roughness = .75;
    x.baseColorMap.image = 0;
    x.metalRoughMap.image = 1;
    x.normalMap.image = 2;
    x.emission[0] = 4, x.emission[1] = 1;
    x.alphaMode = AlphaMode::Blend;
    const std::string t = rib(m);
    for (const char* what :
         {"Surface \"standard\" \"color base_color\" [0.5 1 1]", "\"string base_color_map\" \"map0c\"",
          "\"float specular_roughness\" [0.75]", "\"string metalness_map\" \"map1n\"",
          "\"string specular_roughness_map\" \"map1n\"", "\"string normal_map\" \"map2n\"", "\"float emission\" [4]",
          "\"color emission_color\" [1 0.25 0]", "\"color opacity\" [0.25 0.25 0.25]", "\"string opacity_map\" \"map0c\""})
        EXPECT_HAS(t, what);
    m.materials[0].normalMap.scale[0] = 3;
    std::string notes;
    rib(m, {}, &notes);
    EXPECT_HAS(notes, "placed in different ways");
}

TEST(ModelRib, WhatMovesIsBlurred) {
    Model m = oneTriangle();
    m.animations.push_back({"", {{0, Path::Translation, Interpolation::Linear, {0, 1}, {0, 0, 0, 8, 0, 0}}}});
    const std::string t = rib(m, {.time = .5, .shutter = .25});
    EXPECT_HAS(t, "Shutter 0 1");
    EXPECT_HAS(t, "MotionBegin [0 1]\nConcatTransform [1 0 0 0 0 1 0 0 0 0 1 0 4 0 0 1]\n"
                  "ConcatTransform [1 0 0 0 0 1 0 0 0 0 1 0 6 0 0 1]\nMotionEnd");
    EXPECT_HAS_NOT(rib(m, {.time = .5}), "Motion");
}

TEST(ModelRib, NamesAreNoRequests) {
    Model m = oneTriangle();
    m.nodes[0].name = "a\" Sphere 1\nWorldEnd";
    EXPECT_HAS(rib(m), "\"a\\\" Sphere 1 WorldEnd\"");
}

} // namespace models_rib_test
