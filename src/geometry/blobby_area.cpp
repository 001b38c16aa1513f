// A Blobby as a light: its area, and points of it.
#include "geometry/blobby.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::geometry {

namespace {
constexpr int kRoots = 8;
}

int Blobby::alongAxis(const Box& box, const Now& now, int axis, const Vec3d& through, double* out) const {
    Vec3d o = through, d(0.0);
    o[axis] = 0;
    d[axis] = 1;
    return now.field().crossings(now.tape(), o, d, box.lo[axis], box.hi[axis], kRoots, out);
}

/// Area in camera space over area in object space, for a surface with this normal in object space.
double Blobby::stretch(const Vec3d& n) const {
    const auto& i = toObject_.m;
    const Vec3d c(i[0][0] * n.x + i[0][1] * n.y + i[0][2] * n.z, i[1][0] * n.x + i[1][1] * n.y + i[1][2] * n.z,
                  i[2][0] * n.x + i[2][1] * n.y + i[2][2] * n.z);
    return length(c) / length(n) * std::fabs(determinant3(toCamera()));
}

double Blobby::Areas::Part::chance(uint32_t box) const {
    const auto at = std::lower_bound(boxes.begin(), boxes.end(), box);
    if (at == boxes.end() || *at != box) return 0;
    const size_t i = size_t(at - boxes.begin());
    return cumulative[i] - (i ? cumulative[i - 1] : 0);
}

const Blobby::Areas::Part& Blobby::Areas::at(float time) const {
    const size_t n = parts.size();
    return parts[std::min(n - 1, size_t(std::max(0.f, time) * float(n)))];
}

/// Intersects lines along the axes through a box with the surface; the three directions share the area of each root.
double Blobby::boxArea(uint32_t number, int lines) const {
    const Box& b = boxes_[number];
    const Now now(*this, tapeOf(b), b.from + (b.to - b.from) * 0.5f);
    const Vec3d size = b.hi - b.lo;
    double area = 0;
    // Boxes are aligned: lines at equal positions in each would sample a sphere at the same few circles.
    const double turn = number * 0.7548776662466927, shiftA = turn - std::floor(turn);
    const double other = number * 0.5698402909980532, shiftB = other - std::floor(other);
    for (int axis = 0; axis < 3; ++axis)
        for (int k = 0; k < lines * lines; ++k) {
            Vec3d p = b.lo;
            p[(axis + 1) % 3] += size[(axis + 1) % 3] * (k % lines + shiftA) / lines;
            p[(axis + 2) % 3] += size[(axis + 2) % 3] * (k / lines + shiftB) / lines;
            double roots[kRoots];
            for (int n = alongAxis(b, now, axis, p, roots), i = 0; i < n; ++i) {
                p[axis] = roots[i];
                const Vec3d g = normalize(now.jet(p).g);
                // Weights a third by the square of its normal component: zero at silhouettes.
                area += size[(axis + 1) % 3] * size[(axis + 2) % 3] / (lines * lines) * std::fabs(g[axis]) * stretch(g);
            }
        }
    return area;
}

const Blobby::Areas& Blobby::areas() const {
    std::call_once(areas_.made, [&] {
        // Lines along a side of a box; more if there are few boxes, because lines at silhouettes have large weights.
        const int lines = std::clamp(int(std::sqrt(2e5 / (3.0 * double(boxes_.size() + 1)))), motion_ ? 2 : 4, 32);
        areas_.parts.resize(motion_ ? 64 : 1);
        const float n = float(areas_.parts.size());
        std::vector<double> sums(areas_.parts.size());
        for (uint32_t k = 0; k < boxes_.size(); ++k) {
            const Box& b = boxes_[k];
            const double area = boxArea(k, lines);
            areas_.sum += area * (double(b.to) - b.from);
            // A box that all lines missed may contain a corner of the surface: it has a nonzero probability as well.
            const Vec3d size = b.hi - b.lo;
            const double face = size.x * size.y + size.y * size.z + size.z * size.x;
            const double chance = area + 1e-3 * face * stretch(Vec3d(0, 0, 1));
            for (size_t p = size_t(b.from * n); p < areas_.parts.size() && float(p) < b.to * n; ++p) {
                areas_.parts[p].boxes.push_back(k);
                areas_.parts[p].cumulative.push_back(sums[p] += chance);
            }
        }
        for (size_t p = 0; p < sums.size(); ++p)
            for (double& c : areas_.parts[p].cumulative) c /= sums[p];
    });
    return areas_;
}

