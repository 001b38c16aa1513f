// Processes that draw frames: what they say comes out in the order of the frames, and they wait for each other where they must.
#include "render/frameprocesses.h"
#include "render/framerecords.h"
#include "render/heap.h"
#include "render/limits.h"
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <thread>
#include <unistd.h>

namespace frameprocesses_test {

using namespace alpenglow;
using namespace alpenglow::render;

namespace {

class Processes : public ::testing::Test {
protected:
    void SetUp() override {
        std::string name = (std::filesystem::temp_directory_path() / "alpenglow-test-XXXXXX").string(); // mkdtemp wants the X
        ASSERT_NE(mkdtemp(name.data()), nullptr);
        dir = name;
    }
    void TearDown() override { std::filesystem::remove_all(dir); }
    void make(const std::string& file) const { std::ofstream(dir / file) << "."; }
    bool there(const std::string& file) const { return std::filesystem::exists(dir / file); }
    /// In a process: until the file is there, two minutes at most.
    void await(const std::string& file) const {
        for (int i = 0; i < 12'000 && !there(file); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    /// A frame that does this in a process of its own.
    template <class Work> void frame(FrameProcesses& p, FrameProcesses::Writes writes, Work work) {
        p.openFrame();
        if (p.start("a frame", std::move(writes), false)) {
            work();
            FrameResult r;
            r.outcome.rendered = 1;
            p.finish(std::move(r));
        }
        p.closeFrame();
    }
    static Diagnostic message(const std::string& text, const std::string& once = "") {
        Diagnostic d;
        d.severity = Severity::Warning;
        d.message = text;
        d.once = once;
        return d;
    }
    std::filesystem::path dir;
    std::vector<std::string> said;
    Diagnostics messages{[this](const Diagnostic& d) { said.push_back(d.message); }};
    const FrameProcesses::Writes nothing{{}, false, true};
};

} // namespace

TEST_F(Processes, MessagesComeInTheOrderOfTheFrames) {
    FrameProcesses p({.most = 3}, messages);
    int taken = 0;
    p.setTake([&](const FrameResult& r) { taken += r.outcome.rendered; });
    p.say(message("before"));
    frame(p, nothing, [&] {
        await("third");
        p.say(message("first", "key"));
    });
    p.say(message("between"));
    frame(p, nothing, [&] { p.say(message("second", "key")); }); // said before: it is printed once
    frame(p, nothing, [&] {
        p.say(message("third"));
        make("third");
    });
    p.say(message("behind"));
    p.waitForFrames();
    EXPECT_EQ(said, (std::vector<std::string>{"before", "first", "between", "third", "behind"}));
    EXPECT_EQ(taken, 3);
}

// The second reads what the first writes, and the third what nobody does: so it is the third that lets the first end.
TEST_F(Processes, AFrameWaitsForTheFilesOfEarlierOnesAlone) {
    FrameProcesses p({.most = 3}, messages);
    frame(p, {{(dir / "Map.TIF").string()}, false, true}, [&] {
        await("third");
        make("written");
    });
    frame(p, nothing, [&] {
        p.awaitRead("elsewhere\\map.tif"); // the name as findFile() may find it
        p.say(message(there("written") ? "second came behind" : "second came before"));
    });
    frame(p, nothing, [&] {
        p.awaitRead("other.tif");
        make("third");
    });
    p.waitForFrames();
    EXPECT_EQ(said, std::vector<std::string>{"second came behind"});
}

// One whose files are not known yet may write any; once it has said that there are none, or is done, others go on.
TEST_F(Processes, FilesThatAreNotKnownMayBeAny) {
    FrameProcesses p({.most = 3}, messages);
    for (const bool bakes : {false, true}) {
        std::filesystem::remove(dir / "second");
        std::filesystem::remove(dir / "done");
        frame(p, {}, [&] {
            p.declare(bakes);
            if (!bakes) await("second"); // which can only be if that goes on
            else std::this_thread::sleep_for(std::chrono::milliseconds(200));
            make("done");
        });
        frame(p, nothing, [&] {
            p.awaitRead("any.ptc");
            p.say(message(there("done") ? "behind" : "beside"));
            make("second");
        });
        p.waitForFrames();
    }
    EXPECT_EQ(said, (std::vector<std::string>{"beside", "behind"}));
}

TEST_F(Processes, ATurnComesWhenEarlierFramesAreDrawn) {
    FrameProcesses p({.most = 3}, messages);
    frame(p, nothing, [&] {
        await("third");
        make("first");
    });
    frame(p, nothing, [&] {
        p.awaitTurn();
        p.say(message(there("first") ? "behind" : "before"));
    });
    frame(p, nothing, [&] { make("third"); });
    p.awaitRead("anything"); // of the reader: no frame is known to write it
    p.waitForFrames();
    EXPECT_EQ(said, std::vector<std::string>{"behind"});
}

// What waits to be printed is bounded: the first frame ends when the last that may be begun meanwhile has, and one more is begun
// only then.
TEST_F(Processes, NoMoreThanSoManyFramesAreAhead) {
    FrameProcesses p({.most = 2}, messages);
    const int ahead = limits::kFramesAhead * 2;
    int taken = 0;
    p.setTake([&](const FrameResult&) { ++taken; });
    frame(p, nothing, [&] { await("last"); });
    for (int k = 2; k <= ahead; ++k)
        frame(p, nothing, [&] {
            if (k == ahead) make("last");
        });
    frame(p, nothing, [] {});
    EXPECT_GE(taken, 1);
    p.waitForFrames();
    EXPECT_EQ(taken, ahead + 1);
}

// The system rounds to pages, which may be of 2 MB.
TEST_F(Processes, MemoryIsTakenAtOnceUpToALimit) {
    FrameProcesses p({.most = 2}, messages);
    for (const size_t bytes : {size_t(0), size_t(64) << 20, 2 * limits::kHeapAtOnce})
        frame(p, nothing, [&] {
            const uint64_t before = ownBytes();
            fillHeap(bytes, true);
            const uint64_t after = ownBytes(), most = std::min(bytes, limits::kHeapAtOnce);
            const uint64_t grown = after - std::min(after, before);
            if (before == 0) return p.say(message("memory is not known"));
            p.say(message(grown <= most + (size_t(24) << 20) ? "bounded" : std::to_string(grown)));
        });
    p.waitForFrames();
    EXPECT_EQ(said, (std::vector<std::string>{"bounded", "bounded", "bounded"}));
}

TEST_F(Processes, AProcessThatEndsByItselfIsToldOf) {
    FrameProcesses p({.most = 2}, messages);
    Outcome all;
    p.setTake([&](const FrameResult& r) { all.add(r.outcome); });
    frame(p, nothing, [] { _exit(4); });
    frame(p, nothing, [] {});
    p.waitForFrames();
    ASSERT_EQ(said.size(), 1u);
    EXPECT_EQ(said[0], "a frame is given up: its process ended with status 4");
    EXPECT_EQ(all.rendered, 1);
    EXPECT_EQ(all.refused, 1);
    EXPECT_TRUE(all.outOfMemory);
}

TEST(FrameRecords, ComeBackAsTheyWere) {
    Diagnostic d{Severity::Severe, Rie::Limit, {"a.rib", 3, 4}, "what", "hint", "line"};
    d.id = "id";
    d.length = 7;
    d.notes = {"one", ""};
    d.fixes = {{{"b.sl", 1, 2}, 3, "new"}};
    d.always = true;
    d.once = std::string("k\0ey", 4);
    Diagnostic back;
    ASSERT_TRUE(unpack(packed(d), back));
    EXPECT_EQ(packed(back), packed(d));
    EXPECT_EQ(toString(back), toString(d));
    EXPECT_EQ(back.once, d.once);
    EXPECT_EQ(back.fixes[0].text, "new");

    FrameResult r;
    r.outcome.refused = 2;
    r.stats.emplace();
    r.stats->pictures = {{"p.exr", "openexr", {"r", "g"}}};
    r.stats->textures = {{"t.tif", 1, 2, 3}};
    r.stats->figures.rays = {{"camera", 5}, {"shadow", 6}};
    r.stats->figures.noise.noise = .25;
    FrameResult same;
    ASSERT_TRUE(unpack(packed(r), same));
    EXPECT_EQ(packed(same), packed(r));
    EXPECT_EQ(same.stats->figures.rays.at("shadow"), 6u);
    EXPECT_EQ(same.stats->pictures[0].channels[1], "g");
    const std::string bytes = packed(r); // cut anywhere they are none
    for (size_t n = 0; n < bytes.size(); ++n) EXPECT_FALSE(unpack(bytes.substr(0, n), same)) << n;
}

} // namespace frameprocesses_test
