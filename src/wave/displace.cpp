// Displacement again at hits, for P, N and what the surface's shader asks of it.
#include "wave/engine.h"

namespace alpenglow::transport {

std::shared_ptr<BatchContext> Engine::displace(const BatchContext& c) {
    const BoundKernel& bound = c.binding->displacementS;
    if (!bound || bound.kernel->facts().suspends) return nullptr;
    auto d = std::make_shared<BatchContext>();
    d->engine = this;
    d->bound = &bound;
    d->binding = c.binding;
    d->points = c.points;
    d->rays = c.rays;
    d->bindings = c.bindings;
    for (size_t k = 0; k < d->rays.size(); ++k) d->points[k].ray = &d->rays[k];
    const ShaderInstance& shader = *c.binding->displacement;
    const shading::InstanceView view = shader.view();
    d->batch = std::make_shared<shading::Batch>();
    d->batch->assign(bound.kernel, *bound.plan, d->points, {&view, 1}, {}, *world_);
    bindCall(d->batch->call(), *d);
    bound.kernel->run(&d->batch->call());
    d->ran();
    return d;
}

void Engine::moveToFacets(BatchContext& c) {
    for (size_t k = 0; k < c.rays.size(); ++k) {
        ShadePoint& p = c.points[k];
        if (!p.surface.displaced) continue;
        p.P = p.surface.P = p.surface.displacedP;
        p.surface.n = p.surface.displacedN;
        p.I = p.P - c.rays[k].begin();
    }
}

} // namespace alpenglow::transport
