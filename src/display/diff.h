// Comparison of two pictures (`alpenglow diff a b`).
#pragma once
#include "base/diagnostics.h"
#include "display/image.h"
#include <string>
#include <vector>

namespace alpenglow::display {

/// Errors of a channel over all pixels, in the units of the pictures. Pixels where both are the same (also both NaN or the same
/// infinity) differ by 0; where exactly one is not finite, they count in nonFinite and nowhere else.
struct ChannelDiff {
    std::string name;                      ///< name of the channel
    double meanAbs = 0, rmse = 0, max = 0; ///< absolute errors, in the units of the pictures
    double meanA = 0, meanB = 0;           ///< over pixels finite in both
    int maxX = 0, maxY = 0;                ///< first pixel, in reading order, of the largest error
    size_t nonFinite = 0;
};

/// What a comparison found.
struct DiffResult {
    std::vector<ChannelDiff> channels; ///< in the order of the first picture
    ChannelDiff all;                   ///< over every sample; its name is "all"
    Image difference;                  ///< absolute difference per sample; infinity where it is counted in nonFinite
    /// Whether the largest error is at most `tolerance` and nonFinite is 0.
    bool within(double tolerance) const { return all.nonFinite == 0 && all.max <= tolerance; }
};

/// Matches channels by name if both pictures have the same names, else by position if they have equally many. Returns nothing,
/// with an error reported, if sizes or channel counts differ.
std::optional<DiffResult> compareImages(const Image& a, const Image& b, Diagnostics&);

/// One line per channel and one for all: name, mean absolute, RMSE, maximum and its pixel.
std::string toString(const DiffResult&);

} // namespace alpenglow::display
