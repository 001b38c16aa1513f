#include "cli/completion.h"

namespace alpenglow::cli {

namespace {

std::string fishText(const std::string& text) {
    std::string s = "'";
    for (const char c : text) {
        if (c == '\'' || c == '\\') s += '\\';
        s += c;
    }
    return s + "'";
}

std::string fishArgument(const OptionText& o, const std::string& command) {
    if (o.argument.empty()) return "";
    if (!o.choices.empty()) return (o.attached ? " -f -a " : " -x -a ") + fishText(joined(o.choices, " "));
    if (o.takesFile()) return " -r -F";
    if (o.takesFolders()) return " -x -a '(__fish_complete_directories)'";
    if (o.takesListed())
        return " -x -a " + fishText("(alpenglow " + command + " " + o.names.back() + " 2>/dev/null | string split -f1 \" \")");
    return " -x";
}

} // namespace

std::string fishCompletion(const ProgramText& p) {
    std::string s = "# Completion of alpenglow in fish. Made by: alpenglow help --completion fish\n", commands;
    for (const CommandText& c : p.commands) commands += c.name + " ";
    s += R"(function __alpenglow_uses
    set -l words (commandline -opc)
    set -l command render
    set -q words[2]; and contains -- $words[2] )" +
         commands + R"(help; and set command $words[2]
    contains -- $command $argv
end
)";
    for (const CommandText& c : p.commands)
        s += "complete -c alpenglow -n __fish_use_subcommand -a " + c.name + " -d " + fishText(summary(c.description)) + "\n";
    s += "complete -c alpenglow -n __fish_use_subcommand -a help -d 'Explain a command'\n"
         "complete -c alpenglow -n '__alpenglow_uses help' -f -a '" +
         commands + "'\n";
    for (const CommandText& c : p.commands)
        for (const OptionText& o : c.options) {
            const std::string begin = "complete -c alpenglow -n '__alpenglow_uses " + c.name + "'";
            if (o.positional) {
                if (!o.choices.empty()) s += begin + " -a " + fishText(joined(o.choices, " ")) + "\n";
                else if (!o.takesFile()) s += begin + " -f\n";
                continue;
            }
            s += begin;
            for (const std::string& n : o.names) s += n.starts_with("--") ? " -l " + n.substr(2) : " -s " + n.substr(1);
            s += fishArgument(o, c.name) + " -d " + fishText(summary(o.help)) + "\n";
        }
    return s;
}

std::string completion(const ProgramText& p, const std::string& shell) {
    return shell == "bash" ? bashCompletion(p) : shell == "zsh" ? zshCompletion(p) : shell == "fish" ? fishCompletion(p) : "";
}

} // namespace alpenglow::cli
