// Displacement at hits: P, N and the displacement outputs that the surface shader reads.
#include "integrator/displacement.h"
#include "integrator/context.h"
#include "integrator/gathercalls.h"
#include "integrator/kernelinputs.h"
#include "integrator/stageset.h"
#include "world/turned.h"

namespace alpenglow::integrator {

Displacement::Displacement(const StageSet& s) : Stage(s.context), inputs_(s.inputs), gathers_(s.gathers) {}

std::shared_ptr<BatchContext> Displacement::displace(const BatchContext& c) {
    const BoundKernel& bound = c.binding->displacementS;
    if (!bound || bound.kernel->facts().suspends) return nullptr;
    auto d = std::make_shared<BatchContext>();
    d->bound = &bound;
    d->binding = c.binding;
    d->points = c.points;
    d->rays = c.rays;
    d->bindings = c.bindings;
    d->again = c.forShadow; // baking happens at the surface
    for (size_t k = 0; k < d->rays.size(); ++k) {
        d->points[k].ray = &d->rays[k];
        if (turnedOver(*d->points[k].shape)) turnOver(d->points[k]);
    }
    const ShaderInstance& shader = *c.binding->displacement;
    const shading::InstanceView view = shader.view();
    d->batch = std::make_shared<shading::Batch>();
    d->batch->assign(bound.kernel, *bound.plan, d->points, {&view, 1}, {}, world_);
    gathers_.takeSent(*d->batch, c.targets, rsl::PairName::To::Displacement);
    inputs_.bind(d->batch->call(), *d);
    bound.kernel->run(&d->batch->call());
    d->ran();
    return d;
}

/// Runs the displacement at the hit, for P and N (docs/design/decisions.md). All points of a displaced group share its binding.
void Displacement::take(BatchContext& c) {
    const auto d = displace(c);
    if (!d) return;
    int po = d->batch->output("P"), no = d->batch->output("N");
    using rsl::OutputName;
    const int dpu = d->batch->output(OutputName::du("P")), dpv = d->batch->output(OutputName::dv("P"));
    const int dnu = d->batch->output(OutputName::du("N")), dnv = d->batch->output(OutputName::dv("N"));
    for (size_t k = 0; k < c.points.size(); ++k) {
        ShadePoint& p = c.points[k];
        if (po >= 0) {
            p.P = d->batch->color(po, int(k));
            p.I = p.P - c.rays[k].begin();
        }
        const float turn = turnedOver(*p.shape) && !p.shape->givesNormals() ? -1.f : 1.f;
        if (no >= 0) p.N = Vec3(d->batch->color(no, int(k))) * turn;
        // Derivatives for the surface shader are those of the displaced surface; second partials remain those of the undisplaced
        // one.
        if (po >= 0 && dpu >= 0 && dpv >= 0) {
            p.surface.dPdu = d->batch->color(dpu, int(k));
            p.surface.dPdv = d->batch->color(dpv, int(k));
            p.surface.Ng = cross(p.surface.dPdu, p.surface.dPdv) * p.surface.orientation;
        }
        if (no >= 0 && dnu >= 0 && dnv >= 0) {
            p.surface.dNdu = Vec3(d->batch->color(dnu, int(k))) * turn;
            p.surface.dNdv = Vec3(d->batch->color(dnv, int(k))) * turn;
        }
        if (p.surface.displaced) { // rays hit and leave the facet; offsets start there
            p.surface.P = p.surface.displacedP;
            p.surface.n = p.surface.displacedN;
            p.P = p.surface.displacedP;
        }
    }
    if (c.binding->displacementQueried) c.displaced = d;
}

void Displacement::moveToFacets(BatchContext& c) {
    for (size_t k = 0; k < c.rays.size(); ++k) {
        ShadePoint& p = c.points[k];
        if (!p.surface.displaced) continue;
        p.P = p.surface.P = p.surface.displacedP;
        p.surface.n = p.surface.displacedN;
        p.I = p.P - c.rays[k].begin();
    }
}

} // namespace alpenglow::integrator
