// The mattes of a frame's pictures.
#include "render/framework.h"
#include "render/mattepass.h"
#include "render/watcher.h"
#include <algorithm>

namespace alpenglow::render {

/// Makes the mattes of pictures that ask for them. Returns false if the user stopped that and no picture is left.
bool Renderer::makeMattes(FrameWork& f, Job& job) {
    if (settings_.watcher && !settings_.watcher->writes()) return true;
    if (f.path) gridOf(f.o, settings_, &f.nx, &f.ny);
    for (OutputSpec& s : f.plan.pictures)
        if (s.asksMattes && !job.interrupted)
            s.mattes = seeMattes(job, *s.asksMattes, s.filter, f.nx, f.ny, jitterOf(f.o, diagnostics_), settings_.seed);
    noteInterrupted(job);
    if (!job.interrupted) return true;
    if (!job.aborted)
        diagnostics_.report(Severity::Warning, Rie::NoError, {},
                            "interrupted before the mattes were complete; they are not written");
    std::erase_if(f.plan.pictures, [](const OutputSpec& p) { return p.asksMattes.has_value(); });
    return !f.plan.pictures.empty();
}

} // namespace alpenglow::render
