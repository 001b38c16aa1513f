// Runs the stages of vertexsampling.h in order, and their shared functions.
#include "integrator/vertexsampling.h"
#include "integrator/lightpathstates.h"
#include "integrator/litsurfaces.h"
#include "integrator/photonstage.h"

namespace alpenglow::integrator {

VertexSampling::VertexSampling(const StageSet& s)
    : VertexStage(s, *this), selection_(s, *this, photonScatter_), lightSampling_(s, *this, connection_, photonScatter_),
      connection_(s, *this, lightSampling_), guideScatter_(s, *this, selection_), photonScatter_(s, *this, selection_, scatter_),
      scatter_(s, *this, selection_, photonScatter_), lastSkies_(s.lastSkies), litSurfaces_(s.litSurfaces), paths_(s.paths),
      photons_(s.photons) {}

void VertexSampling::run(BatchContext& c, Sched& sched) {
    if (requests_.lobes.empty()) return;
    begin(c, requests_.lobes);
    if (world_.lightsAsk() && !photons_.photonTrace()) tellLights();
    requests_.rows.prepare();
    selection_.choose();
    selection_.measureAlbedos();
    selection_.lightDirections();
    if (rules_.lightsAtRequests) lightSampling_.run(sched);
    if (rules_.emissionCounts && lastSkies_.any()) lastSkies();
    guideScatter_.run(sched);
    if (photons_.photonTrace()) photonScatter_.restPhotons();
    else if (rules_.pickOne) photonScatter_.takePhotons(sched);
    scatter_.run(sched);
    requests_.lobes.clear();
    requests_.rows.clear();
}

void VertexLobes::begin(BatchContext& c, std::span<const LobeVertex> lobes) {
    batch = &c;
    first.assign(c.points.size() + 1, 0);
    order.resize(lobes.size());
    for (const LobeVertex& l : lobes) ++first[size_t(l.point) + 1];
    for (size_t i = 1; i < first.size(); ++i) first[i] += first[i - 1];
    next_.assign(first.begin(), first.end() - 1);
    for (size_t i = 0; i < lobes.size(); ++i) order[size_t(next_[size_t(lobes[i].point)]++)] = int(i);
}

/// Samples lobes whose rays the depth limit ends, of those that sample lights, for skies.
void VertexSampling::lastSkies() {
    scatter_.sent.clear();
    for (size_t point = 0; point < c_->points.size(); ++point)
        for (const int i : lobesOf(point)) {
            const LobeVertex& l = requests_.lobes[size_t(i)];
            if (l.last && l.lights && !l.elsewhere && !l.delta) scatter_.sent.push_back({int(point), i, 1, 1, true, Vec3(), {}});
        }
    if (scatter_.sent.empty()) return;
    scatter_.draw(0);
    last_.clear();
    for (const LobeRay& s : scatter_.sent) {
        if (!s.goes || !(s.value.pdf > 0)) continue;
        const LobeVertex& l = requests_.lobes[size_t(s.lobe)];
        const Color weight = l.weight * (s.value.colour / s.value.pdf);
        const uint16_t path = paths_.atLobe(l, c_->points[size_t(s.point)], rayOf(l), s.w);
        last_.push_back({s.point, l.rays, origin(l, s.w), s.w, l.ownsTarget ? weight : weight * rayOf(l).weight, l.target,
                         l.maxDistance, l.lit, shareOf(l), path});
    }
    lastSkies_.send(*c_, last_);
}

/// A vertex gives one answer to lights that query its surface. If its requests are summed, its kernel has finished: outputs have
/// their final values.
void VertexSampling::tellLights() {
    for (size_t point = 0; point < c_->points.size(); ++point) {
        const auto list = lobesOf(point);
        if (list.empty()) continue;
        const int first = requests_.lobes[size_t(list[0])].lit;
        litSurfaces_.tellOutputs(litSurfaces_.values[size_t(first)], *c_, point);
        for (int i : list) requests_.lobes[size_t(i)].lit = first;
    }
}

uint32_t VertexStage::lightVertex(size_t point) const {
    const LobeVertex& first = requests_.lobes[size_t(lobesOf(point)[0])];
    const uint32_t vertex = c_->rays[point].vertex;
    return first.ownsTarget ? childVertex(vertex, kLightPoint + first.site, first.occurrence) : vertex;
}

Vec3 VertexStage::origin(const LobeVertex& l, const Vec3& w) const {
    const Vec3& at = l.elsewhere ? l.from : c_->points[size_t(l.point)].P;
    if (l.bias >= 0) return at + w * l.bias;
    return l.elsewhere ? at + w * geometry::roundingError(at) : surfaces_.leave(*c_, size_t(l.point), w);
}

} // namespace alpenglow::integrator
