// The requests that stand in the text of docs/ and README.md can be copied: each is read without a message.
#include "collect.h"
#include "ri/requests/request.h"
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>

namespace documents_test {

using namespace alpenglow;
using namespace alpenglow::ri;
namespace fs = std::filesystem;

namespace {

std::string textOf(const fs::path& p) {
    std::ifstream in(p);
    return {std::istreambuf_iterator<char>(in), {}};
}

/// What stands between backquotes in a line or over two, not in blocks.
std::vector<std::string> spansOf(const std::string& page) {
    std::vector<std::string> spans;
    const std::string prose = std::regex_replace(page, std::regex("```[^`]*```"), "");
    const std::regex span("`([^`]+)`");
    for (std::sregex_iterator i(prose.begin(), prose.end(), span), end; i != end; ++i) {
        std::string s = (*i)[1];
        std::replace(s.begin(), s.end(), '\n', ' ');
        spans.push_back(s);
    }
    return spans;
}

/// Whether a span is more than the name of a request, an option or an attribute: it says a value.
bool isExample(const std::string& s) {
    const size_t blank = s.find(' ');
    if (blank == s.npos || !findRequest(s.substr(0, blank))) return false;
    for (const char* gap : {"...", "…", "[bound]", " value", " parameters"}) // something is left out
        if (s.find(gap) != s.npos) return false;
    const auto quotes = std::count(s.begin(), s.end(), '"');
    const bool named = s.starts_with("Attribute") || s.starts_with("Option");
    const bool value = named ? quotes >= 6 || (quotes == 4 && s.back() != '"') : true;
    return value && s != "Display \"deepshad\"" && s != "Quantize \"rgba\"";
}

} // namespace

TEST(Documents, RequestsCanBeCopied) {
    std::vector<fs::path> pages{fs::path(ALPENGLOW_SOURCE_DIR) / "README.md"};
    for (const auto& e : fs::directory_iterator(fs::path(ALPENGLOW_SOURCE_DIR) / "docs"))
        if (e.path().extension() == ".md" && e.path().stem() != "rib" && e.path().stem() != "options") // tested as tables
            pages.push_back(e.path());
    int examples = 0;
    for (const fs::path& page : pages)
        for (std::string s : spansOf(textOf(page))) {
            if (!isExample(s)) continue;
            ++examples;
            if (s.ends_with(" N")) s.replace(s.size() - 1, 1, "4"); // a number
            const Request* r = findRequest(s.substr(0, s.find(' ')));
            const bool before = (r->scopes & kWorld) == 0; // of the world
            if (s.starts_with("SolidBegin")) s += " Sphere 1 -1 1 360 SolidEnd";
            auto c = read(before ? s : "WorldBegin " + s + " Sphere 1 -1 1 360 WorldEnd");
            EXPECT_EQ(c->messages(), "") << page << ": " << s;
        }
    EXPECT_GT(examples, 25);
}

} // namespace documents_test
