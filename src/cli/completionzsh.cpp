#include "cli/completion.h"

namespace alpenglow::cli {

namespace {

/// In single quotes, with a backslash before what means something in a specification of _arguments.
std::string zshText(const std::string& text, const char* special) {
    std::string s;
    for (const char c : text) {
        if (std::string(special).find(c) != std::string::npos) s += '\\';
        s += c == '\'' ? std::string("'\\''") : std::string(1, c);
    }
    return s;
}

std::string zshAction(const OptionText& o, const std::string& command) {
    if (!o.choices.empty()) return "(" + joined(o.choices, " ") + ")";
    if (o.takesFile()) return "_files";
    if (o.argument == "DIR") return "_files -/";
    if (o.takesFolders()) return "_dir_list";
    if (o.takesListed()) return "{compadd - ${${(f)\"$(alpenglow " + command + " " + o.names.back() + " 2>/dev/null)\"}%% *}}";
    return "";
}

std::string zshSpecification(const OptionText& o, const std::string& command) {
    const std::string message = ":" + zshText(o.positional ? o.names[0] : o.argument, "\\:") + ":" + zshAction(o, command);
    if (o.positional) return "        '" + std::string(o.repeated ? "*" : "") + message + "' \\\n";
    std::string all;
    for (const std::string& n : o.names) {
        const bool brief = !n.starts_with("--");
        const std::string excluded = o.repeated ? "*" : o.names.size() > 1 ? "(" + joined(o.names, " ") + ")" : "";
        const std::string takes = o.argument.empty() ? "" : o.attached ? "=-" : brief ? "+" : "=";
        all += "        '" + excluded + n + takes + "[" + zshText(summary(o.help), "\\[]") + "]" +
               (o.argument.empty() ? "" : (o.optionalArgument ? ":" : "") + message) + "' \\\n";
    }
    return all;
}

} // namespace

std::string zshCompletion(const ProgramText& p) {
    std::string s = "#compdef alpenglow\n# Completion of alpenglow in zsh. Made by: alpenglow help --completion zsh\n"
                    "_alpenglow() {\n    local command=render ret=1\n    local -a commands=(\n";
    for (const CommandText& c : p.commands) s += "        '" + c.name + ":" + zshText(summary(c.description), "") + "'\n";
    s += R"(        'help:Explain a command'
    )
    if (( CURRENT == 2 )) && [[ $words[2] != -* ]]; then
        _describe -t commands command commands && ret=0
        _files && ret=0
        return ret
    fi
    if (( CURRENT > 2 && ${commands[(I)$words[2]:*]} )); then
        command=$words[2]
        shift words
        (( CURRENT-- ))
    fi
    case $command in
)";
    for (const CommandText& c : p.commands) {
        s += "    " + c.name + ") _arguments -S \\\n";
        for (const OptionText& o : c.options) s += zshSpecification(o, c.name);
        s += "        && ret=0 ;;\n";
    }
    return s + R"(    help) _describe -t commands command commands && ret=0 ;;
    esac
    return ret
}
if [[ $funcstack[1] = _alpenglow ]]; then _alpenglow "$@"; else compdef _alpenglow alpenglow; fi
)";
}

} // namespace alpenglow::cli
