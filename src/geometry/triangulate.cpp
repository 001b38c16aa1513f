#include "geometry/triangulate.h"
#include "base/exact.h"
#include "base/limits.h"
#include <algorithm>
#include <cmath>
#include <numeric>

namespace alpenglow::geometry {
namespace {

struct P2 {
    double x, y;
};

double turn(const P2& a, const P2& b, const P2& c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }

Vec3d newell(std::span<const Vec3d> p) {
    Vec3d n;
    for (size_t i = 0; i < p.size(); ++i) {
        // Relative to the first corner: far from the origin the products would cancel.
        Vec3d a = p[i] - p[0], b = p[(i + 1) % p.size()] - p[0];
        n += cross(a, b);
    }
    return n;
}

double area2(const std::vector<P2>& p, const std::vector<uint32_t>& ring) {
    double s = 0;
    for (size_t i = 0; i < ring.size(); ++i) {
        const P2 &a = p[ring[i]], &b = p[ring[(i + 1) % ring.size()]], &o = p[ring[0]];
        s += (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
    }
    return s;
}

// Closed triangle, counter-clockwise.
bool inside(const P2& a, const P2& b, const P2& c, const P2& p) {
    return turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0;
}

bool same(const P2& a, const P2& b) { return a.x == b.x && a.y == b.y; }

// Joins a hole (clockwise) to the ring (counter-clockwise) at its rightmost corner: a ray to +x finds the edge it sees, then
// the corner that is surely visible (Eberly, "Triangulation by Ear Clipping").
bool bridge(const std::vector<P2>& p, std::vector<uint32_t>& ring, const std::vector<uint32_t>& hole) {
    size_t h = 0;
    for (size_t i = 1; i < hole.size(); ++i)
        if (p[hole[i]].x > p[hole[h]].x) h = i;
    P2 m = p[hole[h]];
    double best = INFINITY;
    size_t edge = ring.size();
    for (size_t i = 0; i < ring.size(); ++i) {
        const P2 &a = p[ring[i]], &b = p[ring[(i + 1) % ring.size()]];
        if (!(a.y <= m.y && b.y >= m.y) || a.y == b.y) continue; // upward edges face a ray from inside
        double x = a.x + (m.y - a.y) / (b.y - a.y) * (b.x - a.x);
        if (x >= m.x && x < best) best = x, edge = i;
    }
    if (edge == ring.size()) return false;
    size_t e2 = (edge + 1) % ring.size();
    size_t pick = p[ring[edge]].x > p[ring[e2]].x ? edge : e2;
    P2 q{best, m.y}, c = p[ring[pick]];
    if (!same(q, c)) {
        // A reflex corner inside the triangle (m, q, c) hides c: takes the one nearest in angle to the ray.
        double slope = INFINITY, dist = INFINITY;
        size_t blocker = ring.size();
        for (size_t i = 0; i < ring.size(); ++i) {
            const P2& r = p[ring[i]];
            if (i == pick || r.x < m.x) continue;
            bool in = c.y > m.y ? inside(m, q, c, r) : inside(m, c, q, r);
            if (!in) continue;
            const P2 &before = p[ring[(i + ring.size() - 1) % ring.size()]], &after = p[ring[(i + 1) % ring.size()]];
            if (turn(before, r, after) > 0) continue;
            double s = std::fabs(r.y - m.y) / std::max(r.x - m.x, 1e-300), d = r.x - m.x;
            if (s < slope || (s == slope && d < dist)) slope = s, dist = d, blocker = i;
        }
        if (blocker != ring.size()) pick = blocker;
    }
    std::vector<uint32_t> join;
    join.reserve(ring.size() + hole.size() + 2);
    join.insert(join.end(), ring.begin(), ring.begin() + ptrdiff_t(pick) + 1);
    for (size_t i = 0; i <= hole.size(); ++i) join.push_back(hole[(h + i) % hole.size()]);
    join.insert(join.end(), ring.begin() + ptrdiff_t(pick), ring.end());
    ring = std::move(join);
    return true;
}

// Clips ears off a counter-clockwise ring. Returns false if it had to guess.
bool clip(const std::vector<P2>& p, const std::vector<uint32_t>& ring, std::vector<uint32_t>& out, size_t most) {
    size_t n = ring.size();
    std::vector<uint32_t> next(n), prev(n);
    for (size_t i = 0; i < n; ++i) next[i] = uint32_t((i + 1) % n), prev[i] = uint32_t((i + n - 1) % n);
    auto at = [&](uint32_t i) -> const P2& { return p[ring[i]]; };
    auto corner = [&](uint32_t i) { return turn(at(prev[i]), at(i), at(next[i])); };
    std::vector<uint32_t> reflex;
    std::vector<char> isReflex(n, 0), gone(n, 0);
    for (uint32_t i = 0; i < n; ++i)
        if (corner(i) <= 0) isReflex[i] = 1, reflex.push_back(i);
    size_t tests = 0, left = n, sinceEar = 0;
    bool good = true;
    uint32_t i = 0;
    while (left > 3) {
        uint32_t a = prev[i], b = next[i];
        bool budget = tests < most;
        double t = corner(i);
        bool ear = t > 0;
        if (ear && budget) {
            for (uint32_t r : reflex) {
                if (gone[r] || !isReflex[r] || r == a || r == i || r == b) continue;
                ++tests;
                const P2& q = at(r);
                // Bridges duplicate their ends: a corner that coincides with one of the ear's is not inside.
                if (same(q, at(a)) || same(q, at(i)) || same(q, at(b))) continue;
                if (inside(at(a), at(i), at(b), q)) {
                    ear = false;
                    break;
                }
            }
        }
        // A flat corner is removed without a triangle only if no ear is left, or where a loop reverses: a neighbour shares it,
        // and a triangle across it would leave a crack.
        bool doubled = same(at(a), at(i)) || same(at(i), at(b)) || same(at(a), at(b));
        bool flat = t == 0 && (doubled || sinceEar > left);
        bool force = sinceEar > 2 * left;
        if (ear || flat || force) {
            if (force && !flat && !ear) good = false;
            if (!budget) good = false;
            if (!flat) out.insert(out.end(), {ring[a], ring[i], ring[b]});
            next[a] = b;
            prev[b] = a;
            gone[i] = 1;
            --left;
            for (uint32_t k : {a, b})
                if (isReflex[k] && corner(k) > 0) isReflex[k] = 0;
                else if (!isReflex[k] && corner(k) <= 0) isReflex[k] = 1, reflex.push_back(k);
            if (reflex.size() > 2 * left + 16)
                reflex.erase(std::remove_if(reflex.begin(), reflex.end(), [&](uint32_t r) { return gone[r] || !isReflex[r]; }),
                             reflex.end());
            sinceEar = 0;
            i = next[b]; // skipping one spreads the cuts: fewer slivers
        } else {
            ++sinceEar;
            i = b;
        }
    }
    uint32_t a = prev[i], b = next[i];
    if (corner(i) != 0) out.insert(out.end(), {ring[a], ring[i], ring[b]});
    return good;
}

} // namespace

TriangulationResult triangulate(std::span<const Vec3d> points, std::span<const int> loops, std::vector<uint32_t>& out,
                                Vec3d& normal, size_t most) {
    normal = Vec3d(0.0);
    if (loops.empty() || loops[0] < 3) return TriangulationResult::Nothing;
    normal = newell(points.subspan(0, size_t(loops[0])));
    double len = length(normal);
    if (!(len > 0) || !std::isfinite(len)) return TriangulationResult::Nothing;
    size_t start = out.size();
    // Drops the dominant axis; the other two keep the winding counter-clockwise.
    int axis = std::fabs(normal.x) > std::fabs(normal.y) ? (std::fabs(normal.x) > std::fabs(normal.z) ? 0 : 2)
                                                         : (std::fabs(normal.y) > std::fabs(normal.z) ? 1 : 2);
    int ax = (axis + 1) % 3, ay = (axis + 2) % 3;
    if (normal[axis] < 0) std::swap(ax, ay);
    std::vector<P2> p(points.size());
    for (size_t i = 0; i < points.size(); ++i) p[i] = {points[i][ax] - points[0][ax], points[i][ay] - points[0][ay]};

    std::vector<uint32_t> ring(static_cast<size_t>(loops[0]));
    std::iota(ring.begin(), ring.end(), 0u);
    bool good = true, holes = false;
    std::vector<std::vector<uint32_t>> inner;
    size_t first = size_t(loops[0]);
    for (size_t l = 1; l < loops.size(); ++l) {
        std::vector<uint32_t> hole(static_cast<size_t>(std::max(0, loops[l])));
        std::iota(hole.begin(), hole.end(), uint32_t(first));
        first += hole.size();
        double a = hole.size() < 3 ? 0 : area2(p, hole);
        if (a == 0) continue;
        if (a > 0) std::reverse(hole.begin(), hole.end());
        inner.push_back(std::move(hole));
        holes = true;
    }
    if (!holes) {
        bool convex = true;
        size_t n = ring.size();
        double sumTurns = 0;
        for (size_t i = 0; i < n && convex; ++i) {
            const P2 &a = p[ring[i]], &b = p[ring[(i + 1) % n]], &c = p[ring[(i + 2) % n]];
            if (turn(a, b, c) <= 0) convex = false; // flat corners too: a fan could pass over one
            sumTurns += exact::atan2(turn(a, b, c), (b.x - a.x) * (c.x - b.x) + (b.y - a.y) * (c.y - b.y));
        }
        if (convex && std::fabs(sumTurns - 2 * kPi) < 0.1) { // once around: a pentagram is also locally convex
            for (size_t i = 1; i + 1 < n; ++i)
                if (turn(p[ring[0]], p[ring[i]], p[ring[i + 1]]) > 0) out.insert(out.end(), {ring[0], ring[i], ring[i + 1]});
            return out.size() > start ? TriangulationResult::Good : TriangulationResult::Nothing;
        }
    }
    auto right = [&](const std::vector<uint32_t>& h) {
        double x = -INFINITY;
        for (uint32_t i : h) x = std::max(x, p[i].x);
        return x;
    };
    std::vector<std::pair<double, size_t>> order;
    for (size_t i = 0; i < inner.size(); ++i) order.push_back({-right(inner[i]), i});
    std::sort(order.begin(), order.end());
    size_t cost = 0;
    for (auto& [x, i] : order) {
        cost += ring.size() + inner[i].size();
        if (cost > most || !bridge(p, ring, inner[i])) good = false; // outside the outer loop: left out
    }
    if (!clip(p, ring, out, most)) good = false;
    // Guessed triangles may have the wrong winding.
    for (size_t i = start; i + 2 < out.size(); i += 3)
        if (turn(p[out[i]], p[out[i + 1]], p[out[i + 2]]) < 0) std::swap(out[i + 1], out[i + 2]);
    if (out.size() == start) return TriangulationResult::Nothing;
    return good ? TriangulationResult::Good : TriangulationResult::Forced;
}

} // namespace alpenglow::geometry
