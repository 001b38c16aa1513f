// Facets of displaced polygons. Each edge of a triangle is cut by its data and the camera (edge_curve.h), so neighbours in this
// mesh and others have the same points there; triangles whose edges have too many parts are first cut into smaller ones.
#include "base/limits.h"
#include "geometry/edge_corners.h"
#include "geometry/edge_curve.h"
#include "geometry/picture_sides.h"
#include "geometry/piece_grid.h"
#include "geometry/polygon_mesh.h"
#include "geometry/seams.h"
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>

namespace alpenglow::geometry {

namespace {
constexpr int kDeepest = 20; ///< recursion depth: if the eye is on a face, near parts would look large at any size
}

struct PolygonMesh::Dicing {
    const PolygonMesh& s;
    const DiceOptions& opt;
    const DiceCamera camera;
    Unseen unseen;
    std::vector<const PolygonMesh*> keys; ///< this, or all keys
    std::vector<uint8_t> open;            ///< by side of a triangle: no other triangle of the mesh has it
    double coarse = 1;                    ///< of sides that are not open
    std::map<std::array<int, 3>, PieceGrid> grids;
    TriMesh mesh;
    std::vector<Vec2> param;
    std::vector<uint32_t> prim;
    std::vector<float> step;  ///< size of a facet, as a part of the triangle
    std::vector<uint8_t> rim; ///< on an open side
    double facets = 0, most;  ///< when they are only counted: no further than to `most`

    /// A side of a part of a triangle: a piece of an edge, `from` at its first corner.
    struct Side {
        const EdgeCuts* cuts;
        const EdgeCurve* own; ///< of this mesh
        double from, to;
        bool open;
        double middle() const { return 0.5 * (from + to); }
    };
    struct Part {
        uint32_t tri;
        struct Corner {
            Vec2 b;  ///< b1, b2
            Vec3d P; ///< shared by all parts that join there
        } corner[3];
        Side side[3]; ///< from corner k to the next
        int depth = 0;
    };

    Dicing(const PolygonMesh&, const DiceOptions&);
    void findOpen();
    /// A triangle, or a part of one, with corners of others on its sides: it is cut there first.
    struct Met {
        Part::Corner corner[3];
        std::vector<Part::Corner> on[3];
        bool open[3];
    };
    void cut(uint32_t tri, bool count);
    void cutMet(uint32_t tri, const Met&, bool count);
    void cut(const Part&, bool count);
    void cutInside(const Part&, const bool split[3], bool count);
    void leaf(const Part&, const int rates[3], bool count);
    Vec3d at(const PolygonMesh& m, uint32_t tri, const Vec2& b) const {
        const Vec3d a = m.cameraCorner(tri, 0);
        return a * (1 - double(b.x) - double(b.y)) + m.cameraCorner(tri, 1) * double(b.x) + m.cameraCorner(tri, 2) * double(b.y);
    }
    EdgeCuts cutsOf(std::span<const EdgeCurve> curves, bool isOpen) const {
        const double edge = diceEdge(s.attributes());
        EdgeCuts c(curves, camera, edge, edge, true);
        if (!isOpen) c.coarsen(coarse);
        return c;
    }
};

PolygonMesh::Dicing::Dicing(const PolygonMesh& shape, const DiceOptions& o)
    : s(shape), opt(o), camera(diceCamera(o, shape.attributes(), true)), unseen(shape, o),
      most(std::max(2.0 * double(limits::kDiceQuads), 2.0 * shape.triangles_)) {
    for (const ShapeRef& key : opt.keys)
        if (const auto* k = dynamic_cast<const PolygonMesh*>(key.get()); k && k->triangles_ == s.triangles_) keys.push_back(k);
    if (keys.empty()) keys.push_back(&s);
}

/// By positions of their ends, as faces may have separate points.
void PolygonMesh::Dicing::findOpen() {
    using Place = std::tuple<float, float, float>;
    const auto place = [&](uint32_t tri, int k) {
        const Vec3 p = keys[0]->base().P[keys[0]->vertexOf(tri, k)] + Vec3(0.f);
        return Place(p.x, p.y, p.z);
    };
    std::vector<uint32_t> order(3 * size_t(s.triangles_));
    std::iota(order.begin(), order.end(), 0u);
    const auto key = [&](uint32_t side) {
        const Place a = place(side / 3, int(side % 3)), b = place(side / 3, int(side % 3 + 1) % 3);
        return std::pair(std::min(a, b), std::max(a, b));
    };
    std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return key(a) < key(b); });
    open.assign(order.size(), 0);
    for (size_t i = 0, j; i < order.size(); i = j) {
        for (j = i + 1; j < order.size() && key(order[j]) == key(order[i]);) ++j;
        if (j == i + 1) open[order[i]] = 1;
    }
}

