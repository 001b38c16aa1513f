// Facets of subdivision surfaces. Every edge of the cage has one rate and its points are made once, so neighbours join bit by
// bit, displaced or not. So do separate meshes, whose borders are cut by their own data (cage_border.h).
#include "base/limits.h"
#include "base/parallel.h"
#include "geometry/cage_border.h"
#include "geometry/dice.h"
#include "geometry/picture_sides.h"
#include "geometry/piece_grid.h"
#include "geometry/subdivision.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

namespace alpenglow::geometry {

struct Subdivision::Dicing {
    const Subdivision& s;
    const LimitSurface& limit;
    const DiceOptions& opt;
    bool displaced;
    DiceCamera camera;
    Unseen unseen;

    /// A point of the mesh, shared by adjacent pieces: where it is evaluated.
    struct Point {
        uint32_t piece;
        float u, v;
    };
    std::vector<uint8_t> away;              ///< per piece: no ray reaches it
    std::vector<std::array<float, 2>> need; ///< per piece: segments along u and v, before rounding up
    /// Per edge of the cage; per piece of split faces: from the edge's midpoint to the face's centre
    std::vector<int> edgeRate, spokeRate;
    std::vector<uint8_t> even; ///< per edge: it borders a split face, so its midpoint is a point
    std::vector<Point> points;
    std::vector<uint32_t> cornerPoint, edgePoint, middlePoint, spokePoint; ///< first of its points; kNone: none yet
    struct Rim {
        CageBorder border;
        std::vector<EdgeCurve> curve; ///< of its edges
        std::vector<int> rate;
    };
    std::optional<Rim> rim;

