// The command lines that stand in the documents are of commands and options that there are.
#include "command_folder.h"
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <vector>

namespace commands_in_docs_test {

namespace fs = std::filesystem;

namespace {

using CommandsInDocs = alpenglow::cli::testing::CommandFolder;

/// What stands between backquotes and begins with the program's name, and lines that do.
std::vector<std::string> commandsOf(const fs::path& page) {
    std::ifstream in(page);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    std::vector<std::string> all;
    const std::regex span("`(alpenglow [^`]*)`"), line("(^|\n) *(alpenglow [^\n]*)");
    for (std::sregex_iterator i(text.begin(), text.end(), span), end; i != end; ++i) all.push_back((*i)[1]);
    for (std::sregex_iterator i(text.begin(), text.end(), line), end; i != end; ++i) all.push_back((*i)[2]);
    return all;
}

} // namespace

TEST_F(CommandsInDocs, AreCommandsAndOptionsThatThereAre) {
    const fs::path root = ALPENGLOW_SOURCE_DIR;
    std::vector<fs::path> pages{root / "README.md", root / "CONTRIBUTING.md", root / "SECURITY.md"};
    for (const auto& e : fs::directory_iterator(root / "docs"))
        if (e.path().extension() == ".md") pages.push_back(e.path());
    const std::set<std::string> commands{"render", "view", "eval",   "shade", "compile", "info", "probe", "ptc",
                                         "merge",  "diff", "maketx", "lsp",   "help",    "rib",  "from"};
    std::map<std::string, std::string> help;
    int lines = 0, options = 0;
    for (const fs::path& page : pages)
        for (const std::string& command : commandsOf(page)) {
            std::istringstream words(command);
            std::string word, which = "render";
            words >> word >> word;
            if (commands.count(word)) which = word;
            ++lines;
            if (which == "help") continue; // its options are for scripts and packages, and stand in no help
            do {
                if (word.starts_with("#")) break; // what the line is for
                if (!word.starts_with("--") || word == "--help" || word == "--version") continue;
                std::string& text = help[which];
                if (text.empty()) text = run(which + " --help", "2>&1") + "\n";
                const std::string option = word.substr(0, word.find_first_of("=,;:)]"));
                ++options;
                EXPECT_TRUE(std::regex_search(text, std::regex(option + "[^a-z-]"))) << page << ": " << command << ": " << option;
            } while (words >> word);
        }
    EXPECT_GT(lines, 80);
    EXPECT_GT(options, 40);
}

} // namespace commands_in_docs_test
