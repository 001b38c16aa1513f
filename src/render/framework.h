// One frame on its way through the renderer, as the files of Renderer share it.
#pragma once
#include "render/imaging.h"
#include "render/partfile.h"
#include "render/provenance.h"
#include "render/renderer.h"
#include "render/rendering.h"
#include "scene/scene.h"
#include <optional>

namespace alpenglow::render {

using transport::Hider;

/// The hider that runs for the one that the scene names; an unknown one is reported.
Hider hiderOf(const scene::Options&, Diagnostics&);

struct Renderer::FrameWork {
    std::shared_ptr<const scene::Frame> frame;
    FrameStats& told;
    const scene::Options& o;
    Hider hider;
    bool path;
    Camera camera;
    uint32_t spp = 0;   ///< samples of a pixel
    int nx = 1, ny = 1; ///< the same as a grid; not under path
    std::optional<SampleRange> part;
    SampleRange wanted{};
    OutputPlan plan;
    std::string checkpoint; ///< "": none
    transport::Settings settings;
    std::shared_ptr<const scene::Frame> made; ///< the frame with the procedurals that are made by now
    std::unique_ptr<Diagnostics> later;       ///< of worlds with further procedurals: says what was not said yet
    std::shared_ptr<const transport::World> world;
    PictureFacts picture;
    Imager imager;
    uint64_t nonFinite = 0; ///< samples that were left out

    FrameWork(std::shared_ptr<const scene::Frame> of, FrameStats& stats, Diagnostics& d)
        : frame(std::move(of)), told(stats), o(frame->options), hider(hiderOf(o, d)), path(hider == Hider::Path), camera(o, d),
          made(frame) {}
};

/// Notes how many procedurals of a frame waited, and how many were made. procedurals.cpp
void sayProcedurals(const scene::Frame&, Diagnostics&);

} // namespace alpenglow::render