    void cutBorder();
    void placeBorder(std::vector<Vec3>& P) const;
    std::vector<uint8_t> onBorder() const;
    void measure(const Subdivision& at, uint32_t piece);
    void rates(double scale);
    double quads() const;
    double mostQuads() const;
    void sharedPoints();
    void pieceRates(uint32_t piece, int out[4]) const;
    void border(uint32_t piece, std::vector<uint32_t>& out) const;
    void along(uint32_t first, int from, int to, bool back, std::vector<uint32_t>& out) const;
    bool split(uint32_t face) const { return limit.piecesOf(face) > 1; }
    size_t edge(uint32_t face, uint32_t corner) const { return size_t(limit.edgeAt(face, int(corner))); }
};

/// Segments of a piece along u and v: as for surfaces over one square (parametric.cpp).
void Subdivision::Dicing::measure(const Subdivision& of, uint32_t piece) {
    if (!limit.drawn(limit.pieceOf(piece).face)) return;
    constexpr double kDeviation = 0.05; // pixels that facets may stray from the surface
    const double edge = diceEdge(s.attributes()), flat = diceFlatness(s.attributes()), tol = flat > 0 ? flat : kDeviation * edge;
    const bool three = limit.triangles();
    double lu = 0, lv = 0;
    std::vector<LocalPoint> probed;
    const auto probe = [&](double u, double v) {
        const LocalPoint p = of.cameraPoint(piece, u, v, displaced ? 1 : 2);
        if (!unseen.none()) probed.push_back(p);
        double a = camera.pixels(p.P, p.Pu) / edge, b = camera.pixels(p.P, p.Pv) / edge;
        if (three) a = b = std::max({a, b, camera.pixels(p.P, p.Pu - p.Pv) / edge});
        if (!displaced) {
            double cu = std::sqrt(camera.pixels(p.P, p.Puu) / (8 * tol)), cv = std::sqrt(camera.pixels(p.P, p.Pvv) / (8 * tol));
            const double twist = std::sqrt(camera.pixels(p.P, p.Puv) / (4 * tol));
            if (three) cu = cv = std::max({cu, cv, std::sqrt(camera.pixels(p.P, p.Puu - p.Puv * 2 + p.Pvv) / (8 * tol))});
            cu = 1.5 * std::max(cu, twist); // 1.5: the probes miss the peak
            cv = 1.5 * std::max(cv, twist);
            a = flat > 0 ? cu : std::min(a, cu);
            b = flat > 0 ? cv : std::min(b, cv);
        }
        lu = std::max(lu, a);
        lv = std::max(lv, b);
    };
    if (three) {
        probe(1 / 3.0, 1 / 3.0);
        if (lu > 1)
            for (const auto& q : {std::array{0.1, 0.1}, {0.8, 0.1}, {0.1, 0.8}, {0.45, 0.1}, {0.1, 0.45}, {0.45, 0.45}})
                probe(q[0], q[1]);
    } else {
        probe(0.5, 0.5);
        if (std::max(lu, lv) > 1)
            for (double v : {0.1, 0.5, 0.9})
                for (double u : {0.1, 0.5, 0.9})
                    if (u != 0.5 || v != 0.5) probe(u, v);
    }
    constexpr double kMost = 1e9; // rates() reduces it to one by the smallest scale
    need[piece] = {std::max(need[piece][0], float(std::min(lu, kMost))), std::max(need[piece][1], float(std::min(lv, kMost)))};
    if (unseen.none()) return;
    ProbedBox box;
    // Extent that a probe represents
    const double part = three ? (probed.size() > 1 ? 0.35 : 0.7) : probed.size() > 1 ? 0.2 : 0.5;
    for (const LocalPoint& p : probed) box.add(p.P, p.Pu * part, p.Pv * part);
    away[piece] = unseen(box.box());
}

void Subdivision::Dicing::rates(double scale) {
    const auto whole = [&](double n) { return int(std::clamp(std::ceil(n * scale), 1.0, double(limits::kDiceEdge))); };
    edgeRate.assign(limit.edges(), 1);
    even.assign(limit.edges(), 0);
    if (limit.pieces() != limit.faces()) spokeRate.assign(limit.pieces(), 1);
    for (uint32_t f = 0; f < limit.faces(); ++f) {
        if (!limit.drawn(f)) continue;
        const uint32_t first = limit.firstPiece(f), n = uint32_t(limit.corners(f));
        const auto raise = [&](uint32_t k, int rate) {
            int& r = edgeRate[edge(f, k % n)];
            r = std::max(r, rate);
        };
        if (!split(f)) {
            for (uint32_t k = 0; k < n; ++k) raise(k, whole(need[first][k & 1]));
            continue;
        }
        for (uint32_t k = 0; k < n; ++k) {
            const auto& a = need[first + k];
            const auto& b = need[first + (k + 1) % n];
            raise(k, std::min(limits::kDiceEdge, 2 * whole(std::max(a[0], b[1]))));
            spokeRate[first + k] = whole(std::max(a[1], b[0]));
            even[edge(f, k)] = 1;
        }
    }
    for (size_t i = 0; rim && i < rim->rate.size(); ++i) edgeRate[size_t(rim->border.edges()[i])] = rim->rate[i];
    for (size_t e = 0; e < edgeRate.size(); ++e)
        if (even[e]) edgeRate[e] += edgeRate[e] & 1;
}

/// Cuts border edges by their data at all times: surfaces with the same edge cut it alike.
void Subdivision::Dicing::cutBorder() {
    std::vector<const Subdivision*> keys;
    for (const ShapeRef& key : opt.keys)
        if (const auto* k = dynamic_cast<const Subdivision*>(key.get()); k && k->limit_->pieces() == limit.pieces())
            keys.push_back(k);
    if (keys.empty()) keys.push_back(&s);
    rim.emplace(CageBorder(s.input_.cage, limit), std::vector<EdgeCurve>(), std::vector<int>());
    const double edge = diceEdge(s.attributes()), flat = diceFlatness(s.attributes()), tolerance = flat > 0 ? flat : 0.05 * edge;
    const double micro = !displaced && flat > 0 ? 1e-9 : edge; // curvature decides alone
    for (size_t i = 0; i < rim->border.edges().size(); ++i) {
        std::vector<EdgeCurve> curves;
        for (const Subdivision* k : keys) curves.push_back(rim->border.curve(i, [k](int v) { return k->controlPoint(v); }));
        // In equal parts, as small as the smallest.
        const std::vector<double> places = EdgeCuts(curves, camera, micro, tolerance, displaced).places();
        double least = 1;
        for (size_t n = 1; n < places.size(); ++n) least = std::min(least, places[n] - places[n - 1]);
        rim->rate.push_back(int(std::min(1 / least, double(limits::kDiceEdge))));
        rim->curve.push_back(rim->border.curve(i, [this](int v) { return s.controlPoint(v); }));
    }
}

void Subdivision::Dicing::placeBorder(std::vector<Vec3>& P) const {
    for (size_t i = 0; i < rim->border.edges().size(); ++i) {
        const size_t e = size_t(rim->border.edges()[i]);
        if (edgePoint[e] == kNone) continue;
        const EdgeCurve& curve = rim->curve[i];
        const int rate = edgeRate[e];
        for (int k = 1; k < rate; ++k) P[edgePoint[e] + uint32_t(k) - 1] = Vec3(curve.at(double(k) / rate));
        const auto [first, last] = rim->border.ends(i);
        P[cornerPoint[size_t(first)]] = Vec3(curve.at(0));
        P[cornerPoint[size_t(last)]] = Vec3(curve.at(1));
    }
}

/// By point: whether it is on such an edge.
std::vector<uint8_t> Subdivision::Dicing::onBorder() const {
    std::vector<uint8_t> on(points.size(), 0);
    for (size_t i = 0; i < rim->border.edges().size(); ++i) {
        const size_t e = size_t(rim->border.edges()[i]);
        if (edgePoint[e] == kNone) continue;
        for (int k = 1; k < edgeRate[e]; ++k) on[edgePoint[e] + uint32_t(k) - 1] = 1;
        const auto [first, last] = rim->border.ends(i);
        on[cornerPoint[size_t(first)]] = on[cornerPoint[size_t(last)]] = 1;
    }
    return on;
}

/// Segments of the edges of a piece, by winding.
void Subdivision::Dicing::pieceRates(uint32_t piece, int out[4]) const {
    const LimitSurface::PieceOf at = limit.pieceOf(piece);
    const int n = limit.corners(at.face), k = at.corner;
    if (!split(at.face)) {
        for (int i = 0; i < n; ++i) out[i] = edgeRate[edge(at.face, uint32_t(i))];
        return;
    }
    const int before = (k + n - 1) % n;
    const uint32_t first = limit.firstPiece(at.face);
    out[0] = edgeRate[edge(at.face, uint32_t(k))] / 2;
    out[1] = spokeRate[piece];
    out[2] = spokeRate[first + uint32_t(before)];
    out[3] = edgeRate[edge(at.face, uint32_t(before))] / 2;
}

double Subdivision::Dicing::quads() const {
    double sum = 0;
    for (uint32_t k = 0; k < limit.pieces(); ++k) {
        if (!limit.drawn(limit.pieceOf(k).face)) continue;
        int r[4] = {1, 1, 1, 1};
        pieceRates(k, r);
        sum += limit.triangles() ? 0.5 * std::max({r[0], r[1], r[2]}) * std::max({r[0], r[1], r[2]})
                                 : double(std::max(r[0], r[2])) * std::max(r[1], r[3]);
    }
    return sum;
}

/// Undisplaced surfaces are smooth: if pieces need more than 64 x 64 on average, some extend far beyond the picture.
double Subdivision::Dicing::mostQuads() const {
    const double most = double(limits::kDiceQuads), smooth = 64 * 64 * double(limit.pieces());
    return std::max(displaced ? most : std::clamp(smooth, most / 16, most), 2.0 * limit.pieces());
}

/// Points at vertices, on edges, at centres of split faces and on the lines that split them.
void Subdivision::Dicing::sharedPoints() {
    cornerPoint.assign(size_t(s.input_.cage.vertices), kNone);
    edgePoint.assign(limit.edges(), kNone);
    if (!spokeRate.empty()) middlePoint.assign(limit.faces(), kNone), spokePoint.assign(limit.pieces(), kNone);
    static constexpr float corner4[5][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}},
                           corner3[4][2] = {{0, 0}, {1, 0}, {0, 1}, {0, 0}};
    for (uint32_t f = 0; f < limit.faces(); ++f) {
        if (!limit.drawn(f)) continue;
        const uint32_t first = limit.firstPiece(f), n = uint32_t(limit.corners(f));
        const bool parts = split(f);
        for (uint32_t k = 0; k < n; ++k) {
            const float* c = n == 3 && !parts ? corner3[k] : corner4[parts ? 0 : k];
            const float* d = n == 3 && !parts ? corner3[k + 1] : corner4[parts ? 1 : k + 1];
            const int vertex = limit.vertexAt(f, int(k));
            uint32_t& at = cornerPoint[size_t(vertex)];
            if (at == kNone) at = uint32_t(points.size()), points.push_back({parts ? first + k : first, c[0], c[1]});
            uint32_t& line = edgePoint[edge(f, k)];
            if (line != kNone) continue;
            // From the vertex that the edge calls its first, as every face will look at them.
            line = uint32_t(points.size());
            const int rate = edgeRate[edge(f, k)];
            const bool forward = limit.edgeStart(int(edge(f, k))) == vertex;
            for (int i = 1; i < rate; ++i) {
                const float t = float(forward ? i : rate - i) / float(rate);
                if (!parts) points.push_back({first, c[0] + (d[0] - c[0]) * t, c[1] + (d[1] - c[1]) * t});
                else if (2 * t <= 1) points.push_back({first + k, 2 * t, 0});
                else points.push_back({first + (k + 1) % n, 0, 2 - 2 * t});
            }
        }
        if (!parts) continue;
        middlePoint[f] = uint32_t(points.size());
        points.push_back({first, 1, 1});
        for (uint32_t k = 0; k < n; ++k) { // from the midpoint of the edge to the centre of the face
            spokePoint[first + k] = uint32_t(points.size());
            const int rate = spokeRate[first + k];
            for (int i = 1; i < rate; ++i) points.push_back({first + k, 1, float(i) / float(rate)});
        }
    }
}

