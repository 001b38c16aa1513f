// Observers of rendering: a viewer, a preview in the terminal.
#pragma once
#include "integrator/integrator.h"
#include "render/outputs.h"
#include <functional>
#include <memory>

namespace alpenglow::render {

/// A frame that is about to be rendered. All of it is valid until Watcher::finished().
struct WatchedFrame {
    const OutputPlan& plan;                    ///< planned pictures
    const PictureFacts& picture;               ///< for the headers of pictures
    std::shared_ptr<const world::World> world; ///< never null
    const Imager& imager;                      ///< may be empty
};

/// The picture so far.
struct Glance {
    std::function<Image(const OutputSpec&)> pixels; ///< pixels of a picture of the plan, in the form for writeOutputs()
    const Film* film = nullptr;                     ///< path: complete passes; else null
    /// hidden and raytrace, while the picture grows: for each pixel of its window in reading order, whether it is complete, as of
    /// the last call of pixels(). Incomplete pixels are black. Null: all are complete.
    const std::vector<uint8_t>* there = nullptr;
    bool whole() const { return !film && !there; } ///< the final state
    double seconds = 0;                            ///< since rendering began
    uint64_t rays = 0;                             ///< traced so far, including the current pass
    bool grown = true;                             ///< a pass, or some tile, was completed; false: only time has passed
};

/// All calls are made by the thread that called Renderer::render().
class Watcher {
public:
    virtual ~Watcher() = default;
    /// False: pictures are only displayed. No file is written, and file names are not checked.
    virtual bool writes() const { return true; }
    /// Whether the noise figures of the frame are wanted in Renderer::stats(), which takes a look at every pixel.
    virtual bool wantsNoise() const { return writes(); }
    /// A frame begins; called by the thread that renders it.
    virtual void begin(const WatchedFrame&) {}
    /// Under path: a film to continue; null: none. The result must match this description.
    virtual std::unique_ptr<Film> filmFor(const FilmDescription&) { return nullptr; }
    /// Called under path after each pass, else when the picture is complete; and about every 20 ms in between.
    virtual void look(const Glance&) {}
    /// How far the samples of a frame are, as often as the progress line is updated. what: the picture.
    virtual void progress(const ProgressState&, const std::string& what) { (void)what; }
    /// The end of a frame; also of one that was interrupted. Under path with its film, if a pass is whole.
    virtual void finished(std::unique_ptr<Film>) {}
};

} // namespace alpenglow::render
