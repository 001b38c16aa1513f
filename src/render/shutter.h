// How a shutter opens.
#pragma once
#include "base/diagnostics.h"
#include "scene/fwd.h"

namespace alpenglow::render {

/// Option "shutter" "float[2] shutteropening" [a b]: it is wide open from the part a of its time to the part b; before and after,
/// it opens and closes linearly.
struct ShutterOpening {
    double wide = 0, closing = 1;
    ShutterOpening() = default;
    /// What is not 0 <= a <= b <= 1 is reported, and the shutter opens and closes at once.
    ShutterOpening(const scene::Options&, Diagnostics&);
    /// The part of the time, 0 to 1, of a sample with a number of [0, 1): more samples where the shutter is wider open.
    double at(double u) const;
};

} // namespace alpenglow::render
