// Sources of the rooms of transport stay readable: no line above 130 columns, no function above 80 lines.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <string>
#include <vector>

namespace lengths_test {

namespace fs = std::filesystem;

namespace {

constexpr size_t kColumns = 130;
constexpr int kLines = 80;

/// Columns of a line of UTF-8: continuation bytes take none.
size_t columns(const std::string& line) {
    size_t n = 0;
    for (const char c : line) n += (c & 0xC0) != 0x80;
    return n;
}

struct Function {
    std::string head;
    int line = 0, lines = 0;
};

/// Functions outside of classes, as the sources are formatted: they begin at the first column, their body ends with "}" there,
/// and nothing between does.
std::vector<Function> functionsIn(const std::vector<std::string>& lines) {
    static const std::vector<std::string> kOther = {"namespace", "struct", "class",  "enum",
                                                    "union",     "using",  "extern", "typedef"};
    std::vector<Function> found;
    std::string head;
    int begin = -1;
    for (size_t i = 0; i < lines.size(); ++i) {
        const std::string& l = lines[i];
        if (begin >= 0) {
            if (l.rfind("}", 0) != 0) continue;
            found.push_back({head, begin + 1, int(i) - begin + 1});
            begin = -1;
            head.clear();
            continue;
        }
        const bool continued = !head.empty() && l.rfind(" ", 0) == 0;
        if (!continued) {
            const std::string word = l.substr(0, l.find_first_of(" (<:"));
            const bool starts = !l.empty() && std::string(" }#/").find(l[0]) == std::string::npos;
            head = starts && std::find(kOther.begin(), kOther.end(), word) == kOther.end() ? l : "";
        }
        if (head.empty() || l.empty()) continue;
        if (l.back() == ';' || l.back() == '}') head.clear();
        else if (l.back() == '{') begin = int(i);
    }
    return found;
}

std::vector<std::string> linesOf(const fs::path& p) {
    std::ifstream in(p);
    std::vector<std::string> lines;
    for (std::string l; std::getline(in, l);) lines.push_back(l);
    return lines;
}

TEST(Lengths, FunctionsAreFound) {
    const std::vector<Function> f =
        functionsIn({"namespace a {", "struct B {", "    int f() {", "    }", "};", "int f();", "template <class T>",
                     "static int g(int a,", "             int b) {", "    if (a) {", "    }", "    return b;", "}",
                     "int h() { return 1; }", "void C::d() {", "}", "} // namespace a"});
    ASSERT_EQ(f.size(), 2u);
    EXPECT_EQ(f[0].line, 9);
    EXPECT_EQ(f[0].lines, 5);
    EXPECT_EQ(f[1].lines, 2);
}

TEST(Lengths, RoomsOfTransport) {
    const fs::path src = fs::path(ALPENGLOW_SOURCE_DIR) / "src";
    int functions = 0;
    for (const char* room : {"lobes", "world", "answers", "wave", "transport"})
        for (const auto& e : fs::recursive_directory_iterator(src / room)) {
            const auto ext = e.path().extension();
            if (ext != ".cpp" && ext != ".h" && ext != ".inc") continue;
            const std::string file = fs::relative(e.path(), src).string();
            const std::vector<std::string> lines = linesOf(e.path());
            for (size_t i = 0; i < lines.size(); ++i) EXPECT_LE(columns(lines[i]), kColumns) << file << ":" << i + 1;
            for (const Function& f : functionsIn(lines)) {
                ++functions;
                EXPECT_LE(f.lines, kLines) << file << ":" << f.line << " " << f.head;
            }
        }
    EXPECT_GT(functions, 300);
}

} // namespace

} // namespace lengths_test
