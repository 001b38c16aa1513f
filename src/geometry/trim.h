// Trim curves: which part of a NURBS patch is there (RISpec 3.2, 5.2).
//
// Nothing is made of polygons: a curve is cut into rational Bezier pieces that rise or fall in v, and whether a point lies left
// or right of a piece is found on the piece itself, in double. Inside is what a line to infinity leaves through an odd number of
// pieces.
#pragma once
#include "base/diagnostics.h"
#include "scene/primitive.h"
#include <memory>
#include <string>
#include <vector>

namespace alpenglow::geometry {

/// The part of the unit square that loops of curves keep.
class TrimRegion {
public:
    /// Parameters of the patch that become 0 and 1.
    struct Domain {
        double lo[2], hi[2]; ///< along u and v
    };
    /// curves: the nine arrays of TrimCurve (scene::Attributes::trimCurve), u, v, w homogeneous. keepInside: removes the outside.
    /// An open loop is closed by a line (with a warning if the gap is visible). Returns null, with a message in `why`, for
    /// invalid curves.
    static std::shared_ptr<const TrimRegion> make(const scene::ParamList& curves, const Domain&, bool keepInside,
                                                  std::string& why, double& widestGap);

    /// Whether the point is kept. Points on the curve belong to one side.
    bool keeps(double u, double v) const;
    /// How much of a rectangle is kept.
    enum class Cover { None, Some, All };
    /// Coverage of a rectangle; conservative: Some may stand for None or All, never the reverse.
    Cover cover(double u0, double v0, double u1, double v1) const;
    /// The kept intervals of u at v, pairs of ends by increasing u.
    void intervals(double v, std::vector<double>& ends) const;
    /// Kept fraction of the unit square, 0 to 1. By quadrature, to about 1e-9 for smooth curves.
    double area() const { return area_; }
    /// Samples a kept point from two numbers in [0,1), with density(); returns false if there is none at the sampled v.
    bool sample(double xi1, double xi2, double& u, double& v) const;
    /// Density of sample() per du dv at this v, about 1 / area(). 0 if nothing is kept there.
    double density(double v) const;
    /// Nodes and weights for integrals over the kept part, by du dv.
    struct Node {
        double u, v, weight; ///< in the unit square; weights add up to the kept area
    };
    /// The same for every call.
    std::vector<Node> nodes() const;

private:
    struct Piece {
        std::vector<double> x, y, w; ///< Bezier points, homogeneous
        double u0, v0, u1, v1;       ///< its ends: those of its neighbours to the bit
        double left, right;          ///< bounds of u
        double crossing(double v) const;
    };
    struct Strip {
        double lo = 0, hi = 0;
        uint32_t first = 0, count = 0; ///< into active_
        double share = 0, cumulative = 0;
    };
    class Maker;
    TrimRegion() = default;
    void makeStrips();
    void weighStrips();
    const Strip& stripOf(double v) const;
    double keptLength(double v) const;

    std::vector<Piece> pieces_;
    std::vector<Strip> strips_; ///< of v, from 0 to 1
    std::vector<uint32_t> active_;
    bool keepInside_ = false;
    double area_ = 0;
};

} // namespace alpenglow::geometry
