// Points inside scattering media, in blocks: their lobe is the phase function of the medium, without a kernel (medium.h).
#include "integrator/blockflight.h"
#include "integrator/lightpathstates.h"
#include "integrator/medium.h"
#include "services/random.h"
#include <algorithm>
#include <bit>

namespace alpenglow::integrator {

/// Whether light kernels of a binding read more at points inside media than rows hold.
bool BlockVertices::needsPoints(const SurfaceBinding& b) const {
    const WorldImpl::LightList& list = world_.lightLists_[size_t(b.lightList)];
    const std::vector<int>& on = world_.sampledOf(list);
    return flight_->on() || !rules_.pickOne || paths_.automaton || choosesLights(list) ||
           !std::all_of(on.begin(), on.end(), [&](int l) { return inRows_[size_t(l)] != 0; });
}

void BlockVertices::run(BatchContext& c, const Homogeneous& h, std::span<const Vec3> beside, Sched& sched) {
    begin(c, false);
    loadVertices(c);
    beginMedium(beside, h.anisotropy);
    followLobes(c, sched);
}

bool BlockVertices::light(const BatchContext& c, const Homogeneous& h, const BoundLight& light, std::vector<BlockLit>& found) {
    if (!rules_.pickOne || !inRows_[size_t(&light - world_.lights_.data())]) return false;
    begin(c, false);
    loadVertices(c);
    beginMedium({}, h.anisotropy);
    prepare();
    findLit(&light);
    askInRows(light, c);
    const Site& s = sites_[0];
    for (size_t b = 0; b < blocks_; ++b) {
        const LightBlock& l = lights_[b];
        if (l.asked) s.lanes->evaluate(s.lobes[b].lobe[0], l.asked, l.w[0], value_[0]);
        for (Lanes left = l.asked; left; left &= left - 1) {
            const size_t i = size_t(std::countr_zero(left)), point = b * kBlock + i;
            BlockLit& to = found.emplace_back();
            to.point = point;
            to.w = {l.w[0][i], l.w[1][i], l.w[2][i]};
            if (l.emitter) to.end = {l.end[0][i], l.end[1][i], l.end[2][i]};
            to.Cl = {l.Cl[0][i], l.Cl[1][i], l.Cl[2][i]};
            to.density = l.density[i], to.far = l.far[i], to.kept = l.keptDiffuse[i], to.phase = value_[kRowFcos][i];
            const int32_t says = queryAt_.empty() ? -1 : queryAt_[point];
            to.shadowRadius = says < 0 ? 0 : values_[size_t(says)].shadowRadius;
            if (says >= 0) to.L = values_[size_t(says)].L;
        }
    }
    return true;
}

/// Fills the points of a block.
void BlockVertices::loadFlown(size_t b, const BatchContext& c) {
    VertexBlock& v = vertices_[b];
    const RayBlock& rays = rays_[b];
    const size_t first = b * kBlock, n = std::min(points_ - first, size_t(kBlock));
    v.points = n >= size_t(kBlock) ? 0xffffu : (1u << n) - 1;
    v.through = false;
    for (size_t k = 0; k < size_t(kBlock); ++k) {
        const float t = c.flown[first + std::min(k, n - 1)].t;
        endRays(b, int(k), *c.binding, true);
        for (int q = 0; q < 3; ++q) v.P[q][k] = rays.origin[q][k] + rays.direction[q][k] * t;
    }
    for (int q = 0; q < 3; ++q) { // no sides and no viewing direction
        std::fill_n(v.n[q], kBlock, 0.f);
        std::fill_n(v.I[q], kBlock, 0.f);
        std::fill_n(v.clear[q], kBlock, 0.f);
    }
    std::fill_n(v.error, kBlock, 0.f);
    std::fill_n(v.bias, kBlock, c.binding->bias);
}

/// Sets the lobes; near a light, those with light-directed sampling.
void BlockVertices::beginMedium(std::span<const Vec3> beside, float anisotropy) {
    static const LobeKind* const kKinds[] = {findLobe("henyey-greenstein"), findLobe("henyey-greenstein-beside")};
    count_ = std::any_of(beside.begin(), beside.end(), [](const Vec3& l) { return l != Vec3(0); }) ? 2 : 1;
    sites_.resize(std::max(sites_.size(), count_));
    for (size_t k = 0; k < count_; ++k) {
        Site& s = sites_[k];
        s.number = kSegmentEvent;
        s.info = nullptr;
        s.kind = kKinds[k];
        s.lanes = &lanes_.lobes[s.kind->index];
        s.rays = &kDiffuseKind;
        s.lighting = s.lights = s.diffuse = true;
        s.begin(blocks_);
        for (size_t b = 0; b < blocks_; ++b) {
            LobeBlock& l = s.lobes[b];
            for (int q = 0; q < 3; ++q) {
                std::fill_n(l.weight[q], kBlock, 1.f);
                std::copy_n(rays_[b].direction[q], kBlock, l.lobe[kRowAxis + q]);
            }
            std::fill_n(l.lobe[kRowA], kBlock, anisotropy);
        }
    }
    for (size_t i = 0; i < points_; ++i) {
        const bool near = !beside.empty() && beside[i] != Vec3(0);
        LobeBlock& l = sites_[near].lobes[i / kBlock];
        l.asked |= 1u << i % kBlock;
        for (int q = 0; q < 3 && near; ++q) l.lobe[kRowWo + q][i % kBlock] = beside[i][q];
    }
}

/// Applies the MIS weights of distance sampling to the light samples; removes samples of weight 0.
void BlockVertices::takeParts(const BoundLight& light, const BatchContext& c) {
    lights_.resize(blocks_);
    std::erase_if(litBlocks_, [&](size_t b) {
        for (Lanes left = lit_[b]; left; left &= left - 1) {
            const size_t i = size_t(std::countr_zero(left));
            lights_[b].part[i] = mediumEvents_.shareOfDistance(c.flown[b * kBlock + i], light);
            if (lights_[b].part[i] == 0) lit_[b] &= ~(1u << i);
        }
        return lit_[b] == 0;
    });
}

} // namespace alpenglow::integrator
