// One call of a service while a kernel runs: which points ask, what they give, and where their answers go.
#pragma once
#include "answers/kernelrun.h"
#include "world/told.h"
#include <bit>

namespace alpenglow::transport {

/// Rows are floats, one a lane. Those of the results begin at zero. A query has 1 or 0, whether the answer came and fits, in row
/// 0; then the answer, component by component, element by element. For an array that can change its length that stands before it.
class ServiceCall {
public:
    ServiceCall(KernelRun&, Diagnostics&, int site, int first, uint64_t mask, int lanes, const float* in, float* out);
    template <class Body> void each(Body&& body) const {
        for (int lane = 0; lane < lanes; ++lane)
            if ((mask >> lane & 1) && first + lane < int(c.points.size())) body(lane, c.points[size_t(first + lane)]);
    }
    /// The same for those who only need the number of a lane.
    template <class Body> void eachLane(Body&& body) const {
        for (int lane = 0; lane < lanes; ++lane)
            if ((mask >> lane & 1) && size_t(first + lane) < c.size()) body(lane);
    }
    float at(int row, int lane) const { return in[size_t(row) * lanes + lane]; }
    void put(int row, int lane, float v) const { out[size_t(row) * lanes + lane] = v; }
    void putText(int row, int lane, const std::string& t) const { put(row, lane, std::bit_cast<float>(rsl::internString(t))); }
    /// The first string of the call, where each point may have its own.
    std::string name(int lane) const;
    /// The same, interned.
    int32_t nameId(int lane) const;
    SourcePlace place() const;
    /// Answers, where that fits the variable that waits for it.
    void answer(int lane, const Told&) const;
    /// What the point of a lane is bound to; for a light's kernel the surface that it lights. Null where there is no primitive.
    const SurfaceBinding* binding(const WorldImpl&, int lane) const;

    KernelRun& c;
    Diagnostics& diagnostics;
    const SiteInfo& s;
    const rsl::ir::Site& d;
    const int site, first, lanes;
    const uint64_t mask;
    const float* const in;
    float* const out;
};

} // namespace alpenglow::transport
