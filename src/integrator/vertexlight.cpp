#include "integrator/vertexlight.h"
#include "integrator/ambientlight.h"
#include "integrator/blockvertices.h"
#include "integrator/stageset.h"

namespace alpenglow::integrator {

VertexLight::VertexLight(const StageSet& s) : Stage(s.context), ambient_(s.ambient), blocks_(s.blocks) {}

void VertexLight::gather(BatchContext& c, Sched& sched) {
    if (!ambient_.asked.empty()) ambient_.gather(c);
    blocks_.runRequests(c, sched);
}

void VertexLight::tellScaled(const SurfaceBinding& b, bool more) {
    if (!(more ? tamed_ : tamedClear_).insert(b.surface.get()).second) return;
    diagnostics_.reportOnce((more ? "energy:" : "energyclear:") + b.surface->name,
                            {more ? Severity::Warning : Severity::Info,
                             Rie::NoError,
                             b.surface->place,
                             "shader \"" + b.surface->name + "\" reflects" + (more ? "" : ", including transmitted light,") +
                                 " more light than it receives; its indirect light is scaled down to conserve energy",
                             "--unbiased disables this",
                             {}});
}

} // namespace alpenglow::integrator
