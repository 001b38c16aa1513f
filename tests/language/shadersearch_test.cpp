// Shaders that share a file are found by their own names; how much is looked at on the way is limited, as are the lines of
// messages.
#include "base/limits.h"
#include "rsl/compiler.h"
#include "rsl/shadersearch.h"
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <unistd.h>

namespace fs = std::filesystem;

namespace alpenglow::rsl::shadersearch_test {
namespace {

struct Folder {
    fs::path path = fs::temp_directory_path() / ("alpenglow_search_" + std::to_string(::getpid()));
    Folder() { fs::create_directories(path); }
    ~Folder() { fs::remove_all(path); }
    void write(const std::string& name, const std::string& text) const { std::ofstream(path / name) << text; }
    std::string found(const std::string& shader) const {
        const auto f = fileWithShader(shader, {path.string()});
        return f ? fs::path(*f).filename().string() : "";
    }
};

TEST(ShaderSearch, DeclarationsCountTextInCommentsAndStringsDoesNot) {
    EXPECT_TRUE(declaresShader("light\n  lamp (float k = 1;) {}", "lamp"));
    EXPECT_TRUE(declaresShader("surface a() {} /* x */ class /* y */ b(float k = 1;) {}", "b"));
    for (const char* text : {"// surface b() {}\nsurface a() {}", "/* surface b() */", "string s = \"surface b()\";",
                             "surface bb() {}", "surface b;", "float b() { return 1; }"})
        EXPECT_FALSE(declaresShader(text, "b")) << text;
}

TEST(ShaderSearch, TheFirstFileByNameHasIt) {
    Folder folder;
    folder.write("two.sl", "surface shared() {}");
    folder.write("one.sl", "surface first() {}\nsurface shared() {}");
    folder.write("text.txt", "surface other() {}");
    EXPECT_EQ(folder.found("shared"), "one.sl");
    EXPECT_EQ(folder.found("other"), "");
    EXPECT_EQ(folder.found("../one"), "");
}

TEST(ShaderSearch, LargeFilesAndVeryManyAreNotLookedAt) {
    Folder folder;
    const std::string shader = "surface hidden() {}\n";
    folder.write("a.sl", std::string(limits::kShaderFileLooked, ' ') + shader);
    EXPECT_EQ(folder.found("hidden"), "");
    for (int n = 1; n < limits::kShaderFilesLooked; ++n) folder.write("b" + std::to_string(n) + ".sl", "");
    folder.write("c.sl", shader); // the last that is looked at, with a.sl, would be the one before it
    EXPECT_EQ(folder.found("hidden"), "");
    fs::remove(folder.path / "b1.sl");
    EXPECT_EQ(folder.found("hidden"), "c.sl");
}

// A line of a message is no longer than this where the fault stands near its beginning.
TEST(ShaderSearch, LinesOfMessagesAreCut) {
    ShaderCompiler compiler;
    Diagnostics d;
    compiler.loadText("surface s() { Ci = nothere; /*" + std::string(limits::kExcerptLine, '*') + "*/ }", "long", d);
    ASSERT_FALSE(d.all().empty());
    EXPECT_GT(d.all()[0].sourceLine.size(), 30u);
    EXPECT_LE(d.all()[0].sourceLine.size(), limits::kExcerptLine);
}

} // namespace
} // namespace alpenglow::rsl::shadersearch_test
