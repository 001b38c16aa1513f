// Small scenes: searches queued rays in rows of 16 (accel/directblock.h).
#include "accel/directblock.h"
#include "integrator/gridrays.h"
#include "integrator/intersector.h"
#include "integrator/raywords.h"
#include "lanes/stages.h"
#include <algorithm>

namespace alpenglow::integrator {

static_assert(accel::DirectRays::kSize == kBlock);

/// Row version of cast(). Returns false if a ray needs more than rows hold.
bool Intersector::castRows(std::span<const Sched::Task> slice) {
    if (!inRows_) return false;
    if (grids_ && std::any_of(slice.begin(), slice.end(), [](const Sched::Task& t) { return beginsAtGrid(t.payload); }))
        return false;
    constexpr int kWords = 16; // PathRay::origin to media
    hits.resize(slice.size());
    uint64_t of[4] = {}; // by RayType
    alignas(64) RayBlock rays;
    accel::DirectRays block;
    std::fill_n(block.tnear, kBlock, 0.f);
    for (size_t first = 0; first < slice.size(); first += kBlock) {
        const int n = int(std::min(slice.size() - first, size_t(kBlock)));
        lanes::stages().load(&slice[first].payload, int(sizeof(Sched::Task)), n, kWords, rays.origin);
        float time[kBlock];
        for (int i = 0; i < n; ++i) {
            const RayKind& kind = *slice[first + size_t(i)].payload.kind;
            if (kind.set.only || !world_.accel().takesRows(kind.set.sides)) return false;
            block.mask[i] = visibilityBit(kind.type);
            time[i] = slice[first + size_t(i)].payload.sample->shutter;
            ++of[size_t(kind.type)];
        }
        std::fill(block.mask + n, block.mask + kBlock, 0u);
        for (int q = 0; q < 3; ++q) {
            std::copy_n(rays.origin[q], kBlock, block.org[q]);
            std::copy_n(rays.direction[q], kBlock, block.dir[q]);
        }
        std::copy_n(rays.maxDistance, kBlock, block.tfar);
        world_.accel().intersect(block, (1u << n) - 1, time, &hits[first]);
    }
    for (const RayType t : {RayType::Camera, RayType::Diffuse, RayType::Specular, RayType::Transmission})
        context_.raysOf(t) += of[size_t(t)];
    counters_.tests += slice.size();
    for (const accel::Hit& h : hits) counters_.hits += h.valid();
    return true;
}

bool Intersector::blockInRows(std::span<const ShadowRay> asked, std::span<Color> out) {
    if (!inRows_) return false;
    const auto plain = [&](const ShadowRay& s) { return !s.kind->set.only && world_.accel().takesRows(s.kind->set.sides); };
    if (!std::all_of(asked.begin(), asked.end(), plain)) return false;
    constexpr int kWords = 16; // from ShadowRay::origin; dir and distance follow
    static_assert(offsetof(ShadowRay, dir) == 12 && offsetof(ShadowRay, distance) == 24);
    alignas(64) Row rows[kWords];
    accel::DirectRays block;
    std::fill_n(block.tnear, kBlock, 0.f);
    uint8_t met[kBlock];
    for (size_t first = 0; first < asked.size(); first += kBlock) {
        const int n = int(std::min(asked.size() - first, size_t(kBlock)));
        lanes::stages().load(&asked[first], int(sizeof(ShadowRay)), n, kWords, rows);
        for (int q = 0; q < 3; ++q) {
            std::copy_n(rows[q], kBlock, block.org[q]);
            std::copy_n(rows[3 + q], kBlock, block.dir[q]);
        }
        std::copy_n(rows[6], kBlock, block.tfar);
        float time[kBlock];
        std::fill_n(block.mask, kBlock, 0u);
        for (int i = 0; i < n; ++i) {
            const ShadowRay& ray = asked[first + size_t(i)];
            block.mask[i] = visibilityBit(ray.kind->type);
            time[i] = ray.time;
        }
        world_.accel().occluded(block, (1u << n) - 1, time, met);
        for (int i = 0; i < n; ++i) {
            out[first + size_t(i)] = met[i] ? Color(0) : Color(1);
            counters_.hits += met[i];
        }
        if (context_.stop && *context_.stop) break; // the result is undefined
    }
    counters_.tests += asked.size();
    return true;
}

} // namespace alpenglow::integrator
