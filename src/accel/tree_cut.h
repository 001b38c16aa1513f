// Where a range of references is cut in two: surface area heuristic over bins of centroids. Not for other rooms.
#pragma once
#include "accel/tree_refs.h"
#include <cstdint>

namespace alpenglow::accel {

typedef int32_t Whole4 __attribute__((vector_size(16)));
inline Four all4(float f) { return Four{f, f, f, f}; }

/// By axis, which of `last` + 1 equal steps from `from` on holds what is there. No float's bits: what has no whole number goes to
/// a step at an end.
inline Whole4 stepsOf(Four twiceCentre, Four from, Four scale, Four last) {
    return __builtin_convertvector(least(most((twiceCentre - from) * scale, Four{}), last), Whole4);
}

/// The axis and the bins before it; axis -1: nothing divides the centres.
struct Cut {
    static constexpr int kBins = 16;
    int axis = -1, bin = 0, bins = kBins;
    Four from{}, scale{};
    Box below, above; ///< of what lies there
    /// Whether binsOf() is below `bin` along the axis.
    bool isBelow(Four twiceCentre) const {
        return !((twiceCentre[axis] - from[axis]) * scale[axis] >= float(bin)); // so is what is not a number
    }
    Whole4 binsOf(Four twiceCentre) const { return stepsOf(twiceCentre, from, scale, all4(float(bins - 1))); }
};

Cut bestCut(const Ref* refs, const Range&);
/// Those below a cut to the front; returns where the others begin. a, b: boxes of their centres.
size_t partition(Ref* refs, const Range&, const Cut&, Range& a, Range& b);
/// Both halves of a range, without `leaf`. False: no cut divides it.
bool cutInTwo(Ref* refs, const Range&, Range& a, Range& b);
/// The range with its boxes, without `leaf`.
Range measuredRange(const Ref* refs, size_t begin, size_t end);

} // namespace alpenglow::accel
