// base/exactlanes.h: the bits of base/exact.h at every width.
#include "base/exact.h"
#include "base/exactlanes.h"
#include <bit>
#include <cstdint>
#include <gtest/gtest.h>
#include <random>
#include <vector>

namespace exactlanes_test {

namespace {
using namespace alpenglow;
typedef double Two __attribute__((ext_vector_type(2)));
typedef double Four __attribute__((ext_vector_type(4)));
typedef double Eight __attribute__((ext_vector_type(8)));

bool same(double a, double b) { return std::bit_cast<uint64_t>(a) == std::bit_cast<uint64_t>(b); }

/// Numbers of every size, with those where signs and scales decide.
std::vector<double> numbers(double most) {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> even(-most, most), size(-1070, std::log2(most));
    std::vector<double> all = {0, -0.0, 1, -1, .5, 1 / 32., 3 / 32., 0x1p-1074, -0x1p-1074, 0x1p-901, most, -most};
    while (all.size() < 1600) {
        all.push_back(even(random));
        all.push_back(std::copysign(std::exp2(size(random)), even(random)));
    }
    return all;
}

template <class V> void compareAngles() {
    constexpr size_t kLanes = sizeof(V) / sizeof(double);
    const std::vector<double> all = numbers(0x1p1020);
    for (size_t step : {size_t(0), size_t(1), size_t(7), size_t(12)}) // with itself, and with others
        for (size_t i = 0; i + kLanes <= all.size(); i += kLanes) {
            V y, x;
            for (size_t k = 0; k < kLanes; ++k) y[k] = all[i + k], x[k] = all[(i + k + step) % all.size()];
            const V got = exact::atan2Lanes(y, x);
            for (size_t k = 0; k < kLanes; ++k) ASSERT_TRUE(same(got[k], exact::atan2(y[k], x[k]))) << y[k] << ", " << x[k];
        }
}
template <class V> void compareSines() {
    constexpr size_t kLanes = sizeof(V) / sizeof(double);
    for (double most : {7., 1e6}) {
        const std::vector<double> all = numbers(most);
        for (size_t i = 0; i + kLanes <= all.size(); i += kLanes) {
            V x, sine, cosine;
            for (size_t k = 0; k < kLanes; ++k) x[k] = all[i + k];
            exact::sinCosLanes(x, sine, cosine);
            for (size_t k = 0; k < kLanes; ++k) {
                ASSERT_TRUE(same(sine[k], exact::sin(x[k]))) << x[k];
                ASSERT_TRUE(same(cosine[k], exact::cos(x[k]))) << x[k];
            }
        }
    }
}
} // namespace

TEST(ExactLanes, AnglesHaveTheBitsOfOneNumber) {
    compareAngles<Two>();
    compareAngles<Four>();
    compareAngles<Eight>();
}
TEST(ExactLanes, SinesHaveTheBitsOfOneNumber) {
    compareSines<Two>();
    compareSines<Four>();
    compareSines<Eight>();
}

} // namespace exactlanes_test
