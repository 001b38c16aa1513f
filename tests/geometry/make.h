// Primitives for tests, made as a RIB reader would.
#pragma once
#include "geometry/build.h"
#include "geometry/dice.h"
#include <string>
#include <vector>

namespace alpenglow::geometry::test {

inline scene::Param param(const std::string& name, scene::Class c, scene::Type t, std::vector<float> v) {
    scene::Param p;
    p.name = name;
    p.cls = c;
    p.type = t;
    p.numbers = std::move(v);
    return p;
}
inline scene::Param points(std::vector<float> v) { return param("P", scene::Class::Vertex, scene::Type::Point, std::move(v)); }

inline std::shared_ptr<scene::Primitive> quadric(const std::string& kind, std::vector<float> numbers) {
    auto p = std::make_shared<scene::Primitive>();
    p->kind = kind;
    p->numbers = std::move(numbers);
    return p;
}
inline std::shared_ptr<scene::Primitive> polygon(std::vector<float> P) {
    auto p = std::make_shared<scene::Primitive>();
    p->kind = "Polygon";
    p->params = {points(std::move(P))};
    return p;
}
inline std::shared_ptr<scene::Primitive> patch(const std::string& type, std::vector<float> P) {
    auto p = std::make_shared<scene::Primitive>();
    p->kind = "Patch";
    p->strings = {type};
    p->params = {points(std::move(P))};
    return p;
}
inline std::shared_ptr<scene::Primitive> patchMesh(const std::string& type, int nu, const std::string& uw, int nv,
                                                   const std::string& vw, std::vector<float> P) {
    auto p = patch(type, std::move(P));
    p->kind = "PatchMesh";
    p->strings = {type, uw, vw};
    p->ints = {nu, nv};
    return p;
}
/// Sixteen points of a gently bent patch over about the unit square.
inline std::vector<float> bentNet() {
    std::vector<float> P;
    for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 4; ++i) {
            P.push_back(float(i) / 3 + 0.05f * float(j));
            P.push_back(float(j) / 3 - 0.03f * float(i * i) / 3);
            P.push_back(0.1f * float(i * i) - 0.13f * float(j * (3 - j)) + 0.04f * float(i * j));
        }
    return P;
}
inline ShapeRef build(const std::shared_ptr<scene::Primitive>& p, const Matrix& m, Diagnostics& d,
                      const scene::Attributes& a = {}) {
    return buildShape(p, std::make_shared<scene::Attributes>(a), m, -1, d);
}
/// Turned, unevenly scaled, moved; without a mirror.
inline Matrix skewed() {
    return rotateMatrix(33, 1, 2, 0.5) * scaleMatrix(1.5, 0.8, 1.2) * rotateMatrix(-70, 0, 1, 1) * translateMatrix(0.3, -1, 7);
}

} // namespace alpenglow::geometry::test
