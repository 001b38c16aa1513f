// The position of a primitive in a solid (RISpec 3.2, "Solids"): a path from the outermost SolidBegin to the part that it bounds,
// kept among its attributes, so that instances have it as well.
#pragma once
#include "scene/primitive.h"

namespace alpenglow::scene {

/// Empty outside of solids.
inline const std::vector<SolidStep>& solidPath(const Attributes& a) { return a.solid; }
/// Whether the inside of a part is what the whole lacks: an odd number of blocks around it are taken away from another.
inline bool solidTakenAway(const Attributes& a) {
    bool away = false;
    for (size_t i = 1; i < a.solid.size(); ++i)
        away ^= a.solid[i - 1].operation == SolidOperation::Difference && a.solid[i].child > 0;
    return away;
}

} // namespace alpenglow::scene
