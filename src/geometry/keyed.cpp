#include "geometry/keyed.h"
#include "base/parallel.h"
#include <mutex>
#include <typeinfo>

namespace alpenglow::geometry {

bool KeyedShape::join(std::vector<ShapeRef> later, std::vector<float> times, Diagnostics& diag) {
    for (const ShapeRef& s : later) {
        auto* k = dynamic_cast<KeyedShape*>(s.get());
        const auto same = [](const PrimVar& a, const PrimVar& b) {
            return a.cls == b.cls && a.type == b.type && a.outWidth() == b.outWidth();
        };
        if (!k || typeid(*k) != typeid(*this) || !fits(*k)) return false;
        if (!std::equal(primvars_.begin(), primvars_.end(), k->primvars_.begin(), k->primvars_.end(), same)) return false;
        if (!normal_.param != !k->normal_.param || (normal_.param && !same(normal_, k->normal_))) return false;
    }
    later_ = std::move(later);
    times_ = std::move(times);
    joinKeys(times_, diag);
    measure();
    return true;
}

void KeyedShape::measure() {
    bounds_ = {};
    constexpr uint32_t kRun = 4096;
    const uint32_t n = exactPrims();
    std::mutex adding;
    parallelFor(uint32_t(0), (n + kRun - 1) / kRun, [&](uint32_t run) {
        std::vector<Bounds> of(std::min(kRun, n - run * kRun));
        exactBoundsOf(run * kRun, of);
        Bounds all;
        for (const Bounds& b : of) all.add(b);
        std::lock_guard lock(adding);
        bounds_.add(all);
    });
}

Bounds KeyedShape::exactBounds(uint32_t prim) const {
    Bounds b = keyBounds(prim);
    for (size_t k = 1; k < keys(); ++k) b.add(key(k).keyBounds(prim));
    return b;
}

void KeyedShape::interpolateVariable(const PrimVar& v, const SurfacePoint& at, float* out, float* du, float* dv) const {
    double way;
    const size_t k = keyAt(at.time, way), number = size_t(&v - primvars_.data()); // or the normal, which is not among them
    const auto of = [&](const KeyedShape& s) -> const PrimVar& { return &v == &normal_ ? s.normal_ : s.primvars_[number]; };
    const KeyedShape& first = key(k);
    if (way == 0 || k + 1 >= keys()) return first.Shape::interpolateVariable(of(first), at, out, du, dv);
    const KeyedShape& last = key(k + 1);
    const size_t n = size_t(v.outWidth());
    float few[96];
    std::vector<float> many(6 * n > std::size(few) ? 6 * n : 0);
    float* const room = many.empty() ? few : many.data();
    float* const to[3] = {out, du, dv};
    const auto part = [&](size_t i) { return to[i % 3] ? &room[i * n] : nullptr; };
    first.Shape::interpolateVariable(of(first), at, part(0), part(1), part(2));
    last.Shape::interpolateVariable(of(last), at, part(3), part(4), part(5));
    for (size_t j = 0; j < 3; ++j)
        for (size_t i = 0; to[j] && i < n; ++i) to[j][i] = float(room[j * n + i] * (1 - way) + room[(3 + j) * n + i] * way);
}

void KeyedShape::localPoints(std::span<const HitRef> hits, uint32_t) const {
    for (const HitRef& h : hits) {
        *h.out = pointAt(h.prim, h.b1, h.b2, h.time);
        h.out->time = h.time;
    }
}

} // namespace alpenglow::geometry
