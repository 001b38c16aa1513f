// Deep shadow maps in memory: for each pixel how much light from the eye is left at each depth (Lokovic, Veach: Deep Shadow
// Maps, 2000).
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace alpenglow::display {

/// Light that is left behind a depth (camera-space z), channel by channel, 0 to 1.
struct DeepStep {
    float z = 0;
    float left[3] = {1, 1, 1};
};

/// Staircases over depth, pixel by pixel in rows from the top. Before its first step a pixel has all light, behind its last what
/// that leaves.
struct DeepSamples {
    std::vector<uint64_t> first; ///< of each pixel, and behind the last one the number of all steps
    std::vector<DeepStep> steps; ///< of a pixel by increasing z
    /// What is left at a depth: surfaces nearer than that have taken theirs.
    void leftAt(size_t pixel, double z, double out[3]) const;
};

/// A step of one staircase among several.
struct DeepChange {
    float z;
    float before[3], after[3];
};
/// Appends the mean of `count` staircases, given by all their steps in any order, as one staircase that lies nowhere more than
/// `tolerance` (>= 0) above or below it, and ends where it does. `all` is sorted.
void meanStairs(std::vector<DeepChange>& all, size_t count, float tolerance, std::vector<DeepStep>& out);

} // namespace alpenglow::display
