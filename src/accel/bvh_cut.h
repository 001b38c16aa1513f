// Splits ranges of references in two: surface area heuristic over bins of centroids. Internal to accel.
#pragma once
#include "accel/bvh_refs.h"
#include <cstdint>

namespace alpenglow::accel {

/// Four integers in one register.
typedef int32_t Whole4 __attribute__((vector_size(16)));
/// The same number in every lane.
inline Four all4(float f) { return Four{f, f, f, f}; }

/// By axis: which of `last` + 1 equal steps from `from` on contains the centre. Values without an integer go to the first or last
/// step.
inline Whole4 stepsOf(Four twiceCentre, Four from, Four scale, Four last) {
    return __builtin_convertvector(least(most((twiceCentre - from) * scale, Four{}), last), Whole4);
}

/// The axis and the bins before it; axis -1: nothing divides the centres.
struct Cut {
    static constexpr int kBins = 16;      ///< most bins of an axis
    int axis = -1, bin = 0, bins = kBins; ///< references of bins below `bin` go to the left
    Four from{}, scale{};                 ///< the bin of twice a centre c is (c - from) * scale
    Box below, above;                     ///< of the contents
    /// Whether binsOf() is below `bin` along the axis.
    bool isBelow(Four twiceCentre) const {
        return !((twiceCentre[axis] - from[axis]) * scale[axis] >= float(bin)); // true for NaN
    }
    /// By axis: the bin that contains the centre.
    Whole4 binsOf(Four twiceCentre) const { return stepsOf(twiceCentre, from, scale, all4(float(bins - 1))); }
};

/// The cut of least cost by the surface area heuristic; axis -1 if all centres are in one bin.
Cut bestCut(const Ref* refs, const Range&);
/// Moves references below a cut to the front; returns the start of the others. a, b: boxes of their centres.
size_t partition(Ref* refs, const Range&, const Cut&, Range& a, Range& b);
/// Splits a range, without `leaf`. Returns false if no cut divides it.
bool cutInTwo(Ref* refs, const Range&, Range& a, Range& b);
/// A range with its boxes, without `leaf`.
Range measuredRange(const Ref* refs, size_t begin, size_t end);

} // namespace alpenglow::accel
