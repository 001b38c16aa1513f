// Tasks shared by threads.
#include "render/team.h"
#include <gtest/gtest.h>

namespace team_test {
using namespace alpenglow;
using namespace alpenglow::render;

TEST(Team, EveryTaskOnceAndExceptionsArrive) {
    Team team(3);
    std::vector<std::atomic<int>> done(1000);
    StopFlag halt{0};
    EXPECT_TRUE(team.run(done.size(), &halt, [&](int w, size_t i) { done[i] += w < 3 ? 1 : 100; }, [](size_t) {}));
    for (auto& d : done) EXPECT_EQ(d, 1);
    EXPECT_THROW(team.run(
                     10, &halt,
                     [&](int, size_t i) {
                         if (i == 5) throw std::bad_alloc();
                     },
                     [](size_t) {}),
                 std::bad_alloc);
    EXPECT_EQ(halt, 1);
    halt = 0;
    const auto wait = [](int, size_t) { std::this_thread::sleep_for(std::chrono::milliseconds(1)); };
    EXPECT_THROW(team.run(1000, &halt, wait, [](size_t) { throw std::bad_alloc(); }), std::bad_alloc); // of who looks on, too
    EXPECT_EQ(halt, 1);
}

} // namespace team_test
