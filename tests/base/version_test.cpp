// The version is said in one place, CMakeLists.txt; whatever has to repeat it agrees.
#include "base/version.h"
#include <fstream>
#include <gtest/gtest.h>
#include <regex>

namespace version_test {

namespace {

std::string textOf(const std::string& name) {
    std::ifstream in(ALPENGLOW_SOURCE_DIR "/" + name);
    return {std::istreambuf_iterator<char>(in), {}};
}

std::string found(const std::string& text, const char* pattern) {
    std::smatch m;
    return std::regex_search(text, m, std::regex(pattern)) ? m[1].str() : "";
}

TEST(Version, IsThatOfTheProject) {
    const std::string version = found(textOf("CMakeLists.txt"), R"(project\(alpenglow VERSION ([0-9.]+))");
    EXPECT_EQ(alpenglow::versionText(), version);
    const auto& n = alpenglow::versionNumbers();
    EXPECT_EQ(std::to_string(n[0]) + "." + std::to_string(n[1]) + "." + std::to_string(n[2]), version);
}

TEST(Version, HasASectionInTheChanges) {
    EXPECT_NE(textOf("CHANGES.md").find(std::string("\n## [") + alpenglow::versionText() + "]"), std::string::npos);
}

TEST(Version, IsThatOfTheEditorsExtension) {
    EXPECT_EQ(found(textOf("editors/vscode/package.json"), R"x("version": "([0-9.]+)")x"), alpenglow::versionText());
    EXPECT_EQ(found(textOf("docs/editors.md"), R"(alpenglow\.alpenglow-([0-9.]+[0-9]))"), alpenglow::versionText());
}

} // namespace

} // namespace version_test
