// Subdivision surfaces the slow way: the whole mesh is refined in double by the rules of Catmull and Clark, Loop, and DeRose et
// al. (creases), and limits are read off at its vertices with the masks of Halstead et al. Shares no code with the renderer.
#pragma once
#include "base/vec.h"
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

namespace alpenglow::geometry::test {

struct SlowMesh {
    struct Corner {
        int vertex;
        double u, v;
    };
    struct Face {
        std::vector<Corner> c;
        int base, piece;
    };
    std::vector<Vec3d> P;
    std::vector<Face> faces;
    std::map<std::pair<int, int>, double> sharp; ///< edges by ascending vertices
    std::map<int, double> corner;
    bool loop = false, boundaryCorners = true;
    int level = 0;

    static std::pair<int, int> key(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

    struct Edge {
        std::vector<int> faces;
        int a, b;
        double s;
        int index;
    };
    struct Links {
        std::map<std::pair<int, int>, Edge> edges;
        std::vector<std::vector<int>> vertexFaces;
        std::vector<std::vector<std::pair<int, int>>> vertexEdges;
    };
    Links links() const {
        Links l;
        l.vertexFaces.resize(P.size());
        l.vertexEdges.resize(P.size());
        for (size_t f = 0; f < faces.size(); ++f)
            for (size_t k = 0; k < faces[f].c.size(); ++k) {
                const int a = faces[f].c[k].vertex, b = faces[f].c[(k + 1) % faces[f].c.size()].vertex;
                auto [at, isNew] = l.edges.try_emplace(key(a, b));
                if (isNew) {
                    at->second.a = a, at->second.b = b;
                    const auto s = sharp.find(key(a, b));
                    at->second.s = s == sharp.end() ? 0 : s->second;
                    l.vertexEdges[size_t(a)].push_back(key(a, b));
                    l.vertexEdges[size_t(b)].push_back(key(a, b));
                }
                at->second.faces.push_back(int(f));
                l.vertexFaces[size_t(a)].push_back(int(f));
            }
        for (auto& [k, e] : l.edges)
            if (e.faces.size() != 2) e.s = 1000; // borders are creases
        return l;
    }
    Vec3d middle(const Face& f) const {
        Vec3d m(0.0);
        for (const Corner& c : f.c) m = m + P[size_t(c.vertex)];
        return m / double(f.c.size());
    }
    int other(std::pair<int, int> e, int v) const { return e.first == v ? e.second : e.first; }

    Vec3d smoothVertex(const Links& l, int v) const {
        const auto& es = l.vertexEdges[size_t(v)];
        const double n = double(es.size());
        Vec3d e(0.0), f(0.0);
        for (auto k : es) e = e + P[size_t(other(k, v))];
        if (loop) {
            const double q = 3.0 / 8 + std::cos(2 * std::numbers::pi / n) / 4, beta = (5.0 / 8 - q * q) / n;
            return P[size_t(v)] * (1 - n * beta) + e * beta;
        }
        for (int k : l.vertexFaces[size_t(v)]) f = f + middle(faces[size_t(k)]);
        return (f / n + e / n + P[size_t(v)] * (n - 2)) / n;
    }
    /// By the number of sharp edges that end at it; fractions blend smooth and sharp.
    Vec3d newVertex(const Links& l, int v) const {
        const auto at = corner.find(v);
        double cs = at == corner.end() ? 0 : at->second;
        if (boundaryCorners && l.vertexFaces[size_t(v)].size() == 1) cs = 1000;
        std::vector<std::pair<int, int>> creases;
        double least = 1000;
        for (auto k : l.vertexEdges[size_t(v)])
            if (l.edges.at(k).s > 0) creases.push_back(k), least = std::min(least, l.edges.at(k).s);
        const Vec3d smooth = smoothVertex(l, v);
        if (cs > 0) {
            const double t = std::min(cs, 1.0);
            return P[size_t(v)] * t + smooth * (1 - t);
        }
        if (creases.size() < 2) return smooth;
        const double t = std::min(least, 1.0);
        Vec3d hard = P[size_t(v)];
        if (creases.size() == 2)
            hard = P[size_t(v)] * 0.75 + (P[size_t(other(creases[0], v))] + P[size_t(other(creases[1], v))]) * 0.125;
        return hard * t + smooth * (1 - t);
    }
    Vec3d newEdge(const Edge& e) const {
        const Vec3d half = (P[size_t(e.a)] + P[size_t(e.b)]) * 0.5;
        if (e.s >= 1) return half;
        Vec3d smooth;
        if (loop) {
            Vec3d far(0.0);
            for (int f : e.faces)
                for (const Corner& c : faces[size_t(f)].c)
                    if (c.vertex != e.a && c.vertex != e.b) far = far + P[size_t(c.vertex)];
            smooth = (P[size_t(e.a)] + P[size_t(e.b)]) * 0.375 + far * 0.125;
        } else {
            smooth =
                (P[size_t(e.a)] + P[size_t(e.b)] + middle(faces[size_t(e.faces[0])]) + middle(faces[size_t(e.faces[1])])) * 0.25;
        }
        return half * e.s + smooth * (1 - e.s);
    }

    SlowMesh refined() const {
        Links l = links();
        SlowMesh r;
        r.loop = loop;
        r.boundaryCorners = boundaryCorners;
        r.level = level + 1;
        for (size_t v = 0; v < P.size(); ++v) r.P.push_back(l.vertexFaces[v].empty() ? P[v] : newVertex(l, int(v)));
        for (auto& [k, e] : l.edges) e.index = int(r.P.size()), r.P.push_back(newEdge(e));
        for (auto& [k, e] : l.edges)
            if (e.s > 1)
                for (int v : {e.a, e.b}) r.sharp[key(v, e.index)] = e.s - 1;
        for (auto& [v, s] : corner)
            if (s > 1) r.corner[v] = s - 1;
        for (size_t f = 0; f < faces.size(); ++f) {
            const Face& face = faces[f];
            const size_t n = face.c.size();
            const auto mid = [&](size_t k) {
                const Corner &a = face.c[k % n], &b = face.c[(k + 1) % n];
                return Corner{l.edges.at(key(a.vertex, b.vertex)).index, (a.u + b.u) / 2, (a.v + b.v) / 2};
            };
            if (loop) {
                for (size_t k = 0; k < 3; ++k) r.faces.push_back({{face.c[k], mid(k), mid(k + 2)}, face.base, face.piece});
                r.faces.push_back({{mid(0), mid(1), mid(2)}, face.base, face.piece});
                continue;
            }
            const int centre = int(r.P.size());
            r.P.push_back(middle(face));
            if (n == 4) {
                const Corner m{centre, (face.c[0].u + face.c[2].u) / 2, (face.c[0].v + face.c[2].v) / 2};
                for (size_t k = 0; k < 4; ++k) r.faces.push_back({{face.c[k], mid(k), m, mid(k + 3)}, face.base, face.piece});
            } else {
                for (size_t k = 0; k < n; ++k)
                    r.faces.push_back(
                        {{{face.c[k].vertex, 0, 0}, {mid(k).vertex, 1, 0}, {centre, 1, 1}, {mid(k + n - 1).vertex, 0, 1}},
                         face.base,
                         int(k)});
            }
        }
        return r;
    }

    struct Limit {
        Vec3d P, du, dv;
        bool slopes = false, known = true;
    };
    /// At corner k of a face; slopes where the vertex is smooth and regular. Semi-sharp creases must have become smooth by now.
    Limit limit(const Links& l, int f, int k) const {
        const Face& face = faces[size_t(f)];
        const int n = int(face.c.size()), v = face.c[size_t(k)].vertex;
        const auto& es = l.vertexEdges[size_t(v)];
        Limit r;
        std::vector<int> sharpEnds;
        for (auto e : es)
            if (l.edges.at(e).s > 0) sharpEnds.push_back(other(e, v));
        const bool single = boundaryCorners && l.vertexFaces[size_t(v)].size() == 1;
        if (corner.count(v) || single || sharpEnds.size() > 2) {
            r.P = P[size_t(v)];
            return r;
        }
        if (sharpEnds.size() == 2) {
            r.P = (P[size_t(v)] * 4 + P[size_t(sharpEnds[0])] + P[size_t(sharpEnds[1])]) / 6;
            return r;
        }
        if (sharpEnds.size() == 1) {
            r.known = false;
            return r;
        } // the end of a crease has a mask of its own
        const double m = double(es.size());
        Vec3d e(0.0), q(0.0);
        for (auto x : es) e = e + P[size_t(other(x, v))];
        if (loop) {
            const double c = 3.0 / 8 + std::cos(2 * std::numbers::pi / m) / 4, beta = (5.0 / 8 - c * c) / m,
                         w = 1 / (m + 3 / (8 * beta));
            r.P = P[size_t(v)] * (1 - m * w) + e * w;
            return r;
        }
        for (int g : l.vertexFaces[size_t(v)]) {
            const Face& o = faces[size_t(g)];
            for (size_t i = 0; i < 4; ++i)
                if (o.c[i].vertex == v) q = q + P[size_t(o.c[(i + 2) % 4].vertex)];
        }
        r.P = (P[size_t(v)] * (m * m) + e * 4 + q) / (m * (m + 5));
        if (es.size() != 4 || !sharpEnds.empty() || n != 4) return r;
        // The uniform cubic B-spline: the nine points around v by walking from face to face.
        std::map<std::pair<int, int>, Vec3d> grid;
        int g = f, i = k;
        for (int turn = 0; turn < 4; ++turn) {
            static constexpr int dir[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
            const Face& o = faces[size_t(g)];
            const auto& a = dir[turn];
            const auto& b = dir[(turn + 1) % 4];
            grid[{a[0], a[1]}] = P[size_t(o.c[size_t(i + 1) % 4].vertex)];
            grid[{a[0] + b[0], a[1] + b[1]}] = P[size_t(o.c[size_t(i + 2) % 4].vertex)];
            const int side = o.c[size_t(i + 3) % 4].vertex;
            const auto& across = l.edges.at(key(v, side)).faces;
            g = across[0] == g ? across[1] : across[0];
            for (int j = 0; j < 4; ++j)
                if (faces[size_t(g)].c[size_t(j)].vertex == v) i = j;
        }
        const auto at = [&](int x, int y) { return grid.at({x, y}); };
        // By the corner's own two edges, then turned to u and v of the face.
        const Vec3d dx = (at(1, 1) + at(1, 0) * 4 + at(1, -1) - at(-1, 1) - at(-1, 0) * 4 - at(-1, -1)) / 12.0;
        const Vec3d dy = (at(1, 1) + at(0, 1) * 4 + at(-1, 1) - at(1, -1) - at(0, -1) * 4 - at(-1, -1)) / 12.0;
        const Corner &c0 = face.c[size_t(k)], &c1 = face.c[size_t(k + 1) % 4], &c3 = face.c[size_t(k + 3) % 4];
        const double ux = c1.u - c0.u, vx = c1.v - c0.v, uy = c3.u - c0.u, vy = c3.v - c0.v, det = ux * vy - uy * vx;
        r.du = (dx * vy - dy * vx) / det;
        r.dv = (dy * ux - dx * uy) / det;
        r.slopes = true;
        return r;
    }
};

} // namespace alpenglow::geometry::test
