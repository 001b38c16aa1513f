// What it costs to add one more of a kind: the files of src that name one example of each. docs/architecture.md has the table.
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <regex>
#include <set>
#include <string>

namespace addcosts_test {

namespace fs = std::filesystem;

namespace {

/// The words of a source in lower case, without comments: "makeTorus(al_bsdf_ward)" has make, torus, al, bsdf and ward.
std::set<std::string> wordsOf(const std::string& s) {
    std::set<std::string> words;
    std::string word;
    const auto end = [&] {
        if (!word.empty()) words.insert(std::move(word));
        word.clear();
    };
    const auto is = [&](size_t i, int (*kind)(int)) { return i < s.size() && kind(static_cast<unsigned char>(s[i])); };
    for (size_t i = 0; i < s.size(); ++i) {
        if (s[i] == '/' && i + 1 < s.size() && s[i + 1] == '/') i = std::min(s.find('\n', i), s.size());
        if (!is(i, std::isalnum)) {
            end();
            continue;
        }
        // A capital begins a word, unless it is inside of capitals: RIF, TorusV.
        if (is(i, std::isupper) && (!is(i - 1, std::isupper) || is(i + 1, std::islower))) end();
        word += char(std::tolower(static_cast<unsigned char>(s[i])));
    }
    end();
    return words;
}

/// The files of src whose code has one of these words. `others`: files in which the words mean something else.
std::set<std::string> filesThatName(const std::set<std::string>& examples, const std::set<std::string>& others = {}) {
    const fs::path src = fs::path(ALPENGLOW_SOURCE_DIR) / "src";
    std::set<std::string> files;
    for (const auto& e : fs::recursive_directory_iterator(src)) {
        const auto ext = e.path().extension();
        const std::string file = fs::relative(e.path(), src).string();
        if ((ext != ".cpp" && ext != ".h" && ext != ".inc") || others.count(file)) continue;
        std::ifstream in(e.path());
        const auto words = wordsOf({std::istreambuf_iterator<char>(in), {}});
        if (std::any_of(examples.begin(), examples.end(), [&](const std::string& e) { return words.count(e) > 0; }))
            files.insert(file);
    }
    return files;
}

std::string lines(const std::set<std::string>& files) {
    std::string text;
    for (const std::string& f : files) text += "\n    " + f;
    return text;
}

/// The row of docs/architecture.md, "The cost of adding", that begins with this.
int limitInTheTable(const std::string& kind) {
    std::ifstream in(fs::path(ALPENGLOW_SOURCE_DIR) / "docs/architecture.md");
    const std::regex row("\\| " + kind + R"( \| (\d+) \| .*)");
    std::smatch found;
    for (std::string line; std::getline(in, line);)
        if (std::regex_match(line, found, row)) return std::stoi(found[1]);
    return -1;
}

TEST(AddCosts, TheScannerFindsWords) {
    const auto words = wordsOf("case SiteKind::Torus: makeTorus(al_bsdf_ward, toward); // comment\nRIF(DiskV) \"cook-torrance\"");
    for (const char* w : {"site", "kind", "torus", "make", "ward", "toward", "rif", "disk", "cook", "torrance"})
        EXPECT_TRUE(words.count(w)) << w;
    EXPECT_FALSE(words.count("comment"));
}

// If a test fails, take the name out of the file that it lists: a descriptor, a trait or a table of the example's own file does
// what the file asks the name for.
TEST(AddCosts, Lobe) {
    const auto files = filesThatName({"ward"}, {"rsl/front/osl.cpp"}); // the closures of another language
    EXPECT_EQ(int(files.size()), limitInTheTable("a lobe, `ward`")) << lines(files);
}

TEST(AddCosts, Primitive) {
    const auto files = filesThatName({"torus"});
    EXPECT_EQ(int(files.size()), limitInTheTable("a primitive, `Torus`")) << lines(files);
}

TEST(AddCosts, Service) {
    const auto files = filesThatName({"ptexture"});
    EXPECT_EQ(int(files.size()), limitInTheTable("a service, `ptexture\\(\\)`")) << lines(files);
}

// Albedo is also a quantity of surfaces and of lobes: only the text of its name and the values of SampleResult are the output.
TEST(AddCosts, Output) {
    const fs::path src = fs::path(ALPENGLOW_SOURCE_DIR) / "src";
    const std::regex output(R"re("albedo"|'albedo'|\]->albedo\b|SampleResult::albedo,)re");
    const std::set<std::string> others = {"world/bindkernel.cpp", "shadeops/raytracing.cpp"}; // a parameter of subsurface()
    std::set<std::string> files = {"integrator/samples.h"};                                   // which declares the value
    for (const auto& e : fs::recursive_directory_iterator(src)) {
        const std::string file = fs::relative(e.path(), src).string();
        if (!e.is_regular_file() || others.count(file)) continue;
        std::ifstream in(e.path());
        for (std::string line; std::getline(in, line);)
            if (std::regex_search(line.substr(0, line.find("//")), output)) files.insert(file);
    }
    EXPECT_EQ(int(files.size()), limitInTheTable("an output, `albedo`")) << lines(files);
}

TEST(AddCosts, PictureFormat) {
    const auto files = filesThatName({"jpeg", "jpg"}, {"cli/foreignmodel.cpp"}); // pictures inside of models
    EXPECT_EQ(int(files.size()), limitInTheTable("a picture format, `JPEG`")) << lines(files);
}

} // namespace

} // namespace addcosts_test