/// Points from..to of a line, without its ends; `back` from the far one.
void Subdivision::Dicing::along(uint32_t first, int from, int to, bool back, std::vector<uint32_t>& out) const {
    const int n = to - from - 1;
    for (int i = 0; i < n; ++i) out.push_back(first + uint32_t(from + (back ? n - 1 - i : i)));
}

/// The points of a piece's border, as PieceGrid orders them.
void Subdivision::Dicing::border(uint32_t piece, std::vector<uint32_t>& out) const {
    out.clear();
    const LimitSurface::PieceOf at = limit.pieceOf(piece);
    const size_t n = size_t(limit.corners(at.face));
    const auto vertex = [&](size_t k) { return limit.vertexAt(at.face, int(k)); };
    const auto turned = [&](size_t k) { return limit.edgeStart(int(edge(at.face, uint32_t(k)))) != vertex(k); };
    const auto rate = [&](size_t k) { return edgeRate[edge(at.face, uint32_t(k))]; };
    const auto line = [&](size_t k) { return edgePoint[edge(at.face, uint32_t(k))]; };
    if (!split(at.face)) {
        for (size_t k = 0; k < n; ++k) {
            out.push_back(cornerPoint[size_t(vertex(k))]);
            along(line(k), 0, rate(k), turned(k), out);
        }
        return;
    }
    const size_t k = size_t(at.corner), before = (k + n - 1) % n;
    const uint32_t first = limit.firstPiece(at.face);
    const auto half = [&](size_t edge) { return rate(edge) / 2; };
    out.push_back(cornerPoint[size_t(vertex(k))]);
    along(line(k), turned(k) ? half(k) : 0, turned(k) ? rate(k) : half(k), turned(k), out); // to its midpoint
    out.push_back(line(k) + uint32_t(half(k)) - 1);
    along(spokePoint[first + k], 0, spokeRate[first + k], false, out);
    out.push_back(middlePoint[at.face]);
    along(spokePoint[first + before], 0, spokeRate[first + before], true, out);
    out.push_back(line(before) + uint32_t(half(before)) - 1);
    const bool back = turned(before);
    along(line(before), back ? 0 : half(before), back ? half(before) : rate(before), back, out); // on to the corner
}

