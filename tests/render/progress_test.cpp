#include "render/progress.h"
#include <gtest/gtest.h>
#include <vector>

namespace progress_test {

using namespace alpenglow::render;

namespace {

struct Fixture {
    double now = 100;
    std::vector<std::string> out;
    Progress make(ProgressMode m, bool terminal, int columns = 100) {
        return Progress(m, [this](std::string_view t) { out.emplace_back(t); }, [this] { return now; }, terminal, columns);
    }
    static ProgressState state(double done, uint64_t total) { return {done / double(total), done, total, 0.01234, 850.4}; }
};

} // namespace

TEST(Progress, PlainLines) {
    Fixture f;
    Progress p = f.make(ProgressMode::Auto, false);
    EXPECT_EQ(p.mode(), ProgressMode::Plain);
    p.update(Fixture::state(0, 64));
    EXPECT_TRUE(f.out.empty()); // nothing to tell yet
    f.now += 2;
    p.update(Fixture::state(16, 64));
    ASSERT_EQ(f.out.size(), 1u); // more than 10 % since the start
    EXPECT_EQ(f.out[0], " 25%  16/64 samples  noise 0.01234  850 rays/ms  ETA 0:06\n");
    f.now += 0.5;
    p.update(Fixture::state(40, 64));
    EXPECT_EQ(f.out.size(), 1u); // too soon
    f.now += 1;
    p.update(Fixture::state(17, 64));
    EXPECT_EQ(f.out.size(), 1u); // neither 10 % nor 5 s
    f.now += 4;
    p.update(Fixture::state(18, 64));
    EXPECT_EQ(f.out.size(), 2u);
    f.now += 0.5;
    p.finish(Fixture::state(64, 64), "box");
    ASSERT_EQ(f.out.size(), 3u);
    EXPECT_EQ(f.out[2], "box  100%  64/64 samples  noise 0.01234  850 rays/ms  in 0:08\n");
}

TEST(Progress, BarAtMostTwiceASecond) {
    Fixture f;
    Progress p = f.make(ProgressMode::Auto, true);
    EXPECT_EQ(p.mode(), ProgressMode::Bar);
    for (int i = 0; i < 1000; ++i) { // ten seconds, a call every 10 ms
        p.update(Fixture::state(i, 1000));
        f.now += 0.01;
    }
    EXPECT_GE(f.out.size(), 18u);
    EXPECT_LE(f.out.size(), 21u);
    const std::string& last = f.out.back();
    EXPECT_EQ(last.front(), '\r');
    EXPECT_NE(last.find('#'), std::string::npos);
    EXPECT_EQ(last.find('\n'), std::string::npos);
    EXPECT_NE(last.find("ETA 0:0"), std::string::npos);
    p.finish(Fixture::state(1000, 1000));
    EXPECT_EQ(f.out.back(), "\r100%  1000/1000 samples  noise 0.01234  850 rays/ms  in 0:10\x1b[K\n");
}

TEST(Progress, ABarNeverWraps) {
    for (int columns : {10, 40, 60, 80, 200}) {
        Fixture f;
        Progress p = f.make(ProgressMode::Bar, true, columns);
        p.update(Fixture::state(3, 7), "a rather long name of a picture.exr");
        ASSERT_EQ(f.out.size(), 1u);
        EXPECT_LT(int(f.out[0].size()) - 4, columns); // "\r" and "\x1b[K" take no room
    }
}

TEST(Progress, ClearMakesRoomForAMessage) {
    Fixture f;
    Progress p = f.make(ProgressMode::Bar, true);
    p.clear();
    EXPECT_TRUE(f.out.empty());
    p.update(Fixture::state(1, 4));
    p.clear();
    EXPECT_EQ(f.out.back(), "\r\x1b[K");
    p.update(Fixture::state(1, 4)); // redrawn at once
    EXPECT_EQ(f.out.size(), 3u);
}

TEST(Progress, UnknownTotalAndNone) {
    Fixture f;
    Progress p = f.make(ProgressMode::Plain, false);
    p.update({-1, 0, 0, -1, 0});
    f.now += 6;
    p.update({-1, 12, 0, -1, 0});
    ASSERT_EQ(f.out.size(), 1u);
    EXPECT_EQ(f.out[0], "12 samples\n");
    Fixture g;
    Progress none = g.make(ProgressMode::None, true);
    none.update(Fixture::state(1, 2));
    g.now += 100;
    none.update(Fixture::state(2, 2));
    none.finish(Fixture::state(2, 2));
    none.clear();
    EXPECT_TRUE(g.out.empty());
}

TEST(Progress, NamesAndDurations) {
    EXPECT_EQ(progressModeByName("bar"), ProgressMode::Bar);
    EXPECT_FALSE(progressModeByName("loud"));
    EXPECT_EQ(formatDuration(7.4), "0:07");
    EXPECT_EQ(formatDuration(754), "12:34");
    EXPECT_EQ(formatDuration(11100), "3:05:00");
    EXPECT_EQ(formatDuration(2 * 86400 + 3 * 3600 + 300), "2d 3:05:00");
    EXPECT_EQ(formatDuration(-1), "?");
}

} // namespace progress_test
