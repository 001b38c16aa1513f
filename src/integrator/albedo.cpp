// The output "albedo": reflected fraction of uniform light. For lobes without an exact albedo (microfacets with Fresnel,
// highlights) it is an unbiased estimate from sampled directions.
#include "integrator/accumulator.h"
#include "integrator/lobeselection.h"
#include "integrator/raystore.h"
#include "integrator/requests.h"

namespace alpenglow::integrator {

bool LobeSelection::albedoIsMeasured(const LobeVertex& l) const {
    return world_.settings_.firstSeen && !l.ownsTarget && !l.delta && l.below < 0 &&
           integrator::albedoIsMeasured(*l.kind, *l.rays);
}

void LobeSelection::measureAlbedos() {
    if (!world_.settings_.firstSeen || c_->aside) return;
    std::vector<const LobeVertex*> lobes;
    for (const LobeVertex& l : requests_.lobes)
        if (rayOf(l).counts && albedoIsMeasured(l)) lobes.push_back(&l);
    if (lobes.empty()) return;
    BsdfBatch& rows = requests_.rows;
    std::vector<Color> sum(lobes.size(), Color(0));
    std::vector<Vec3> ways(lobes.size());
    std::vector<uint8_t> drawn(lobes.size());
    for (uint32_t k = 0; k < kAlbedoDraws; ++k) {
        numbers_.clear();
        for (const LobeVertex* l : lobes)
            numbers_.askPair(store_.random(rayOf(*l)).draw(k, kAlbedoDraws).numbers(), rayOf(*l).vertex, kAlbedo,
                             l->site * 4096 + l->occurrence);
        numbers_.draw();
        for (size_t i = 0; i < lobes.size(); ++i) rows.ask(lobes[i]->place, numbers_.pair(i));
        rows.sample();
        for (size_t i = 0; i < lobes.size(); ++i)
            if ((drawn[i] = rows.drawn(lobes[i]->place, ways[i]))) rows.ask(lobes[i]->place, ways[i]);
        rows.evaluate();
        for (size_t i = 0; i < lobes.size(); ++i)
            if (const LobeValue v = drawn[i] ? rows.value(lobes[i]->place) : LobeValue{}; v.pdf > 0) sum[i] += v.colour / v.pdf;
    }
    for (size_t i = 0; i < lobes.size(); ++i) {
        const PathRay& from = rayOf(*lobes[i]);
        const Color seen = from.weight * lobes[i]->weight * (sum[i] / float(kAlbedoDraws));
        if (isFinite(seen)) accumulator_.results[size_t(from.sample->path)]->albedo += seen;
    }
}

} // namespace alpenglow::integrator
