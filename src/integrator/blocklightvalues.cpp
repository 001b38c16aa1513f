// Light samples of vertices in blocks, one structure each: what light kernels query of lit surfaces, and what they give besides
// Cl.
#include "integrator/blockvertices.h"
#include "integrator/kernelinputs.h"
#include "integrator/lightkernels.h"
#include "integrator/litsurfaces.h"
#include "integrator/mediastacks.h"
#include "integrator/raystore.h"
#include "services/random.h"
#include <bit>

namespace alpenglow::integrator {

/// A vertex gives one answer to lights that query its surface: that of its first lobe.
void BlockVertices::tellLights(const BatchContext& c) {
    told_.assign(points_, -1);
    std::vector<LitValues>& all = litSurfaces_.values;
    for (size_t k = 0; k < count_; ++k) {
        const Site& s = sites_[k];
        for (size_t b = 0; b < blocks_; ++b)
            for (Lanes left = s.lobes[b].asked & vertices_[b].points; left; left &= left - 1) {
                const size_t i = size_t(std::countr_zero(left)), point = b * kBlock + i;
                if (told_[point] >= 0) continue;
                if (const LobeVertex* const r = s.requestAt(point)) {
                    told_[point] = r->lit;
                    if (s.info) litSurfaces_.tellOutputs(all[size_t(r->lit)], c, point);
                    continue;
                }
                told_[point] = int(all.size());
                if (!s.info) { // no call: points in a medium, and exits of walks
                    all.emplace_back().binding = c.below ? c.bindings[point] : -1;
                    continue;
                }
                const auto row = [&](int r) { return s.rows[b][size_t(r) * size_t(s.stride) + i]; };
                all.push_back(litValuesOf(c, *s.info, int(point), row));
                litSurfaces_.tellOutputs(all.back(), c, point);
            }
    }
}

int BlockVertices::toldAt(size_t point) const { return told_.empty() ? -1 : told_[point]; }

/// Runs the kernel of a light over queries_, to values_. group: the kernel that lights `of` share, which need nothing else; null:
/// the light's own.
void BlockVertices::askQueries(const BoundLight& light, const BoundKernel* group, std::span<const BoundLight* const> of,
                               BatchContext& c) {
    values_.assign(asked_.size(), {});
    LightCall call;
    if (group) {
        call.kernel = group;
        call.of = of;
        return lightKernels_.evaluateLight(light, queries_, values_, call);
    }
    LitSurface lit;
    std::vector<int> told;
    if (light.asksSurface) {
        for (const BlockQuery& a : asked_) told.push_back(toldAt(size_t(a.point)));
        lit = litSurfaces_.litBy(told);
        call.lit = &lit;
    }
    std::vector<char> inMedium;
    if (light.hazy && !world_.media_.empty()) {
        for (const BlockQuery& a : asked_)
            inMedium.push_back(MediaStacks::mediumOf(media_.towards(c, a.point, a.sample.direction)) >= 0);
        call.inMedium = &inMedium;
    }
    std::vector<float> values;
    const bool sends = light.sentCl >= 0;
    if (light.channels || sends) {
        values.resize(asked_.size() * size_t(light.valueWidth));
        call.values = &values;
    }
    lightKernels_.evaluateLight(light, queries_, values_, call);
    if (sends) chooseSent(light, values, c);
    if (light.channels) keepChannels(light, values, c);
}

/// For lights with generateSamples(): one of their samples at each query.
void BlockVertices::chooseSent(const BoundLight& light, std::span<const float> values, const BatchContext& c) {
    const uint32_t use = kLightPoint + numberOf(light);
    for (size_t k = 0; k < asked_.size(); ++k) {
        const size_t point = size_t(asked_[k].point);
        const uint32_t vertex = vertices_[point / kBlock].lightVertex[point % kBlock];
        const Random random = store_.random(c.rays[point]).draw(draw_, uint32_t(drawsOf(light, point)));
        Services::chooseSent(light, random.one(vertex, use, 0), values.data() + k * size_t(light.valueWidth), values_[k]);
    }
}

/// Keeps what the light writes to AOVs at its first sample at a point, of several call sites and of kDrawsAtOnce samples.
void BlockVertices::keepChannels(const BoundLight& light, std::span<const float> values, BatchContext& c) {
    constexpr uint32_t kDrawsAtOnce = 16;
    const uint64_t now = (uint64_t(numberOf(light)) + 1) << 32 | draw_ / kDrawsAtOnce;
    given_.resize(points_, 0);
    for (size_t k = 0; k < asked_.size(); ++k) {
        const size_t point = size_t(asked_[k].point);
        if (std::exchange(given_[point], now) == now) continue;
        inputs_.answers.keepChannels(c, light, int(point), values.data() + k * size_t(light.valueWidth));
    }
}

} // namespace alpenglow::integrator
