// A world without primitives in the place of transport's, for tests that bring a tracer of their own.
#pragma once
#include "render/engine.h"
#include <memory>
#include <utility>

namespace alpenglow::render::test {

/// Holds the frame and the settings it was built with. One number an output; an imager changes nothing.
struct PlainWorld : world::World {
    std::shared_ptr<const scene::Frame> frame_;
    world::Settings settings_;
    const scene::Frame& frame() const override { return *frame_; }
    const world::Settings& settings() const override { return settings_; }
    Facts facts() const override { return {}; }
    void flushPrints(bool) const override {}
    std::vector<int> outputWidths() const override { return std::vector<int>(settings_.outputs.size(), 1); }
    bool runImager(int, const float*, const float*, float*, float*, float*, float*, Diagnostics&,
                   const StopFlag*) const override {
        return true;
    }
};

/// An engine of such worlds. `tracer`: makes the tracer of a world, std::unique_ptr<Tracer>(const world::World&).
template <class World = PlainWorld, class Make> Engine plainEngine(Make tracer) {
    return {
        [](std::shared_ptr<const scene::Frame> f, const world::Settings& s, Diagnostics&) {
            auto w = std::make_shared<World>();
            w->frame_ = std::move(f);
            w->settings_ = s;
            return w;
        },
        [tracer](const std::shared_ptr<const world::World>& w, Diagnostics&) -> std::unique_ptr<Tracer> { return tracer(*w); }};
}

} // namespace alpenglow::render::test
