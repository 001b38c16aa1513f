// Every citation leads somewhere: files of the repository and their headings, sections and tables of RISpec 3.2 and of the
// 3Delight manual. Comments, documents and strings of src, tests, include, shaders, examples, bench, scripts and cmake are read.
#include <algorithm>
#include <cctype>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace citations_test {

namespace fs = std::filesystem;

namespace {

const fs::path kRoot = ALPENGLOW_SOURCE_DIR;

/// Folders whose texts are read. What stands in CHANGES.md and bench/RESULTS.md is history.
constexpr const char* kFolders[] = {"src",   "tests", "include", "shaders", "examples",
                                    "bench", "docs",  "scripts", "cmake",   "editors"};
constexpr const char* kDocuments[] = {"README.md", "CONTRIBUTING.md", "SECURITY.md"};
constexpr const char* kUnread[] = {"bench/RESULTS.md", "tests/base/citations_test.cpp", "tests/fuzz/corpus"};

/// Sections of "The RenderMan Interface", version 3.2 (July 2000).
const std::set<std::string> kRISpec = {
    "1",     "2",     "3",     "4",     "4.1",   "4.1.1", "4.1.2",  "4.1.3",  "4.1.4",  "4.2",    "4.2.1", "4.2.2", "4.2.3",
    "4.2.4", "4.2.5", "4.2.6", "4.2.7", "4.2.8", "4.2.9", "4.2.10", "4.2.11", "4.2.12", "4.2.13", "4.3",   "4.3.1", "4.3.2",
    "4.4",   "5",     "5.1",   "5.2",   "5.3",   "5.4",   "5.5",    "5.6",    "5.7",    "5.8",    "5.9",   "5.10",  "6",
    "7",     "7.1",   "7.2",   "7.3",   "8",     "9",     "10",     "11",     "12",     "12.1",   "12.2",  "12.3",  "12.4",
    "12.5",  "13",    "13.1",  "13.2",  "13.3",  "14",    "14.1",   "14.2",   "15",     "15.1",   "15.2",  "15.3",  "15.4",
    "15.5",  "15.6",  "15.7",  "15.8",  "16",    "A",     "B",      "C",      "C.1",    "C.2",    "D",     "E"};
/// Sections and tables of the 3Delight User's Manual, version 10.0.
const std::set<std::string> kManual = {"6.1",     "6.1.1", "6.1.1.1", "6.1.1.2", "6.2",   "6.3",     "6.4",
                                       "6.4.1",   "6.4.2", "6.4.3",   "6.4.4",   "6.4.5", "6.4.5.1", "6.4.5.2",
                                       "6.4.5.3", "6.4.6", "6.4.7",   "6.4.8",   "6.4.9", "6.4.10"};
const std::set<std::string> kTables = {"6.10", "6.11", "6.14", "6.15", "6.16", "6.17", "6.18", "6.19", "6.20", "6.21", "6.22"};

struct Line {
    std::string file, text; ///< file: from the root
    int number;
    bool document;
};
std::ostream& operator<<(std::ostream& out, const Line& l) { return out << l.file << ":" << l.number << ": "; }

bool hasText(const fs::path& p) {
    static const std::set<std::string> kinds = {".cpp", ".h",  ".inc", ".c",  ".md",    ".sl", ".rsl",
                                                ".rib", ".py", ".sh",  ".js", ".cmake", ""};
    return kinds.count(p.extension().string()) > 0;
}

void readFile(const std::string& file, std::vector<Line>& out) {
    for (const char* unread : kUnread)
        if (file.rfind(unread, 0) == 0) return;
    std::ifstream in(kRoot / file);
    std::string text;
    for (int n = 1; std::getline(in, text); ++n) out.push_back({file, text, n, file.ends_with(".md")});
}

const std::vector<Line>& lines() {
    static const std::vector<Line> all = [] {
        std::vector<Line> out;
        for (const char* folder : kFolders)
            for (const auto& e : fs::recursive_directory_iterator(kRoot / folder))
                if (e.is_regular_file() && hasText(e.path())) readFile(fs::relative(e.path(), kRoot).string(), out);
        for (const char* document : kDocuments) readFile(document, out);
        return out;
    }();
    return all;
}

/// Headings of a document, without the marks of code.
const std::vector<std::string>& headingsOf(const std::string& file) {
    static std::map<std::string, std::vector<std::string>> known;
    auto [at, fresh] = known.try_emplace(file);
    if (!fresh) return at->second;
    std::ifstream in(kRoot / file);
    std::string text;
    for (bool code = false; std::getline(in, text);) {
        if (text.rfind("```", 0) == 0) code = !code;
        const size_t level = text.find_first_not_of('#');
        if (code || level == 0 || level == std::string::npos || text[level] != ' ') continue;
        std::string heading = text.substr(level + 1);
        std::erase(heading, '`');
        at->second.push_back(heading);
    }
    return at->second;
}

/// The anchor of a heading: small letters, digits, - and _; blanks become -.
std::string anchorOf(const std::string& heading) {
    std::string out;
    for (const char c : heading) {
        if (std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_') out += char(std::tolower(c));
        else if (c == ' ') out += '-';
    }
    return out;
}

bool hasAnchor(const std::string& file, const std::string& anchor) {
    const auto& all = headingsOf(file);
    return std::any_of(all.begin(), all.end(), [&](const std::string& h) { return anchorOf(h) == anchor; });
}

/// Calls `found` with each match of a pattern in the lines that hold `word`.
template <class Found> void each(const char* word, const std::regex& pattern, const Found& found) {
    for (const Line& l : lines()) {
        if (l.text.find(word) == std::string::npos) continue;
        for (std::sregex_iterator i(l.text.begin(), l.text.end(), pattern), end; i != end; ++i) found(l, *i);
    }
}

/// The file that a citation in this line means, from the root; "" if there is none.
std::string cited(const Line& l, const std::string& name) {
    const fs::path places[] = {fs::path(l.file).parent_path() / name, name};
    for (const fs::path& p : places)
        if (fs::exists(kRoot / p.lexically_normal())) return p.lexically_normal().string();
    return {};
}

bool inComment(const Line& l, size_t at) {
    return l.document || l.file.ends_with(".sl") || l.text.rfind("//", at) != std::string::npos ||
           (l.file.ends_with(".cmake") && l.text[0] == '#');
}

} // namespace

TEST(Citations, Documents) {
    // A name, perhaps with #anchor or , "Heading" behind it. Names of pages on other servers are none of ours.
    const std::regex name(R"x(((?:\.\./)*[A-Za-z0-9_][A-Za-z0-9_./-]*\.md)\b(?:#([A-Za-z0-9_-]+)|, "([^"]+)")?)x");
    int found = 0;
    each(".md", name, [&](const Line& l, const std::smatch& m) {
        const size_t at = size_t(m.position());
        const std::string text = m[1];
        if (at > 0 && (std::isalnum(static_cast<unsigned char>(l.text[at - 1])) || std::strchr(".:-", l.text[at - 1]))) return;
        if (l.text.substr(0, at).find("://") != std::string::npos && l.text.rfind(' ', at) < l.text.rfind("://", at)) return;
        if (!inComment(l, at) && text.rfind("docs/", 0) != 0) return;
        ++found;
        const std::string file = cited(l, text);
        EXPECT_NE(file, "") << l << "there is no " << text;
        if (file.empty()) return;
        if (m[2].matched) { EXPECT_TRUE(hasAnchor(file, m[2])) << l << file << " has no heading #" << m[2]; }
        if (m[3].matched) { EXPECT_TRUE(hasAnchor(file, anchorOf(m[3]))) << l << file << " has no heading \"" << m[3] << "\""; }
    });
    EXPECT_GT(found, 400);
}

TEST(Citations, FilesInDocuments) {
    const std::regex path(R"((?:^|[^A-Za-z0-9_/.-])((?:src|tests|shaders|scripts|bench|examples|include|docs)/)"
                          R"([A-Za-z0-9_./-]+\.[a-z]{1,5})(?![A-Za-z0-9_/]))");
    each("/", path, [&](const Line& l, const std::smatch& m) {
        const std::string file = m[1];
        if (!l.document || fs::path(file).extension() == ".exr" || fs::path(file).extension() == ".json") return;
        EXPECT_NE(cited(l, file), "") << l << "there is no " << file;
    });
}

// `lobe.h`, `base/owen.h`: the end of the name of a file.
TEST(Citations, SourcesInDocuments) {
    std::set<std::string> ends;
    for (const char* folder : kFolders)
        for (const auto& e : fs::recursive_directory_iterator(kRoot / folder)) {
            fs::path end;
            for (fs::path p = fs::relative(e.path(), kRoot); !p.empty(); p = p.parent_path()) {
                end = end.empty() ? p.filename() : p.filename() / end;
                ends.insert(end.string());
            }
        }
    each(".", std::regex(R"(`([a-z0-9_/]+\.(?:h|cpp|inc|sl|py))`)"), [&](const Line& l, const std::smatch& m) {
        if (l.document) { EXPECT_TRUE(ends.count(m[1])) << l << "there is no " << m[1]; }
    });
}

TEST(Citations, SectionsOfRISpec) {
    int found = 0;
    each("RISpec 3.2", std::regex(R"(RISpec 3\.2,? (?:sections? |appendix )?([0-9]+(?:\.[0-9]+)*|[A-Z](?:\.[0-9]+)?\b))"),
         [&](const Line& l, const std::smatch& m) {
             if (std::isalpha(static_cast<unsigned char>(m[1].str()[0])) && m.str().find("appendix") == std::string::npos) return;
             ++found;
             EXPECT_TRUE(kRISpec.count(m[1])) << l << "RISpec 3.2 has no section " << m[1];
             EXPECT_NE(m.str().find(','), std::string::npos) << l << "a section is cited as in \"RISpec 3.2, 5.4\"";
         });
    EXPECT_GT(found, 60);
}

TEST(Citations, SectionsOfTheManual) {
    int found = 0;
    each("3Delight manual", std::regex(R"(3Delight manual, (6(?:\.[0-9]+)+))"), [&](const Line& l, const std::smatch& m) {
        ++found;
        EXPECT_TRUE(kManual.count(m[1])) << l << "the 3Delight manual has no section " << m[1];
    });
    each("able", std::regex(R"([Tt]ables? (6\.[0-9]+)(?: and (6\.[0-9]+))?)"), [&](const Line& l, const std::smatch& m) {
        for (size_t k = 1; k < 3; ++k)
            if (m[k].matched) { EXPECT_TRUE(kTables.count(m[k])) << l << "the 3Delight manual has no table " << m[k]; }
    });
    EXPECT_GT(found, 60);
}

// Sources that nobody can look up.
TEST(Citations, NameNoSourceThatIsNotThere) {
    const std::pair<const char*, const char*> none[] = {{"ecision", R"([Dd]esign decisions? [0-9])"},
                                                        {"seed", R"([Tt]he seed's|Source: seed|\bseed 6\.)"},
                                                        {"shared/", R"(shared/(?:reference|design))"},
                                                        {"plan", R"(test plan)"},
                                                        {"(k)", R"x((?:[^A-Za-z0-9_>]|^)\(k\)[.;,"])x"}};
    for (const auto& [word, pattern] : none)
        each(word, std::regex(pattern),
             [](const Line& l, const std::smatch& m) { ADD_FAILURE() << l << "\"" << m.str() << "\""; });
}

} // namespace citations_test