void Subdivision::dice(const DiceOptions& opt, Diagnostics& diag) {
    displaced_ = isDisplaced(*this, opt);
    Unseen unseen(*this, opt);
    Diagnostics reported;
    if (!diceSeen(opt, unseen, reported) && !unseen.none()) { // exceeds the declared bound: omitted parts may be visible
        unseen.lookAnywhere();
        diceSeen(opt, unseen, diag);
    } else {
        for (const Diagnostic& d : reported.all()) diag.report(d);
    }
    limit_->forgetTopology();
}

/// Omits unreachable parts. Returns false if displacement exceeded its bound.
bool Subdivision::diceSeen(const DiceOptions& opt, const Unseen& unseen, Diagnostics& diag) {
    const DiceCamera camera = diceCamera(opt, attributes(), displaced_);
    Dicing d{*this, *limit_, opt, displaced_, camera, unseen, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}};
    d.need.resize(limit_->pieces());
    d.away.assign(limit_->pieces(), 0);
    parallelFor(uint32_t(0), limit_->pieces(), [&](uint32_t k) {
        d.need[k] = {1, 1};
        d.measure(*this, k);
        for (const ShapeRef& key : opt.keys) // finely enough for every time of a moving one
            if (const auto* other = dynamic_cast<const Subdivision*>(key.get());
                other && other != this && other->limit_->pieces() == limit_->pieces())
                d.measure(*other, k);
    });
    d.cutBorder();
    double scale = 1;
    d.rates(scale);
    const double most = d.mostQuads();
    while (d.quads() > most && scale > 1e-9) d.rates(scale *= 0.7);
    if (scale < 1)
        diag.report(Severity::Info, Rie::Limit, place(),
                    kind() + " would need more than " + std::to_string(size_t(most)) +
                        " micropolygons; it is diced more coarsely");
    d.sharedPoints();
    // The same rates recur.
    std::map<std::array<int, 4>, PieceGrid> grids;
    std::vector<const PieceGrid*> gridOf(limit_->pieces(), nullptr);
    std::vector<uint32_t> insideOf(limit_->pieces(), 0);
    for (uint32_t k = 0; k < limit_->pieces(); ++k) {
        if (!limit_->drawn(limit_->pieceOf(k).face) || d.away[k]) continue;
        std::array<int, 4> r{};
        d.pieceRates(k, r.data());
        auto [at, isNew] = grids.try_emplace(r);
        if (isNew) at->second = PieceGrid::make(r.data(), limit_->triangles() ? 3 : 4);
        const PieceGrid& g = *(gridOf[k] = &at->second);
        insideOf[k] = uint32_t(d.points.size());
        for (size_t i = size_t(g.border); i < g.param.size(); ++i) d.points.push_back({k, g.param[i].x, g.param[i].y});
    }
    TriMesh shared;
    shared.P.resize(d.points.size());
    parallelFor(size_t(0), d.points.size(), [&](size_t i) {
        const Dicing::Point& p = d.points[i];
        shared.P[i] = Vec3(cameraPosition(p.piece, p.u, p.v));
    });
    d.placeBorder(shared.P);
    const std::vector<Vec3> flat = displaced_ ? shared.P : std::vector<Vec3>();
    if (displaced_) {
        const bool within = displaceMesh(
            *this, opt, diag, [&](uint32_t i) { return evaluateLocal(d.points[i].piece, d.points[i].u, d.points[i].v); },
            [&](uint32_t i) {
                int r[4] = {1, 1, 1, 1};
                d.pieceRates(d.points[i].piece, r);
                return Vec2{1.f / float(r[0]), 1.f / float(r[1])};
            },
            shared);
        if (!within && !unseen.none()) return false;
    }
    takeMesh(d, shared, flat, gridOf, insideOf);
    return true;
}

