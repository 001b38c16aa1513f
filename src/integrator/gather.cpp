// The stages of gather.h in order, and what they share.
#include "integrator/gather.h"

namespace alpenglow::transport {

void Gather::run(BatchContext& c, Sched& sched) {
    if (e_.lobes.empty()) return;
    c_ = &c;
    sortByPoint();
    if (world_.lightsAsk() && !e_.photonTrace()) tellLights();
    e_.lobeRows_.prepare();
    choose();
    measureAlbedos();
    besideLights();
    if (rules_.lightsAtRequests) light(sched);
    if (rules_.emissionCounts) lastSkies();
    if (e_.photonTrace()) restPhotons();
    else if (rules_.pickOne) takePhotons(sched);
    scatter(sched);
    e_.lobes.clear();
    e_.lobeRows_.clear();
}

void Gather::sortByPoint() {
    begin_.assign(c_->points.size() + 1, 0);
    order_.resize(e_.lobes.size());
    for (const LobeVertex& l : e_.lobes) ++begin_[size_t(l.point) + 1];
    for (size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
    next_.assign(begin_.begin(), begin_.end() - 1);
    for (size_t i = 0; i < e_.lobes.size(); ++i) order_[size_t(next_[size_t(e_.lobes[i].point)]++)] = int(i);
}

void Engine::tellOutputs(LitValues& told, const BatchContext& c, size_t point) const {
    if (c.bound->kernel->facts().suspends) return;
    for (auto& [output, v] : told.outputs) {
        const int o = c.batch->output(output->name);
        for (size_t r = 0; o >= 0 && r < v.size(); ++r) v[r] = c.batch->value(o, int(r), int(point));
    }
}

/// A vertex has one answer for lights that ask. Where its requests are summed up, its kernel is done: its outputs as they are
/// now.
void Gather::tellLights() {
    for (size_t point = 0; point < c_->points.size(); ++point) {
        const auto list = lobesOf(point);
        if (list.empty()) continue;
        const int first = e_.lobes[size_t(list[0])].lit;
        e_.tellOutputs(e_.litValues_[size_t(first)], *c_, point);
        for (int i : list) e_.lobes[size_t(i)].lit = first;
    }
}

uint32_t Gather::lightVertex(size_t point) const {
    const LobeVertex& first = e_.lobes[size_t(lobesOf(point)[0])];
    const uint32_t vertex = c_->rays[point].vertex;
    return first.ownsTarget ? childVertex(vertex, kLightPoint + first.site, first.occurrence) : vertex;
}

Vec3 Engine::leave(const BatchContext& c, size_t point, const Vec3& w) const {
    const ShadePoint& p = c.points[point];
    if (const float bias = world_->bindings_[size_t(c.bindings[point])].bias; bias > 0) return p.P + w * bias;
    return geometry::offsetOrigin(p.surface, w, p.P == p.surface.P ? 0 : length(p.P - p.surface.P));
}

Vec3 Gather::origin(size_t point, const Vec3& w) const { return e_.leave(*c_, point, w); }

Vec3 Gather::origin(const LobeVertex& l, const Vec3& w) const {
    const Vec3& at = l.elsewhere ? l.from : c_->points[size_t(l.point)].P;
    if (l.bias >= 0) return at + w * l.bias;
    return l.elsewhere ? at + w * geometry::roundingError(at) : origin(size_t(l.point), w);
}

} // namespace alpenglow::transport
