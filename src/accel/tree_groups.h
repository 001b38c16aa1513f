// The upper levels of a tree over a large range: over groups of references, some hundred or thousand, instead of all of them. Not
// for other rooms.
#pragma once
#include "accel/tree_refs.h"
#include <vector>

namespace alpenglow::accel {

struct Half {
    Range range;
    int left = -1, right = -1; ///< -1: a group
};

/// Puts the references of a range into the cells of a grid over their centres; the cells that hold some are divided in two again
/// and again down to single ones. All ranges are in the order of the references then, which is changed; the first of the list is
/// the whole. Empty: one cell holds all of them. depth: of halves by cost, below they are halves by number.
std::vector<Half> inGroups(Ref* refs, const Range&, int depth);

} // namespace alpenglow::accel
