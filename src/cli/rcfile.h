// .alpenglowrc: what a user has in front of every scene, as .rendermn.ini and .aqsisrc are for other renderers.
#pragma once
#include "base/diagnostics.h"
#include <string>
#include <vector>

namespace alpenglow::cli {

/// One such file.
struct RcFile {
    std::string path, rib;            ///< rib: its text without the lines of options
    std::vector<std::string> options; ///< of the command line, from lines that begin with "--"
    bool own = true;                  ///< the user's, not one that lies in the current folder
    int optionLine = 0;               ///< of the first such line, from 1; 0: none
};

/// For manuals.
inline constexpr const char* kRcFilesText =
    "What it holds is read before every scene that alpenglow render draws: RIB such as Option, Attribute, Hider and Display, "
    "and, "
    "on lines that begin with --, options of the command line, which have the last word there. First comes "
    "$XDG_CONFIG_HOME/alpenglow/alpenglowrc (~/.config/alpenglow/alpenglowrc), then ~/.alpenglowrc, then .alpenglowrc in the "
    "current folder, which may hold RIB only. A message names each that is read. --no-rc or ALPENGLOW_RC=off read none.";

/// The files that there are, in the order in which they are read, so that later ones have the last word:
/// $XDG_CONFIG_HOME/alpenglow/alpenglowrc (~/.config without the variable), ~/.alpenglowrc, ./.alpenglowrc. The variable
/// ALPENGLOW_RC names one file instead of these, or "off". A file of more than 1 MiB is not read (reported).
std::vector<RcFile> rcFiles(Diagnostics&);
/// Their options, as arguments that stand before those of the command line. Those of the current folder do not count: that may be
/// anybody's, and options allow scenes to run programs.
std::vector<std::string> rcOptions(const std::vector<RcFile>&);

} // namespace alpenglow::cli