/// The mesh of pieces with a grid, each with its own vertices. flat: undisplaced positions.
void Subdivision::takeMesh(const Dicing& d, const TriMesh& shared, const std::vector<Vec3>& flat,
                           const std::vector<const PieceGrid*>& gridOf, const std::vector<uint32_t>& insideOf) {
    const std::vector<uint8_t> onBorder = d.onBorder();
    size_t vertices = 0, facets = 0;
    for (const PieceGrid* g : gridOf)
        if (g) vertices += g->param.size(), facets += g->facet.size();
    TriMesh m;
    m.P.reserve(vertices + 1);
    m.made.reserve(facets);
    meshParam_.reserve(vertices);
    meshPrim_.reserve(vertices);
    std::vector<uint32_t> border, seam;
    std::vector<Vec3> flatSeam;
    for (uint32_t k = 0; k < limit_->pieces(); ++k) {
        if (!gridOf[k]) continue;
        const PieceGrid& g = *gridOf[k];
        d.border(k, border);
        const uint32_t base = uint32_t(m.P.size());
        for (size_t i = 0; i < g.param.size(); ++i) {
            const uint32_t point = i < border.size() ? border[i] : insideOf[k] + uint32_t(i) - uint32_t(g.border);
            if (displaced_ && onBorder[point]) seam.push_back(uint32_t(m.P.size())), flatSeam.push_back(flat[point]);
            m.P.push_back(shared.P[point]);
            meshParam_.push_back(g.param[i]);
            meshPrim_.push_back(k);
        }
        for (uint32_t i : g.facet) m.made.push_back(base + i);
    }
    if (m.P.empty() && !shared.P.empty()) {
        Bounds all;
        for (const Vec3& p : shared.P) all.add(p);
        return leaveOut(all);
    }
    m.finish();
    mesh_ = std::move(m);
    if (displaced_) closeSeams(d.opt, mesh_, std::move(seam), std::move(flatSeam));
}

} // namespace alpenglow::geometry
