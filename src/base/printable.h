// Makes untrusted text safe for terminals: names from files and output of shaders may contain control sequences.
#pragma once
#include <string>
#include <string_view>

namespace alpenglow {

/// Appends the character that starts at byte `at` of `text` to `out` and returns its length in bytes (at least 1; `at` must be
/// less than the size). Control characters other than tab and newline (below 32, 127, and 128 to 159, as UTF-8 or as single
/// bytes) become "\x1b" etc., each byte in hexadecimal; others are copied.
size_t appendPrintable(std::string_view text, size_t at, std::string& out);

/// Converts the complete text.
std::string printable(std::string_view text);

/// "1 value", "2 values": the number and the noun, with an s unless n is 1.
std::string counted(size_t n, std::string_view thing);

} // namespace alpenglow