/// Density by area in object space of a sample at a point.
double Blobby::densityObject(uint32_t prim, const Now& now, float time, const Vec3d& p, const Vec3d& normal) const {
    const Box& b = boxes_[prim];
    const Vec3d size = b.hi - b.lo;
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis) {
        double roots[kRoots];
        const int n = std::max(1, alongAxis(b, now, axis, p, roots)); // including the point itself
        sum += std::fabs(normal[axis]) / (n * size[(axis + 1) % 3] * size[(axis + 2) % 3]);
    }
    return areas().at(time).chance(prim) * sum / 3;
}

SurfacePoint Blobby::evaluate(int, double u, double v) const {
    // No two numbers name all points of such a surface: (u, v) of the unit square go round it as samples do.
    return sampleArea(std::clamp(u, 0.0, 0x1.fffffffffffffp-1), std::clamp(v, 0.0, 0x1.fffffffffffffp-1));
}

SurfacePoint Blobby::sampleFromAt(const Vec3&, double xi1, double xi2, float time) const {
    const Areas::Part& part = areas().at(time);
    SurfacePoint none; // density 0
    none.n = none.N = none.Ng = Vec3(0, 0, 1);
    none.prim = kNone;
    none.time = time;
    if (part.boxes.empty()) return none;
    const auto& sums = part.cumulative;
    const size_t i = size_t(std::upper_bound(sums.begin(), sums.end() - 1, xi1) - sums.begin());
    const uint32_t prim = part.boxes[i];
    const double before = i ? sums[i - 1] : 0, share = sums[i] - before;
    // The rest of the numbers selects the axis, the line, and one of its roots.
    double x = share > 0 ? std::clamp((xi1 - before) / share, 0.0, 0x1.fffffffffffffp-1) : 0.5, y = xi2;
    const int axis = std::min(2, int(y * 3));
    y = y * 3 - axis;
    const Box& b = boxes_[prim];
    Vec3d p = b.lo;
    p[(axis + 1) % 3] += (b.hi[(axis + 1) % 3] - b.lo[(axis + 1) % 3]) * x;
    p[(axis + 2) % 3] += (b.hi[(axis + 2) % 3] - b.lo[(axis + 2) % 3]) * y;
    none.P = Vec3(transformPoint(toCamera(), p));
    if (motion_ && !b.at(time)) return none;
    const Now now(*this, tapeOf(b), time);
    double roots[kRoots];
    const int n = alongAxis(b, now, axis, p, roots);
    if (n == 0) return none;                                  // no hit on this line
    const double scrambled = x * 4096 - std::floor(x * 4096); // bits of x that hardly affect the line
    p[axis] = roots[std::min(n - 1, int(scrambled * n))];
    double b1, b2;
    encode(prim, p, now.jet(p).g, time, b1, b2);
    return pointAt(prim, b1, b2, time);
}

double Blobby::sampleDensity(const SurfacePoint& s) const {
    if (s.prim >= boxes_.size()) return 0;
    const Found found = decoded(s.prim, s.b1, s.b2, s.time);
    const Vec3d& p = found.p;
    const Now now(*this, *found.tape, found.time);
    const Vec3d g = now.jet(p).g;
    const double l = length(g);
    return l > 0 ? densityObject(s.prim, now, found.time, p, g / l) / stretch(g) : 0;
}

} // namespace alpenglow::geometry
