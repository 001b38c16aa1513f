// Options that stand for parameters of requests, or that no other test is about: what each does to the camera.
#include "render/camera.h"
#include "render/shutter.h"
#include "scene/motion.h"
#include "scene/scene.h"
#include <cmath>
#include <gtest/gtest.h>

namespace optioneffects_test {

using namespace alpenglow;
using namespace alpenglow::render;

namespace {
void set(scene::Options& o, const std::string& key, std::vector<float> numbers) {
    scene::Param p;
    p.name = key;
    p.numbers = std::move(numbers);
    o.values[key] = std::move(p);
}
} // namespace

TEST(OptionEffects, ShutterOffset) {
    scene::Options o;
    o.shutterOpen = 1, o.shutterClose = 3;
    set(o, "shutter:offset", {.5f});
    EXPECT_EQ(scene::Shutter(o).open, 1.5);
    EXPECT_EQ(scene::Shutter(o).close, 3.5);
}

// Light through a shutter that opens up to a and closes from b on: w(t) = t / a, 1, (1 - t) / (1 - b). Times have its density.
TEST(OptionEffects, ShutterOpening) {
    constexpr double a = .25, b = .5;
    scene::Options o;
    Diagnostics d;
    set(o, "shutter:shutteropening", {float(a), float(b)});
    const ShutterOpening s(o, d);
    const double all = a / 2 + (b - a) + (1 - b) / 2;
    const auto before = [&](double t) { // light up to t
        return t < a ? t * t / (2 * a) : t < b ? a / 2 + (t - a) : all - (1 - t) * (1 - t) / (2 * (1 - b));
    };
    for (double u : {.01, .1, .2, .35, .5, .65, .8, .95}) EXPECT_NEAR(before(s.at(u)) / all, u, 1e-6) << u;
    EXPECT_TRUE(d.all().empty());
    set(o, "shutter:shutteropening", {.5f, .25f});
    EXPECT_EQ(ShutterOpening(o, d).at(.3), .3); // as without it
    EXPECT_EQ(d.errors(), 1);
}

TEST(OptionEffects, Aperture) {
    Diagnostics d;
    scene::Options o;
    o.projection = "perspective";
    o.fstop = 1, o.focalLength = 2, o.focalDistance = 5; // radius 1
    set(o, "hider:aperture", {4, 0, 0, 0});
    double most = 0;
    for (int i = 0; i < 1000; ++i) {
        const auto r = Camera(o, d).ray(320, 240, {float(i) / 1000, 0.9999f}, 0);
        most = std::max(most, double(std::fabs(r.origin.x) + std::fabs(r.origin.y)));
    }
    EXPECT_NEAR(most, 1, 1e-3); // |x| + |y| on the edge of a square that stands on its corner; of a disc it is up to sqrt(2)
}

} // namespace optioneffects_test
