// The same templates at 16 lanes (8 on a processor without such vectors: CMakeLists.txt): every lane has the bits of the
// program's 4-lane copy, on ordinary and on odd inputs.
#ifndef ALPENGLOW_LANES
#define ALPENGLOW_LANES 16
#endif
#include "jets_runtime.h"
#include "shadeops/descriptor.h"
#include "shadeops/runtime.h"
#include <cmath>
#include <cstring>
#include <functional>
#include <gtest/gtest.h>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace wide_lanes_test {

using namespace alpenglow::shadeops;

namespace {

bool sameBits(float a, float b) { return (std::isnan(a) && std::isnan(b)) || std::memcmp(&a, &b, sizeof a) == 0; }

void compareAll(const std::function<float()>& draw, int rounds) {
    static constexpr int kParts[] = {1, 3, 6};
    for (const auto& entry : AL_NAMESPACE::kEntries)
        for (int order = 0; order < 3; ++order)
            for (int round = 0; round < rounds; ++round) {
                const int in = entry.in * kParts[order], out = entry.out * kParts[order];
                std::vector<AL_NAMESPACE::vf> a(in), r(out);
                for (auto& x : a)
                    for (int lane = 0; lane < ALPENGLOW_LANES; ++lane) x[lane] = draw();
                entry.order[order](a.data(), r.data());
                for (int lane = 0; lane < ALPENGLOW_LANES; lane += 5) {
                    std::vector<float> one(in), result(out);
                    for (int i = 0; i < in; ++i) one[i] = a[i][lane];
                    ASSERT_TRUE(evaluateRuntimeJet(entry.symbol, order, one.data(), in, result.data(), out)) << entry.symbol;
                    for (int i = 0; i < out; ++i)
                        ASSERT_TRUE(sameBits(r[i][lane], result[i]))
                            << entry.symbol << " order " << order << " output " << i << ": " << r[i][lane] << " " << result[i];
                }
            }
}

TEST(WideLanes, SameBitsAsFourLanes) {
    std::mt19937 random(3);
    compareAll([&] { return -4 + 8 * std::generate_canonical<float, 24>(random); }, 2);
}

// 0, -0, infinities, not-a-number, denormals, huge and tiny numbers: no trap, and still the same bits.
TEST(WideLanes, OddInputsNeitherTrapNorDiffer) {
    const float odd[] = {0.0f,     -0.0f,  INFINITY, -INFINITY, NAN,  1e-45f, -1e-40f, 3.4e38f,
                         -3.4e38f, 1e-38f, 1,        -1,        0.5f, 1e9f,   -1e20f,  2147483648.0f};
    std::mt19937 random(4);
    compareAll([&] { return odd[random() % (sizeof odd / sizeof *odd)]; }, 4);
}

} // namespace

} // namespace wide_lanes_test
