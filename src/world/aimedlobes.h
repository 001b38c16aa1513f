// A mixture of lobes over directions that aim at points, so that it is valid from anywhere near where it was fitted. After
// Ruppert et al., "Robust Fitting of Parallax-Aware Mixtures for Path Guiding" (2020).
#pragma once
#include "base/vec.h"
#include "world/names.h"
#include <cstddef>
#include <span>

namespace alpenglow::world {

/// Stored in rows, by lobe. The density around an axis falls as 1 / (1 + k (1 - cosine))^2: its tail covers what few photons
/// showed.
struct alignas(32) AimedLobes {
    static constexpr int kMost = 8; ///< most lobes
    float aim[3][kMost] = {};       ///< centres of the lobes: points, camera space
    float perRadius2[kMost] = {};   ///< two over the squared size that a lobe covers around its aim
    float share[kMost] = {};        ///< mixture weight; 0: unused

    /// Light that came to P from `aim`.
    struct Target {
        Vec3 P, aim;
        float power; ///< > 0
    };
    /// Fits lobes to one target or more. scale: size of the scene; least distance of an aim is a millionth of it.
    static AimedLobes fit(std::span<const Target>, float scale);
    /// Lobes in use.
    int count() const;
    /// Density of draw() per steradian. w: unit, from P.
    float density(const Vec3& P, const Vec3& w) const;
    /// Samples a direction from P. u: each in [0, 1).
    Vec3 draw(const Vec3& P, Vec2 u) const;
};

} // namespace alpenglow::world
