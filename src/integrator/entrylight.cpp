// At the exit of a subsurface walk, the shader there may define the entering light by "irradiance" of its own subsurface().
#include "integrator/accumulator.h"
#include "integrator/batchpool.h"
#include "integrator/displacement.h"
#include "integrator/kernelinputs.h"
#include "integrator/photonstage.h"
#include "integrator/raystore.h"
#include "integrator/requests.h"
#include "integrator/shadowrays.h"
#include "integrator/subsurface.h"
#include "integrator/vertexlight.h"
#include <algorithm>

namespace alpenglow::integrator {

void Walks::askSurfaces(Sched& sched) {
    if (photons_.photonTrace()) return;
    const WorldImpl& world = world_;
    const auto number = [&](const Exit& x) { return world.bindingOf()[x.shape]; };
    const auto silent = [&](const Exit& x) { return !world.bindings()[size_t(number(x))].entering; };
    const auto middle = std::stable_partition(exits_.begin(), exits_.end(), silent);
    std::stable_sort(middle, exits_.end(), [&](const Exit& a, const Exit& b) { return number(a) < number(b); });
    const std::span<Exit> asked(middle, exits_.end());
    std::vector<Exit> left;
    for (size_t first = 0, end; first < asked.size(); first = end) {
        for (end = first; end < asked.size() && number(asked[end]) == number(asked[first]);) ++end;
        const std::span<Exit> same = asked.subspan(first, end - first);
        const size_t kept = askAt(same, sched);
        left.insert(left.end(), same.begin(), same.begin() + long(kept));
    }
    exits_.erase(middle, exits_.end());
    exits_.insert(exits_.end(), left.begin(), left.end());
}

size_t Walks::askAt(std::span<Exit> exits, Sched& sched) {
    const WorldImpl& world = world_;
    const SurfaceBinding& b = world.bindings()[size_t(world.bindingOf()[exits[0].shape])];
    auto c = batches_.take();
    c->bound = &b.entering;
    c->binding = &b;
    c->again = true;
    enterAt(*c, exits);
    for (ShadePoint& p : c->points) {
        p.P = p.surface.P; // initial values for surface and displacement shaders
        shading::setFootprint(p, p.ray->footprint, p.ray->dir, 0, 1);
    }
    if (b.displacement) displacement_.take(*c);
    for (ShadePoint& p : c->points) p.I = p.ray->dir;
    inputs_.fill(*c);
    if (c->displaced) c->batch->takeDisplacement(*c->displaced->batch);
    c->bound->kernel->run(&c->batch->call());
    c->ran();
    const shading::Batch& batch = *c->batch;
    const int irradiance = batch.output(rsl::OutputName::of(rsl::kEntering));
    const int given = batch.output(rsl::OutputName::given(rsl::kEntering));
    const auto reported = [&](size_t i) { return batch.value(given, 0, int(i)) != 0; };
    for (size_t i = 0; i < exits.size(); ++i) {
        const PathRay& ray = c->rays[i];
        const Color light = batch.color(irradiance, int(i));
        if (reported(i) && isFinite(light))
            accumulator_.contribute(sched, {c->targets[i], ray.weight * light, LightEvent::Surface, &ray,
                                            store_.extraOf(ray).share, b.surface.get()});
    }
    askLights(*c, exits, sched);
    size_t kept = 0;
    for (size_t i = 0; i < exits.size(); ++i)
        if (!reported(i)) exits[kept++] = exits[i];
    batches_.giveBack(std::move(c));
    return kept;
}

/// Evaluates further light at the exits where the shader gathers it.
void Walks::askLights(BatchContext& c, std::span<const Exit> exits, Sched& sched) {
    const size_t had = requests_.lobes.size();
    requests_.requestPairs(c, nullptr, sched);
    for (size_t i = had; i < requests_.lobes.size(); ++i) {
        LobeVertex& l = requests_.lobes[i];
        l.indirect *= asked_[size_t(exits[size_t(l.point)].asked)].indirect;
    }
    vertexLight_.gather(c, sched);
    shadows_.flush(sched);
}

} // namespace alpenglow::integrator
