// Small scenes in blocks of rays. Rays that float bounds do not decide are intersected one by one (Accel::Impl::intersectDirect),
// with the same bits.
#include "accel/directblock.h"
#include "accel/impl.h"
#include <algorithm>
#include <bit>

namespace alpenglow::accel {

// One for each file compiled from lanes/direct.inc.
const DirectSearch& directSearch_4v2();
const DirectSearch& directSearch_8v3();
const DirectSearch& directSearch_16v4();

const DirectSearch* directSearch(int lanes) {
    static const bool v3 = __builtin_cpu_supports("x86-64-v3"), v4 = __builtin_cpu_supports("x86-64-v4");
    return lanes == 4          ? &directSearch_4v2()
           : lanes == 8 && v3  ? &directSearch_8v3()
           : lanes == 16 && v4 ? &directSearch_16v4()
                               : nullptr;
}

const DirectSearch& directSearch() {
    static const DirectSearch& widest = *[] {
        for (int lanes : {16, 8})
            if (const DirectSearch* s = directSearch(lanes)) return s;
        return directSearch(4);
    }();
    return widest;
}

void Accel::Impl::readyBlocks() {
    const auto scene = std::make_shared<DirectScene>();
    triangles.copyTo(*scene);
    for (int k = 0; k < scene->triangles; ++k) scene->visible[k] = visibility[triangles[size_t(k)].shape];
    scene->balls = int(balls.size());
    for (size_t k = 0; k < balls.size(); ++k) {
        scene->centre[0][k] = balls[k].centre.x, scene->centre[1][k] = balls[k].centre.y, scene->centre[2][k] = balls[k].centre.z;
        scene->radius2[k] = balls[k].radius2;
    }
    blockScene = scene;
}

/// Whether rays can be traced in blocks: no shape is hidden from some rays.
bool Accel::Impl::takesBlocks() const { return blockScene && levels.empty() && trimmed.empty() && !solids; }

/// A new ray that hits all surfaces from both sides.
bool Accel::Impl::beginsPlainly(const Ray& r) const {
    return r.passed < 0 && r.excludeShape == kNone && !r.only && (r.sides == Sides::Both || !anyOneSided) && usable(r);
}

uint32_t Accel::Impl::loadBlock(std::span<const Ray> rays, DirectRays& to) const {
    uint32_t plain = 0;
    for (size_t i = 0; i < size_t(DirectRays::kSize); ++i) {
        const Ray& r = rays[std::min(i, rays.size() - 1)];
        plain |= uint32_t(i < rays.size() && beginsPlainly(r)) << i;
        for (int q = 0; q < 3; ++q) to.org[q][i] = r.org[q], to.dir[q][i] = r.dir[q];
        to.tnear[i] = r.tnear;
        to.tfar[i] = r.tfar;
        to.mask[i] = r.mask;
    }
    return plain;
}

namespace {
/// One ray of a block.
Ray rayOf(const DirectRays& b, int i, float time) {
    Ray r;
    r.org = {b.org[0][i], b.org[1][i], b.org[2][i]};
    r.dir = {b.dir[0][i], b.dir[1][i], b.dir[2][i]};
    r.tnear = b.tnear[i];
    r.tfar = b.tfar[i];
    r.time = time;
    r.mask = b.mask[i];
    r.sides = Sides::Both;
    return r;
}
/// usable() for each.
uint32_t usableOf(const DirectRays& b) {
    uint32_t all = 0;
    for (int i = 0; i < DirectRays::kSize; ++i)
        all |= uint32_t((b.tnear[i] < b.tfar[i]) &
                        usable({b.org[0][i], b.org[1][i], b.org[2][i]}, {b.dir[0][i], b.dir[1][i], b.dir[2][i]}))
               << i;
    return all;
}
} // namespace

void Accel::Impl::nearestInBlock(const DirectRays& block, uint32_t rays, const float* time, Hit* hits) const {
    DirectHits found;
    const uint32_t good = usableOf(block);
    if (rays & good) directSearch().nearest(*blockScene, block, rays & good, found);
    for (; rays; rays &= rays - 1) {
        const int i = std::countr_zero(rays);
        Hit& hit = hits[i];
        hit = Hit();
        if (!(good >> i & 1)) continue;
        if (found.undecided >> i & 1) {
            intersectOne(rayOf(block, i, time[i]), hit);
            continue;
        }
        Best best{found.t[i], kNone, kNone, 0, 0};
        if (const int t = found.triangle[i]; t >= 0)
            best = {found.t[i], triangles[size_t(t)].shape, triangles[size_t(t)].prim, found.b1[i], found.b2[i]};
        uint32_t near = 0;
        for (size_t k = 0; k < balls.size(); ++k) near |= (found.ball[k] >> i & 1) << k;
        if (near) {
            const Ray r = rayOf(block, i, time[i]);
            Query q{&r, best, false};
            for (; near; near &= near - 1) intersectExact(q, balls[size_t(std::countr_zero(near))].shape, 0);
            best = q.best;
        }
        if (best.shape != kNone) hit = {float(best.t), best.shape, best.prim, time[i], best.b1, best.b2, best.t};
    }
}

void Accel::Impl::anyInBlock(const DirectRays& block, uint32_t rays, const float* time, uint8_t* met) const {
    DirectHits found;
    const uint32_t good = usableOf(block);
    if (rays & good) directSearch().any(*blockScene, block, rays & good, found);
    for (; rays; rays &= rays - 1) {
        const int i = std::countr_zero(rays);
        met[i] = good >> i & found.blocked >> i & 1;
        if (!(good >> i & 1) || met[i]) continue;
        uint32_t near = found.undecided >> i & 1 ? ~0u : 0;
        for (size_t k = 0; k < balls.size() && near != ~0u; ++k) near |= (found.ball[k] >> i & 1) << k;
        if (!near) continue;
        const Ray r = rayOf(block, i, time[i]);
        if (near == ~0u) {
            met[i] = occludedOne(r);
            continue;
        }
        Query q{&r, {INFINITY, kNone, kNone, 0, 0}, true};
        for (; near && !met[i]; near &= near - 1) met[i] = intersectExact(q, balls[size_t(std::countr_zero(near))].shape, 0);
    }
}

void Accel::Impl::nearestInBlocks(std::span<const Ray> rays, std::span<Hit> hits) const {
    DirectRays block;
    for (size_t first = 0; first < rays.size(); first += DirectRays::kSize) {
        const auto some = rays.subspan(first, std::min(size_t(DirectRays::kSize), rays.size() - first));
        const uint32_t plain = loadBlock(some, block);
        float time[DirectRays::kSize] = {};
        for (size_t i = 0; i < some.size(); ++i) {
            time[i] = some[i].time;
            if (!(plain >> i & 1)) intersectOne(some[i], hits[first + i]);
        }
        nearestInBlock(block, plain, time, &hits[first]);
    }
}

void Accel::Impl::anyInBlocks(std::span<const Ray> rays, std::span<uint8_t> out) const {
    DirectRays block;
    for (size_t first = 0; first < rays.size(); first += DirectRays::kSize) {
        const auto some = rays.subspan(first, std::min(size_t(DirectRays::kSize), rays.size() - first));
        const uint32_t plain = loadBlock(some, block);
        float time[DirectRays::kSize] = {};
        for (size_t i = 0; i < some.size(); ++i) {
            time[i] = some[i].time;
            if (!(plain >> i & 1)) out[first + i] = occludedOne(some[i]);
        }
        anyInBlock(block, plain, time, &out[first]);
    }
}

bool Accel::takesRows() const { return impl_->direct && impl_->takesBlocks(); }
bool Accel::takesRows(Sides s) const { return s == Sides::Both || !impl_->anyOneSided; }
void Accel::intersect(const DirectRays& block, uint32_t rays, const float* time, Hit* hits) const {
    impl_->nearestInBlock(block, rays, time, hits);
}
void Accel::occluded(const DirectRays& block, uint32_t rays, const float* time, uint8_t* met) const {
    impl_->anyInBlock(block, rays, time, met);
}

} // namespace alpenglow::accel
