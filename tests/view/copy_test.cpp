// What was tuned, as requests: read back it says the same.
#include "ri/reader.h"
#include "scene/scene.h"
#include "view/pose.h"
#include "view/ribcopy.h"
#include <gtest/gtest.h>

namespace copy_test {

using namespace alpenglow;
using namespace alpenglow::view;

namespace {

struct Kept final : scene::FrameConsumer {
    std::shared_ptr<const scene::Frame> frame;
    Diagnostics diagnostics;
    explicit Kept(const std::string& rib) {
        ri::RibReader reader({}, *this, diagnostics);
        reader.readMemory(rib, "copy.rib");
        EXPECT_EQ(diagnostics.all().size(), 0u) << rib << (diagnostics.all().empty() ? "" : toString(diagnostics.all()[0]));
    }
    void render(std::shared_ptr<const scene::Frame> f) override { frame = std::move(f); }
    void makeTexture(const std::string&, const std::vector<std::string>&, const scene::ParamList&, const SourcePlace&) override {}
};

scene::Param number(const std::string& name, scene::Type type, std::vector<float> values) {
    scene::Param p;
    p.name = name;
    p.type = type;
    p.numbers = std::move(values);
    return p;
}

const char* const kScene = "Translate 0 0 5\nWorldBegin\nLightSource \"spotlight\" \"key\" \"from\" [-3 5 -4] \"intensity\" 20\n"
                           "LightSource \"pointlight\" \"fill\"\nShader \"flakes\" \"fl\" \"float size\" .25\n"
                           "Surface \"paint\" \"Kd\" .5 \"string map\" [\"a \\\"b\\\"\"]\nSphere 1 -1 1 360\nWorldEnd\n";

} // namespace

TEST(CopyRib, ShadersOfEveryRole) {
    const Kept kept(kScene);
    const std::vector<ShaderUse> uses = shadersOf(*kept.frame, 100);
    ASSERT_EQ(uses.size(), 4u);
    EXPECT_EQ(uses[3].role, "coshader");
    EXPECT_EQ(uses[3].handle, "fl");
    EXPECT_EQ(ribOfShader(uses[3], {}), "Shader \"flakes\" \"fl\" \"float size\" [0.25]\n");
    EXPECT_EQ(ribOfShader(uses[2], {number("Kd", scene::Type::Float, {.75f}), number("tint", scene::Type::Color, {1, .5f, 0})}),
              "Surface \"paint\" \"float Kd\" [0.75] \"string map\" [\"a \\\"b\\\"\"] \"color tint\" [1 0.5 0]\n");
    // A change reaches what has the shader.
    const auto frame = changed(kept.frame, uses, {{3, {number("size", scene::Type::Float, {4})}}});
    EXPECT_EQ(frame->primitives[0]->attributes->coshaders.at("fl")->params[0].numbers[0], 4);
    EXPECT_EQ(kept.frame->primitives[0]->attributes->coshaders.at("fl")->params[0].numbers[0], .25f);
}

TEST(CopyRib, LightsThatWereDimmed) {
    const Kept kept(kScene);
    const std::vector<ShaderUse> uses = shadersOf(*kept.frame, 100);
    const std::string rib = ribOfDimmedLight(uses[0], {}, .5, {}) + ribOfDimmedLight(uses[1], {}, .25, 2.);
    const Kept back("WorldBegin\n" + rib + "Sphere 1 -1 1 360\nWorldEnd\n");
    ASSERT_EQ(back.frame->lights.size(), 2u) << rib;
    EXPECT_EQ(back.frame->lights[0].handle, "key");
    EXPECT_EQ(scene::find(back.frame->lights[0].shader->params, "intensity")->numbers[0], 10);
    EXPECT_EQ(scene::find(back.frame->lights[0].shader->params, "from")->numbers, (std::vector<float>{-3, 5, -4}));
    EXPECT_EQ(scene::find(back.frame->lights[1].shader->params, "intensity")->numbers[0], .5f);
    EXPECT_EQ(ribOfDimmedLight(uses[1], {}, .25, {})[0], '#'); // nobody knows by which parameter
}

TEST(CopyRib, TheCamera) {
    const Kept kept(std::string("Projection \"perspective\" \"fov\" 40\n") + kScene);
    Pose pose(kept.frame->options);
    pose.orbit(30, 10);
    pose.dolly(1.5);
    scene::Options o = kept.frame->options;
    pose.apply(o);
    const Kept back("Projection \"perspective\" \"fov\" 40\n" + ribOfCamera(o) + "WorldBegin\nSphere 1 -1 1 360\nWorldEnd\n");
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x)
            EXPECT_NEAR(back.frame->options.worldToCamera.first().m[y][x], o.worldToCamera.first().m[y][x], 1e-6) << y << x;
}

} // namespace copy_test
