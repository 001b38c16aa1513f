// Curves of the tests, their bases, and what is found about them by slow means.
#pragma once
#include "make.h"
#include <cmath>
#include <random>

namespace curves_test {

using namespace alpenglow;
using namespace alpenglow::geometry;
using namespace alpenglow::geometry::test;
using scene::Class;
using scene::Type;

using Rng = std::mt19937;
inline double uniform(Rng& r) { return r() / 4294967296.0; }
inline Vec3d within(Rng& r, double size) {
    const double x = uniform(r), y = uniform(r), z = uniform(r);
    return Vec3d(2 * x - 1, 2 * y - 1, 2 * z - 1) * size;
}

inline std::shared_ptr<scene::Primitive> curves(const std::string& type, std::vector<int> n, const std::string& wrap,
                                                std::vector<float> P, float width = 0.1f) {
    auto p = std::make_shared<scene::Primitive>();
    p->kind = "Curves";
    p->strings = {type, wrap};
    p->ints = std::move(n);
    p->params = {points(std::move(P)), param("constantwidth", Class::Constant, Type::Float, {width})};
    return p;
}
inline scene::Param floats(const std::string& name, Class c, std::vector<float> v) {
    return param(name, c, Type::Float, std::move(v));
}
inline scene::Param normals(Class c, std::vector<float> v) { return param("N", c, Type::Normal, std::move(v)); }

inline scene::Attributes withBasis(std::vector<double> rows, int step) {
    scene::Attributes a;
    for (int i = 0; i < 16; ++i) a.vbasis.m[i / 4][i % 4] = rows[size_t(i)];
    a.vbasis.step = step;
    return a;
}
struct NamedBasis {
    const char* name;
    std::vector<double> m;
    int step;
};
inline const std::vector<NamedBasis>& bases() { // RISpec 3.2, 5.2
    static const std::vector<NamedBasis> all = {
        {"bezier", {-1, 3, -3, 1, 3, -6, 3, 0, -3, 3, 0, 0, 1, 0, 0, 0}, 3},
        {"b-spline", {-1. / 6, .5, -.5, 1. / 6, .5, -1, .5, 0, -.5, 0, .5, 0, 1. / 6, 4. / 6, 1. / 6, 0}, 1},
        {"catmull-rom", {-.5, 1.5, -1.5, .5, 1, -2.5, 2, -.5, -.5, 0, .5, 0, 0, 1, 0, 0}, 1},
        {"hermite", {2, 1, -2, 1, -3, -2, 3, -1, 0, 1, 0, 0, 1, 0, 0, 0}, 2},
        {"power", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, 4},
    };
    return all;
}
/// (t^3 t^2 t 1) B (P0 P1 P2 P3), or its derivative.
inline Vec3d byBasis(const NamedBasis& b, const std::vector<Vec3d>& p, size_t first, double t, bool slope = false) {
    const double power[4] = {t * t * t, t * t, t, 1}, d[4] = {3 * t * t, 2 * t, 1, 0};
    Vec3d sum(0.0);
    for (size_t i = 0; i < 4; ++i)
        for (size_t k = 0; k < 4; ++k) sum += p[(first + k) % p.size()] * ((slope ? d : power)[i] * b.m[4 * i + k]);
    return sum;
}
inline std::vector<Vec3d> randomPoints(Rng& rng, size_t n, double size = 1) {
    std::vector<Vec3d> p;
    for (size_t i = 0; i < n; ++i) p.push_back(Vec3d(Vec3(within(rng, size))));
    return p;
}
inline std::vector<float> flat(const std::vector<Vec3d>& p) {
    std::vector<float> f;
    for (const Vec3d& q : p) f.insert(f.end(), {float(q.x), float(q.y), float(q.z)});
    return f;
}
inline Vec3d casteljau(std::vector<Vec3d> p, double t) {
    for (size_t n = p.size() - 1; n > 0; --n)
        for (size_t i = 0; i < n; ++i) p[i] = p[i] * (1 - t) + p[i + 1] * t;
    return p[0];
}

struct Nearest {
    double distance = INFINITY, f = 0;
};
/// Of a line to a curve, by looking.
template <class At> Nearest nearest(const Vec3d& o, const Vec3d& d, At at) {
    Nearest best;
    const auto look = [&](double f) {
        const Vec3d w = at(f) - o;
        const double l = length(cross(w, d)) / length(d);
        if (l < best.distance) best = {l, f};
    };
    for (int i = 0; i <= 2000; ++i) look(i / 2000.0);
    for (double step = 1 / 2000.0; step > 1e-9; step *= 0.5) {
        const double f = best.f;
        look(std::clamp(f - step, 0.0, 1.0)), look(std::clamp(f + step, 0.0, 1.0));
    }
    return best;
}
inline int allHits(const Shape& s, const Vec3d& o, const Vec3d& d, std::vector<std::pair<uint32_t, ExactHit>>& out,
                   double lo = -INFINITY) {
    out.clear();
    for (uint32_t k = 0; k < s.exactPrims(); ++k) {
        ExactHit h[4];
        const int n = s.exactHits(k, o, d, lo, INFINITY, Shape::Wanted::All, h);
        for (int i = 0; i < n; ++i) out.push_back({k, h[i]});
    }
    return int(out.size());
}
inline scene::Attributes round() {
    scene::Attributes a;
    a.values["dice:roundcurve"] = param("roundcurve", Class::Constant, Type::Integer, {1});
    return a;
}
inline std::vector<float> ring(size_t n, double radius) {
    std::vector<float> P;
    for (size_t i = 0; i < n; ++i) {
        const double a = 2 * kPi * double(i) / double(n);
        P.insert(P.end(), {float(radius * std::cos(a)), float(radius * std::sin(a)), float(0.3 * std::sin(2 * a))});
    }
    return P;
}

} // namespace curves_test
