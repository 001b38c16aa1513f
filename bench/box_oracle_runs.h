// The oracle's side of box_bench. Each function is compiled on its own: with the count of rays and without.
#pragma once
#include <cstdint>
#include <functional>
#include <vector>

namespace alpenglow::bench {

struct OracleRun {
    int width = 0, height = 0;
    uint32_t samples = 0;      ///< of each pixel
    bool sameSequences = true; ///< numbers of the renderer's own sampler; else a Mersenne twister's
    int freeBounces = 4;       ///< roulette behind it
    bool rootRoulette = false; ///< by the renderer's rule, 1.5 sqrt(throughput); else by the throughput
};
/// Sums of the pixels, three floats each; returns the mean of all.
double runOracle(const OracleRun&, std::vector<double>& sums);
using OracleRunner = std::function<double(const OracleRun&, std::vector<double>& sums)>;
/// runOracle() with rays that meet the box through Embree, whose scene is built here.
OracleRunner oracleThroughEmbree();
/// Rays per sample of the same run.
double oracleRays(const OracleRun&);

} // namespace alpenglow::bench
