// Rays that leave surfaces in a medium and pass a light there: what they find is about 1 / sine of the angle that they are off
// its direction, so that draws by a lobe alone bring it with a variance without bound. A part of the draws is even in that angle.
#pragma once
#include "base/vec.h"
#include "lobes/lobe.h"
#include <optional>

namespace alpenglow::transport {

struct Beside {
    Vec3 light;      ///< unit, toward it; where there is one
    float share = 0; ///< of the draws; 0: there is none

    /// The density of draws toward w, of which those of the lobe alone have `ofLobe`.
    float density(const Vec3& w, float ofLobe) const;
    /// A direction beside the light by u, or nothing: then u is for the lobe.
    std::optional<Vec3> draw(Vec2& u) const;
    /// Fewer draws the less the lobe gives back from the light, whose value this is.
    void weigh(const LobeValue& v) { share *= v.fcos > 0 && v.pdf > 0 ? std::min(1.f, v.pdf * float(kPi)) : 0; }
};

} // namespace alpenglow::transport
