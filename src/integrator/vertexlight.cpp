#include "integrator/vertexlight.h"
#include "integrator/ambientlight.h"
#include "integrator/blockvertices.h"
#include "integrator/context.h"
#include "integrator/photonstage.h"
#include "integrator/requests.h"
#include "integrator/stageset.h"
#include "integrator/subsurfacewalks.h"
#include "integrator/vertexsampling.h"

namespace alpenglow::integrator {

VertexLight::~VertexLight() = default;

VertexLight::VertexLight(const StageSet& s)
    : Stage(s.context), set_(s), ambient_(s.ambient), blocks_(s.blocks), requests_(s.requests), subsurface_(s.subsurface) {}

void VertexLight::gather(BatchContext& c, Sched& sched) {
    if (!ambient_.asked.empty()) ambient_.gather(c);
    if (blocks_.runRequests(c, sched)) return;
    if (set_.photons.photonTrace()) set_.photons.takeModels(c, false);
    if (context_.world.settings_.blocks && !requests_.lobes.empty()) fprintf(stderr, "POINTWAY accel %d\n", context_.world.accel_ != nullptr), abort();
    std::unique_ptr<VertexSampling> g = std::move(gather_); // moved out, so that a nested call makes its own
    if (!g) g = std::make_unique<VertexSampling>(set_);
    g->run(c, sched);
    requests_.apartAt.clear();
    gather_ = std::move(g);
    if (!subsurface_.below.empty()) subsurface_.walk(c, sched);
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