void PolygonMesh::Dicing::cut(uint32_t tri, bool count) {
    std::vector<EdgeCurve> curves[3];
    std::vector<EdgeCuts> cuts;
    EdgeCurve own[3];
    Part p{tri, {{{0, 0}, s.cameraCorner(tri, 0)}, {{1, 0}, s.cameraCorner(tri, 1)}, {{0, 1}, s.cameraCorner(tri, 2)}}, {}};
    if (opt.corners && keys.size() == 1) {
        Met m{{p.corner[0], p.corner[1], p.corner[2]}, {}, {}};
        bool any = false;
        for (int k = 0; k < 3; ++k) {
            m.open[k] = open[3 * size_t(tri) + size_t(k)] != 0;
            if (!m.open[k]) continue;
            const Part::Corner &a = p.corner[k], &b = p.corner[(k + 1) % 3];
            for (const EdgeCorners::On& on : opt.corners->within(opt.seamWith, a.P, b.P)) {
                const float t = float(on.t);
                m.on[k].push_back({{a.b.x + (b.b.x - a.b.x) * t, a.b.y + (b.b.y - a.b.y) * t}, Vec3d(on.P)});
            }
            any |= !m.on[k].empty();
        }
        if (any) return cutMet(tri, m, count);
    }
    for (int k = 0; k < 3; ++k) {
        for (const PolygonMesh* m : keys)
            curves[k].push_back(EdgeCurve::line(m->cameraCorner(tri, k), m->cameraCorner(tri, (k + 1) % 3)));
        own[k] = EdgeCurve::line(s.cameraCorner(tri, k), s.cameraCorner(tri, (k + 1) % 3));
        cuts.push_back(cutsOf(curves[k], open[3 * size_t(tri) + size_t(k)] != 0));
    }
    for (int k = 0; k < 3; ++k) p.side[k] = {&cuts[size_t(k)], &own[k], 0, 1, open[3 * size_t(tri) + size_t(k)] != 0};
    cut(p, count);
}

/// Connects the middle one of the corners on a side with the corner across. Sides are then edges from corner to corner, as in
/// other meshes.
void PolygonMesh::Dicing::cutMet(uint32_t tri, const Met& m, bool count) {
    int k = 0;
    while (k < 3 && m.on[k].empty()) ++k;
    if (k == 3) {
        EdgeCurve own[3];
        std::vector<EdgeCuts> cuts;
        cuts.reserve(3);
        Part p{tri, {m.corner[0], m.corner[1], m.corner[2]}, {}};
        for (int i = 0; i < 3; ++i) {
            own[i] = EdgeCurve::line(m.corner[i].P, m.corner[(i + 1) % 3].P);
            cuts.push_back(cutsOf({&own[i], 1}, m.open[i]));
            p.side[i] = {&cuts.back(), &own[i], 0, 1, m.open[i]};
        }
        return cut(p, count);
    }
    const int next = (k + 1) % 3, last = (k + 2) % 3;
    const std::vector<Part::Corner>& on = m.on[k];
    const auto middle = on.begin() + std::ptrdiff_t(on.size() / 2);
    cutMet(tri,
           {{m.corner[k], *middle, m.corner[last]}, {{on.begin(), middle}, {}, m.on[last]}, {m.open[k], false, m.open[last]}},
           count);
    cutMet(
        tri,
        {{*middle, m.corner[next], m.corner[last]}, {{middle + 1, on.end()}, m.on[next], {}}, {m.open[k], m.open[next], false}},
        count);
}

void PolygonMesh::borderCorners(std::vector<Vec3>& out) const {
    const DiceOptions none;
    Dicing d(*this, none);
    d.findOpen();
    for (uint32_t side = 0; side < d.open.size(); ++side)
        if (d.open[side])
            for (const uint32_t k : {side % 3, (side + 1) % 3}) out.push_back(base().P[vertexOf(side / 3, int(k))]);
}

void PolygonMesh::Dicing::cut(const Part& p, bool count) {
    int rates[3];
    bool split[3], any = false;
    if (count && facets > most) return;
    if (!count && !unseen.none()) {
        Bounds b;
        for (const Part::Corner& c : p.corner) b.add(Vec3(c.P));
        if (unseen(b)) return;
    }
    for (int k = 0; k < 3; ++k) {
        rates[k] = p.side[k].cuts->segments(p.side[k].from, p.side[k].to);
        any |= split[k] = rates[k] == 0;
    }
    if (!any) leaf(p, rates, count);
    else cutInside(p, split, count);
}

