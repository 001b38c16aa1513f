#include "geometry/cage_border.h"
#include <algorithm>
#include <map>

namespace alpenglow::geometry {

namespace {

constexpr int kUnknown = -2;
constexpr float kSharp = 10; ///< and more is infinitely sharp

struct Around {
    std::vector<int> border; ///< vertices at the other ends of border edges
    int faces = 0;
    bool sharp = false, semiSharp = false; ///< tagged as a corner, or a crease from within ends here
};

} // namespace

CageBorder::CageBorder(const SubdivisionCage& cage, const LimitSurface& limit) {
    straight_ = cage.scheme == SubdivisionScheme::Bilinear;
    if (cage.boundary == SubdivisionCage::Boundary::None || limit.blunted()) return;
    struct Side {
        int first = -1, last = -1, faces = 0;
        bool drawn = false;
    };
    std::vector<Side> sides(limit.edges());
    std::vector<Around> around(size_t(cage.vertices));
    for (uint32_t f = 0; f < limit.faces(); ++f) {
        const int n = limit.corners(f);
        for (int k = 0; k < n; ++k) {
            Side& s = sides[size_t(limit.edgeAt(f, k))];
            const int a = limit.vertexAt(f, k), b = limit.vertexAt(f, (k + 1) % n);
            const bool forward = limit.edgeStart(limit.edgeAt(f, k)) == a;
            s = {forward ? a : b, forward ? b : a, s.faces + 1, s.drawn || limit.drawn(f)};
            ++around[size_t(a)].faces;
        }
    }
    std::map<std::pair<int, int>, float> creases;
    for (size_t i = 0; i < cage.creaseSharpness.size() && 2 * i + 1 < cage.creaseEnds.size(); ++i) {
        float& s = creases[std::minmax(cage.creaseEnds[2 * i], cage.creaseEnds[2 * i + 1])];
        s = std::max(s, cage.creaseSharpness[i]);
    }
    for (const Side& s : sides) {
        if (s.faces == 1) {
            around[size_t(s.first)].border.push_back(s.last);
            around[size_t(s.last)].border.push_back(s.first);
        } else if (s.faces > 1) {
            const auto crease = creases.find(std::minmax(s.first, s.last));
            if (crease == creases.end() || !(crease->second > 0)) continue;
            for (const int v : {s.first, s.last})
                (crease->second >= kSharp ? around[size_t(v)].sharp : around[size_t(v)].semiSharp) = true;
        }
    }
    for (size_t i = 0; i < cage.cornerVertex.size() && i < cage.cornerSharpness.size(); ++i) {
        Around& a = around[size_t(cage.cornerVertex[i])];
        if (cage.cornerSharpness[i] > 0) (cage.cornerSharpness[i] >= kSharp ? a.sharp : a.semiSharp) = true;
    }
    // Neighbour beyond an end of a border edge from vertex `from`.
    const auto behind = [&](int v, int from) {
        const Around& a = around[size_t(v)];
        if (a.sharp || (a.faces == 1 && cage.boundary == SubdivisionCage::Boundary::EdgeAndCorner)) return kCorner;
        if (a.semiSharp || a.border.size() != 2) return kUnknown;
        return a.border[0] == from ? a.border[1] : a.border[0];
    };
    for (size_t e = 0; e < sides.size(); ++e) {
        const Side& s = sides[e];
        if (s.faces != 1 || !s.drawn) continue;
        const Ends ends{behind(s.first, s.last), s.first, s.last, behind(s.last, s.first)};
        if (!straight_ && (ends.before == kUnknown || ends.behind == kUnknown)) continue;
        edges_.push_back(int(e));
        ends_.push_back(ends);
    }
}

EdgeCurve CageBorder::curve(size_t k, const std::function<Vec3d(int)>& point) const {
    const auto at = [&](int v) { return Vec3d(Vec3(point(v))); }; // rounded as corners of polygons are
    const Ends& e = ends_[k];
    const Vec3d a = at(e.first), b = at(e.last);
    if (straight_) return EdgeCurve::line(a, b);
    const Vec3d before = e.before == kCorner ? a * 2 - b : at(e.before), behind = e.behind == kCorner ? b * 2 - a : at(e.behind);
    // A uniform cubic B-spline. Sums are such that they are the same from both ends.
    const Vec3d p[4] = {e.before == kCorner ? a : (a * 4 + (before + b)) / 6.0, (a * 2 + b) / 3.0, (b * 2 + a) / 3.0,
                        e.behind == kCorner ? b : (b * 4 + (a + behind)) / 6.0};
    std::array<double, 4> bezier[4];
    for (int i = 0; i < 4; ++i) bezier[i] = {p[i].x, p[i].y, p[i].z, 1};
    return EdgeCurve::bezier(bezier);
}

} // namespace alpenglow::geometry
