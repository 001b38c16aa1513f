// A folder of its own for each test, and the program run in it.
#pragma once
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <string>
#include <sys/wait.h>

namespace alpenglow::cli::testing {

/// Shell commands that wait until a process has had so many seconds of processor time: however busy the machine is, it has come
/// as far. They end too when it is gone, and after two minutes.
inline std::string worked(const std::string& process, double seconds) {
    return "t=0; while [ $t -lt 1200 ] && kill -0 " + process + " 2>/dev/null && [ $(awk '{ print $14 + $15 }' /proc/" + process +
           "/stat 2>/dev/null || echo 999999) -lt $((" + std::to_string(int(seconds * 1000)) +
           " * $(getconf CLK_TCK) / 1000)) ]; do sleep .1; t=$((t + 1)); done;";
}

class CommandFolder : public ::testing::Test {
protected:
    std::filesystem::path dir;
    int status = -1; ///< exit status of the last run; 128 and more: a signal
    void SetUp() override {
        std::string name = (std::filesystem::temp_directory_path() / "alpenglow-test-XXXXXX").string(); // mkdtemp wants the X
        ASSERT_NE(mkdtemp(name.data()), nullptr);
        dir = name;
    }
    void TearDown() override { std::filesystem::remove_all(dir); }
    void write(const std::string& name, const std::string& text) const { std::ofstream(dir / name, std::ios::binary) << text; }
    /// What the program writes to standard output; its errors go where the shell sends them.
    std::string run(const std::string& arguments, const std::string& redirected) {
        const std::string command = "cd '" + dir.string() + "' && '" + ALPENGLOW_PROGRAM "' " + arguments + " " + redirected;
        std::string out;
        FILE* p = popen(command.c_str(), "r");
        if (!p) return out;
        std::array<char, 4096> buffer;
        while (size_t n = fread(buffer.data(), 1, buffer.size(), p)) out.append(buffer.data(), n);
        const int s = pclose(p);
        status = WIFEXITED(s) ? WEXITSTATUS(s) : 128 + WTERMSIG(s);
        return out;
    }
};

} // namespace alpenglow::cli::testing
