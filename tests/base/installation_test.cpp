// Where the program's files are found: in an installation, in a build folder, and where an environment variable says.
#include "base/installation.h"
#include <cstdlib>
#include <fstream>
#include <gtest/gtest.h>

namespace installation_test {

namespace fs = std::filesystem;
using namespace alpenglow;

namespace {

class Installation : public ::testing::Test {
protected:
    fs::path prefix;
    void SetUp() override {
        std::string name = (fs::temp_directory_path() / "alpenglow-test-XXXXXX").string();
        ASSERT_NE(mkdtemp(name.data()), nullptr);
        prefix = fs::canonical(name);
        unsetenv("ALPENGLOW_TEST_MODULE");
    }
    void TearDown() override {
        unsetenv("ALPENGLOW_TEST_MODULE");
        fs::remove_all(prefix);
    }
    void make(const std::string& file) const {
        fs::create_directories((prefix / file).parent_path());
        std::ofstream(prefix / file) << "x";
    }
    std::string module() const { return moduleFile("libtest.so", "ALPENGLOW_TEST_MODULE", prefix / "bin"); }
    std::string shaders() const { return shippedShaders(prefix / "bin"); }
};

TEST_F(Installation, NothingIsFoundWhereNothingIs) {
    EXPECT_EQ(module(), "");
    EXPECT_EQ(shaders(), "");
    EXPECT_EQ(moduleFile("libtest.so", "ALPENGLOW_TEST_MODULE", ""), "");
    EXPECT_EQ(shippedShaders(""), "");
}

TEST_F(Installation, OfAPrefix) {
    make("bin/alpenglow");
    make("lib/alpenglow/libtest.so");
    make("share/alpenglow/shaders/matte.sl");
    EXPECT_EQ(module(), (prefix / "lib/alpenglow/libtest.so").string());
    EXPECT_EQ(shaders(), (prefix / "share/alpenglow/shaders").string());
}

// Modules lie next to the program, and share/alpenglow/shaders is a link to the sources.
TEST_F(Installation, OfABuildFolder) {
    make("bin/libtest.so");
    make("lib/alpenglow/libtest.so"); // of an older installation; not taken
    make("sources/shaders/matte.sl");
    fs::create_directories(prefix / "share/alpenglow");
    fs::create_symlink(prefix / "sources/shaders", prefix / "share/alpenglow/shaders");
    EXPECT_EQ(module(), (prefix / "bin/libtest.so").string());
    EXPECT_EQ(shaders(), (prefix / "sources/shaders").string());
}

// libalpenglow.so in <prefix>/lib, and Python's extension module below the modules.
TEST_F(Installation, OfALibrary) {
    make("lib/alpenglow/libtest.so");
    make("share/alpenglow/shaders/matte.sl");
    for (const char* folder : {"lib", "lib/alpenglow/python/alpenglow"}) {
        fs::create_directories(prefix / folder);
        EXPECT_EQ(moduleFile("libtest.so", "ALPENGLOW_TEST_MODULE", prefix / folder),
                  (prefix / "lib/alpenglow/libtest.so").string());
    }
    EXPECT_EQ(shippedShaders(prefix / "lib"), (prefix / "share/alpenglow/shaders").string());
}

TEST_F(Installation, OfALibraryInABuildFolder) {
    make("bin/libtest.so");
    make("share/alpenglow/shaders/matte.sl");
    for (const char* folder : {"lib", "python/alpenglow"}) {
        fs::create_directories(prefix / folder);
        EXPECT_EQ(moduleFile("libtest.so", "ALPENGLOW_TEST_MODULE", prefix / folder), (prefix / "bin/libtest.so").string());
        EXPECT_EQ(shippedShaders(prefix / folder), (prefix / "share/alpenglow/shaders").string());
    }
}

TEST_F(Installation, AVariableNamesTheOnlyModule) {
    make("bin/libtest.so");
    make("other.so");
    setenv("ALPENGLOW_TEST_MODULE", (prefix / "other.so").c_str(), 1);
    EXPECT_EQ(module(), (prefix / "other.so").string());
    setenv("ALPENGLOW_TEST_MODULE", (prefix / "missing.so").c_str(), 1);
    EXPECT_EQ(module(), "");
    setenv("ALPENGLOW_TEST_MODULE", "", 1);
    EXPECT_EQ(module(), "");
}

TEST_F(Installation, ThisProgramIsInABuildFolder) {
    EXPECT_EQ(codeFolder().filename(), "bin");
    EXPECT_EQ(codeFile(), fs::read_symlink("/proc/self/exe"));
    EXPECT_EQ(shippedShaders(), fs::canonical(ALPENGLOW_SOURCE_DIR "/shaders").string());
}

// A link to the program, as in ~/bin, does not change where its files are.
TEST_F(Installation, LinksAreFollowed) {
    const std::string program = fs::read_symlink("/proc/self/exe").string(), link = (prefix / "link").string();
    fs::create_symlink(program, link);
    const std::string command = "'" + link + "' --gtest_filter=Installation.ThisProgramIsInABuildFolder >" + link + ".log 2>&1";
    EXPECT_EQ(std::system(command.c_str()), 0);
}

} // namespace

} // namespace installation_test
