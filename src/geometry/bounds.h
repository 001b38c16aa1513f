// Axis-aligned boxes.
#pragma once
#include "base/matrix.h"
#include "base/vec.h"
#include <algorithm>
#include <limits>

namespace alpenglow::geometry {

/// Empty when lo > hi.
struct Bounds {
    /// Corners.
    Vec3 lo{std::numeric_limits<float>::infinity()}, hi{-std::numeric_limits<float>::infinity()};
    /// Also with a corner that is NaN.
    bool empty() const { return !(lo.x <= hi.x && lo.y <= hi.y && lo.z <= hi.z); }
    /// Extends the box to a point. A coordinate that is NaN changes nothing.
    void add(const Vec3& p) {
        for (int i = 0; i < 3; ++i) {
            lo[i] = std::min(lo[i], p[i]);
            hi[i] = std::max(hi[i], p[i]);
        }
    }
    /// An empty box has no effect.
    void add(const Bounds& b) {
        if (b.empty()) return;
        add(b.lo);
        add(b.hi);
    }
};

} // namespace alpenglow::geometry
