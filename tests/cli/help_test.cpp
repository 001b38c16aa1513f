// Manual pages and completions, which the program makes from the descriptions of its options.
#include "command_folder.h"
#include <algorithm>
#include <regex>
#include <set>
#include <sstream>

namespace help_test {

namespace {

class Help : public alpenglow::cli::testing::CommandFolder {
protected:
    std::string run(const std::string& arguments) { return CommandFolder::run(arguments, "2>err"); }
    std::vector<std::string> lines(const std::string& text) const {
        std::istringstream in(text);
        std::vector<std::string> all;
        for (std::string l; std::getline(in, l);) all.push_back(l);
        return all;
    }
    std::vector<std::string> commands() { return lines(run("help --commands")); }
    /// The text of a page with roff's spellings of characters taken back.
    std::string page(const std::string& command) {
        std::string text = run("help --man " + command);
        EXPECT_EQ(status, 0) << command;
        for (const auto& [roff, plain] : {std::pair{R"(\\-)", "-"}, {R"(\\\(aq)", "'"}, {R"(\\f[BIR])", ""}})
            text = std::regex_replace(text, std::regex(roff), plain);
        return text;
    }
    /// Words that bash offers for the last of `words`, or "FILES" where it completes file names.
    std::set<std::string> bash(const std::string& words) {
        write("try", R"(source ./script
files=1
compopt() { case "$*" in *"+o default"*) files= ;; esac; }
read -ra COMP_WORDS <<<"$1"
[[ $1 == *' ' ]] && COMP_WORDS+=('')
COMP_CWORD=$((${#COMP_WORDS[@]} - 1))
_alpenglow
printf '%s\n' "${COMPREPLY[@]}"
[ ${#COMPREPLY[@]} -gt 0 ] || [ ! "$files" ] || echo FILES
)");
        write("script", run("help --completion bash"));
        const std::string program = ALPENGLOW_PROGRAM;
        std::string text = words;
        text.replace(0, std::string("alpenglow").size(), program);
        std::set<std::string> all;
        const std::string command = "cd '" + dir.string() + "' && bash -u try '" + text + "' >words 2>&1";
        EXPECT_EQ(std::system(command.c_str()), 0) << words;
        std::ifstream in(dir / "words");
        for (std::string l; std::getline(in, l);)
            if (!l.empty()) all.insert(l);
        return all;
    }
};

using Words = std::set<std::string>;

TEST_F(Help, ManualPagesHaveEveryOption) {
    ASSERT_GE(commands().size(), 12u);
    for (const std::string& c : commands()) {
        const std::string text = page(c), help = run(c + " --help");
        EXPECT_EQ(text.find(".TH ALPENGLOW-"), text.find(".TH"));
        EXPECT_NE(text.find("\n.SH NAME\nalpenglow-" + c + " - "), text.npos) << c;
        const std::regex option("(^|[ ,])(--?[a-zA-Z][a-z-]*)");
        for (const std::string& l : lines(help)) {
            if (!l.starts_with("  -")) continue;
            const std::string names = l.substr(2, 32);
            for (std::sregex_iterator i(names.begin(), names.end(), option), end; i != end; ++i)
                EXPECT_NE(text.find((*i)[2].str()), text.npos) << c << " " << (*i)[2].str();
        }
    }
    EXPECT_NE(page("render").find(".SS Pictures\n"), std::string::npos);
    EXPECT_NE(page("render").find("--preview[=auto|kitty|sixel|blocks]"), std::string::npos);
    EXPECT_NE(page("ptc").find(".SS Of bounce\n"), std::string::npos);
    EXPECT_NE(page("merge").find(".SH SYNOPSIS\nalpenglow merge [options] parts ...\n"), std::string::npos) << page("merge");
}

TEST_F(Help, TheProgramsPageHasCommandsStatusesAndVariables) {
    const std::string text = page("");
    for (const std::string& c : commands()) EXPECT_NE(text.find(".TP\n" + c + "\n"), text.npos) << c;
    for (const char* status : {"0", "1", "2", "3", "4", "5", "130"})
        EXPECT_NE(text.find(std::string(".TP\n") + status + "\n"), text.npos) << status;
    // Every variable of ours that a source names.
    const std::regex variable("\"(ALPENGLOW_[A-Z]+)\"");
    std::set<std::string> names;
    for (const auto& e : std::filesystem::recursive_directory_iterator(ALPENGLOW_SOURCE_DIR "/src")) {
        if (e.path().extension() != ".cpp") continue;
        std::ifstream in(e.path());
        for (std::string l; std::getline(in, l);)
            for (std::sregex_iterator i(l.begin(), l.end(), variable), end; i != end; ++i) names.insert((*i)[1].str());
    }
    EXPECT_TRUE(names.contains("ALPENGLOW_JIT"));
    for (const std::string& n : names) EXPECT_NE(text.find(".TP\n" + n + "\n"), text.npos) << n;
}

TEST_F(Help, BashCompletesCommandsOptionsAndValues) {
    write("scene.rib", "");
    Words first = bash("alpenglow ");
    for (const std::string& c : commands()) EXPECT_TRUE(first.contains(c)) << c;
    EXPECT_TRUE(first.contains("scene.rib"));
    EXPECT_EQ(bash("alpenglow mer"), Words{"merge"});
    EXPECT_EQ(bash("alpenglow render --hi"), Words{"--hider"});
    EXPECT_EQ(bash("alpenglow render --hider "), (Words{"hidden", "path", "photon", "raytrace"}));
    EXPECT_EQ(bash("alpenglow render --hider p"), (Words{"path", "photon"}));
    EXPECT_EQ(bash("alpenglow render --hider = pa"), Words{"path"}); // as readline splits --hider=pa
    EXPECT_EQ(bash("alpenglow scene.rib --pre"), (Words{"--preset", "--preview"}));
    EXPECT_EQ(bash("alpenglow render --preview = s"), Words{"sixel"});
    EXPECT_EQ(bash("alpenglow render --preview "), Words{"FILES"}); // its value must follow =
    EXPECT_EQ(bash("alpenglow render -o "), Words{"FILES"});
    EXPECT_EQ(bash("alpenglow render --spp "), Words{});
    EXPECT_EQ(bash("alpenglow render "), Words{"FILES"});
    EXPECT_EQ(bash("alpenglow eval "), Words{});
    EXPECT_EQ(bash("alpenglow ptc b"), (Words{"bounce", "brick"}));
    EXPECT_EQ(bash("alpenglow ptc bounce --alb"), Words{"--albedo"});
    EXPECT_EQ(bash("alpenglow ptc bounce "), Words{"FILES"});
    EXPECT_EQ(bash("alpenglow help sh"), Words{"shade"});
    EXPECT_TRUE(bash("alpenglow info --shadeops nois").contains("noise"));
}

TEST_F(Help, OtherShells) {
    const std::string zsh = run("help --completion zsh"), fish = run("help --completion fish");
    EXPECT_TRUE(zsh.starts_with("#compdef alpenglow\n"));
    EXPECT_NE(zsh.find("'--hider=[Override the scene'\\''s Hider]:NAME:(hidden raytrace path "
                       "photon)'"),
              zsh.npos);
    EXPECT_NE(fish.find("complete -c alpenglow -n '__alpenglow_uses render' -l hider -x -a 'hidden raytrace path photon' -d "
                        "'Override the scene\\'s Hider'"),
              fish.npos);
    for (const auto& [shell, script] : {std::pair{"zsh -n", zsh}, std::pair{"fish --no-execute", fish}}) {
        write("script", script);
        const std::string program = std::string(shell).substr(0, std::string(shell).find(' '));
        const std::string command =
            "cd '" + dir.string() + "' && if command -v " + program + " >/dev/null; then " + shell + " script; fi";
        EXPECT_EQ(std::system(command.c_str()), 0) << shell;
    }
    run("help --completion tcsh");
    EXPECT_EQ(status, 2);
    run("help --man nosuch");
    EXPECT_EQ(status, 2);
}

} // namespace

} // namespace help_test
