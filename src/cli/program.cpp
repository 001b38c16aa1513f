// Finds the subcommand, reads its arguments. `alpenglow scene.rib` is `alpenglow render scene.rib`.
#include "base/diagnostics.h"
#include "base/memory.h"
#include "base/printable.h"
#include "base/processors.h"
#include "cli/command.h"
#include "cli/completion.h"
#include "cli/manpage.h"
#include "cli/oldflags.h"
#include "cli/oldnames.h"
#include "cli/rcfile.h"
#include "cli/version.h"
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <fmt/format.h>
#include <iterator>
#include <sstream>
#include <unistd.h>

namespace alpenglow::cli {
namespace {

/// A command line as the parser takes it. `error`: not "", then it ends with status 2 and this text. `text`: not "", then it is
/// printed, and that is all.
struct CommandLine {
    std::vector<std::string> arguments;
    std::string error, text;
};

std::vector<std::string> commandNames(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::App* s : app.get_subcommands([](const CLI::App*) { return true; })) names.push_back(s->get_name());
    return names;
}

/// A word in the place of a command that is neither a command nor a file, but near to a command.
std::string unknownCommand(const std::string& word, const std::vector<std::string>& commands) {
    if (word.empty() || word[0] == '-' || word.find_first_of("./") != word.npos || access(word.c_str(), F_OK) == 0) return "";
    const std::string near = nearestName(word, commands);
    return near.empty() ? "" : "there is no command and no file \"" + word + "\"; did you mean \"" + near + "\"?";
}

/// help, help COMMAND, help --man [COMMAND], help --completion SHELL, help --commands.
CommandLine helpFor(const std::vector<std::string>& args, const CLI::App& app) {
    const std::string what = args.size() > 1 ? args[1] : "";
    if (what == "--completion") {
        const std::string shell = args.size() > 2 ? args[2] : "", text = completion(programText(app), shell);
        return {{}, text.empty() ? "help --completion takes bash, zsh or fish" : "", text};
    }
    const std::vector<std::string> commands = commandNames(app);
    if (what == "--commands") return {{}, "", joined(commands, "\n") + "\n"};
    const bool man = what == "--man";
    const std::string command = !man ? what : args.size() > 2 ? args[2] : "";
    if (!command.empty() && std::find(commands.begin(), commands.end(), command) == commands.end()) {
        const std::string near = nearestName(command, commands);
        return {{}, "there is no command \"" + command + "\"" + (near.empty() ? "" : "; did you mean \"" + near + "\"?"), ""};
    }
    if (man) return {{}, "", manPage(programText(app), command)};
    return {command.empty() ? std::vector<std::string>{"--help"} : std::vector<std::string>{command, "--help"}, "", ""};
}

/// Called by the name of another renderer's program: its command, and what there is to say.
void takeOldName(CommandLine& line, const OldName& name) {
    std::vector<std::string>& args = line.arguments;
    if (name.command.empty()) {
        line.error = fmt::format("{} is not done here: {}", name.name, name.instead);
        return;
    }
    if (!name.instead.empty())
        std::fprintf(stderr, "note: %s: %s\n", std::string(name.name).c_str(), std::string(name.instead).c_str());
    const auto is = [&](const char* flag) { return std::find(args.begin(), args.end(), flag) != args.end(); };
    if (is("-version") || is("--version")) {
        args = {"--version"};
        return;
    }
    std::istringstream words{std::string(name.command)};
    const std::vector<std::string> command{std::istream_iterator<std::string>(words), {}};
    const bool files =
        std::any_of(args.begin(), args.end(), [](const std::string& a) { return !a.starts_with('-') || a == "-"; });
    if (command[0] == "compile" && !files && !is("--help") && !is("-h")) args.push_back("-"); // what these tools read then
    args.insert(args.begin(), command.begin(), command.end());
}

/// Flags of other renderers, as render and the tools take them; what was replaced is noted under -v.
void takeOldFlags(CommandLine& line) {
    std::vector<std::string>& args = line.arguments;
    const std::vector<std::string> given(args.begin() + 1, args.end());
    TranslatedFlags t = args[0] == "render" ? translateOldFlags(given) : translateFlags(toolFlags(args[0]), given);
    line.error = t.error;
    args.resize(1);
    args.insert(args.end(), t.arguments.begin(), t.arguments.end());
    const auto has = [&](const char* flag) { return std::find(args.begin(), args.end(), flag) != args.end(); };
    if (has("--version")) args = {"--version"};
    const auto say = [](const std::vector<std::string>& notes) {
        for (const std::string& n : notes) std::fprintf(stderr, "note: %s\n", printable(n).c_str());
    };
    if (has("-v") || has("--verbose")) say(t.notes);
    if (!has("-q") && !has("--quiet")) say(t.withoutEquivalent);
}

/// Finds the command, and makes old tools' spellings what the parser takes: prman's -res, maketx's -envlatl, numbers like -.5.
CommandLine normalise(int argc, char** argv, const CLI::App& app) {
    CommandLine line{{argv + 1, argv + argc}, "", ""};
    std::vector<std::string>& args = line.arguments;
    const std::vector<std::string> commands = commandNames(app);
    const OldName* const old = oldNameOf(argc > 0 ? argv[0] : nullptr);
    if (old) takeOldName(line, *old);
    if (!line.error.empty()) return line;
    if (args.empty() && standardInputHasData()) args = {"render"}; // prman < scene.rib
    if (!args.empty()) {
        if (args[0] == "help") return helpFor(args, app);
        const bool known = std::find(commands.begin(), commands.end(), args[0]) != commands.end();
        if (!known) line.error = unknownCommand(args[0], commands);
        if (!known && args[0] != "-h" && args[0] != "--help" && args[0] != "--version" && args[0] != "--help-all")
            args.insert(args.begin(), "render");
        takeCatrib(args, old);
        if ((args[0] == "render" || !toolFlags(args[0]).empty()) && line.error.empty()) takeOldFlags(line);
    }
    for (size_t i = 1; i < args.size(); ++i) {
        std::string& a = args[i];
        if (a.size() > 2 && a[0] == '-' && a[1] == '.' && std::isdigit(static_cast<unsigned char>(a[2]))) a.insert(1, "0");
        if (args[0] == "maketx" && a.size() > 2 && a[0] == '-' && std::isalpha(static_cast<unsigned char>(a[1])))
            a.insert(0, "-");
    }
    return line;
}

/// What to say about arguments that the command does not have; "" when there are none.
std::string unknownOptions(const CLI::App& app) {
    for (const CLI::App* sub : app.get_subcommands()) {
        std::vector<std::string> names;
        for (const CLI::Option* o : sub->get_options()) {
            for (const std::string& n : o->get_lnames()) names.push_back("--" + n);
            for (const std::string& n : o->get_snames()) names.push_back("-" + n);
        }
        for (const std::string& word : sub->remaining()) {
            if (word.size() < 2 || word[0] != '-') return sub->get_name() + " does not take \"" + word + "\"";
            const std::string name = word.substr(0, word.find('=')), near = nearestName(name, names);
            return sub->get_name() + " has no option " + name + (near.empty() ? "" : "; did you mean " + near + "?");
        }
    }
    return "";
}

/// "Exit status: 0 done; 1 ...", in two lines.
std::string exitStatuses() {
    std::string s = "Exit status: ";
    for (const StatusText& t : statusTexts())
        s += std::to_string(t.status) + " " + t.meaning + (t.status == kInterrupted ? "." : t.status == kLimit ? ";\n" : "; ");
    return s;
}

/// Options of render that the user has in .alpenglowrc; those of the command line come behind them and have the last word.
std::vector<std::string> optionsOfRcFiles(const std::vector<std::string>& args) {
    if (args.empty() || args[0] != "render" || std::find(args.begin(), args.end(), "--no-rc") != args.end()) return {};
    Diagnostics dropped; // the reader of their RIB reports the same
    const std::vector<std::string> options = rcOptions(rcFiles(dropped));
    if (!options.empty()) std::fprintf(stderr, "note: .alpenglowrc adds %s\n", printable(joined(options, " ")).c_str());
    return options;
}

/// Status 2, with the reason and where to read on.
int wrongUse(const std::string& why, const std::string& more) {
    std::fprintf(stderr, "alpenglow: %s\nSee %s for more.\n", printable(why).c_str(), more.c_str());
    return kWrongUse;
}

} // namespace

