// Deep shadow maps in memory: transmittance over depth for each pixel (Lokovic, Veach: Deep Shadow Maps, 2000).
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace alpenglow::display {

/// Transmittance behind a depth (camera-space z), by channel, 0 to 1.
struct DeepStep {
    float z = 0;
    float transmittance[3] = {1, 1, 1}; ///< red, green, blue
};

/// Transmittance over depth as a staircase, pixel by pixel in rows from the top: 1 before the first step, constant after the
/// last.
struct DeepSamples {
    std::vector<uint64_t> first; ///< of each pixel, and behind the last one the number of all steps
    std::vector<DeepStep> steps; ///< of a pixel by increasing z
    /// Transmittance at a depth, including surfaces nearer than it.
    void transmittanceAt(size_t pixel, double z, double out[3]) const;
};

/// A step of one staircase among several.
struct DeepChange {
    float z;                   ///< depth of the step, camera space
    float before[3], after[3]; ///< transmittance by channel, in front of the step and behind it
};
/// Appends the mean of `count` staircases, given by all their steps in any order, as one staircase that deviates from it by at
/// most `tolerance` (>= 0), and ends at its final value. Sorts `all`.
void meanStairs(std::vector<DeepChange>& all, size_t count, float tolerance, std::vector<DeepStep>& out);

} // namespace alpenglow::display
