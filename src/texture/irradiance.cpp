// indirectdiffuse(map, direction): cosine-weighted mean of an environment map around a direction. Each map becomes a table of
// cells with their sum of light times direction: exact for a cell entirely above the plane, regardless of its contents.
#include "texture/irradiance.h"
#include "base/exact.h"

namespace alpenglow::texture {

namespace {
constexpr int kAround = 64, kDown = 32, kInside = 8; ///< cells, and directions along a side of each
} // namespace

IrradianceTable::IrradianceTable(Handle map, const LatLong& axes) {
    if (!map) return;
    LookupOptions colours;
    colours.asLight = true;
    colours.filter = Filter::Box;
    cells_.resize(kAround * kDown);
    for (int y = 0; y < kDown * kInside; ++y) {
        // Uniform in height: all directions represent equal solid angles.
        const float z = 1 - 2 * (float(y) + .5f) / float(kDown * kInside), r = std::sqrt(std::max(0.f, 1 - z * z));
        for (int x = 0; x < kAround * kInside; ++x) {
            const double turn = 2 * kPi * (x + .5) / (kAround * kInside);
            const Vec2 d(float(exact::cos(turn)), float(exact::sin(turn)));
            const Vec3 w(r * d.x, r * d.y, z);
            const Vec3 around = Vec3(-d.y, d.x, 0) * (r * float(2 * kPi) / float(kAround * kInside));
            const Vec3 down = Vec3(-z * d.x, -z * d.y, r) * (2 / float(kDown * kInside) / std::max(r, 1e-3f));
            float v[3] = {};
            environment(map, axes, 0, 3, w, around, down, colours, v);
            Cell& c = cells_[size_t(y / kInside * kAround + x / kInside)];
            for (int k = 0; k < 3; ++k) c.light[k] += w * (v[k] * 4 / float(kAround * kInside * kDown * kInside));
        }
    }
}

Color IrradianceTable::about(const Vec3& n) const {
    Color sum(0);
    for (const Cell& c : cells_)
        for (int k = 0; k < 3; ++k) sum[k] += std::max(0.f, dot(c.light[k], n));
    return sum;
}

const IrradianceTable& IrradianceTables::of(Handle map, const LatLong& axes) const {
    std::lock_guard lock(mutex_);
    auto& t = tables_[map];
    if (!t) t = std::make_unique<IrradianceTable>(map, axes);
    return *t;
}

} // namespace alpenglow::texture
