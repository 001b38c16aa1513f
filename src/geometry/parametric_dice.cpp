// Facets of surfaces over a square. The square is cut into blocks that need about some dozens of facets by their size on screen;
// a block has a uniform grid inside and, around it, a ring that connects to the points of its four sides. Points of a side are
// shared by the blocks on both sides. On the border of the surface, if its edges are edge curves (edge_curve.h), points are those
// of every surface with the same edge.
#include "base/limits.h"
#include "base/parallel.h"
#include "geometry/edge_corners.h"
#include "geometry/parametric_dicing.h"
#include "geometry/seams.h"
#include <cmath>

namespace alpenglow::geometry {

namespace {
constexpr double kBlock = 48;            ///< facets along a block, beyond which it is cut in two
constexpr int kDeepestHalving = 12;      ///< halvings of a patch
constexpr size_t kMostBlocks = 1u << 16; ///< that patches are cut into, beyond one a patch
} // namespace

Parametric::Dicing::Dicing(const Parametric& shape, const DiceOptions& o, bool moves)
    : s(shape), opt(o), displaced(moves), camera(diceCamera(o, shape.attributes(), moves)) {
    for (const ShapeRef& key : opt.keys)
        if (const auto* k = dynamic_cast<const Parametric*>(key.get());
            k && k->patchesU() == s.patchesU() && k->patchesV() == s.patchesV())
            keys.push_back(k);
    if (keys.empty()) keys.push_back(&s);
    closed[0] = std::all_of(keys.begin(), keys.end(), [](const Parametric* k) { return k->closedU(); });
    closed[1] = std::all_of(keys.begin(), keys.end(), [](const Parametric* k) { return k->closedV(); });
}

/// Number of facets along a block, from some points strictly inside of it, so that knots do not mix second derivatives of
/// neighbours. `least`: the smallest number of a probe.
void Parametric::Dicing::probe(const Parametric& shape, Block& k, Block& least, ProbedBox& box) const {
    constexpr int kProbe = 5;
    const double wu = k.u1 - k.u0, wv = k.v1 - k.v0, micro = edge(), tol = tolerance();
    const bool flat = diceFlatness(s.attributes()) > 0;
    for (int b = 0; b < kProbe; ++b)
        for (int a = 0; a < kProbe; ++a) {
            const LocalPoint p = shape.cameraPoint(k.u0 + wu * (a + 0.5) / kProbe, k.v0 + wv * (b + 0.5) / kProbe);
            if (leavesOut()) box.add(p.P, p.Pu * (0.5 * wu / kProbe), p.Pv * (0.5 * wv / kProbe));
            double lu = camera.pixels(p.P, p.Pu) * wu / micro, lv = camera.pixels(p.P, p.Pv) * wv / micro;
            if (!displaced) {
                const double cu = std::sqrt(camera.pixels(p.P, p.Puu) / (8 * tol)) * wu;
                const double cv = std::sqrt(camera.pixels(p.P, p.Pvv) / (8 * tol)) * wv;
                const double twist = std::sqrt(camera.pixels(p.P, p.Puv) / (4 * tol)) * std::sqrt(wu * wv);
                // 1.5: the probes miss the peak
                const double bu = 1.5 * std::max(cu, twist), bv = 1.5 * std::max(cv, twist);
                lu = flat ? bu : std::min(lu, bu);
                lv = flat ? bv : std::min(lv, bv);
            }
            k.nu = std::max(k.nu, lu);
            k.nv = std::max(k.nv, lv);
            least.nu = std::min(least.nu, lu);
            least.nv = std::min(least.nv, lv);
        }
}

void Parametric::Dicing::refine(Block k, int depth) {
    // A closed line needs three distinct points, or its two facets would coincide.
    k.nu = closed[0] ? std::max(1.0, 4 * (k.u1 - k.u0)) : 1;
    k.nv = closed[1] ? std::max(1.0, 4 * (k.v1 - k.v0)) : 1;
    Block least = k;
    least.nu = least.nv = std::numeric_limits<double>::infinity();
    ProbedBox box;
    for (const Parametric* key : keys) probe(*key, k, least, box);
    // Does not divide a block that stays too large after all remaining subdivisions, such as a patch at 1e39.
    const double hopeless = std::ldexp(kBlock, kDeepestHalving - depth);
    const bool u = k.nu > kBlock && least.nu <= hopeless, v = k.nv > kBlock && least.nv <= hopeless;
    if ((!u && !v) || depth >= kDeepestHalving || cuts >= kMostBlocks) {
        k.nu = std::min(k.nu, double(limits::kDiceEdge)); // a vanishing weight makes it arbitrarily large
        k.nv = std::min(k.nv, double(limits::kDiceEdge));
        k.seen = !leavesOut() || !(*unseen)(box.box());
        blocks.push_back(k);
        return;
    }
    ++cuts;
    const double mu = 0.5 * (k.u0 + k.u1), mv = 0.5 * (k.v0 + k.v1);
    for (int j = 0; j <= int(v); ++j)
        for (int i = 0; i <= int(u); ++i) {
            Block part = k;
            if (u) (i ? part.u0 : part.u1) = mu;
            if (v) (j ? part.v0 : part.v1) = mv;
            refine(part, depth + 1);
        }
}

/// Start and end of patches, two numbers each: if the surface is torn, both sides have separate ends.
std::vector<double> Parametric::Dicing::cells(int direction) const {
    const std::vector<double> at = s.borders(direction);
    std::vector<double> out;
    for (size_t i = 0; i + 1 < at.size(); ++i) {
        out.push_back(at[i]);
        const bool last = i + 2 == at.size();
        out.push_back(!last && s.torn(direction, at[i + 1]) ? double(std::nextafter(float(at[i + 1]), 0.f)) : at[i + 1]);
    }
    return out;
}

void Parametric::Dicing::cutPatches() {
    const std::vector<double> u = cells(0), v = cells(1);
    const std::vector<uint8_t> away = unseenPatches(u, v);
    for (size_t j = 0; j + 1 < v.size(); j += 2)
        for (size_t i = 0; i + 1 < u.size(); i += 2) {
            Block k{u[i], u[i + 1], v[j], v[j + 1], 1, 1};
            if (away.empty() || !away[j / 2 * (u.size() / 2) + i / 2]) refine(k, 0);
            else k.seen = false, blocks.push_back(k);
        }
}

/// Makes facets larger until they are not too many. True: they had to be.
bool Parametric::Dicing::limitFacets() {
    const auto total = [&] {
        double sum = 0;
        for (const Block& k : blocks) { // sides may have twice as many points, being cut in halves
            const double nu = std::ceil(std::max(1.0, k.nu * scale)), nv = std::ceil(std::max(1.0, k.nv * scale));
            sum += nu * nv + (nu > 1 ? nu : 0) + (nv > 1 ? nv : 0);
        }
        return sum;
    };
    const double most = std::max(double(limits::kDiceQuads), 1.5 * double(blocks.size()));
    while (total() > most && scale > 1e-9) scale *= 0.9;
    return scale < 1;
}

/// Halves a part of a line until no side of a block starts or ends within a segment, and none is longer than its blocks need.
void Parametric::Dicing::cutLine(Line& line, double a, double b, std::span<const Line::Side*> sides) {
    double need = 0;
    bool within = false, any = false;
    std::vector<const Line::Side*> here;
    for (const Line::Side* k : sides) {
        if (!(k->from < b && k->to > a)) continue;
        any = true;
        need = std::max(need, k->need * scale * (b - a) / (k->to - k->from));
        within |= (k->from > a && k->from < b) || (k->to > a && k->to < b);
        here.push_back(k);
    }
    if (!any) return;
    if (const double m = 0.5 * (a + b); (within || need > 1) && m > a && m < b) {
        cutLine(line, a, m, here);
        cutLine(line, m, b, here);
        return;
    }
    if (line.at.empty() || line.at.back() != a) line.at.push_back(a);
    line.at.push_back(b);
}

/// Points of a border of the surface (0: v = 0, 1: u = 1, 2: v = 1, 3: u = 0), for edges with edge curves.
void Parametric::Dicing::giveEdge(int side, Line& line, const std::vector<double>& cells) {
    std::vector<double> at;
    std::vector<Vec3d> points;
    for (size_t c = 0; 2 * c + 1 < cells.size(); ++c) {
        std::vector<EdgeCurve> curves;
        EdgeCurve own;
        const double from = cells[2 * c], to = cells[2 * c + 1];
        if (!s.edgeCurve(side, int(c), from, to, own) || (c > 0 && from != cells[2 * c - 1])) return;
        for (const Parametric* key : keys)
            if (EdgeCurve e; key->edgeCurve(side, int(c), from, to, e)) curves.push_back(e);
        if (curves.size() != keys.size()) return;
        if (std::all_of(curves.begin(), curves.end(), [](const EdgeCurve& e) { return e.collapsed(); })) return;
        const double micro = !displaced && diceFlatness(s.attributes()) > 0 ? 1e-9 : edge(); // curvature decides alone
        // Where others have a corner it is two edges.
        std::vector<EdgeCorners::On> ends{{0, Vec3(own.at(0))}};
        if (opt.corners && displaced && own.straight() && keys.size() == 1)
            for (const EdgeCorners::On& k : opt.corners->within(opt.seamWith, own.at(0), own.at(1))) ends.push_back(k);
        ends.push_back({1, Vec3(own.at(1))});
        for (size_t k = 0; k + 1 < ends.size(); ++k) {
            if (ends.size() > 2) curves = {own = EdgeCurve::line(Vec3d(ends[k].P), Vec3d(ends[k + 1].P))};
            const double width = ends[k + 1].t - ends[k].t;
            for (double t : EdgeCuts(curves, camera, micro, tolerance(), displaced).places()) {
                if ((c > 0 || k > 0) && t == 0) continue;
                const double whole = t == 1 ? ends[k + 1].t : ends[k].t + width * t;
                at.push_back(whole == 1 ? to : from + (to - from) * whole);
                points.push_back(own.at(t));
            }
        }
    }
    line.at = std::move(at);
    line.points = std::move(points);
    line.given = true;
}

void Parametric::Dicing::makeLines() {
    for (const Block& k : blocks) {
        lines[0][k.v0].sides.push_back({k.u0, k.u1, k.nu});
        lines[0][k.v1].sides.push_back({k.u0, k.u1, k.nu});
        lines[1][k.u0].sides.push_back({k.v0, k.v1, k.nv});
        lines[1][k.u1].sides.push_back({k.v0, k.v1, k.nv});
    }
    for (int d = 0; d < 2; ++d) {
        Line &first = lines[d].begin()->second, &last = lines[d].rbegin()->second;
        const std::vector<double> along = cells(d);
        if (closed[1 - d]) { // one line
            first.sides.insert(first.sides.end(), last.sides.begin(), last.sides.end());
            last.sides = first.sides;
        } else {
            giveEdge(d == 0 ? 0 : 3, first, along);
            giveEdge(d == 0 ? 2 : 1, last, along);
        }
        for (auto& [where, line] : lines[d]) {
            if (line.given) continue;
            std::vector<const Line::Side*> sides;
            for (const Line::Side& k : line.sides) sides.push_back(&k);
            std::sort(sides.begin(), sides.end(), [](const auto* a, const auto* b) { return a->from < b->from; });
            size_t begin = 0;
            for (size_t c = 0; c + 1 < along.size(); c += 2) {
                size_t end = begin;
                while (end < sides.size() && sides[end]->from < along[c + 1]) ++end;
                cutLine(line, along[c], along[c + 1], {sides.data() + begin, end - begin});
                begin = end;
            }
            line.sides = {};
        }
    }
}

size_t Parametric::Dicing::Line::nearest(double x) const {
    const size_t k = size_t(std::lower_bound(at.begin(), at.end(), x) - at.begin());
    if (k == at.size()) return k - 1;
    return k > 0 && x - at[k - 1] < at[k] - x ? k - 1 : k;
}

/// Points of lines. Crossing lines share a vertex; an end that is not a point of an existing border moves to the nearest point of
/// it.
void Parametric::Dicing::makeVertices() {
    const auto make = [&](double u, double v) {
        param.push_back({u, v});
        return uint32_t(param.size() - 1);
    };
    Line* const sides[2] = {&lines[1].begin()->second, &lines[1].rbegin()->second}; // u = 0 and u = 1
    for (auto& [v, line] : lines[0])
        for (double u : line.at) {
            const Line* end = u == 0 ? sides[0] : u == 1 ? sides[1] : nullptr;
            line.vertex.push_back(end && end->given && !end->has(v) ? kNone : make(u, v));
        }
    for (auto& [u, line] : lines[1])
        for (double v : line.at) {
            const auto cross = lines[0].find(v);
            if (cross == lines[0].end()) {
                line.vertex.push_back(make(u, v));
                continue;
            }
            const Line& other = cross->second;
            const size_t k = other.nearest(u);
            if (other.at[k] == u || (other.given && (v == 0 || v == 1))) line.vertex.push_back(other.vertex[k]);
            else line.vertex.push_back(make(u, v));
        }
    for (auto& [v, line] : lines[0])
        for (size_t k = 0; k < line.at.size(); ++k)
            if (line.vertex[k] == kNone) {
                const Line& end = *sides[line.at[k] == 1];
                line.vertex[k] = end.vertex[end.nearest(v)];
            }
    for (Block& k : blocks)
        if (k.seen) makeInside(k);
}

void Parametric::Dicing::makeInside(Block& k) {
    const auto one = [&](int direction, double of, double from, double to) {
        const Line& line = lines[direction].at(of);
        return line.nearest(to) - line.nearest(from) == 1;
    };
    const auto count = [&](double need) { return uint32_t(std::ceil(std::max(1.0, need * scale))); };
    k.cutU = count(k.nu), k.cutV = count(k.nv);
    const bool plainU = one(0, k.v0, k.u0, k.u1) && one(0, k.v1, k.u0, k.u1),
               plainV = one(1, k.u0, k.v0, k.v1) && one(1, k.u1, k.v0, k.v1);
    if ((k.cutV == 1 && plainV) || (k.cutU == 1 && plainU)) return; // a strip
    k.cutU = std::max(k.cutU, 2u), k.cutV = std::max(k.cutV, 2u);
    k.first = uint32_t(param.size());
    for (uint32_t j = 1; j < k.cutV; ++j)
        for (uint32_t i = 1; i < k.cutU; ++i)
            param.push_back({k.u0 + (k.u1 - k.u0) * i / k.cutU, k.v0 + (k.v1 - k.v0) * j / k.cutV});
}

void Parametric::Dicing::placeEdge(int side, const Line& line, std::vector<Vec3>& P) const {
    if (line.given) {
        for (size_t k = 0; k < line.vertex.size(); ++k) P[line.vertex[k]] = Vec3(line.points[k]);
        return;
    }
    const std::vector<double> cell = cells(side & 1);
    for (size_t c = 0; 2 * c + 1 < cell.size(); ++c) {
        EdgeCurve e;
        if (!s.edgeCurve(side, int(c), cell[2 * c], cell[2 * c + 1], e) || !e.collapsed()) continue;
        for (size_t k = line.nearest(cell[2 * c]); k <= line.nearest(cell[2 * c + 1]); ++k) P[line.vertex[k]] = Vec3(e.at(0));
    }
}

void Parametric::Dicing::place(std::vector<Vec3>& P) const {
    parallelFor(size_t(0), param.size(), [&](size_t i) {
        if (used.empty() || used[i]) P[i] = Vec3(s.cameraPosition(float(param[i][0]), float(param[i][1])));
    });
    // At corners the borders of constant v have priority: they are complete circles, the others may be none.
    if (!closed[0]) placeEdge(3, lines[1].begin()->second, P), placeEdge(1, lines[1].rbegin()->second, P);
    if (!closed[1]) placeEdge(0, lines[0].begin()->second, P), placeEdge(2, lines[0].rbegin()->second, P);
    // A closed surface joins itself bit by bit, so that no ray leaks through the seam.
    for (size_t d = 0; d < 2; ++d) {
        if (!closed[1 - d]) continue;
        const Line &first = lines[d].begin()->second, &last = lines[d].rbegin()->second;
        for (size_t k = 0; k < first.vertex.size(); ++k) P[last.vertex[k]] = P[first.vertex[k]];
    }
}

std::vector<Parametric::Dicing::Point> Parametric::Dicing::side(int direction, double of, double from, double to) const {
    const Line& line = lines[direction].at(of);
    std::vector<Point> out;
    for (size_t k = line.nearest(from), end = line.nearest(to); k <= end; ++k) out.push_back({line.at[k], line.vertex[k]});
    return out;
}

void Parametric::Dicing::triangle(uint32_t a, uint32_t b, uint32_t c) {
    if (a != b && b != c && a != c) index.insert(index.end(), {a, b, c});
}

/// The strip between two rows of points; `out` on the right of `in` as u, v are drawn, or with flip on the left.
void Parametric::Dicing::zip(const std::vector<Point>& out, const std::vector<Point>& in, bool flip) {
    size_t i = 0, j = 0;
    const auto put = [&](uint32_t a, uint32_t b, uint32_t c) { flip ? triangle(a, c, b) : triangle(a, b, c); };
    while (i + 1 < out.size() || j + 1 < in.size()) {
        const bool next = j + 1 >= in.size() || (i + 1 < out.size() && out[i].at + out[i + 1].at <= in[j].at + in[j + 1].at);
        if (next) put(out[i].vertex, out[i + 1].vertex, in[j].vertex), ++i;
        else put(out[i].vertex, in[j + 1].vertex, in[j].vertex), ++j;
    }
}

void Parametric::Dicing::fill(const Block& k, const TriMesh& m) {
    const auto bottom = side(0, k.v0, k.u0, k.u1), top = side(0, k.v1, k.u0, k.u1), left = side(1, k.u0, k.v0, k.v1),
               right = side(1, k.u1, k.v0, k.v1);
    const Vec2 size{float((k.u1 - k.u0) / k.cutU), float((k.v1 - k.v0) / k.cutV)};
    for (const auto* row : {&bottom, &top, &left, &right})
        for (const Point& p : *row) step[p.vertex] = size;
    const auto quad = [&](uint32_t a, uint32_t b, uint32_t c, uint32_t d) { // (0,0) (1,0) (0,1) (1,1)
        const auto far = [&](uint32_t x, uint32_t y) {
            const Vec3 e = m.P[x] - m.P[y];
            return dot(e, e);
        };
        if (!opt.keys.empty() || far(a, d) <= far(b, c)) triangle(a, b, d), triangle(a, d, c);
        else triangle(a, b, c), triangle(b, d, c);
    };
    const bool plainU = bottom.size() == 2 && top.size() == 2, plainV = left.size() == 2 && right.size() == 2;
    if (plainU && plainV && (k.cutU == 1 || k.cutV == 1))
        return quad(bottom[0].vertex, bottom[1].vertex, top[0].vertex, top[1].vertex);
    if (k.cutV == 1) return zip(bottom, top, false);
    if (k.cutU == 1) return zip(left, right, true);
    const uint32_t first = k.first, w = k.cutU - 1, h = k.cutV - 1;
    std::fill(step.begin() + first, step.begin() + first + w * h, size);
    std::vector<Point> row[4];
    for (uint32_t i = 0; i < w; ++i) {
        const double u = param[first + i][0];
        row[0].push_back({u, first + i}), row[1].push_back({u, first + (h - 1) * w + i});
    }
    for (uint32_t j = 0; j < h; ++j) {
        const double v = param[first + j * w][1];
        row[2].push_back({v, first + j * w}), row[3].push_back({v, first + j * w + w - 1});
    }
    for (uint32_t j = 0; j + 1 < h; ++j)
        for (uint32_t i = 0; i + 1 < w; ++i) {
            const uint32_t a = first + j * w + i;
            quad(a, a + 1, a + w, a + w + 1);
        }
    zip(bottom, row[0], false);
    zip(top, row[1], true);
    zip(left, row[2], true);
    zip(right, row[3], false);
}

std::vector<uint32_t> Parametric::Dicing::border() const {
    std::vector<uint32_t> out;
    for (const Lines& all : lines)
        for (const Line* line : {&all.begin()->second, &all.rbegin()->second})
            out.insert(out.end(), line->vertex.begin(), line->vertex.end());
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
}

void Parametric::borderCorners(std::vector<Vec3>& out) const {
    const DiceOptions none;
    const Dicing d(*this, none, true);
    for (int side = 0; side < 4; ++side) {
        const int direction = side & 1; // sides 0 and 2 run along u
        if (d.closed[1 - direction]) continue;
        const std::vector<double> cells = d.cells(direction);
        for (size_t c = 0; 2 * c + 1 < cells.size(); ++c)
            if (EdgeCurve e; edgeCurve(side, int(c), cells[2 * c], cells[2 * c + 1], e))
                out.insert(out.end(), {Vec3(e.at(0)), Vec3(e.at(1))});
    }
}

void Parametric::dice(const DiceOptions& opt, Diagnostics& diag) {
    displaced_ = isDisplaced(*this, opt);
    if (!displaced_ && !needsDicing() && opt.keys.empty()) return;
    Unseen unseen(*this, opt);
    Bounds all;
    if (!unseen.none() && hull(0, 0, 1, 1, all) && unseen(all)) return leaveOut(all);
    Diagnostics reported;
    if (!diceSeen(opt, unseen, reported) && !unseen.none()) { // exceeds the declared bound: omitted parts may be visible
        unseen.lookAnywhere();
        diceSeen(opt, unseen, diag);
        return;
    }
    for (const Diagnostic& d : reported.all()) diag.report(d);
}

/// Omits unreachable parts. Returns false if displacement exceeded its bound.
bool Parametric::diceSeen(const DiceOptions& opt, Unseen& unseen, Diagnostics& diag) {
    Dicing d(*this, opt, displaced_);
    d.unseen = &unseen;
    d.cutPatches();
    if (d.limitFacets())
        diag.report(Severity::Info, Rie::Limit, place(),
                    kind() + " would need more than " + std::to_string(limits::kDiceQuads) +
                        " micropolygons; it is diced more coarsely");
    if (std::none_of(d.blocks.begin(), d.blocks.end(), [](const Dicing::Block& k) { return k.seen; })) {
        Bounds some;
        for (const Dicing::Block& k : d.blocks) some.add(Vec3(cameraPosition(0.5 * (k.u0 + k.u1), 0.5 * (k.v0 + k.v1))));
        return leaveOut(some), true;
    }
    d.makeLines();
    d.makeVertices();
    d.findUsed();
    TriMesh m;
    m.P.resize(d.param.size());
    d.step.assign(d.param.size(), Vec2{});
    d.place(m.P);
    for (const Dicing::Block& k : d.blocks)
        if (k.seen) d.fill(k, m);
    std::vector<uint32_t> border = displaced_ ? d.border() : std::vector<uint32_t>();
    d.dropUnused(m.P, border);
    meshParam_.clear();
    meshParam_.reserve(d.param.size());
    for (const auto& p : d.param) meshParam_.push_back({float(p[0]), float(p[1])});
    m.made = std::move(d.index);
    trim(m);
    std::vector<Vec3> flat;
    for (uint32_t i : border) flat.push_back(m.P[i]);
    bool within = true;
    if (displaced_)
        within = displaceMesh(
            *this, opt, diag, [&](uint32_t i) { return evaluateLocal(0, meshParam_[i].x, meshParam_[i].y); },
            [&](uint32_t i) { return d.step[i]; }, m);
    if (!within && !unseen.none()) return false;
    m.finish();
    mesh_ = std::move(m);
    closeSeams(opt, mesh_, border, std::move(flat));
    return within;
}

} // namespace alpenglow::geometry
