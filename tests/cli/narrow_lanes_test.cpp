// The runtime for 4 and 8 lanes is in files next to the program's modules: without them, and with those of another build, shaders
// of so few lanes are refused with what to do. 16 lanes need no file.
#include "command_folder.h"

namespace narrow_lanes_test {

namespace {

namespace fs = std::filesystem;

class NarrowLanes : public alpenglow::cli::testing::CommandFolder {
protected:
    /// A copy of the program with the compiler's module alone.
    void SetUp() override {
        CommandFolder::SetUp();
        fs::create_directory(dir / "bin");
        fs::copy_file(ALPENGLOW_PROGRAM, dir / "bin/alpenglow");
        take("libalpenglow_jit.so");
    }
    /// Copies a file that lies next to the program.
    void take(const std::string& name) const {
        fs::copy_file(fs::path(ALPENGLOW_PROGRAM).parent_path() / name, dir / "bin" / name, fs::copy_options::overwrite_existing);
    }
    /// What the copy prints for an expression that is no constant.
    std::string eval(int lanes) {
        return run("--version >version && env ALPENGLOW_CACHE=off bin/alpenglow eval --lanes " + std::to_string(lanes) +
                       " 'noise(P + 1.5) + s'",
                   "2>&1");
    }
};

TEST_F(NarrowLanes, FilesThatLackOrAreOfAnotherBuildAreNamed) {
    const std::string want = eval(16);
    ASSERT_EQ(status, 0) << want;
    for (const int lanes : {4, 8}) {
        const std::string said = eval(lanes);
        EXPECT_NE(status, 0);
        EXPECT_NE(said.find("alpenglow_runtime" + std::to_string(lanes) +
                            ".bc, which is neither next to the program nor in "
                            "lib/alpenglow: build it by `ninja -C build/release narrow_lanes`, or leave out --lanes"),
                  said.npos)
            << said;
    }
    take("alpenglow_runtime4.bc");
    take("alpenglow_runtime8.bc");
    for (const int lanes : {4, 8}) {
        EXPECT_EQ(eval(lanes), want);
        EXPECT_EQ(status, 0);
    }
    // The last bytes are the digest of the sources.
    const fs::path eight = dir / "bin/alpenglow_runtime8.bc";
    fs::resize_file(eight, fs::file_size(eight) - 1);
    const std::string said = eval(4); // two vectors of 4 lanes are 8
    EXPECT_NE(status, 0);
    EXPECT_NE(said.find("alpenglow_runtime8.bc was built from other sources than this program"), said.npos) << said;
}

} // namespace

} // namespace narrow_lanes_test
