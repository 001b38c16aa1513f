// Small scenes, a block of rays at a time. What float bounds do not decide goes ray by ray (Accel::Impl::meetDirect), with the
// same bits.
#include "accel/directblock.h"
#include "accel/impl.h"
#include <algorithm>
#include <bit>

namespace alpenglow::accel {

// One for each file made from lanes/direct.inc.
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
    triangles.tell(*scene);
    for (int k = 0; k < scene->triangles; ++k) scene->visible[k] = visibility[triangles[size_t(k)].shape];
    scene->balls = int(balls.size());
    for (size_t k = 0; k < balls.size(); ++k) {
        scene->centre[0][k] = balls[k].centre.x, scene->centre[1][k] = balls[k].centre.y, scene->centre[2][k] = balls[k].centre.z;
        scene->radius2[k] = balls[k].radius2;
    }
    blockScene = scene;
}

/// Whether rays of a scene go in blocks: nothing of it is left out by who asks from where.
bool Accel::Impl::takesBlocks() const { return blockScene && levels.empty() && trimmed.empty() && !solids; }

/// A ray that begins, and meets all surfaces from both sides.
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

void Accel::Impl::nearestInBlocks(std::span<const Ray> rays, std::span<Hit> hits) const {
    DirectRays block;
    DirectHits found;
    for (size_t first = 0; first < rays.size(); first += DirectRays::kSize) {
        const auto some = rays.subspan(first, std::min(size_t(DirectRays::kSize), rays.size() - first));
        const uint32_t plain = loadBlock(some, block);
        if (plain) directSearch().nearest(*blockScene, block, plain, found);
        for (size_t i = 0; i < some.size(); ++i) {
            const Ray& r = some[i];
            Hit& hit = hits[first + i];
            if (!(plain >> i & 1) || (found.undecided >> i & 1)) {
                intersectOne(r, hit);
                continue;
            }
            Query q{&r, {found.t[i], kNone, kNone, 0, 0}, false};
            if (const int t = found.triangle[i]; t >= 0)
                q.best = {found.t[i], triangles[size_t(t)].shape, triangles[size_t(t)].prim, found.b1[i], found.b2[i]};
            for (size_t k = 0; k < balls.size(); ++k)
                if (found.ball[k] >> i & 1) meetExact(q, balls[k].shape, 0);
            hit = Hit();
            if (q.best.shape != kNone) hit = {float(q.best.t), q.best.shape, q.best.prim, r.time, q.best.b1, q.best.b2, q.best.t};
        }
    }
}

void Accel::Impl::anyInBlocks(std::span<const Ray> rays, std::span<uint8_t> out) const {
    DirectRays block;
    DirectHits found;
    for (size_t first = 0; first < rays.size(); first += DirectRays::kSize) {
        const auto some = rays.subspan(first, std::min(size_t(DirectRays::kSize), rays.size() - first));
        const uint32_t plain = loadBlock(some, block);
        if (plain) directSearch().any(*blockScene, block, plain, found);
        for (size_t i = 0; i < some.size(); ++i) {
            if (!(plain >> i & 1) || (found.undecided >> i & 1)) {
                out[first + i] = occludedOne(some[i]);
                continue;
            }
            bool met = found.blocked >> i & 1;
            Query q{&some[i], {INFINITY, kNone, kNone, 0, 0}, true};
            for (size_t k = 0; k < balls.size() && !met; ++k)
                if (found.ball[k] >> i & 1) met = meetExact(q, balls[k].shape, 0);
            out[first + i] = met;
        }
    }
}

} // namespace alpenglow::accel
