#include "integrator/specularlights.h"
#include "base/hash.h"
#include "integrator/connection.h"
#include "integrator/raystore.h"
#include "integrator/stageset.h"
#include "services/random.h"
#include "world/photonstore.h"
#include <algorithm>
#include <bit>
#include <set>

namespace alpenglow::integrator {

SpecularLights::SpecularLights(const StageSet& s, const VertexStages& v)
    : VertexStage(s, v), connection_(v.connection), store_(s.store) {}

SpecularLights::~SpecularLights() = default;

std::shared_ptr<const CausticSeeds> SpecularLights::seeds() const {
    return rules_.pickOne && rules_.lightsAtRequests && world_.photons() ? world_.photons()->seeds : nullptr;
}

/// Luminance that the eye receives from a point under uniform light of radiance 1.
float SpecularLights::bringsAt(size_t block, int i, const BatchContext& c) const {
    float sum = 0;
    const Color& ray = c.rays[block * kBlock + size_t(i)].weight;
    for (size_t k = 0; k < v_.count; ++k) {
        const LobeBlock& l = v_.sites[k].lobes[block];
        if (!(l.lights >> i & 1)) continue;
        const Color weight(l.weight[0][i], l.weight[1][i], l.weight[2][i]);
        sum += luminance(absolute(ray * weight)) * l.lobe[kRowAlbedo][i];
    }
    return std::isfinite(sum) ? sum : 0;
}

/// Decides by chance which points search.
void SpecularLights::ask(const CausticSeeds& seeds, const BatchContext& c) {
    asked_.clear();
    queries_.clear();
    for (size_t block = 0; block < v_.blocks; ++block) {
        const VertexBlock& v = v_.vertices[block];
        for (Lanes left = v.points & ~v.guided & ~(v.deep[0] & v.deep[1]); left; left &= left - 1) {
            const int i = std::countr_zero(left);
            const float brings = bringsAt(block, i, c);
            if (!(brings > 0)) continue;
            const size_t point = block * kBlock + size_t(i);
            const PathRay& from = c.rays[point];
            const int bounces = world_.maxDepth() - from.bounces - 1; // those of a path that meets a lamp there
            if (bounces < 1) continue;
            const Vec3 P(v.P[0][i], v.P[1][i], v.P[2][i]), n(v.n[0][i], v.n[1][i], v.n[2][i]);
            const CausticSeeds::Cell& cell = seeds.find(P, SurfaceTree::sideOf(dot(n, from.dir) > 0 ? -n : n));
            const float chance = seeds.chanceOf(cell, brings);
            const SampleNumbers& numbers = store_.random(from).numbers();
            if (!(Random(numbers).one(from.vertex, kSpecularSearch, 0) < chance)) continue;
            asked_.push_back({point, chance});
            queries_.push_back({P, &cell, bounces, world_.shadesAtOpen() ? 0 : from.shutter(), from.vertex, numbers});
        }
    }
}

/// Connects the points to which this light came.
void SpecularLights::connect(int number, BatchContext& c) {
    const BoundLight& light = world_.lights()[size_t(number)];
    v_.lights.resize(std::max(v_.lights.size(), v_.blocks));
    for (size_t b = 0; b < v_.blocks; ++b) {
        LightBlock& l = v_.lights[b];
        l.asked = l.metDiffuse = l.metSpecular = 0;
        l.emitter = l.met = l.hasPart = false;
        l.draws = nullptr;
        std::fill_n(l.density, kBlock, 1.f);
        std::fill_n(l.keptDiffuse, kBlock, 1.f);
        std::fill_n(l.keptSpecular, kBlock, 1.f);
    }
    for (size_t k = 0; k < asked_.size(); ++k) {
        if (found_[k].light != number) continue;
        constexpr float kShort = 1 - 1e-4f; // the last mirror does not block
        LightBlock& l = v_.lights[asked_[k].point / kBlock];
        const size_t i = asked_[k].point % kBlock;
        const Vec3 way = found_[k].from - queries_[k].P;
        const float far = length(way);
        const Color Cl = found_[k].Cl / asked_[k].chance;
        if (!(far > 0) || !isFinite(Cl)) continue;
        for (int q = 0; q < 3; ++q) l.w[q][i] = way[q] / far, l.Cl[q][i] = Cl[q];
        l.keptDiffuse[i] = found_[k].keptDiffuse, l.keptSpecular[i] = found_[k].keptSpecular;
        l.far[i] = far * kShort;
        l.asked |= 1u << i;
    }
    v_.mirrored = true;
    connection_.connect(light, c);
    v_.mirrored = false;
}

void SpecularLights::run(BatchContext& c) {
    const std::shared_ptr<const CausticSeeds> s = seeds();
    if (!s || v_.waits || c.between) return;
    ask(*s, c);
    if (asked_.empty()) return;
    if (searched_ != s) {
        search_ = std::make_unique<SpecularSearch>(context_.frame, *s, diagnostics_);
        searched_ = s;
    }
    const SpecularSearch::Counts before = search_->counts();
    found_.resize(asked_.size());
    if (!search_->run(queries_, found_, context_.stop)) return;
    counters_.searches += search_->counts().searches - before.searches;
    counters_.searchesFound += search_->counts().found - before.found;
    counters_.probes += search_->counts().probes - before.probes;
    v_.values.clear();
    v_.queryAt.clear();
    v_.several = v_.checksHits = false;
    std::set<int> lights;
    for (const SpecularSearch::Found& f : found_)
        if (f.light >= 0) lights.insert(f.light);
    for (const int l : lights) connect(l, c);
}

} // namespace alpenglow::integrator
