// Runs the stages of vertexsampling.h in order, and their shared functions.
#include "integrator/vertexsampling.h"
#include "integrator/litsurfaces.h"
#include "integrator/photonstage.h"

namespace alpenglow::integrator {

VertexSampling::VertexSampling(const StageSet& s)
    : VertexStage(s, *this), selection_(s, *this, photonScatter_), lightSampling_(s, *this, connection_, photonScatter_),
      connection_(s, *this, lightSampling_), lastSkies_(s, *this, scatter_), guideScatter_(s, *this, selection_),
      photonScatter_(s, *this, selection_, scatter_), scatter_(s, *this, selection_, connection_, photonScatter_),
      litSurfaces_(s.litSurfaces), photons_(s.photons) {}

void VertexSampling::run(BatchContext& c, Sched& sched) {
    if (requests_.lobes.empty()) return;
    begin(c, requests_.lobes);
    if (world_.lightsAsk() && !photons_.photonTrace()) tellLights();
    requests_.rows.prepare();
    selection_.choose();
    selection_.measureAlbedos();
    selection_.lightDirections();
    if (rules_.lightsAtRequests) lightSampling_.run(sched);
    if (rules_.emissionCounts) lastSkies_.run();
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
