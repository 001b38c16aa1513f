// scene/lightset.h against a set of numbers.
#include "scene/lightset.h"
#include <gtest/gtest.h>
#include <random>
#include <set>

namespace lightset_test {

using alpenglow::scene::LightSet;

TEST(LightSet, IsASet) {
    std::mt19937 rng(7);
    for (const int range : {3, 20, 400}) {
        LightSet lights;
        std::set<int> want;
        for (int turn = 0; turn < 3000; ++turn) {
            const int l = int(rng() % unsigned(range));
            if (rng() % 3) lights.insert(l), want.insert(l);
            else lights.erase(l), want.erase(l);
            if (rng() % 500 == 0) {
                lights.keepBelow(l);
                want.erase(want.lower_bound(l), want.end());
            }
            ASSERT_EQ(lights.size(), want.size());
            ASSERT_EQ(lights.empty(), want.empty());
            ASSERT_EQ(std::vector<int>(lights.begin(), lights.end()), std::vector<int>(want.begin(), want.end()));
            if (!want.empty()) ASSERT_EQ(lights.last(), *want.rbegin());
            for (size_t r = 0; r < lights.runs().size(); ++r) {
                ASSERT_LT(lights.runs()[r].first, lights.runs()[r].second);
                if (r) ASSERT_LT(lights.runs()[r - 1].second, lights.runs()[r].first) << "runs that touch are one";
            }
        }
        for (int l = -2; l < range + 2; ++l) EXPECT_EQ(lights.contains(l), want.count(l) == 1);
        EXPECT_EQ(lights, LightSet(std::vector<int>(want.rbegin(), want.rend()))); // whatever the order
    }
    EXPECT_EQ(LightSet({5, 6, 8}), (std::vector<int>{5, 6, 8}));
    EXPECT_NE(LightSet({5, 6}), LightSet({5, 6, 8}));
}

} // namespace lightset_test
