// Shutter opening over time.
#pragma once
#include "base/diagnostics.h"
#include "scene/fwd.h"

namespace alpenglow::render {

/// Option "shutter" "float[2] shutteropening" [a b]: fully open from fraction a of its time to fraction b; opens and closes
/// linearly before and after.
struct ShutterOpening {
    double wide = 0, closing = 1; ///< a and b
    ShutterOpening() = default;
    /// Values other than 0 <= a <= b <= 1 are reported; the shutter then opens and closes at once.
    ShutterOpening(const scene::Options&, Diagnostics&);
    /// Time of a sample, 0 to 1, from a number in [0, 1): more samples where the shutter is wider open.
    double at(double u) const;
};

} // namespace alpenglow::render
