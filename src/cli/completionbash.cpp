#include "cli/completion.h"
#include <map>

namespace alpenglow::cli {

namespace {

constexpr const char* kBashBegin = R"(# Completion of alpenglow in bash. Made by: alpenglow help --completion bash
_alpenglow_words() {
    compopt +o default
    mapfile -t COMPREPLY < <(compgen -W "$1" -- "$current")
}
_alpenglow() {
    local commands='@commands@' command=render options='' attached='' current=${COMP_WORDS[COMP_CWORD]} at=$COMP_CWORD
    COMPREPLY=()
    case " $commands help " in *" ${COMP_WORDS[1]} "*) command=${COMP_WORDS[1]} ;; esac
    # Readline takes = and : for words of their own.
    case $current in [=:]) current='' ;; *) at=$((at - 1)) ;; esac
    while ((at > 1)); do
        case ${COMP_WORDS[at]} in
        =) attached='='; at=$((at - 1)) ;;
        :) at=$((at - 2)) ;;
        *) break ;;
        esac
    done
    # File names are what readline completes where this function finds nothing.
    case $command:${COMP_WORDS[at]} in
)";

constexpr const char* kBashMiddle = R"(    esac
    if ((COMP_CWORD == 1)); then
        options="$commands help"
        case $current in -*) options='@program@ @render@' ;; esac
        mapfile -t COMPREPLY < <(compgen -W "$options" -- "$current"; compgen -f -- "$current")
        compopt -o filenames
        return
    fi
    case $command in
)";

constexpr const char* kBashEnd = R"(    esac
    case $current in -*) mapfile -t COMPREPLY < <(compgen -W "$options" -- "$current") ;; esac
}
complete -o default -F _alpenglow alpenglow
)";

std::string bashNames(const std::vector<OptionText>& options) {
    std::vector<std::string> all;
    for (const OptionText& o : options)
        if (!o.positional) all.insert(all.end(), o.names.begin(), o.names.end());
    return joined(all, " ");
}

/// What to do for the argument of an option.
std::string bashAction(const OptionText& o, const std::string& command) {
    std::string words = "_alpenglow_words '" + joined(o.choices, " ") + "'";
    if (o.attached) return "[ \"$attached\" ] && " + words;
    if (!o.choices.empty()) return words;
    if (o.takesFile()) return "";
    if (o.takesFolders()) return "compopt +o default -o dirnames";
    if (o.takesListed())
        return "_alpenglow_words \"$(\"${COMP_WORDS[0]}\" " + command + " " + o.names.back() + " 2>/dev/null | cut -d' ' -f1)\"";
    return "compopt +o default";
}

} // namespace

std::string bashCompletion(const ProgramText& p) {
    std::string cases, positional, commands, render;
    for (const CommandText& c : p.commands) {
        commands += (commands.empty() ? "" : " ") + c.name;
        if (c.name == "render") render = bashNames(c.options);
        std::map<std::string, std::string> patterns; // of each action, so that it is there once
        std::string others;
        int word = 2;
        for (const OptionText& o : c.options) {
            const std::string action = bashAction(o, c.name);
            if (o.positional) {
                if (!o.choices.empty()) others += "((COMP_CWORD == " + std::to_string(word) + ")) && " + action + "; ";
                else if (!o.takesFile()) others += "compopt +o default; ";
                ++word;
            } else if (!o.argument.empty())
                for (const std::string& n : o.names)
                    patterns[action] += (patterns[action].empty() ? "" : " | ") + c.name + ":" + n;
        }
        for (const auto& [action, pattern] : patterns)
            cases += "    " + pattern + ") " + action + (action.empty() ? "" : "; ") + "return ;;\n";
        positional += "    " + c.name + ") " + others + "options='" + bashNames(c.options) + "' ;;\n";
    }
    positional += "    help) ((COMP_CWORD == 2)) && _alpenglow_words \"$commands\"; compopt +o default ;;\n";
    const auto filled = [&](std::string text) {
        for (const auto& [name, value] :
             {std::pair{"@commands@", commands}, std::pair{"@program@", bashNames(p.options)}, std::pair{"@render@", render}})
            if (const size_t i = text.find(name); i != text.npos) text.replace(i, std::string(name).size(), value);
        return text;
    };
    return filled(kBashBegin) + cases + filled(kBashMiddle) + positional + kBashEnd;
}

} // namespace alpenglow::cli
