// Graphs of MaterialX as RSL.
#include "models/materialx.h"
#include "models/standardtext.h"
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>

namespace models_materialx_test {

using namespace alpenglow;
using namespace alpenglow::models;

namespace {

const char* const kStandard = R"sl(/* a comment with surface standard( in it */
#include "layers.h"
surface standard(varying float base = 1; varying color base_color = .8; varying float metalness = 0, specular_roughness = .2;
                 varying float emission = 0; varying color emission_color = 1; varying normal bump_normal = 0;
                 string normal_map = "a;b,c)";
float map_scale[2] = {1, 1}, samples = 16;)
{
    Ci = base * base_color; /* gone */
}
)sl";

class Materialx : public ::testing::Test {
protected:
    std::filesystem::path dir;
    std::string said;
    int errors = 0;
    void SetUp() override {
        std::string name = (std::filesystem::temp_directory_path() / "alpenglow-test-XXXXXX").string();
        ASSERT_NE(mkdtemp(name.data()), nullptr);
        dir = name;
    }
    void TearDown() override { std::filesystem::remove_all(dir); }
    std::string shader(const std::string& inside, const std::string& material = "") {
        std::ofstream(dir / "m.mtlx") << "<?xml version=\"1.0\"?>\n<materialx version=\"1.38\">" << inside << "</materialx>";
        Diagnostics d;
        std::string maps;
        const std::string t = materialxShader(
            {(dir / "m.mtlx").string(), material, "mine", kStandard},
            [&](const MaterialxMap& m) {
                return std::filesystem::path(m.file).filename().string() + (m.colour ? ".c" : ".n") + std::to_string(int(m.u));
            },
            d);
        said.clear();
        for (const Diagnostic& x : d.all()) said += x.message + "\n";
        errors = d.errors();
        return t;
    }
    static bool has(const std::string& text, const std::string& what) { return text.find(what) != text.npos; }
};

std::string surface(const std::string& inputs) {
    return R"(<standard_surface name="s" type="surfaceshader">)" + inputs + "</standard_surface>";
}

} // namespace

TEST(StandardTextTest, IsTakenApart) {
    const auto t = takeApart(kStandard);
    ASSERT_TRUE(t);
    ASSERT_EQ(t->parameters.size(), 10u);
    EXPECT_EQ(t->parameters[3].type, "varying float");
    EXPECT_EQ(t->parameters[3].name, "specular_roughness");
    EXPECT_EQ(t->parameters[7].value, "\"a;b,c)\"");
    EXPECT_EQ(t->parameters[8].array, "[2]");
    EXPECT_EQ(t->parameters[9].name, "samples");
    EXPECT_EQ(t->includes.size(), 1u);
    EXPECT_EQ(t->body.find("gone"), std::string::npos);
    EXPECT_FALSE(takeApart("surface other() {}"));
}

TEST_F(Materialx, NumbersBecomeDefaults) {
    const std::string t = shader(surface(R"(<input name="base_color" type="color3" value="0.1, 0.2, 0.3"/>
        <input name="metalness" type="float" value="1"/>)"));
    EXPECT_TRUE(has(t, "surface mine(")) << t;
    EXPECT_TRUE(has(t, "varying color base_color = color (0.1, 0.2, 0.3);")) << t;
    EXPECT_TRUE(has(t, "varying float metalness = 1;"));
    EXPECT_TRUE(has(t, "varying float specular_roughness = .2;"));
    EXPECT_TRUE(has(t, "Ci = base * base_color;"));
    EXPECT_EQ(said, "");
}

TEST_F(Materialx, GraphsBecomeStatements) {
    std::ofstream(dir / "wood.png") << "x";
    const std::string t = shader(R"(<nodegraph name="g"><input name="tint" type="color3" value="0.5, 1, 1"/>
        <image name="i" type="color3"><input name="file" type="filename" value="wood.png" colorspace="srgb_texture"/>
          <input name="uaddressmode" type="string" value="mirror"/></image>
        <multiply name="m" type="color3"><input name="in1" type="color3" nodename="i"/>
          <input name="in2" type="color3" interfacename="tint"/></multiply>
        <output name="out" type="color3" nodename="m"/></nodegraph>)" +
                                     surface(R"(<input name="base_color" type="color3" nodegraph="g" output="out"/>)") +
                                     R"(<surfacematerial name="mat" type="material">
        <input name="surfaceshader" type="surfaceshader" nodename="s"/></surfacematerial>)",
                                 "mat");
    EXPECT_EQ(said, "");
    EXPECT_TRUE(has(t, "color texture(\"wood.png.c2\"")) << t;
    EXPECT_TRUE(has(t, " * 0.5;")) << t;
    EXPECT_TRUE(has(t, "    color base_color = color (")) << t;
    EXPECT_FALSE(has(t, "varying color base_color"));
}

TEST_F(Materialx, FaultsAreTold) {
    shader("");
    EXPECT_EQ(errors, 1);
    EXPECT_TRUE(has(said, "it has no material")) << said;
    shader(surface(""), "other");
    EXPECT_TRUE(has(said, "no material \"other\"")) << said;
    // Circles of nodes, of graphs, and chains that are too deep: reported, and the rest is there.
    EXPECT_NE(shader(R"(<add name="a" type="float"><input name="in1" type="float" nodename="a"/></add>)" +
                     surface(R"(<input name="base" type="float" nodename="a"/>)")),
              "");
    EXPECT_TRUE(has(said, "connected to itself")) << said;
    EXPECT_NE(shader(R"(<nodegraph name="g"><output name="o" type="float" nodegraph="g" output="o"/></nodegraph>)" +
                     surface(R"(<input name="base" type="float" nodegraph="g" output="o"/>)")),
              "");
    std::string chain;
    for (int i = 0; i < 20000; ++i)
        chain += R"(<absval name="n)" + std::to_string(i) + R"(" type="float"><input name="in" type="float" nodename="n)" +
                 std::to_string(i + 1) + R"("/></absval>)";
    EXPECT_NE(shader(chain + surface(R"(<input name="base" type="float" nodename="n0"/>)")), "");
    EXPECT_TRUE(has(said, "below each other")) << said;
    shader(R"(<wizardry name="a" type="float"/>)" +
           surface(R"(<input name="base" type="float" nodename="a"/><input name="no" value="1"/>)"));
    EXPECT_TRUE(has(said, "<wizardry> are not known")) << said;
    EXPECT_TRUE(has(said, "the input no has no effect")) << said;
    shader(R"(<image name="a" type="float"><input name="file" type="filename" value="../../etc/passwd"/></image>)" +
           surface(R"(<input name="base" type="float" nodename="a"/>)"));
    EXPECT_TRUE(has(said, "is not there")) << said;
}

} // namespace models_materialx_test
