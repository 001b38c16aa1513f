// Control meshes of the tests of subdivision surfaces, and what is asked of their facets.
#pragma once
#include "geometry/subdivision.h"
#include "make.h"
#include "subdivision_slow.h"
#include <array>
#include <cmath>
#include <map>
#include <random>

namespace subdivision_test {

using namespace alpenglow;
using namespace alpenglow::geometry;
using namespace alpenglow::geometry::test;

/// A mesh with its tags.
struct Cage {
    std::string name, scheme = "catmull-clark";
    std::vector<float> P;
    std::vector<int> nverts, verts;
    struct Tag {
        std::string name;
        std::vector<float> ints, floats;
        std::vector<std::string> strings;
    };
    std::vector<Tag> tags;
    scene::ParamList more;

    std::shared_ptr<scene::Primitive> primitive(const std::string& kind = "SubdivisionMesh") const {
        auto p = std::make_shared<scene::Primitive>();
        p->kind = kind;
        p->strings = {scheme};
        p->ints = nverts;
        p->ints2 = verts;
        scene::Param ints = param("intargs", scene::Class::Constant, scene::Type::Integer, {}),
                     floats = param("floatargs", scene::Class::Constant, scene::Type::Float, {});
        scene::Param strings = param("stringargs", scene::Class::Constant, scene::Type::String, {});
        for (const Tag& t : tags) {
            p->strings.push_back(t.name);
            p->ints3.push_back(int(t.ints.size()));
            p->ints3.push_back(int(t.floats.size()));
            if (kind != "SubdivisionMesh") p->ints3.push_back(int(t.strings.size()));
            ints.numbers.insert(ints.numbers.end(), t.ints.begin(), t.ints.end());
            floats.numbers.insert(floats.numbers.end(), t.floats.begin(), t.floats.end());
            strings.strings.insert(strings.strings.end(), t.strings.begin(), t.strings.end());
        }
        p->params = {points(P), ints, floats, strings};
        p->params.insert(p->params.end(), more.begin(), more.end());
        return p;
    }
    SlowMesh slow() const {
        SlowMesh m;
        m.loop = scheme == "loop";
        for (size_t i = 0; i < P.size(); i += 3) m.P.push_back(Vec3d(P[i], P[i + 1], P[i + 2]));
        size_t at = 0;
        for (size_t f = 0; f < nverts.size(); ++f) {
            static constexpr double u4[4] = {0, 1, 1, 0}, v4[4] = {0, 0, 1, 1}, u3[3] = {0, 1, 0}, v3[3] = {0, 0, 1};
            SlowMesh::Face face{{}, int(f), 0};
            for (size_t k = 0; k < size_t(nverts[f]); ++k) {
                const bool three = m.loop, four = nverts[f] == 4;
                face.c.push_back({verts[at++], three ? u3[k] : four ? u4[k] : 0, three ? v3[k] : four ? v4[k] : 0});
            }
            m.faces.push_back(face);
        }
        for (const Tag& t : tags) {
            if (t.name == "crease")
                for (size_t k = 0; k + 1 < t.ints.size(); ++k)
                    m.sharp[SlowMesh::key(int(t.ints[k]), int(t.ints[k + 1]))] = t.floats[0] >= 10 ? 1000 : t.floats[0];
            if (t.name == "corner")
                for (float v : t.ints) m.corner[int(v)] = t.floats[0] >= 10 ? 1000 : t.floats[0];
            if (t.name == "interpolateboundary") m.boundaryCorners = t.ints.empty() || t.ints[0] == 1;
        }
        return m;
    }
};

inline const Cage::Tag kBoundary{"interpolateboundary", {}, {}, {}};

inline Cage cube() {
    Cage c;
    c.name = "cube";
    c.P = {-1, -1, -1, 1, -1, -1, 1, 1, -1, -1, 1, -1, -1, -1, 1, 1, -1, 1, 1, 1, 1, -1, 1, 1};
    c.nverts.assign(6, 4);
    c.verts = {0, 3, 2, 1, 4, 5, 6, 7, 0, 1, 5, 4, 1, 2, 6, 5, 2, 3, 7, 6, 3, 0, 4, 7};
    return c;
}
inline Cage grid(int n, bool triangles = false) {
    Cage c;
    c.name = triangles ? "triangle grid" : "grid";
    std::mt19937 random(7);
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i)
            for (double x : {double(i), double(j), double(random() % 1000) / 1000}) c.P.push_back(float(x));
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const int a = j * (n + 1) + i, b = a + 1, d = a + n + 1, e = d + 1;
            if (triangles) c.nverts.insert(c.nverts.end(), {3, 3}), c.verts.insert(c.verts.end(), {a, b, e, a, e, d});
            else c.nverts.push_back(4), c.verts.insert(c.verts.end(), {a, b, e, d});
        }
    c.tags = {kBoundary};
    return c;
}
inline Cage prism(int n) {
    Cage c;
    c.name = "prism of " + std::to_string(n);
    for (float z : {-1.f, 1.f})
        for (int i = 0; i < n; ++i) {
            const double a = 2 * kPi * i / n;
            c.P.insert(c.P.end(), {float(std::cos(a)), float(std::sin(a)) + 0.1f * z, z});
        }
    c.nverts = {n, n};
    for (int i = 0; i < n; ++i) c.verts.push_back(n - 1 - i);
    for (int i = 0; i < n; ++i) c.verts.push_back(n + i);
    for (int i = 0; i < n; ++i) {
        c.nverts.push_back(4);
        c.verts.insert(c.verts.end(), {i, (i + 1) % n, n + (i + 1) % n, n + i});
    }
    return c;
}
inline Cage octahedron() {
    Cage c;
    c.name = "octahedron";
    c.P = {1, 0, 0, -1, 0, 0, 0, 1.2f, 0, 0, -1, 0, 0, 0, 0.9f, 0, 0.1f, -1};
    c.nverts.assign(8, 3);
    c.verts = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
    return c;
}
inline Cage with(Cage c, const std::string& name, std::vector<Cage::Tag> tags) {
    c.name += name;
    c.tags.insert(c.tags.end(), tags.begin(), tags.end());
    return c;
}
inline Cage looped(Cage c) {
    c.scheme = "loop";
    c.name += " by loop";
    return c;
}
inline std::vector<Cage> cages() {
    Cage edgeOnly = grid(3);
    edgeOnly.name = "grid, edges only";
    edgeOnly.tags = {{"interpolateboundary", {2}, {}, {}}};
    Cage tetra;
    tetra.name = "tetrahedron";
    tetra.P = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    tetra.nverts.assign(4, 3);
    tetra.verts = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};
    const std::vector<float> top{4, 5, 6, 7, 4};
    return {cube(),
            grid(3),
            edgeOnly,
            tetra,
            prism(5),
            prism(6),
            octahedron(),
            grid(2, true),
            with(cube(), " creased", {{"crease", top, {10}, {}}}),
            with(cube(), " creased 2", {{"crease", top, {2}, {}}}),
            with(cube(), " creased 1.5", {{"crease", top, {1.5f}, {}}}),
            with(cube(), " creased 3", {{"crease", top, {3}, {}}}),
            with(cube(), " dart", {{"crease", {4, 5}, {10}, {}}}),
            with(cube(), " dart 2", {{"crease", {4, 5}, {2}, {}}}),
            with(cube(), " corner", {{"corner", {6}, {10}, {}}}),
            with(cube(), " corner 2", {{"corner", {6}, {2}, {}}}),
            with(prism(5), " creased", {{"crease", {5, 6, 7, 8, 9, 5}, {10}, {}}, {"crease", {2, 7}, {3}, {}}}),
            looped(octahedron()),
            looped(grid(3, true)),
            looped(tetra),
            looped(with(octahedron(), " creased", {{"crease", {0, 2, 1, 3, 0}, {10}, {}}})),
            looped(with(octahedron(), " creased 2", {{"crease", {0, 2, 1, 3, 0}, {2}, {}}}))};
}
inline SurfacePoint at(const Shape& s, const SlowMesh::Face& f, const SlowMesh::Corner& c, bool split) {
    return s.evaluate(f.base, split ? f.piece + std::min(c.u, 1 - 1e-9) : c.u, c.v);
}

inline DiceOptions camera(double pixels) {
    DiceOptions o;
    o.camera.pixelsPerUnit = pixels;
    return o;
}
/// Every edge of the mesh, by the bits of its ends, has a partner the other way round.
inline size_t openEdges(const TriMesh& m) {
    std::map<std::pair<std::array<float, 3>, std::array<float, 3>>, int> count;
    const auto bits = [&](uint32_t i) { return std::array<float, 3>{m.P[i].x, m.P[i].y, m.P[i].z}; };
    for (size_t t = 0; t < m.triangles(); ++t)
        for (size_t k = 0; k < 3; ++k) {
            const auto a = bits(m.index[3 * t + k]), b = bits(m.index[3 * t + (k + 1) % 3]);
            ++count[{a, b}];
            --count[{b, a}];
        }
    size_t open = 0;
    for (auto& [e, n] : count) open += n != 0;
    return open;
}
/// A variable of one number, with its slopes.
inline float value(const Shape& s, const std::string& name, const SurfacePoint& p, float* du = nullptr, float* dv = nullptr) {
    float v[4], a[4], b[4];
    s.interpolate(s.findPrimvar(name), p, v, a, b);
    if (du) *du = a[0], *dv = b[0];
    return v[0];
}

} // namespace subdivision_test
