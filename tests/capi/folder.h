// A folder for what programs write, and programs run in it.
#pragma once
#include "display/imageio.h"
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <optional>
#include <sstream>
#include <string>
#include <sys/wait.h>
#include <unistd.h>

namespace alpenglow::capi::testing {

class Folder : public ::testing::Test {
protected:
    std::filesystem::path dir, before;
    int status = -1; ///< of the last run; 128 and more: a signal
    void SetUp() override {
        std::string name = (std::filesystem::temp_directory_path() / "alpenglow-test-XXXXXX").string();
        ASSERT_NE(mkdtemp(name.data()), nullptr);
        dir = name;
        before = std::filesystem::current_path();
        std::filesystem::current_path(dir); // programs write below it
    }
    void TearDown() override {
        std::filesystem::current_path(before);
        std::filesystem::remove_all(dir);
    }
    /// What a command writes to both outputs.
    std::string run(const std::string& command) {
        std::string out;
        FILE* p = popen((command + " 2>&1").c_str(), "r");
        if (!p) return out;
        std::array<char, 4096> buffer;
        while (size_t n = fread(buffer.data(), 1, buffer.size(), p)) out.append(buffer.data(), n);
        const int s = pclose(p);
        status = WIFEXITED(s) ? WEXITSTATUS(s) : 128 + WTERMSIG(s);
        return out;
    }
    /// A program of tests/capi/programs.
    std::string runC(const std::string& program, const std::string& arguments, const std::string& variables = "") {
        return run(variables + " '" ALPENGLOW_CAPI_PROGRAMS "/capi_" + program + "' " + arguments);
    }
    std::string text(const std::string& name) const {
        std::ifstream in(dir / name, std::ios::binary);
        std::stringstream s;
        s << in.rdbuf();
        return s.str();
    }
    /// A picture that must be there; red, green, blue and alpha of a pixel follow each other.
    display::Image picture(const std::string& name) const {
        Diagnostics d;
        auto i = display::readImage((dir / name).string(), d);
        EXPECT_TRUE(i) << name;
        return i ? *i : display::Image{};
    }
};

} // namespace alpenglow::capi::testing
