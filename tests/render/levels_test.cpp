// Levels of detail: sizes of boxes worked out by hand, and which representations of a frame are left.
#include "geometry/instance_attributes.h"
#include "integrator/integrator.h"
#include "render/levels.h"
#include "scene/scene.h"
#include <gtest/gtest.h>

namespace levels_test {

using namespace alpenglow;
using namespace alpenglow::render;

namespace {

/// 100 x 100 pixels over [-1,1] x [-1,1] (at depth 1 in perspective).
scene::Options square(const char* projection) {
    scene::Options o;
    o.xres = o.yres = 100;
    o.projection = projection;
    o.fov = 90;
    return o;
}

std::shared_ptr<scene::Attributes> range(float a, float b, float c, float d) {
    auto out = std::make_shared<scene::Attributes>();
    out->detail = std::vector<float>{-.5f, .5f, -.5f, .5f, -.5f, .5f}; // 50 x 50 pixels when seen orthographically along an axis
    out->detailRange[0] = a, out->detailRange[1] = b, out->detailRange[2] = c, out->detailRange[3] = d;
    return out;
}

scene::PrimitiveRef sphere(scene::AttributesRef a) {
    auto p = std::make_shared<scene::Primitive>();
    p->kind = "Sphere";
    p->attributes = std::move(a);
    return p;
}

} // namespace

TEST(Levels, SizesOfBoxes) {
    Diagnostics d;
    Camera ortho(square("orthographic"), d), perspective(square("perspective"), d);
    EXPECT_NEAR(detailSize({-.5f, .5f, -.25f, .25f, 0, 9}, {}, ortho), 50 * 25, 1e-9);
    EXPECT_NEAR(detailSize({-.5f, .5f, -.25f, .25f, 0, 9}, scaleMatrix(2, 2, 1) * translateMatrix(7, 0, 0), ortho), 100 * 50,
                1e-9)
        << "outside of the picture too";
    // A cube turned by 45 degrees about y shows sqrt(2) of its width.
    EXPECT_NEAR(detailSize({-.5f, .5f, -.5f, .5f, -.5f, .5f}, rotateMatrix(45, 0, 1, 0), ortho), 2500 * std::sqrt(2.), 1e-3);
    // In perspective the near face decides: [-1,1]^2 at depth 2 covers a quarter of the picture, and the far face lies within it.
    EXPECT_NEAR(detailSize({-1, 1, -1, 1, -1, 1}, translateMatrix(0, 0, 3), perspective), 2500, 1e-6);
    EXPECT_EQ(detailSize({-1, 1, -1, 1, -1, 1}, {}, perspective), INFINITY) << "around the eye";
    EXPECT_EQ(detailSize({0, 0, 0, 0, 0, 0}, {}, ortho), 0);
}

TEST(Levels, OneOfThreeIsDrawn) {
    Diagnostics d;
    auto f = std::make_shared<scene::Frame>();
    f->options = square("orthographic");
    const auto low = range(0, 0, 100, 200), middle = range(100, 200, 2000, 4000), high = range(2000, 4000, 1e38f, 1e38f);
    f->primitives = {sphere(low), sphere(middle), sphere(high)};
    auto drawn = [&](float relative) {
        f->options.relativeDetail = relative;
        auto out = drawnLevels(f, Camera(f->options, d));
        EXPECT_EQ(out->primitives.size(), 1u) << relative;
        return out->primitives.empty() ? nullptr : out->primitives[0]->attributes.get();
    };
    EXPECT_EQ(drawn(1.6f), high.get()) << "4000 pixels, where the transition ends";
    EXPECT_EQ(drawn(4), high.get());
    EXPECT_EQ(drawn(.5f), middle.get());
    EXPECT_EQ(drawn(.01f), low.get());
    EXPECT_EQ(drawn(0), low.get());
    low->detail.reset(), middle->detail.reset(), high->detail.reset();
    EXPECT_EQ(drawn(.01f), high.get()) << "without a box the detail is infinite";
}

TEST(Levels, TransitionsFade) {
    Diagnostics d;
    auto f = std::make_shared<scene::Frame>();
    f->options = square("orthographic");
    const auto low = range(0, 0, 100, 200), middle = range(100, 200, 2000, 4000), high = range(2000, 4000, 1e38f, 1e38f);
    f->primitives = {sphere(low), sphere(middle), sphere(high)};
    const auto parts = [&](float relative) { // of each that is left
        f->options.relativeDetail = relative;
        std::vector<std::vector<float>> p;
        const auto out = drawnLevels(f, Camera(f->options, d));
        for (const auto& left : out->primitives) {
            const auto& level = left->attributes->level;
            p.push_back(level ? std::vector<float>(level->begin(), level->end()) : std::vector<float>{});
        }
        return p;
    };
    using Parts = std::vector<std::vector<float>>;
    // 2500 pixels lie a quarter of the way from 2000 to 4000: three quarters of the samples see the middle one, the others the
    // high one.
    EXPECT_EQ(parts(1), (Parts{{0, .75f}, {.75f, 1}}));
    EXPECT_EQ(parts(.05f), (Parts{{0, .75f}, {.75f, 1}})); // 125 between 100 and 200
    EXPECT_EQ(parts(.5f), (Parts{{}}));
    EXPECT_TRUE(d.all().empty());
    EXPECT_FALSE(low->level) << "the scene's own attributes stay";
    // In an instance the mark lies over the attributes of the instance.
    const auto none = std::make_shared<scene::Attributes>();
    auto lit = std::make_shared<scene::Attributes>(*middle);
    lit->color = Color(.5f);
    f->primitives.clear();
    f->objects.push_back({"tree", {sphere(none)}});
    f->instances.push_back({0, scene::Transform(), lit, {}});
    f->options.relativeDetail = 1;
    const auto out = drawnLevels(f, Camera(f->options, d));
    const scene::Instance& i = out->instances[0];
    const auto a = geometry::instanceAttributes(*out->objects[size_t(i.object)].primitives.at(0), i);
    EXPECT_EQ(a->level, (std::array{0.f, .75f}));
    EXPECT_EQ(a->color, Color(.5f));
}

TEST(Levels, InstancesHaveTheirOwn) {
    Diagnostics d;
    auto f = std::make_shared<scene::Frame>();
    f->options = square("orthographic");
    const auto none = std::make_shared<scene::Attributes>();
    auto in = [&](std::shared_ptr<scene::Attributes> a) {
        auto p = std::make_shared<scene::Primitive>(*sphere(std::move(a)));
        p->attributesInside = true;
        p->attributesBefore = none;
        return p;
    };
    const auto low = in(range(0, 0, 1000, 1000)), high = in(range(1000, 1000, 1e38f, 1e38f));
    f->objects.push_back({"tree", {low, high, sphere(none)}});
    f->instances.push_back({0, scene::Transform(), none, {}});
    f->instances.push_back({0, scene::Transform(scaleMatrix(.5, .5, .5)), none, {}}); // 625 pixels
    auto out = drawnLevels(f, Camera(f->options, d));
    auto of = [&](size_t i) { return out->objects[size_t(out->instances[i].object)].primitives; };
    ASSERT_EQ(of(0).size(), 2u);
    EXPECT_EQ(of(0)[0], high);
    ASSERT_EQ(of(1).size(), 2u);
    EXPECT_EQ(of(1)[0], low);
    EXPECT_EQ(f->objects.size(), 1u);
    EXPECT_TRUE(d.all().empty());
}

TEST(Levels, FramesWithoutThemStayTheSame) {
    Diagnostics d;
    auto f = std::make_shared<scene::Frame>();
    f->options = square("orthographic");
    f->primitives = {sphere(std::make_shared<scene::Attributes>())};
    EXPECT_EQ(drawnLevels(f, Camera(f->options, d)), f);
}

} // namespace levels_test
