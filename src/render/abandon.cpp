// ErrorHandler "abort": the first error of a frame ends it, and no picture of it is written.
#include "render/framework.h"
#include "render/rendering.h"
#include "render/watcher.h"

namespace alpenglow::render {

bool Renderer::abandons(const FrameWork& f) {
    if (!f.o.abortsOnError || diagnostics_.errors() <= f.errorsBefore) return false;
    ++outcome_.refused;
    diagnostics_.report(Severity::Info, Rie::IllState, {}, "ErrorHandler \"abort\": the frame ends without a picture");
    if (settings_.watcher) settings_.watcher->finished(nullptr);
    return true;
}

void Renderer::noteInterrupted(const Job& job) { outcome_.interrupted |= job.interrupted && !job.aborted; }

} // namespace alpenglow::render
