// Values of lit surfaces that light shaders query: outputs, displacement.
#pragma once
#include "integrator/batchcontext.h"
#include "integrator/context.h"
#include "integrator/vertex.h"

namespace alpenglow::integrator {

struct StageSet;

/// Values of a point that lights may query, from a call there. f(row): a number of the call's arguments.
template <class Row> LitValues litValuesOf(const BatchContext& c, const SiteInfo& s, int point, const Row& f) {
    LitValues values;
    values.binding = size_t(point) < c.bindings.size() ? c.bindings[size_t(point)] : -1; // a light's own ray has none
    values.displaced = c.displaced;
    values.point = point;
    values.N = c.points[size_t(point)].N;
    values.I = c.points[size_t(point)].I;
    for (const SiteInfo::Output& o : s.outputs) {
        auto& of = values.outputs.emplace_back(&o, std::vector<float>());
        for (int r = 0; r < o.size; ++r) of.second.push_back(f(o.row + r));
    }
    return values;
}

/// Keeps what lights query of the surfaces that they light.
class LitSurfaces final : Stage {
public:
    explicit LitSurfaces(const StageSet&);
    /// For the queries of a light; `of`, by query: index in `values`. This object must outlive the result.
    LitSurface querying(std::span<const int> of) const;
    /// Sets what a light's shader reads of the lit point besides Ps: Ns and I. lit: index in `values`; negative: nothing is
    /// known.
    void tellPoint(ShadePoint& query, int lit) const;
    /// Records current output values of a surface for lights that query them; for a waiting kernel, the values at the call.
    void recordOutputs(LitValues&, const BatchContext&, size_t point) const;

    std::vector<LitValues> values; ///< for the current batch; filled only if lights query surfaces
};

} // namespace alpenglow::integrator
