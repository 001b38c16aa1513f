// base/limits.h says that each limit has a test. This one holds it to that.
#include <cctype>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <set>
#include <sstream>

namespace every_limit_test {

namespace fs = std::filesystem;

namespace {

std::string textOf(const fs::path& p) {
    std::ifstream in(p);
    std::stringstream s;
    s << in.rdbuf();
    return s.str();
}

/// The names beginning with k and a capital letter.
std::set<std::string> constantsIn(const std::string& text) {
    auto inName = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; };
    std::set<std::string> names;
    for (size_t at = 0; at < text.size();) {
        size_t end = at;
        while (end < text.size() && inName(text[end])) ++end;
        if (end - at > 1 && text[at] == 'k' && std::isupper(static_cast<unsigned char>(text[at + 1])))
            names.insert(text.substr(at, end - at));
        at = end + 1;
    }
    return names;
}

std::set<std::string> usedBelow(const fs::path& folder) {
    std::set<std::string> names;
    for (const auto& e : fs::recursive_directory_iterator(folder)) {
        if (e.path().extension() != ".cpp" && e.path().extension() != ".h") continue;
        if (e.path().filename() == "limits.h") continue;
        for (const std::string& n : constantsIn(textOf(e.path()))) names.insert(n);
    }
    return names;
}

TEST(Limits, EachIsUsedAndHasATest) {
    const fs::path root = ALPENGLOW_SOURCE_DIR;
    const std::string header = textOf(root / "src/base/limits.h");
    const std::set<std::string> used = usedBelow(root / "src"), tested = usedBelow(root / "tests");
    int limits = 0;
    std::istringstream lines(header);
    for (std::string line; std::getline(lines, line);) {
        if (line.rfind("inline constexpr ", 0) != 0) continue;
        const std::set<std::string> names = constantsIn(line.substr(0, line.find('=')));
        ASSERT_EQ(names.size(), 1u) << line;
        ++limits;
        EXPECT_TRUE(used.count(*names.begin())) << *names.begin() << " bounds nothing";
        EXPECT_TRUE(tested.count(*names.begin())) << *names.begin() << " has no test";
    }
    EXPECT_GT(limits, 30);
}

} // namespace

} // namespace every_limit_test
