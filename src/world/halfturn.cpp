#include "world/halfturn.h"
#include "scene/primitivekinds.h"
#include <cmath>

namespace alpenglow::world {

using geometry::Shape;
using geometry::SurfacePoint;

bool HalfTurn::has(const Shape& s) {
    if (!s.exact() || s.placed() || !s.source().primitive) return false;
    const auto& p = *s.source().primitive; // the last number of a quadric is its sweep angle
    return scene::has(p.kind, scene::kQuadric) && !p.numbers.empty() && std::fabs(p.numbers.back()) >= 360;
}

HalfTurn::HalfTurn(const Shape& s) {
    Matrix half; // the identity
    half.m[0][0] = half.m[1][1] = -1;
    turn_ = inverse(s.toCamera()) * half * s.toCamera();
    // Where the surface is widest, outside is away from the axis.
    double widest = -1;
    outward_ = 1;
    for (const double v : {.1, .3, .5, .7, .9}) {
        const SurfacePoint at = s.evaluate(0, .25, v);
        const Vec3d chord = Vec3d(at.P) - transformPoint(turn_, Vec3d(at.P));
        if (dot(chord, chord) > widest) widest = dot(chord, chord), outward_ = dot(chord, Vec3d(at.n)) < 0 ? -1 : 1;
    }
    shinesTo(0);
}

void HalfTurn::shinesTo(int side) {
    constexpr float kBoth = .75f; // the inside may be seen, too: through open ends, or from within
    side_ = side ? side : outward_;
    chance_ = side ? 1 : kBoth;
}

bool HalfTurn::facesTurned(const SurfacePoint& p, const Vec3& from) const {
    // Normals transform by the inverse transpose; the turn is its own inverse.
    const auto& m = turn_.m;
    Vec3d n;
    for (int i = 0; i < 3; ++i) n[i] = m[i][0] * double(p.n.x) + m[i][1] * double(p.n.y) + m[i][2] * double(p.n.z);
    return faces(transformPoint(turn_, Vec3d(p.P)), n, from);
}

bool HalfTurn::turns(const SurfacePoint& p, const Vec3& from, float u) const {
    if (faces(Vec3d(p.P), Vec3d(p.n), from) || !facesTurned(p, from)) return false;
    // The last bits of the angle decide; they say nothing of the point.
    const float last = u * 65536;
    return last - std::floor(last) < chance_;
}

double HalfTurn::factor(const SurfacePoint& p, const Vec3& from) const {
    const bool here = faces(Vec3d(p.P), Vec3d(p.n), from), there = facesTurned(p, from);
    return here == there ? 1 : here ? 1 + double(chance_) : 1 - double(chance_);
}

} // namespace alpenglow::world
