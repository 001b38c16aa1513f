// State of one frame in the renderer, shared by the files of Renderer.
#pragma once
#include "render/imaging.h"
#include "render/partfile.h"
#include "render/provenance.h"
#include "render/renderer.h"
#include "render/rendering.h"
#include "scene/scene.h"
#include <optional>

namespace alpenglow::render {

using world::Hider;

/// The hider that runs for the scene's; reports unknown ones.
Hider hiderOf(const scene::Options&, Diagnostics&);

/// A frame from its plan to its pictures.
struct Renderer::FrameWork {
    std::shared_ptr<const scene::Frame> frame;
    FrameStats& stats;               ///< receives the figures of the frame
    const int errorsBefore;          ///< of the run
    const scene::Options& o;         ///< of the frame
    Hider hider;                     ///< of the frame
    bool path;                       ///< hider is Hider::Path
    Camera camera;                   ///< of the frame
    uint32_t spp = 0;                ///< samples per pixel
    int nx = 1, ny = 1;              ///< the same as a grid; unused under path
    std::optional<SampleRange> part; ///< for a part file; nothing: a complete picture
    SampleRange wanted{};            ///< sample indices that are wanted
    OutputPlan plan;
    std::string checkpoint;                    ///< "": none
    world::Settings settings;                  ///< for World::build()
    std::shared_ptr<const scene::Frame> made;  ///< the frame with the procedurals expanded so far
    std::unique_ptr<Diagnostics> later;        ///< for worlds with further procedurals: reports only new messages
    std::shared_ptr<const world::World> world; ///< null until it is built
    PictureFacts picture;                      ///< for the headers of pictures
    Imager imager;                             ///< of the frame; may be empty
    uint64_t nonFinite = 0;                    ///< samples that were dropped

    /// figures: receives those of the frame.
    FrameWork(std::shared_ptr<const scene::Frame> of, FrameStats& figures, Diagnostics& d)
        : frame(std::move(of)), stats(figures), errorsBefore(d.errors()), o(frame->options), hider(hiderOf(o, d)),
          path(hider == Hider::Path), camera(o, d), made(frame) {}
};

/// Reports how many procedurals of a frame were deferred, and how many were expanded. Defined in procedurals.cpp.
void sayProcedurals(const scene::Frame&, Diagnostics&);

} // namespace alpenglow::render
