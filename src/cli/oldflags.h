// Flags of prman, renderdl and aqsis, and their equivalents here, in one table.
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace alpenglow::cli {

/// One flag of another renderer's command line.
struct OldFlag {
    /// What becomes of a flag.
    enum class Use {
        Accepted, ///< becomes `here`
        Dropped,  ///< ignored because it is not needed; `here` has the reason
        Noted,    ///< the same, with a message, because the effect differs from what was asked for
        Answered, ///< ends with status 2 and the text `here`, which names the replacement
    };
    std::string_view name;      ///< "-res"
    int values = 0;             ///< how many follow; a first one may also follow ':' or '=' ("-t:4", "-frames=1-3")
    std::string_view renderers; ///< "prman, renderdl"
    Use use = Use::Dropped;     ///< what becomes of it
    std::string_view here;      ///< "--format $1x$2", or text for people
};

/// The flags of `render`.
std::span<const OldFlag> oldFlags();

/// A command line with the flags of other renderers replaced.
struct TranslatedFlags {
    std::vector<std::string> arguments;         ///< without the program's name
    std::vector<std::string> notes;             ///< what was replaced or ignored, a line each
    std::vector<std::string> withoutEquivalent; ///< those that have no effect, a line each
    std::string error;                          ///< not "": a flag that cannot be taken, and what to write instead
};

/// `arguments`: those of `render`, without its name. Arguments that are no such flags stay as they are.
TranslatedFlags translateOldFlags(const std::vector<std::string>& arguments);
/// The same by another table.
TranslatedFlags translateFlags(std::span<const OldFlag> table, const std::vector<std::string>& arguments);

/// The table for docs/options.md; of render's flags, or of others.
std::string oldFlagsPage();
std::string flagsPage(std::span<const OldFlag> table);

} // namespace alpenglow::cli
