// Where a primitive stands in a solid (RISpec 3.2, "Solids"): a path from the outermost SolidBegin to the part that it bounds,
// kept among its attributes, so that instances have it as well.
#pragma once
#include "scene/primitive.h"

namespace alpenglow::scene {

/// Key in Attributes::values. Its numbers: for each block from the outermost its number, its operation and which child of the one
/// before it is; behind them how many children the innermost has had. No request can set it.
inline constexpr const char* kSolidAttribute = "solid:__path";

enum class SolidOperation { Part, Union, Intersection, Difference };

struct SolidStep {
    uint32_t id;
    SolidOperation operation;
    int child;
};
/// Empty outside of solids.
inline std::vector<SolidStep> solidPath(const Attributes& a) {
    std::vector<SolidStep> path;
    if (const Param* p = a.value(kSolidAttribute))
        for (size_t i = 0; i + 3 < p->numbers.size(); i += 3)
            path.push_back({uint32_t(p->numbers[i]), SolidOperation(int(p->numbers[i + 1])), int(p->numbers[i + 2])});
    return path;
}
/// Whether the inside of a part is what the whole lacks: an odd number of blocks around it are taken away from another.
inline bool solidTakenAway(const Attributes& a) {
    bool away = false;
    const std::vector<SolidStep> path = solidPath(a);
    for (size_t i = 1; i < path.size(); ++i) away ^= path[i - 1].operation == SolidOperation::Difference && path[i].child > 0;
    return away;
}

} // namespace alpenglow::scene
