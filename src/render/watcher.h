// Who looks on while frames are rendered: a viewer, a preview in the terminal.
#pragma once
#include "integrator/integrator.h"
#include "render/outputs.h"
#include <functional>
#include <memory>

namespace alpenglow::render {

/// A frame that is about to be rendered. All of it lives until Watcher::finished().
struct WatchedFrame {
    const OutputPlan& plan;
    const PictureFacts& picture;
    std::shared_ptr<const transport::World> world;
    const Imager& imager; ///< may be empty
};

/// The picture so far.
struct Glance {
    std::function<Image(const OutputSpec&)> pixels; ///< what writeOutputs() takes for a picture of the plan
    const Film* film = nullptr;                     ///< path: whole passes; else null
    /// hidden and raytrace, while the picture grows: by pixel of its window in reading order whether it is there, as of the last
    /// call of pixels(). What is not there is black. Null: all is there.
    const std::vector<uint8_t>* there = nullptr;
    bool whole() const { return !film && !there; } ///< nothing comes behind it
    double seconds = 0;                            ///< since rendering began
    uint64_t rays = 0;                             ///< traced so far, those of the pass under way too
    bool grown = true;                             ///< a pass, or some tile, came in; false: only time went by
};

/// All calls come from the thread that called Renderer::render().
class Watcher {
public:
    virtual ~Watcher() = default;
    /// False: pictures are only looked at. No file is written, and no name of one is checked.
    virtual bool writes() const { return true; }
    /// Whether the noise figures of the frame are wanted in Renderer::stats(), which takes a look at every pixel.
    virtual bool wantsNoise() const { return writes(); }
    virtual void begin(const WatchedFrame&) {}
    /// Under path the samples to go on with; null: none. What comes is of this description.
    virtual std::unique_ptr<Film> filmFor(const FilmDescription&) { return nullptr; }
    /// Under path after each pass, else when the picture is whole; and about every 20 ms between.
    virtual void look(const Glance&) {}
    /// How far the samples of a frame are, as often as the progress line is told. what: the picture.
    virtual void progress(const ProgressState&, const std::string& what) { (void)what; }
    /// The end of a frame; also of one that was interrupted. Under path with its film, if a pass is whole.
    virtual void finished(std::unique_ptr<Film>) {}
};

} // namespace alpenglow::render
