// Text of others, made fit for a terminal: names from files and what shaders print may hold bytes that a terminal obeys.
#pragma once
#include <string>
#include <string_view>

namespace alpenglow {

/// Appends the character that begins at byte `at` of `text` to `out` and returns how many bytes it has (at least 1; `at` must be
/// less than the size). A control character other than tab and newline (below 32, 127, and 128 to 159, as UTF-8 or as bytes by
/// themselves) becomes "\x1b" of each of its bytes in hexadecimal; all else stays as it is.
size_t appendPrintable(std::string_view text, size_t at, std::string& out);

/// The whole text so.
std::string printable(std::string_view text);

/// "1 value", "2 values": the number and the thing, which takes an s unless n is 1.
std::string counted(size_t n, std::string_view thing);

} // namespace alpenglow
