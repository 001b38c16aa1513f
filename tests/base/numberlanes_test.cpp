// Numbers in lanes are those that are drawn one by one, at every width, whoever else is asked.
#include "base/numberlanes.h"
#include <gtest/gtest.h>
#include <vector>

namespace numberlanes_test {

using namespace alpenglow;

namespace {

struct Asked {
    SampleNumbers numbers;
    uint32_t vertex, site, occurrence;
    bool pair;
};

std::vector<Asked> someRequests(size_t count) {
    std::vector<Asked> all;
    uint64_t state = 7;
    const auto next = [&] { return uint32_t(state = mix64(state + 0x9e3779b97f4a7c15ull)); };
    for (size_t i = 0; i < count; ++i) {
        const Sampler s(next(), int(next() >> 4), -int(next() >> 4));
        const uint32_t most = i % 5 == 0 ? 0xffffffffu : 4096; // of samples, of draws
        const SampleNumbers n(s, next() & most);
        all.push_back({i % 3 ? n : n.draw(next() % 7, 7), next(), next() >> 1, i % 2 ? next() : next() % 3, i % 4 != 1});
    }
    return all;
}

TEST(NumberLanes, SameBitsAsOneByOne) {
    for (size_t count : {0u, 1u, 15u, 16u, 17u, 1000u}) {
        const std::vector<Asked> all = someRequests(count);
        NumberRows rows;
        for (int again = 0; again < 2; ++again) {
            rows.clear();
            for (const Asked& a : all) {
                if (a.pair) rows.askPair(a.numbers, a.vertex, a.site, a.occurrence);
                else rows.askOne(a.numbers, a.vertex, a.site, a.occurrence);
            }
            rows.draw();
            ASSERT_EQ(rows.size(), count);
            for (size_t i = 0; i < count; ++i) {
                const Asked& a = all[i];
                if (a.pair) {
                    const alpenglow::Vec2 expected = a.numbers.get2(a.vertex, a.site, a.occurrence);
                    EXPECT_EQ(rows.pair(i).x, expected.x) << i;
                    EXPECT_EQ(rows.pair(i).y, expected.y) << i;
                } else {
                    EXPECT_EQ(rows.one(i), a.numbers.get1(a.vertex, a.site, a.occurrence)) << i;
                }
            }
        }
    }
}

TEST(NumberLanes, EveryWidth) {
    std::vector<NumberBlock> asked(20);
    uint64_t state = 1;
    for (NumberBlock& b : asked)
        for (int i = 0; i < NumberBlock::kSize; ++i)
            for (uint32_t* row : {b.low, b.high, b.index, b.vertex, b.stream, b.occurrence})
                row[i] = uint32_t(state = mix64(state + 1));
    ASSERT_TRUE(drawNumbers(4));
    EXPECT_FALSE(drawNumbers(5));
    std::vector<NumberBlock> four = asked;
    drawNumbers(4)(four.data(), four.size());
    for (int lanes : {8, 16}) {
        if (!drawNumbers(lanes)) continue;
        std::vector<NumberBlock> wide = asked;
        drawNumbers(lanes)(wide.data(), wide.size());
        for (size_t k = 0; k < asked.size(); ++k)
            for (int i = 0; i < NumberBlock::kSize; ++i) {
                EXPECT_EQ(wide[k].x[i], four[k].x[i]) << lanes;
                EXPECT_EQ(wide[k].y[i], four[k].y[i]) << lanes;
            }
    }
}

} // namespace

} // namespace numberlanes_test
