// Upper levels of a tree over a large range: splits groups of some hundred or thousand references. Internal to accel.
#pragma once
#include "accel/bvh_refs.h"
#include <vector>

namespace alpenglow::accel {

/// A node of the upper levels.
struct Half {
    Range range;               ///< references below the node
    int left = -1, right = -1; ///< -1: a group
};

/// Puts the references of a range into the cells of a grid over their centres and divides non-empty cells recursively down to
/// single ones. Reorders the references, so that all ranges are consecutive; the first of the list is the complete range. Empty:
/// one cell holds all. depth: of halves by cost; deeper ones are halves by number.
std::vector<Half> inGroups(Ref* refs, const Range&, int depth);

} // namespace alpenglow::accel
