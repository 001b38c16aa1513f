// Light samples with one structure each: what light kernels query of lit surfaces, and what they give besides Cl.
#include "integrator/kernelinputs.h"
#include "integrator/lightkernels.h"
#include "integrator/lightsampling.h"
#include "integrator/litsurfaces.h"
#include "integrator/mediastacks.h"
#include "integrator/raystore.h"
#include "services/random.h"
#include <bit>

namespace alpenglow::integrator {

/// A vertex gives one answer to lights that query its surface: that of its first lobe.
void LightSampling::recordLitSurfaces(BatchContext& c) {
    surfaces_.pointsOfRows(c);
    v_.litSurface.assign(v_.points, -1);
    std::vector<LitValues>& all = litSurfaces_.values;
    for (size_t k = 0; k < v_.count; ++k) {
        const Site& s = v_.sites[k];
        for (size_t b = 0; b < v_.blocks; ++b)
            for (Lanes left = s.lobes[b].asked & v_.vertices[b].points; left; left &= left - 1) {
                const size_t i = size_t(std::countr_zero(left)), point = b * kBlock + i;
                if (v_.litSurface[point] >= 0) continue;
                if (const LobeVertex* const r = s.requestAt(point)) {
                    v_.litSurface[point] = r->lit;
                    if (s.info) litSurfaces_.recordOutputs(all[size_t(r->lit)], c, point);
                    continue;
                }
                v_.litSurface[point] = int(all.size());
                if (!s.info) { // no call: points in a medium, and exits of walks
                    LitValues& of = all.emplace_back();
                    of.binding = c.subsurface ? c.bindings[point] : -1;
                    of.N = c.points[point].N;
                    of.I = c.points[point].I;
                    continue;
                }
                const auto row = [&](int r) { return s.rows[b][size_t(r) * size_t(s.stride) + i]; };
                all.push_back(litValuesOf(c, *s.info, int(point), row));
                litSurfaces_.recordOutputs(all.back(), c, point);
            }
    }
}

/// Runs the kernel of a light over v_.queries, to v_.values. group: the kernel that lights `of` share, which need nothing else;
/// null: the light's own.
void LightSampling::askQueries(const BoundLight& light, const BoundKernel* group, std::span<const BoundLight* const> of,
                               BatchContext& c) {
    v_.values.assign(v_.asked.size(), {});
    LightCall call;
    if (group) {
        call.kernel = group;
        call.of = of;
        return lightKernels_.evaluateLight(light, v_.queries, v_.values, call);
    }
    LitSurface lit;
    std::vector<int> surfaces;
    if (light.asksSurface) {
        for (const BlockQuery& a : v_.asked) surfaces.push_back(v_.litSurfaceAt(size_t(a.point)));
        lit = litSurfaces_.querying(surfaces);
        call.lit = &lit;
    }
    std::vector<char> inMedium;
    if (light.inAtmosphere && !world_.media().empty()) {
        for (const BlockQuery& a : v_.asked)
            inMedium.push_back(MediaStacks::mediumOf(media_.towards(c, a.point, a.sample.direction)) >= 0);
        call.inMedium = &inMedium;
    }
    std::vector<float> values;
    const bool sends = light.sentCl >= 0;
    if (light.channels || sends) {
        values.resize(v_.asked.size() * size_t(light.valueWidth));
        call.values = &values;
    }
    lightKernels_.evaluateLight(light, v_.queries, v_.values, call);
    if (sends) chooseSent(light, values, c);
    if (light.channels) keepChannels(light, values, c);
}

/// For lights with generateSamples(): one of their samples at each query.
void LightSampling::chooseSent(const BoundLight& light, std::span<const float> values, const BatchContext& c) {
    const uint32_t use = kLightPoint + v_.numberOf(light);
    for (size_t k = 0; k < v_.asked.size(); ++k) {
        const size_t point = size_t(v_.asked[k].point);
        const uint32_t vertex = v_.vertices[point / kBlock].lightVertex[point % kBlock];
        const Random random = store_.random(c.rays[point]).draw(v_.draw, uint32_t(drawsOf(light, point)));
        Services::chooseSent(light, random.one(vertex, use, 0), values.data() + k * size_t(light.valueWidth), v_.values[k]);
    }
}

/// Keeps what the light writes to AOVs at its first sample at a point, whatever the number of its call sites and samples.
void LightSampling::keepChannels(const BoundLight& light, std::span<const float> values, BatchContext& c) {
    const uint32_t now = uint32_t(v_.numberOf(light)) + 1;
    given_.resize(v_.points, 0);
    for (size_t k = 0; k < v_.asked.size(); ++k) {
        const size_t point = size_t(v_.asked[k].point);
        if (std::exchange(given_[point], now) == now) continue;
        inputs_.answers.keepChannels(c, light, int(point), values.data() + k * size_t(light.valueWidth));
    }
}

} // namespace alpenglow::integrator
