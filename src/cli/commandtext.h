// The commands and their options as plain data. Man pages and the completions of shells are made from it, so that the
// descriptions given to the parser are the only ones.
#pragma once
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace alpenglow::cli {

/// An option or argument.
struct OptionText {
    std::vector<std::string> names;            ///< "-o", "--format"; of a positional argument its name alone
    std::string argument;                      ///< "FILE"; "" for a flag
    std::vector<std::string> choices;          ///< the values that are taken, where the parser has a list
    std::string help, group;                   ///< text, and heading in the help
    bool positional = false, required = false; ///< an argument by its position; it must be given
    bool optionalArgument = false;             ///< the argument may be missing
    bool attached = false;                     ///< the argument must follow the name and =, as in --preview=kitty
    bool repeated = false;                     ///< takes several words, or may be given several times

    bool takesFile() const;    ///< a file name
    bool takesFolders() const; ///< a folder, or several separated by :
    bool takesListed() const;  ///< a name of the list that the program prints for this option alone: info --shadeops
};

/// A subcommand.
struct CommandText {
    std::string name, description, footer; ///< what follows the options in the help
    std::vector<OptionText> options;       ///< positionals among them, in the order of the command line
};

/// The whole command line.
struct ProgramText {
    std::string name, description, footer; ///< what follows the subcommands in the help
    std::vector<OptionText> options;       ///< of every subcommand
    std::vector<CommandText> commands;     ///< in the order of the help
};

/// The description of a parser with all its subcommands.
ProgramText programText(const CLI::App&);

/// The first part of a help text: up to a full stop, a semicolon or a bracket. For the lists of shells.
std::string summary(const std::string& help);

/// "a, b, c" of a, b, c and ", ".
std::string joined(const std::vector<std::string>& words, const std::string& separator);

} // namespace alpenglow::cli
