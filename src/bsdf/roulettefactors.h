// How strongly Russian roulette ends the paths of a frame, by bounce (docs/noise.md).
#pragma once
#include <algorithm>

namespace alpenglow::bsdf {

/// A ray of a path goes on with probability min(1, factor sqrt(m)), where m is the largest channel of its throughput.
struct RouletteFactors {
    static constexpr int kBounces = 8;      ///< later bounces have the last factor
    static constexpr float kUsual = 1.5f;   ///< from the fourth bounce on, if nothing is known of the frame
    static constexpr float kAlways = 1e30f; ///< the ray goes on whatever it carries
    /// By number of bounces, the camera ray's is 0; > 0.
    float factors[kBounces] = {kAlways, kAlways, kAlways, kAlways, kUsual, kUsual, kUsual, kUsual};
    float at(int bounces) const { return factors[std::clamp(bounces, 0, kBounces - 1)]; }
    bool always(int bounces) const { return at(bounces) >= kAlways; }
    bool operator==(const RouletteFactors&) const = default;
};

} // namespace alpenglow::bsdf
