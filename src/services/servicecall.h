// One service call of a running kernel: its points, arguments and results.
#pragma once
#include "services/kernelrun.h"
#include "world/shadervalue.h"
#include <bit>

namespace alpenglow::services {

/// Rows have one float for each lane; result rows are initially zero. Row 0 of a query is 1 if there is a value that fits, else
/// 0; then follow the values, by component, then element. For a resizable array its length comes before them.
class ServiceCall {
public:
    /// first, mask: the strip begins at that point of the batch; lanes whose bits are set are active. in, out: rows.
    ServiceCall(KernelRun&, Diagnostics&, int site, int first, uint64_t mask, int lanes, const float* in, float* out);
    /// Calls body(lane, point) for the lanes of the mask that have a point.
    template <class Body> void each(Body&& body) const {
        for (int lane = 0; lane < lanes; ++lane)
            if ((mask >> lane & 1) && first + lane < int(c.points.size())) body(lane, c.points[size_t(first + lane)]);
    }
    /// The same, with the lane only.
    template <class Body> void eachLane(Body&& body) const {
        for (int lane = 0; lane < lanes; ++lane)
            if ((mask >> lane & 1) && size_t(first + lane) < c.size()) body(lane);
    }
    /// An argument.
    float at(int row, int lane) const { return in[size_t(row) * lanes + lane]; }
    /// Sets a result.
    void put(int row, int lane, float v) const { out[size_t(row) * lanes + lane] = v; }
    /// Sets a result that is a string.
    void putText(int row, int lane, const std::string& t) const { put(row, lane, std::bit_cast<float>(rsl::internString(t))); }
    /// The first string of the call, which may vary over the points.
    std::string name(int lane) const;
    /// The same, interned.
    int32_t nameId(int lane) const;
    /// Of the call in the shader's file.
    SourcePlace place() const;
    /// Writes the value, if it fits the destination.
    void answer(int lane, const ShaderValue&) const;
    /// Binding of a lane's point; for a light's kernel, of the surface that it lights. Null without a primitive.
    const SurfaceBinding* binding(const WorldImpl&, int lane) const;

    KernelRun& c;                 ///< the batch, and its services
    Diagnostics& diagnostics;     ///< where messages of the call go
    const SiteInfo& s;            ///< the call site as it was bound
    const rsl::ir::Site& d;       ///< the call site as it was compiled
    const int site, first, lanes; ///< index of the site; first point of the strip in the batch; width of rows
    const uint64_t mask;          ///< active lanes, as bits
    const float* const in;        ///< argument rows
    float* const out;             ///< result rows
};

} // namespace alpenglow::services
