#include "integrator/opacities.h"
#include "integrator/accumulator.h"
#include "integrator/context.h"
#include "integrator/displacement.h"
#include "integrator/kernelinputs.h"
#include "integrator/stageset.h"

namespace alpenglow::integrator {

Opacities::Opacities(const StageSet& s)
    : Stage(s.context), accumulator_(s.accumulator), displacement_(s.displacement), inputs_(s.inputs) {}

Color between0And1(const Color& c) { return {std::clamp(c.x, 0.f, 1.f), std::clamp(c.y, 0.f, 1.f), std::clamp(c.z, 0.f, 1.f)}; }

void Opacities::opacities(std::span<const OpacityQuery> met, std::span<Color> out) {
    BatchContext c;
    const SurfaceBinding& b = world_.bindings()[size_t(met[0].binding)];
    c.bound = met[0].kernel;
    c.binding = &b;
    c.forShadow = true;
    c.rays.reserve(met.size());
    c.points.reserve(met.size());
    for (const OpacityQuery& m : met) {
        PathRay& r = c.rays.emplace_back();
        if (m.ray->ray) {
            r = *m.ray->ray;
            r.footprint = r.footprint.after(length(m.ray->origin - r.origin));
        }
        r.kind = m.ray->kind;
        r.origin = m.ray->origin;
        r.dir = m.ray->dir;
        r.counts = false;
        c.bindings.push_back(m.binding);
        ShadePoint& p = c.points.emplace_back();
        p.ray = &r;
        p.shape = world_.shapes()[m.hit.shape].get();
        p.surface = world_.accel().point(m.hit);
        p.P = p.surface.displaced && !b.moveS ? p.surface.displacedP : p.surface.P; // a shader that moves P moves it here, too
        p.N = p.surface.N;
        p.I = p.P - r.origin;
        p.E = r.origin;
        p.shutter = m.ray->time;
        world_.setTime(p);
        shading::setFootprint(p, r.footprint, r.dir, length(p.I), 1);
    }
    std::vector<shading::InstanceView> views(met.size(), b.surface->view());
    c.batch = std::make_shared<shading::Batch>(c.bound->kernel, *c.bound->plan, c.points, views, world_);
    if (b.displacementQueried && (c.displaced = displacement_.displace(c))) c.batch->takeDisplacement(*c.displaced->batch);
    inputs_.bind(c.batch->call(), c);
    c.bound->kernel->run(&c.batch->call());
    c.ran();
    ++counters_.batches;
    counters_.points += met.size();
    for (size_t i = 0; i < met.size(); ++i) {
        Color o = c.batch->color(c.batch->plan().Oi, int(i));
        if (!isFinite(o)) {
            accumulator_.notFinite(met[i].ray->ray, "Oi", b.surface.get());
            o = Color(1);
        }
        out[i] = between0And1(o);
    }
}

/// Evaluates one batch a surface. The order inside a batch does not matter, because lanes of a kernel are independent. `take`
/// receives the index and the opacity of each hit.
void Opacities::takeOpacities(std::span<const OpacityQuery> met, const std::function<void(size_t, const Color&)>& take) {
    std::vector<size_t> order(met.size());
    for (size_t i = 0; i < order.size(); ++i) order[i] = i;
    const auto what = [&](size_t i) { return std::pair(met[i].binding, met[i].ray->kind->set.mode); };
    std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return what(a) < what(b); });
    std::vector<OpacityQuery> group;
    std::vector<Color> opacity;
    for (size_t first = 0, end; first < order.size(); first = end) {
        group.clear();
        for (end = first; end < order.size() && what(order[end]) == what(order[first]); ++end) group.push_back(met[order[end]]);
        opacity.resize(group.size());
        opacities(group, opacity);
        for (size_t k = first; k < end; ++k) take(order[k], opacity[k - first]);
    }
}

} // namespace alpenglow::integrator
