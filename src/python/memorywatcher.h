// Pictures in memory: what displays would get, kept for Python.
#pragma once
#include "display/image.h"
#include "render/watcher.h"
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace alpenglow::python {

/// One picture of a frame, as its display driver gets it: after filter, exposure and imager, before the quantiser, and without
/// the curve of sRGB that PNG and JPEG get when nobody asked for it.
struct KeptPicture {
    /// Consecutive channels of the image that form one value.
    struct Variable {
        std::string name;         ///< as the display's mode has it: "rgb", "a", "z", "N"
        int first = 0, count = 0; ///< index of the first channel, and their number
    };
    std::string name, type;          ///< of the Display
    int frame = 0;                   ///< number of the FrameBegin; 0: a world without one
    int width = 0, height = 0;       ///< of the image, in pixels
    render::Window window;           ///< that the image covers in the whole picture
    float pixelAspect = 1;           ///< width divided by height of a pixel
    std::vector<Variable> variables; ///< in the order of the channels
    display::Image image;            ///< the pixels
};

/// Keeps pictures and progress of frames for Python.
class MemoryWatcher final : public render::Watcher {
public:
    /// writes: displays write their files, too. keeps: pictures are kept; else only the progress is. grows: grown() is asked.
    MemoryWatcher(bool writes, bool keeps, bool grows = false) : writes_(writes), keeps_(keeps), grows_(grows) {}
    bool writes() const override { return writes_; }
    bool wantsNoise() const override { return true; }
    void begin(const render::WatchedFrame&) override;
    void look(const render::Glance&) override;
    void progress(const render::ProgressState&, const std::string& what) override;
    void finished(std::unique_ptr<render::Film>) override;

    /// What came since the last call. Of a frame that was interrupted under hidden or raytrace: what was there at the last look,
    /// black elsewhere. Not while a frame is rendered.
    std::vector<KeptPicture> take();
    /// The first picture of the frame as it is by now, if it has grown since the last call. Any thread.
    std::optional<KeptPicture> grown();
    struct Progress {
        render::ProgressState state; ///< counts and times
        std::string what;            ///< the stage, for people
    };
    /// The latest progress, if there is any since the last call. Any thread.
    std::optional<Progress> latest();

private:
    using Pixels = std::function<render::Image(const render::OutputSpec&)>;
    /// The pictures of the frame; first: only the first that can be looked at. None: the user stopped the imager.
    std::vector<KeptPicture> pictures(const Pixels&, const render::OutputPlan& own, const render::Imager&, bool first) const;
    const bool writes_, keeps_, grows_;
    const render::OutputPlan* own_ = nullptr;
    std::optional<render::OutputPlan> plan_; ///< as `own_`, with the curves that are kept
    render::PictureFacts facts_;
    render::Imager imager_;
    std::shared_ptr<const world::World> world_;
    int frame_ = 0;
    bool whole_ = false;         ///< the frame's pictures are kept
    double last_ = 0, cost_ = 0; ///< when the growing picture was last looked at, and how long that took, seconds
    std::vector<KeptPicture> kept_, partial_;
    std::mutex mutex_;
    std::optional<Progress> latest_;
    std::optional<KeptPicture> grown_;
};

} // namespace alpenglow::python
