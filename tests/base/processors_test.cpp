// The default number of threads: affinity, control groups, Slurm.
#include "base/processors.h"
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <sched.h>
#include <thread>

namespace processors_test {

using namespace alpenglow;
namespace fs = std::filesystem;

namespace {

class Processors : public testing::Test {
protected:
    fs::path dir;
    void SetUp() override {
        std::string name = (fs::temp_directory_path() / "alpenglow-groups-XXXXXX").string();
        ASSERT_NE(mkdtemp(name.data()), nullptr);
        dir = name;
    }
    void TearDown() override { fs::remove_all(dir); }
    std::string group(const std::string& name, const std::string& file, const std::string& text) const {
        fs::create_directories(dir / name);
        std::ofstream(dir / name / file) << text;
        return (dir / name).string();
    }
};

TEST_F(Processors, LeastOfAllBounds) {
    const std::string open = group("open", "cpu.max", "max 100000\n"), three = group("three", "cpu.max", "250000 100000\n"),
                      tiny = group("tiny", "cpu.max", "5000 100000\n"), none = (dir / "none").string();
    group("old", "cpu.cfs_quota_us", "400000\n");
    const std::string old = group("old", "cpu.cfs_period_us", "100000\n");
    group("oldopen", "cpu.cfs_quota_us", "-1\n");
    const std::string oldOpen = group("oldopen", "cpu.cfs_period_us", "100000\n");
    EXPECT_EQ(threadsWithin(16, {}, nullptr), 16);
    EXPECT_EQ(threadsWithin(0, {}, nullptr), 1);
    EXPECT_EQ(threadsWithin(16, {none, open, oldOpen}, nullptr), 16);
    EXPECT_EQ(threadsWithin(16, {open, three}, nullptr), 3) << "2.5 processors keep three threads busy";
    EXPECT_EQ(threadsWithin(16, {old, open}, nullptr), 4);
    EXPECT_EQ(threadsWithin(16, {old, three}, nullptr), 3);
    EXPECT_EQ(threadsWithin(2, {three}, nullptr), 2);
    EXPECT_EQ(threadsWithin(16, {tiny}, nullptr), 1);
    EXPECT_EQ(threadsWithin(16, {}, "6"), 6);
    EXPECT_EQ(threadsWithin(4, {}, "6"), 4);
    for (const char* nothing : {"", "x", "0", "-3"}) EXPECT_EQ(threadsWithin(8, {}, nothing), 8) << nothing;
}

TEST_F(Processors, AffinityOfTheProcess) {
    cpu_set_t before, one;
    ASSERT_EQ(sched_getaffinity(0, sizeof before, &before), 0);
    CPU_ZERO(&one);
    for (int i = 0; i < CPU_SETSIZE && CPU_COUNT(&one) == 0; ++i)
        if (CPU_ISSET(i, &before)) CPU_SET(i, &one);
    ASSERT_EQ(sched_setaffinity(0, sizeof one, &one), 0);
    EXPECT_EQ(defaultThreads(), 1);
    ASSERT_EQ(sched_setaffinity(0, sizeof before, &before), 0);
    EXPECT_LE(defaultThreads(), CPU_COUNT(&before));
    EXPECT_GE(defaultThreads(), 1);
}

} // namespace

} // namespace processors_test