/// Cuts sides with too many parts in the middle: one, two or three of them.
void PolygonMesh::Dicing::cutInside(const Part& p, const bool split[3], bool count) {
    const int sides = split[0] + split[1] + split[2];
    // So turned that with one or two cut sides side 0 is the one that is cut, or with two the one that is not.
    int turn = 0;
    while (turn < 2 && split[turn] != (sides != 2)) ++turn;
    const auto corner = [&](int k) { return p.corner[(k + turn) % 3]; };
    const auto side = [&](int k) { return p.side[(k + turn) % 3]; };
    const auto mid = [&](int k) {
        const Vec2 a = corner(k).b, b = corner(k + 1).b;
        return Part::Corner{{0.5f * (a.x + b.x), 0.5f * (a.y + b.y)}, Vec3d(Vec3(side(k).own->at(side(k).middle())))};
    };
    const auto half = [&](int k, int which) {
        Side h = side(k);
        (which ? h.from : h.to) = side(k).middle();
        return h;
    };
    // New sides within the triangle: up to three, each used in both directions.
    std::vector<EdgeCurve> curves[3];
    EdgeCurve own[3];
    std::vector<EdgeCuts> cuts;
    cuts.reserve(3);
    const auto inner = [&](int n, const Part::Corner& a, const Part::Corner& b) {
        for (const PolygonMesh* m : keys) curves[n].push_back(EdgeCurve::line(at(*m, p.tri, a.b), at(*m, p.tri, b.b)));
        own[n] = EdgeCurve::line(a.P, b.P);
        cuts.push_back(cutsOf(curves[n], false));
        while (p.depth >= kDeepest && cuts.back().segments(0, 1) == 0) cuts.back().coarsen(2);
        return Side{&cuts.back(), &own[n], 0, 1, false};
    };
    const auto back = [](Side k) { return std::swap(k.from, k.to), k; };
    const auto part = [&](const Part::Corner& a, const Part::Corner& b, const Part::Corner& c, const Side& ab, const Side& bc,
                          const Side& ca) { cut(Part{p.tri, {a, b, c}, {ab, bc, ca}, p.depth + 1}, count); };
    if (sides == 1) {
        const Part::Corner m = mid(0);
        const Side across = inner(0, m, corner(2));
        part(corner(0), m, corner(2), half(0, 0), across, side(2));
        part(m, corner(1), corner(2), half(0, 1), side(1), back(across));
    } else if (sides == 2) { // sides 1 and 2
        const Part::Corner m1 = mid(1), m2 = mid(2);
        const Side tip = inner(0, m1, m2), slant = inner(1, corner(0), m1);
        part(m1, corner(2), m2, half(1, 1), half(2, 0), back(tip));
        part(corner(0), corner(1), m1, side(0), half(1, 0), back(slant));
        part(corner(0), m1, m2, slant, tip, half(2, 1));
    } else {
        const Part::Corner m0 = mid(0), m1 = mid(1), m2 = mid(2);
        const Side a = inner(0, m0, m2), b = inner(1, m1, m0), c = inner(2, m2, m1);
        part(corner(0), m0, m2, half(0, 0), a, half(2, 1));
        part(m0, corner(1), m1, half(0, 1), half(1, 0), b);
        part(m2, m1, corner(2), c, half(1, 1), half(2, 0));
        part(m0, m1, m2, back(b), back(c), back(a));
    }
}

void PolygonMesh::Dicing::leaf(const Part& p, const int rates[3], bool count) {
    const auto [at3, isNew] = grids.try_emplace({rates[0], rates[1], rates[2]});
    if (isNew) at3->second = PieceGrid::make(rates, 3);
    const PieceGrid& g = at3->second;
    if (count) {
        facets += double(g.facet.size()) / 3;
        return;
    }
    const uint32_t base = uint32_t(mesh.P.size());
    const Vec2 o = p.corner[0].b, to1 = p.corner[1].b, to2 = p.corner[2].b, e1{to1.x - o.x, to1.y - o.y},
               e2{to2.x - o.x, to2.y - o.y};
    const float size = std::sqrt(std::fabs(e1.x * e2.y - e1.y * e2.x)) / float(std::max({rates[0], rates[1], rates[2]}));
    int k = 0, i = 0;
    for (size_t n = 0; n < g.param.size(); ++n) {
        const Vec2& x = g.param[n];
        const Vec2 b{o.x + e1.x * x.x + e2.x * x.y, o.y + e1.y * x.x + e2.y * x.y};
        const bool onSide = int(n) < g.border;
        param.push_back(b);
        prim.push_back(p.tri);
        step.push_back(size);
        rim.push_back(onSide && (p.side[k].open || (i == 0 && p.side[(k + 2) % 3].open)));
        mesh.P.push_back(onSide && i == 0 ? Vec3(p.corner[k].P)
                         : onSide ? Vec3(p.side[k].own->at(p.side[k].from + (p.side[k].to - p.side[k].from) * i / rates[k]))
                                  : Vec3(at(s, p.tri, b)));
        if (onSide && ++i == rates[k]) ++k, i = 0;
    }
    for (uint32_t f : g.facet) mesh.made.push_back(base + f);
}

