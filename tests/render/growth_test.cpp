// Pictures of hidden and raytrace while they grow: what is there is what it will be, and more and more is there.
#include "plain_world.h"
#include "render/renderer.h"
#include "render/watcher.h"
#include "scene/scene.h"
#include <chrono>
#include <cmath>
#include <filesystem>
#include <gtest/gtest.h>
#include <thread>
#include <unistd.h>

namespace growth_test {

namespace {

using namespace alpenglow;
using namespace alpenglow::render;

/// A wave that no two samples have the same of; 25 milliseconds a call.
struct SlowTracer final : Tracer {
    integrator::Counters counts;
    bool trace(std::span<const integrator::CameraRay> rays, std::span<integrator::SampleResult> out,
               const StopFlag* stop) override {
        std::this_thread::sleep_for(std::chrono::milliseconds(25));
        for (size_t i = 0; i < rays.size(); ++i) {
            const Vec3 d = rays[i].direction;
            out[i].color = {.5f + .5f * std::sin(300 * d.x), .5f + .5f * std::sin(200 * d.y + 90 * d.x), d.x > 0 ? 1.f : 0.f};
            out[i].opacity = Color(1);
            out[i].z = 5 + d.x;
        }
        return !*stop;
    }
    const integrator::Counters& counters() const override { return counts; }
};

/// Keeps what it was shown.
struct Looker final : Watcher {
    struct Seen {
        Image image;
        std::vector<uint8_t> there; ///< none: all of it
    };
    std::vector<Seen> seen;
    const OutputPlan* plan = nullptr;
    bool throws = false;
    bool writes() const override { return false; }
    void begin(const WatchedFrame& f) override { plan = &f.plan; }
    void look(const Glance& g) override {
        if (throws && g.grown) throw std::bad_alloc();
        if (!g.grown) return;
        Seen s{g.pixels(plan->pictures.back()), {}};
        if (g.there) s.there = *g.there;
        EXPECT_EQ(g.whole(), !g.there);
        seen.push_back(std::move(s));
    }
};

struct Case {
    const char* name;
    const char* hider;
    const char* filter;
    float filterWidth, samples;
    int refined; ///< aaSamples
    int displays;
};

class Growing : public testing::TestWithParam<Case> {};

scene::Options optionsOf(const Case& c) {
    scene::Options o;
    o.hider = c.hider;
    o.xres = 110, o.yres = 75;
    o.projection = "perspective";
    o.filter.name = c.filter;
    o.filter.xwidth = o.filter.ywidth = c.filterWidth;
    o.pixelSamplesX = o.pixelSamplesY = c.samples;
    if (c.refined) {
        scene::Param p;
        p.name = "aaSamples";
        p.numbers = {float(c.refined)};
        o.hiderParams.push_back(p);
    }
    for (int i = 0; i < c.displays; ++i) {
        scene::Display d;
        d.name = "x" + std::to_string(i) + ".exr";
        d.type = "openexr";
        d.mode = "rgbaz";
        o.displays.push_back(d);
    }
    return o;
}

size_t watch(const Case& c, Looker& looker) {
    auto frame = std::make_shared<scene::Frame>();
    frame->options = optionsOf(c);
    RenderSettings s;
    s.threads = 3;
    s.watcher = &looker;
    const Engine e = test::plainEngine([](const world::World&) { return std::make_unique<SlowTracer>(); });
    Diagnostics diags;
    Progress progress(ProgressMode::None);
    Renderer r(s, e, diags, progress);
    r.render(frame);
    return diags.errors();
}

TEST_P(Growing, IsTheWholePictureWhereItIsThere) {
    const Case& c = GetParam();
    Looker looker;
    EXPECT_EQ(watch(c, looker), 0u);
    ASSERT_GE(looker.seen.size(), 3u);
    const Looker::Seen& last = looker.seen.back();
    ASSERT_TRUE(last.there.empty()); // the whole comes last
    const size_t n = last.image.channels.size(), pixels = last.image.window.pixels();
    ASSERT_EQ(pixels, 110u * 75);
    size_t before = 0, between = 0, others = 0;
    for (const Looker::Seen& s : looker.seen) {
        size_t there = 0;
        for (size_t i = 0; i < pixels; ++i) {
            const bool is = s.there.empty() || s.there[i];
            there += is;
            const auto same = [&](size_t k) { return s.image.data[i * n + k] == (is ? last.image.data[i * n + k] : 0); };
            for (size_t k = 0; k < n; ++k)
                if (!same(k)) ++others;
        }
        EXPECT_GE(there, before);
        between += there > 0 && there < pixels;
        before = there;
    }
    EXPECT_GE(between, 1u);
    if (!c.refined) EXPECT_EQ(others, 0u); // else pixels of one sample are there until they have theirs
}

INSTANTIATE_TEST_SUITE_P(All, Growing,
                         testing::Values(Case{"box", "hidden", "box", 1, 2, 0, 1},
                                         Case{"gaussian", "hidden", "gaussian", 3, 2, 0, 2},
                                         Case{"wide", "raytrace", "gaussian", 20, 1, 0, 1},
                                         Case{"refined", "raytrace", "box", 1, 1, 3, 1}),
                         [](const auto& i) { return std::string(i.param.name); });

// Who looks on may run out of memory.
TEST(GrowingFails, WhatAWatcherThrowsEndsTheFrame) {
    Looker looker;
    looker.throws = true;
    EXPECT_EQ(watch({"box", "hidden", "box", 1, 2, 0, 1}, looker), 1u);
}

} // namespace

} // namespace growth_test
