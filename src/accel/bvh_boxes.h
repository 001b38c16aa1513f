// Boxes during construction of trees. Internal to accel.
#pragma once
#include "accel/bvh.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::accel {

/// Four floats in one register: x, y, z and a lane for other use.
typedef float Four __attribute__((vector_size(16)));

/// Component-wise minimum and maximum.
inline Four least(Four a, Four b) { return a < b ? a : b; }
inline Four most(Four a, Four b) { return a > b ? a : b; }
inline constexpr float kHuge = 3e38f; ///< beyond every coordinate of a box

/// A box under construction, empty at first; the fourth lane is not used.
struct Box {
    Four lo{kHuge, kHuge, kHuge, kHuge}, hi{-kHuge, -kHuge, -kHuge, -kHuge}; ///< corners
    /// Extends the box to contain another.
    void add(Four l, Four h) { lo = least(lo, l), hi = most(hi, h); }
    void add(const Box& b) { add(b.lo, b.hi); }
    /// Half the surface area; 0 if the box is empty.
    double halfArea() const {
        const Four d = hi - lo;
        return d[0] < 0 ? 0 : double(d[0]) * d[1] + double(d[1]) * d[2] + double(d[2]) * d[0];
    }
};

/// Sets the boxes of children, rounded outwards to 8 bits relative to their node's.
inline void setBoxes(Bvh::Node& node, const Box& all, std::span<const Box> child) {
    node = Bvh::Node{};
    std::fill_n(node.child, Bvh::kWidth, Bvh::kNothing);
    // Wider than the error of a ray along a flat box, and than rounding.
    double most = 1e-30;
    for (int a = 0; a < 3; ++a) most = std::max({most, std::fabs(double(all.lo[a])), std::fabs(double(all.hi[a]))});
    const double pad = most * 0x1p-21;
    for (int a = 0; a < 3; ++a) {
        const float origin = float(all.lo[a] - 2 * pad);
        const float scale = float((double(all.hi[a]) + 2 * pad - origin) / 254.9);
        node.origin[a] = origin;
        node.scale[a] = scale;
        for (size_t k = 0; k < child.size(); ++k) {
            const double lo = (double(child[k].lo[a]) - pad - origin) / scale,
                         hi = (double(child[k].hi[a]) + pad - origin) / scale;
            node.q[0][a][k] = uint8_t(std::clamp(std::floor(lo), 0.0, 255.0));
            node.q[1][a][k] = uint8_t(std::clamp(std::ceil(hi), 0.0, 255.0));
        }
    }
}

} // namespace alpenglow::accel