namespace {

/// Points that coincided before displacement are joined again: at the mean of the positions by their faces, whose normals and
/// variables may differ. If one of them is on the border, all are.
void closeCracks(const std::vector<Vec3>& flat, std::vector<Vec3>& moved, std::vector<uint8_t>& rim) {
    std::vector<uint32_t> order(flat.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto key = [&](uint32_t i) { return std::tie(flat[i].x, flat[i].y, flat[i].z); };
    std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return key(a) != key(b) ? key(a) < key(b) : a < b; });
    for (size_t i = 0, j; i < order.size(); i = j) {
        Vec3d sum(moved[order[i]]);
        bool same = true, border = rim[order[i]] != 0;
        for (j = i + 1; j < order.size() && key(order[j]) == key(order[i]); ++j) {
            sum = sum + Vec3d(moved[order[j]]);
            same &= moved[order[j]] == moved[order[i]];
            border |= rim[order[j]] != 0;
        }
        const Vec3 middle(sum / double(j - i));
        for (size_t k = i; k < j; ++k) {
            if (!same) moved[order[k]] = middle;
            rim[order[k]] = border;
        }
    }
}

} // namespace

/// Cuts and displaces the visible parts. flat: undisplaced positions. Returns false if displacement exceeded its bound.
bool PolygonMesh::displaceSeen(Dicing& d, std::vector<Vec3>& flat, Diagnostics& diag) {
    d.mesh = TriMesh();
    d.param.clear(), d.prim.clear(), d.step.clear(), d.rim.clear();
    for (uint32_t t = 0; t < triangles_; ++t) d.cut(t, false);
    meshParam_ = d.param;
    meshPrim_ = d.prim;
    flat = d.mesh.P;
    return displaceMesh(
        *this, d.opt, diag, [&](uint32_t i) { return evaluateLocal(meshPrim_[i], meshParam_[i].x, meshParam_[i].y); },
        [&](uint32_t i) {
            // A barycentric step turned to u and v: the extent of one facet.
            const uint32_t t = meshPrim_[i];
            const Frame f = frame(faceNormal(t));
            const Vec3d a = objectPoint(vertexOf(t, 0)), e1 = objectPoint(vertexOf(t, 1)) - a,
                        e2 = objectPoint(vertexOf(t, 2)) - a;
            const auto extent = [&](const Vec3d& x) {
                return float(std::max({std::fabs(dot(e1, x)), std::fabs(dot(e2, x)), 1e-12}));
            };
            return Vec2{extent(f.a) * d.step[i], extent(f.b) * d.step[i]};
        },
        d.mesh);
}

void PolygonMesh::dice(const DiceOptions& opt, Diagnostics& diag) {
    if (!isDisplaced(*this, opt)) return;
    Dicing d(*this, opt);
    d.findOpen();
    const auto total = [&] {
        d.facets = 0;
        for (uint32_t t = 0; t < triangles_ && d.facets <= d.most; ++t) d.cut(t, true);
        return d.facets;
    };
    while (total() > d.most && d.coarse < 1e9) d.coarse *= 2;
    if (d.coarse > 1)
        diag.report(Severity::Info, Rie::Limit, place(),
                    kind() + " would need more than " + std::to_string(limits::kDiceQuads) +
                        " micropolygons; it is diced more coarsely");
    undiced_ = std::move(mesh_); // mesh_.vertices stays: the shape is none of exact hits
    displaced_ = true;
    Diagnostics reported;
    std::vector<Vec3> flat;
    if (!displaceSeen(d, flat, reported) && !d.unseen.none()) { // exceeds the declared bound: omitted parts may be visible
        d.unseen.lookAnywhere();
        displaceSeen(d, flat, diag);
    } else {
        for (const Diagnostic& k : reported.all()) diag.report(k);
    }
    if (d.mesh.P.empty()) {
        Bounds all;
        for (const Vec3& p : undiced_.P) all.add(p);
        return leaveOut(all);
    }
    closeCracks(flat, d.mesh.P, d.rim);
    d.mesh.finish();
    mesh_ = std::move(d.mesh);
    std::vector<uint32_t> border;
    for (uint32_t i = 0; i < d.rim.size(); ++i)
        if (d.rim[i]) flat[border.size()] = flat[i], border.push_back(i);
    flat.resize(border.size());
    closeSeams(opt, mesh_, std::move(border), std::move(flat));
}

} // namespace alpenglow::geometry
