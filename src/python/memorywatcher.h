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
    struct Variable {
        std::string name; ///< as the display's mode has it: "rgb", "a", "z", "N"
        int first = 0, count = 0;
    };
    std::string name, type; ///< of the Display
    int frame = 0;          ///< number of the FrameBegin; 0: a world without one
    int width = 0, height = 0;
    render::Window window; ///< that the image covers in the whole picture
    float pixelAspect = 1;
    std::vector<Variable> variables;
    display::Image image;
};

class MemoryWatcher final : public render::Watcher {
public:
    /// writes: displays write their files, too. keeps: pictures are kept; else only the progress is.
    MemoryWatcher(bool writes, bool keeps) : writes_(writes), keeps_(keeps) {}
    bool writes() const override { return writes_; }
    bool wantsNoise() const override { return true; }
    void begin(const render::WatchedFrame&) override;
    void look(const render::Glance&) override;
    void progress(const render::ProgressState&, const std::string& what) override;
    void finished(std::unique_ptr<render::Film>) override;

    /// What came since the last call. Not while a frame is rendered.
    std::vector<KeptPicture> take();
    struct Told {
        render::ProgressState state;
        std::string what;
    };
    /// The latest progress, if there is any since the last call. Any thread.
    std::optional<Told> told();

private:
    void keep(const std::function<render::Image(const render::OutputSpec&)>& pixels, const render::OutputPlan& own);
    const bool writes_, keeps_;
    const render::OutputPlan* own_ = nullptr;
    std::optional<render::OutputPlan> plan_; ///< as `own_`, with the curves that are kept
    render::PictureFacts facts_;
    render::Imager imager_;
    int frame_ = 0;
    std::vector<KeptPicture> kept_;
    std::mutex mutex_;
    std::optional<Told> told_;
};

} // namespace alpenglow::python
