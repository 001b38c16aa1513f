// Deferred procedurals: expands those that a frame needs from the start, and builds worlds with those that rays reached.
#include "world/procedurals.h"
#include "render/emptyresults.h"
#include "render/framework.h"
#include "render/levels.h"
#include "render/photonpass.h"
#include "scene/deferred.h"
#include <algorithm>
#include <set>

namespace alpenglow::render {

void Renderer::makeAll(FrameWork& f) {
    const auto waits = [](const scene::PrimitiveRef& p) { return p && scene::isDeferred(*p); };
    if (!makeProcedurals_ || std::none_of(f.made->primitives.begin(), f.made->primitives.end(), waits)) return;
    if (auto all = makeProcedurals_(*f.made, {})) f.made = std::move(all);
}

bool Renderer::buildFrame(FrameWork& f) {
    // Maps and shadows need all geometry.
    if (f.plan.anyDeep() || f.plan.anyMattes() || CausticPasses::asked(f.o)) makeAll(f);
    const auto build = [&] { return engine_.build(drawnLevels(f.made, f.camera), f.settings, diagnostics_); };
    f.settings = engineSettings(f);
    f.world = build();
    if (f.world && makeProcedurals_ && world::hasDeferred(*f.world) && world::needsAllShapes(*f.world)) {
        makeAll(f);
        f.world.reset();
        f.world = build();
    }
    if (!f.world) {
        if (settings_.stop && *settings_.stop) outcome_.interrupted = true;
        ++outcome_.refused;
        return false;
    }
    f.plan.resolve(f.world->outputWidths(), diagnostics_, f.world->missingOutputs());
    f.settings.outputWidths = f.plan.engineWidths;
    sayMissingOutputs(f.plan, *f.world, diagnostics_);
    world::World::Facts facts = f.world->facts();
    stats_.buildSec += facts.buildSec;
    stats_.compileSec += facts.compileSec;
    return true;
}

void Renderer::makeWhatIsMet(FrameWork& f, Job& job) {
    if (!makeProcedurals_) return;
    job.make = [&f, this](std::span<const int> met, int most) -> std::shared_ptr<const world::World> {
        if (!f.later) {
            auto reported = std::make_shared<std::set<std::string>>();
            for (const Diagnostic& d : diagnostics_.all()) reported->insert(toString(d));
            f.later = std::make_unique<Diagnostics>([reported, this](const Diagnostic& d) {
                if (reported->insert(toString(d)).second) diagnostics_.report(d);
            });
        }
        const auto begun = clockSeconds();
        std::shared_ptr<const scene::Frame> made = makeProcedurals_(*f.made, met);
        if (!made) return nullptr;
        stats_.parseSec += clockSeconds() - begun;
        f.made = std::move(made);
        world::Settings settings = f.settings;
        settings.deferredAtOnce = most;
        std::shared_ptr<const world::World> next = engine_.build(drawnLevels(f.made, f.camera), settings, *f.later);
        if (!next) return nullptr;
        stats_.buildSec += next->facts().buildSec;
        stats_.compileSec += next->facts().compileSec;
        return f.world = std::move(next);
    };
}

/// Reports how many procedurals were deferred, and how many of them have been expanded.
void sayProcedurals(const scene::Frame& f, Diagnostics& d) {
    size_t all = 0, left = 0;
    for (const scene::PrimitiveRef& p : f.primitives)
        if (p && scene::isProcedural(*p)) ++all, left += scene::isDeferred(*p);
    if (all)
        d.report(Severity::Info, Rie::NoError, {},
                 "of " + std::to_string(all) + " procedurals outside of the picture " + std::to_string(all - left) +
                     " were made, when rays came to them");
}

} // namespace alpenglow::render
