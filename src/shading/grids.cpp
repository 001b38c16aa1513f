#include "shading/grids.h"
#include "base/limits.h"
#include "geometry/placed.h"
#include "scene/primitivekinds.h"
#include <algorithm>
#include <map>

namespace alpenglow::shading {

namespace {

using geometry::Shape;

constexpr int kMostSteps = 4096; ///< along an edge

/// The shape whose triangles or parameters rays meet, at its first time.
const Shape* baseOf(const Shape& s) {
    const geometry::Placed* placed = s.placed();
    if (!placed) return &s;
    return placed->deforming() ? placed->deforming()->keys()[0].get() : placed->geometry().get();
}

bool isQuadric(const Shape& s) { return s.exactPrims() == 1 && scene::has(s.kind(), scene::kQuadric); }

class Grid {
public:
    Grid(const Shape& s, const geometry::DiceCamera& camera, bool middles, std::vector<GridPoint>& points, std::vector<Vec3>& P)
        : shape_(s), base_(*baseOf(s)), camera_(camera), edge_(geometry::diceEdge(s.attributes())), middles_(middles),
          points_(points), P_(P) {}
    void ofQuadric();
    void ofTriangles();

private:
    struct Corner {
        float area = 0, radius = 0;
    };
    struct Edge {
        uint32_t owner;
        double area = 0;
    };
    using Edges = std::map<std::pair<uint32_t, uint32_t>, Edge>;
    double pixels(const Vec3& a, const Vec3& b) const { return camera_.pixels(Vec3d(a), Vec3d(b) - Vec3d(a)); }
    Vec3 placeOf(uint32_t prim, double b1, double b2) const {
        const geometry::SurfacePoint p = shape_.evaluateHit(prim, b1, b2);
        return p.displaced ? p.displacedP : p.P;
    }
    void add(uint32_t prim, double b1, double b2, const Vec3& P, float radius, double area, bool corner) {
        if (!base_.keepsHit(prim, b1, b2)) return;
        points_.push_back({0, prim, b1, b2, 0, radius, float(area), corner});
        P_.push_back(P);
    }
    void stepsOfQuadric(int& nu, int& nv) const;
    void stepsOfTriangles();
    void addCorners(uint32_t triangle, const Edges&, const std::vector<Corner>&, std::vector<bool>& seen);
    void addMiddles(uint32_t triangle);
    struct Triangle {
        Vec3 p[3];
        double longest = 0, area = 0;
        int n = 1;
    };
    const uint32_t* indices(size_t triangle) const { return &base_.mesh().index[3 * triangle]; }
    static std::pair<uint32_t, uint32_t> edge(uint32_t a, uint32_t b) { return {std::min(a, b), std::max(a, b)}; }
    const Shape &shape_, &base_;
    const geometry::DiceCamera& camera_;
    const double edge_;
    const bool middles_;
    std::vector<GridPoint>& points_;
    std::vector<Vec3>& P_;
    std::vector<Triangle> triangles_;
};

void Grid::stepsOfQuadric(int& nu, int& nv) const {
    constexpr int kCoarse = 16;
    Vec3 at[kCoarse + 1][kCoarse + 1];
    for (int j = 0; j <= kCoarse; ++j)
        for (int i = 0; i <= kCoarse; ++i) at[j][i] = shape_.evaluate(0, double(i) / kCoarse, double(j) / kCoarse).P;
    double longest[2] = {0, 0}; // of rows along u, along v
    for (int k = 0; k <= kCoarse; ++k) {
        double u = 0, v = 0;
        for (int i = 0; i < kCoarse; ++i) {
            u += pixels(at[k][i], at[k][i + 1]);
            v += pixels(at[i][k], at[i + 1][k]);
        }
        longest[0] = std::max(longest[0], u);
        longest[1] = std::max(longest[1], v);
    }
    const double cells = std::max(1.0, longest[0] / edge_) * std::max(1.0, longest[1] / edge_);
    const double wider = std::sqrt(std::max(1.0, cells / double(limits::kDiceQuads)));
    nu = int(std::clamp(std::ceil(longest[0] / (edge_ * wider)), 1.0, double(kMostSteps)));
    nv = int(std::clamp(std::ceil(longest[1] / (edge_ * wider)), 1.0, double(kMostSteps)));
}

void Grid::ofQuadric() {
    int nu = 1, nv = 1;
    stepsOfQuadric(nu, nv);
    const size_t row = size_t(nu) + 1;
    std::vector<geometry::SurfacePoint> line(row);
    std::vector<Vec3> P(row * (size_t(nv) + 1));
    std::vector<std::pair<double, double>> where(P.size());
    std::vector<uint32_t> prim(P.size());
    for (size_t j = 0; j <= size_t(nv); ++j)
        for (size_t i = 0; i < row; ++i) {
            const geometry::SurfacePoint p = shape_.evaluate(0, double(i) / nu, double(j) / nv);
            P[j * row + i] = p.P;
            prim[j * row + i] = p.prim;
            where[j * row + i] = {p.b1, p.b2};
        }
    std::vector<Corner> corners(P.size());
    const auto cell = [&](size_t i, size_t j, double* area, float* radius) {
        const size_t a = j * row + i, b = a + 1, c = a + row, d = c + 1;
        *area = (length(cross(Vec3d(P[b]) - Vec3d(P[a]), Vec3d(P[c]) - Vec3d(P[a]))) +
                 length(cross(Vec3d(P[b]) - Vec3d(P[d]), Vec3d(P[c]) - Vec3d(P[d])))) /
                2;
        *radius = std::max(length(P[d] - P[a]), length(P[c] - P[b])) / 2;
    };
    for (size_t j = 0; j < size_t(nv); ++j)
        for (size_t i = 0; i < size_t(nu); ++i) {
            double area;
            float radius;
            cell(i, j, &area, &radius);
            for (const size_t k : {j * row + i, j * row + i + 1, (j + 1) * row + i, (j + 1) * row + i + 1}) {
                corners[k].area += float(area / 4);
                corners[k].radius = std::max(corners[k].radius, radius);
            }
        }
    for (size_t k = 0; k < P.size(); ++k)
        add(prim[k], where[k].first, where[k].second, P[k], corners[k].radius, double(corners[k].area), true);
    for (size_t j = 0; middles_ && j < size_t(nv); ++j)
        for (size_t i = 0; i < size_t(nu); ++i) {
            double area;
            float radius;
            cell(i, j, &area, &radius);
            const geometry::SurfacePoint p = shape_.evaluate(0, (double(i) + .5) / nu, (double(j) + .5) / nv);
            add(p.prim, p.b1, p.b2, p.P, radius, area, false);
        }
}

void Grid::stepsOfTriangles() {
    triangles_.resize(base_.mesh().triangles());
    double cells = 0;
    for (size_t t = 0; t < triangles_.size(); ++t) {
        Triangle& x = triangles_[t];
        for (int k = 0; k < 3; ++k) x.p[k] = placeOf(uint32_t(t), k == 1, k == 2);
        double longest = 0;
        for (int k = 0; k < 3; ++k) {
            longest = std::max(longest, pixels(x.p[k], x.p[(k + 1) % 3]));
            x.longest = std::max(x.longest, double(length(x.p[(k + 1) % 3] - x.p[k])));
        }
        x.area = length(cross(Vec3d(x.p[1]) - Vec3d(x.p[0]), Vec3d(x.p[2]) - Vec3d(x.p[0]))) / 2;
        // The diagonal of a square whose edge is as long as is wanted is one edge of each of its halves.
        x.n = int(std::clamp(std::ceil(longest / (edge_ * 1.42)), 1.0, double(kMostSteps)));
        cells += double(x.n) * x.n / 2;
    }
    if (cells <= double(limits::kDiceQuads)) return;
    const double fewer = std::sqrt(double(limits::kDiceQuads) / cells);
    for (Triangle& x : triangles_) x.n = std::max(1, int(x.n * fewer));
}

void Grid::addCorners(uint32_t t, const Edges& edges, const std::vector<Corner>& corners, std::vector<bool>& seen) {
    const Triangle& x = triangles_[t];
    const uint32_t* v = indices(t);
    const int n = x.n;
    const float radius = float(x.longest / (2 * n));
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i + j <= n; ++i) {
            const int k = n - i - j; // weights of the corners: k, i, j
            const int zero = (i == 0) + (j == 0) + (k == 0);
            const double b1 = double(i) / n, b2 = double(j) / n;
            double area = 2 * x.area / (double(n) * n);
            float r = radius;
            if (zero == 2) {
                const uint32_t corner = v[i == n ? 1 : j == n ? 2 : 0];
                if (seen[corner]) continue;
                seen[corner] = true;
                area = double(corners[corner].area);
                r = corners[corner].radius;
            } else if (zero == 1) {
                const Edge& e = edges.at(i == 0 ? edge(v[0], v[2]) : j == 0 ? edge(v[0], v[1]) : edge(v[1], v[2]));
                if (e.owner != t) continue;
                area = e.area / (n - 1);
            }
            add(t, b1, b2, placeOf(t, b1, b2), r, area, true);
        }
}

void Grid::addMiddles(uint32_t t) {
    const Triangle& x = triangles_[t];
    const int n = x.n;
    const auto middle = [&](double i, double j) {
        add(t, i / n, j / n, placeOf(t, i / n, j / n), float(x.longest / (2 * n)), x.area / (double(n) * n), false);
    };
    for (int j = 0; j < n; ++j)
        for (int i = 0; i + j < n; ++i) {
            middle(i + 1 / 3., j + 1 / 3.);
            if (i + j < n - 1) middle(i + 2 / 3., j + 2 / 3.);
        }
}

void Grid::ofTriangles() {
    stepsOfTriangles();
    std::vector<Corner> corners(base_.mesh().vertices);
    Edges edges;
    for (uint32_t t = 0; t < triangles_.size(); ++t) {
        const Triangle& x = triangles_[t];
        const double part = x.area / (double(x.n) * x.n);
        for (int k = 0; k < 3; ++k) {
            Corner& c = corners[indices(t)[k]];
            c.area += float(part / 3);
            c.radius = std::max(c.radius, float(x.longest / (2 * x.n)));
            if (x.n < 2) continue;
            const auto [e, fresh] = edges.try_emplace(edge(indices(t)[k], indices(t)[(k + 1) % 3]), Edge{t});
            e->second.area += part * (x.n - 1);
        }
    }
    std::vector<bool> seen(base_.mesh().vertices);
    for (uint32_t t = 0; t < triangles_.size(); ++t) addCorners(t, edges, corners, seen);
    for (uint32_t t = 0; middles_ && t < triangles_.size(); ++t) addMiddles(t);
}

} // namespace

bool hasGrid(const Shape& s) { return !baseOf(s)->exact() || isQuadric(*baseOf(s)); }

void gridOf(const Shape& s, const geometry::DiceCamera& camera, bool middles, std::vector<GridPoint>& points,
            std::vector<Vec3>& P) {
    if (!hasGrid(s)) return;
    Grid grid(s, camera, middles, points, P);
    if (baseOf(s)->exact()) grid.ofQuadric();
    else grid.ofTriangles();
}

} // namespace alpenglow::shading