int runProgram(int argc, char** argv) {
    int status = kDone;
    CLI::App app("Alpenglow renders RenderMan scenes: RIB in, shaders in RSL as machine code, path-traced pictures out.",
                 "alpenglow");
    app.set_version_flag("--version", versionReport);
    app.require_subcommand(1);
    app.get_formatter()->column_width(34);
    app.footer("alpenglow scene.rib is the same as alpenglow render scene.rib. See alpenglow help COMMAND for more.\n"
               "Flags of prman, renderdl and aqsis (-t:4, -res 640 480, -progress) work too: docs/options.md lists them.\n\n" +
               exitStatuses());
    addRender(app, &status, commandText(argc, argv));
    addView(app, &status);
    addEval(app, &status);
    addShade(app, &status);
    addCompile(app, &status);
    addInfo(app, &status);
    addProbe(app, &status);
    addMaketx(app, &status);
    addPtc(app, &status);
    addDiff(app, &status);
    addMerge(app, &status);
    addRib(app, &status);
    addLsp(app, &status);
    addFrom(app, &status);
    CommandLine line = normalise(argc, argv, app);
    if (!line.error.empty()) return wrongUse(line.error, "alpenglow --help");
    if (!line.text.empty()) return std::fputs(line.text.c_str(), stdout) < 0 ? kOutputFailed : kDone;
    std::vector<std::string>& args = line.arguments;
    const std::vector<std::string> defaults = optionsOfRcFiles(args);
    if (!defaults.empty()) args.insert(args.begin() + 1, defaults.begin(), defaults.end());
    const bool own = !args.empty() && args.front() == "render"; // has an option for it
    const MemoryLimit limit(own ? 0 : defaultMemoryLimit(), defaultThreads());
    std::reverse(args.begin(), args.end()); // as the parser takes vectors
    try {
        app.parse(args);
    } catch (const CLI::ExtrasError&) {
        return wrongUse(unknownOptions(app), "alpenglow help " + app.get_subcommands().front()->get_name());
    } catch (const CLI::RequiredError& e) {
        const auto used = app.get_subcommands();
        if (used.empty()) return wrongUse(e.what(), "alpenglow --help");
        return wrongUse(used.front()->get_name() + ": " + e.what(), "alpenglow help " + used.front()->get_name());
    } catch (const CLI::ParseError& e) {
        std::ostringstream out, err; // they name what was given
        const int code = app.exit(e, out, err);
        std::fputs(printable(out.str()).c_str(), stdout);
        std::fputs(printable(err.str()).c_str(), stderr);
        return code == 0 ? kDone : kWrongUse;
    }
    return status;
}

} // namespace alpenglow::cli
