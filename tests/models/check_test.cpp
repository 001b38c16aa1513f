// What is wrong with a model is left out and reported; what is sound goes through the pipe of modules unchanged.
#include "models/check.h"
#include "models/stream.h"
#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace models_check_test {

using namespace alpenglow;
using namespace alpenglow::models;

namespace {

Part triangle() {
    Part p;
    p.P = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    p.corners = {0, 1, 2};
    return p;
}

Model oneNode() {
    Model m;
    m.meshes.push_back({"t", {triangle()}, {}, kNone});
    m.nodes.emplace_back();
    m.nodes[0].meshes = {0};
    m.roots = {0};
    return m;
}

std::string said(const Model& m) {
    std::string all;
    for (const Note& n : m.notes) all += (n.error ? "error: " : "warning: ") + n.text + "\n";
    return all;
}

} // namespace

TEST(ModelCheck, LeavesSoundModelsAlone) {
    Model m = oneNode();
    check(m);
    EXPECT_EQ(said(m), "");
    ASSERT_EQ(m.meshes[0].parts.size(), 1u);
    EXPECT_EQ(m.meshes[0].parts[0].counts, std::vector<int32_t>{3});
    EXPECT_EQ(drawnNodes(m), std::vector<int>{0});
}

TEST(ModelCheck, LeavesOutWhatIsNotThere) {
    Model m = oneNode();
    m.meshes[0].parts[0].corners = {0, 1, 2, 0, 1, 3, -1, 1, 2};
    m.meshes[0].parts[0].material = 7;
    m.nodes[0].meshes = {0, 5};
    m.nodes[0].light = 3;
    m.roots = {0, 9};
    check(m);
    EXPECT_EQ(m.meshes[0].parts[0].corners, (std::vector<int32_t>{0, 1, 2}));
    EXPECT_EQ(m.meshes[0].parts[0].material, kNone);
    EXPECT_EQ(m.nodes[0].meshes, std::vector<int32_t>{0});
    EXPECT_EQ(m.nodes[0].light, kNone);
    EXPECT_EQ(m.roots, std::vector<int32_t>{0});
    EXPECT_NE(said(m).find("error: mesh \"t\": 2 faces"), std::string::npos) << said(m);
}

TEST(ModelCheck, TakesNoNumberThatIsNotFinite) {
    Model m = oneNode();
    m.meshes[0].parts[0].P[4] = NAN; // its one face goes, and with it the part
    m.nodes[0].hasMatrix = true;
    m.nodes[0].matrix.m[3][0] = INFINITY;
    m.materials.emplace_back();
    m.materials[0].roughness = NAN;
    m.lights.emplace_back();
    m.lights[0].intensity = NAN;
    check(m);
    EXPECT_TRUE(m.meshes[0].parts.empty());
    EXPECT_EQ(m.nodes[0].matrix, Matrix());
    EXPECT_EQ(m.materials[0].roughness, 0);
    EXPECT_EQ(m.lights[0].intensity, 1);
}

TEST(ModelCheck, CutsCircles) {
    Model m;
    m.nodes.resize(4);
    m.nodes[0].parent = 2, m.nodes[1].parent = 0, m.nodes[2].parent = 1, m.nodes[3].parent = 3;
    m.roots = {0, 3};
    check(m);
    for (size_t i = 0; i < 4; ++i) {
        int steps = 0;
        for (int at = int(i); at != kNone && steps < 10; at = m.nodes[size_t(at)].parent) ++steps;
        EXPECT_LT(steps, 10) << i;
    }
    EXPECT_NE(said(m).find("circle"), std::string::npos);
    EXPECT_LE(drawnNodes(m).size(), 4u);
}

TEST(ModelStream, GoesThereAndBack) {
    Model m = oneNode();
    m.generator = "me";
    m.images.push_back({"a", "", {1, 2, 3}});
    m.materials.emplace_back();
    m.materials[0].baseColorMap.image = 0;
    m.materials[0].emission[1] = 4.5;
    m.animations.push_back({"walk", {{0, Path::Scale, Interpolation::Cubic, {0, 1}, std::vector<float>(18, 2.f)}}});
    m.meshes[0].parts[0].st = {{0, 0, 1, 0, 0, 1}};
    m.notes.push_back({true, "something"});
    const auto bytes = toBytes(m);
    const auto back = fromBytes(bytes);
    ASSERT_TRUE(back);
    EXPECT_EQ(toBytes(*back), bytes);
    EXPECT_EQ(back->materials[0].emission[1], 4.5);
    EXPECT_EQ(back->animations[0].channels[0].values.size(), 18u);
    EXPECT_EQ(back->meshes[0].parts[0].st[0][2], 1.f);
}

// Whatever a module that a file led astray sends: nothing, or a model that check() makes sound.
TEST(ModelStream, TakesNoHarmFromAnyBytes) {
    const auto whole = toBytes(oneNode());
    for (size_t n = 0; n < whole.size(); ++n) EXPECT_FALSE(fromBytes({whole.data(), n})) << n;
    std::mt19937 random(7);
    int sound = 0;
    for (int k = 0; k < 3000; ++k) {
        auto bytes = whole;
        for (int i = 0; i < 1 + k % 4; ++i) bytes[4 + random() % (bytes.size() - 4)] = uint8_t(random());
        if (auto m = fromBytes(bytes)) {
            check(*m);
            sound += drawnNodes(*m).size() <= m->nodes.size();
        }
    }
    EXPECT_GT(sound, 100);
}

} // namespace models_check_test
