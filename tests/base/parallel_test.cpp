#include "base/parallel.h"
#include <algorithm>
#include <atomic>
#include <gtest/gtest.h>
#include <stdexcept>
#include <vector>

namespace parallel_test {

using namespace alpenglow;

namespace {

TEST(Parallel, ALoopDoesEachIndexOnce) {
    std::vector<int> times(1000, 0);
    parallelFor(size_t(0), times.size(), [&](size_t i) { ++times[i]; });
    EXPECT_EQ(std::count(times.begin(), times.end(), 1), 1000);
    parallelFor(5, 5, [&](int) { times.clear(); });
    EXPECT_EQ(times.size(), 1000u);
}

TEST(Parallel, TasksHaveEndedWhenWaitReturns) {
    std::vector<int> results(64, 0);
    TaskGroup group;
    for (int i = 0; i < 64; ++i) group.run([&results, i] { results[size_t(i)] = i + 1; });
    group.wait();
    for (int i = 0; i < 64; ++i) EXPECT_EQ(results[size_t(i)], i + 1);
}

TEST(Parallel, ExceptionsReachTheCaller) {
    EXPECT_THROW(parallelFor(0, 100,
                             [](int i) {
                                 if (i == 50) throw std::runtime_error("fifty");
                             }),
                 std::runtime_error);
    TaskGroup group;
    std::atomic<int> ended{0};
    group.run([] { throw std::length_error("task"); });
    group.run([&] { ++ended; });
    EXPECT_THROW(group.wait(), std::length_error);
}

} // namespace

} // namespace parallel_test
