#include "world/objectbox.h"
#include "base/exact.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::world {
namespace {

struct Box {
    std::array<float, 6> b{INFINITY, -INFINITY, INFINITY, -INFINITY, INFINITY, -INFINITY};
    bool any = false;
    void add(float x, float y, float z) {
        const float p[3] = {x, y, z};
        if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(z)) return;
        any = true;
        for (size_t k = 0; k < 3; ++k) {
            b[2 * k] = std::min(b[2 * k], p[k]);
            b[2 * k + 1] = std::max(b[2 * k + 1], p[k]);
        }
    }
    /// Adds a solid of revolution about z.
    void turn(float radius, float from, float to) {
        add(-std::fabs(radius), -std::fabs(radius), from);
        add(std::fabs(radius), std::fabs(radius), to);
    }
};

void addQuadric(const scene::Primitive& p, Box& box) {
    const auto n = [&](size_t i) { return i < p.numbers.size() ? p.numbers[i] : 0.f; };
    if (p.kind == "Sphere") {
        const float r = std::fabs(n(0));
        box.turn(r, std::clamp(n(1), -r, r), std::clamp(n(2), -r, r));
    } else if (p.kind == "Cone") {
        box.turn(n(1), 0, n(0));
    } else if (p.kind == "Cylinder" || p.kind == "Paraboloid") {
        box.turn(n(0), n(1), n(2));
    } else if (p.kind == "Hyperboloid") {
        box.turn(std::max(exact::hypot(n(0), n(1)), exact::hypot(n(3), n(4))), n(2), n(5));
    } else if (p.kind == "Disk") {
        box.turn(n(1), n(0), n(0));
    } else if (p.kind == "Torus") {
        box.turn(std::fabs(n(0)) + std::fabs(n(1)), -std::fabs(n(1)), std::fabs(n(1)));
    } else if (p.kind == "Volume" && p.numbers.size() >= 6) {
        box.add(n(0), n(2), n(4));
        box.add(n(1), n(3), n(5));
    }
}

void addOf(const scene::Primitive& p, Box& box) {
    addQuadric(p, box);
    if (const scene::Param* points = scene::find(p.params, "P"))
        for (size_t i = 0; i + 2 < points->numbers.size(); i += 3)
            box.add(points->numbers[i], points->numbers[i + 1], points->numbers[i + 2]);
    if (const scene::Param* points = scene::find(p.params, "Pw"))
        for (size_t i = 0; i + 3 < points->numbers.size(); i += 4) {
            const float w = points->numbers[i + 3];
            box.add(points->numbers[i] / w, points->numbers[i + 1] / w, points->numbers[i + 2] / w);
        }
}

} // namespace

std::optional<std::array<float, 6>> objectBox(const scene::Primitive& p) {
    Box box;
    addOf(p, box);
    for (const auto& key : p.motionKeys) addOf(*key, box);
    if (!box.any) return std::nullopt;
    return box.b;
}

} // namespace alpenglow::world
