// The regular expressions of match(): POSIX extended ones, in time proportional to text times pattern whatever either holds.
#pragma once
#include <bitset>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace alpenglow {

/// A pattern, translated. Immutable: threads may share one.
/// Understood: characters, `.`, `[...]` with ranges and classes, `( )`, `|`, `* + ? {n} {n,} {n,m}`, `^ $`, `\` before a
/// character, and
/// \w \W \s \S for words and blanks, \b \B \< \> for their edges, \` \' for those of the text. Bytes are characters, as in the C
/// locale.
class Pattern {
public:
    /// Returns null for invalid patterns, patterns that are too large (limits::kPatternStates), and back-references; `error`
    /// explains.
    static std::shared_ptr<const Pattern> make(const std::string& text, std::string& error);
    /// Whether it occurs anywhere in the text.
    bool occurs(std::string_view text) const;

private:
    friend class PatternParser;
    enum class Op : uint8_t { Byte, Split, Begin, End, Edge, Found };
    struct State {
        Op op;
        uint32_t next = 0, other = 0; ///< Split: both
        uint32_t bytes = 0;           ///< Byte: number of its set; Edge: the letter of its escape
    };
    std::vector<State> states_;
    std::vector<std::bitset<256>> sets_;
    uint32_t start_ = 0;
};

} // namespace alpenglow
