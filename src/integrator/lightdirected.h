// Light-directed phase sampling at surfaces within a medium. Single scattering along a ray at angle a from the direction of a
// light is about 1 / sin a, so sampling the lobe alone has unbounded variance. A share of the samples is therefore uniform in
// that angle.
#pragma once
#include "base/vec.h"
#include "bsdf/lobe.h"
#include "integrator/names.h"
#include <optional>

namespace alpenglow::integrator {

/// The mixture of lobe and light direction at one point.
struct LightDirected {
    Vec3 light;      ///< unit, toward the light, if there is one
    float share = 0; ///< probability of sampling toward the light; 0: no light

    /// Mixture density of direction w, per steradian. ofLobe: density of the lobe alone.
    float density(const Vec3& w, float ofLobe) const;
    /// A direction sampled around the light by u. Without a value, u has been rescaled for sampling the lobe.
    std::optional<Vec3> draw(Vec2& u) const;
    /// Reduces the share where the lobe reflects little of this light. v: value of the lobe toward the light.
    void weigh(const LobeValue& v) { share *= v.fcos > 0 && v.pdf > 0 ? std::min(1.f, v.pdf * float(kPi)) : 0; }
};

} // namespace alpenglow::integrator
