// Links between documents: each leads to a file or folder of the checkout, and to a heading that is there.
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace links_test {

namespace fs = std::filesystem;

namespace {

std::string textOf(const fs::path& p) {
    std::ifstream in(p);
    return {std::istreambuf_iterator<char>(in), {}};
}

/// The text without its code: blocks between ``` lines, and spans between backquotes.
std::string proseOf(const std::string& text) {
    std::string prose;
    bool block = false;
    for (size_t at = 0; at < text.size();) {
        const size_t end = std::min(text.find('\n', at), text.size());
        const std::string line = text.substr(at, end - at);
        if (line.starts_with("```")) block = !block;
        else if (!block) prose += line + "\n";
        at = end + 1;
    }
    bool span = false;
    std::string rest;
    for (const char c : prose)
        if (c == '`') span = !span;
        else if (!span) rest += c;
    return rest;
}

/// The anchor that web pages make of a heading: lower case, blanks are hyphens, other signs are left out.
std::string anchorOf(const std::string& heading) {
    std::string anchor;
    for (const char c : heading) {
        const auto u = static_cast<unsigned char>(c);
        if (std::isalnum(u) || c == '_' || c == '-' || u >= 0x80) anchor += char(std::tolower(u));
        else if (c == ' ') anchor += '-';
    }
    return anchor;
}

std::set<std::string> anchorsOf(const fs::path& page) {
    std::set<std::string> anchors;
    std::ifstream in(page);
    for (std::string line; std::getline(in, line);) {
        const size_t depth = line.find_first_not_of('#');
        if (depth > 0 && depth < line.size() && line[depth] == ' ') anchors.insert(anchorOf(line.substr(depth + 1)));
    }
    return anchors;
}

std::vector<fs::path> documents() {
    const fs::path root = ALPENGLOW_SOURCE_DIR;
    std::vector<fs::path> all{root / "bench/RESULTS.md", root / "editors/vscode/README.md"};
    for (const auto& e : fs::directory_iterator(root))
        if (e.path().extension() == ".md") all.push_back(e.path());
    for (const auto& e : fs::recursive_directory_iterator(root / "docs"))
        if (e.path().extension() == ".md") all.push_back(e.path());
    return all;
}

} // namespace

TEST(Documents, EveryLinkLeadsSomewhere) {
    const std::regex link(R"(\]\(([^)\s]+)\))"), elsewhere("^[a-z]+:");
    int links = 0;
    for (const fs::path& page : documents()) {
        const std::string prose = proseOf(textOf(page));
        for (std::sregex_iterator i(prose.begin(), prose.end(), link), end; i != end; ++i) {
            const std::string target = (*i)[1];
            if (std::regex_search(target, elsewhere)) continue;
            ++links;
            const size_t mark = target.find('#');
            const fs::path to = mark == 0 ? page : page.parent_path() / target.substr(0, mark);
            EXPECT_TRUE(fs::exists(to)) << page << ": " << target;
            if (mark != std::string::npos && to.extension() == ".md")
                EXPECT_TRUE(anchorsOf(to).count(target.substr(mark + 1))) << page << ": " << target;
        }
    }
    EXPECT_GT(links, 300);
}

} // namespace links_test
