#include "base/printable.h"

namespace alpenglow {
namespace {

void escape(unsigned char c, std::string& out) {
    static constexpr char kDigits[] = "0123456789abcdef";
    out += "\\x";
    out += kDigits[c >> 4];
    out += kDigits[c & 15];
}

/// Length in bytes of the UTF-8 character that starts here; 0: none.
size_t utf8Length(std::string_view text, size_t at) {
    const auto byte = [&](size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned char c = byte(at);
    const size_t n = c < 0x80 ? 1 : c >= 0xC2 && c < 0xE0 ? 2 : c >= 0xE0 && c < 0xF0 ? 3 : c >= 0xF0 && c < 0xF5 ? 4 : 0;
    if (n == 0 || at + n > text.size()) return 0;
    for (size_t i = 1; i < n; ++i)
        if ((byte(at + i) & 0xC0) != 0x80) return 0;
    return n;
}

} // namespace

size_t appendPrintable(std::string_view text, size_t at, std::string& out) {
    const auto c = static_cast<unsigned char>(text[at]);
    const size_t n = utf8Length(text, at);
    const bool control = n == 1   ? (c < 32 && c != '\t' && c != '\n') || c == 127
                         : n == 2 ? c == 0xC2 && static_cast<unsigned char>(text[at + 1]) < 0xA0
                                  : n == 0 && c < 0xA0;
    const size_t bytes = n ? n : 1;
    for (size_t i = at; i < at + bytes; ++i) {
        if (control) escape(static_cast<unsigned char>(text[i]), out);
        else out += text[i];
    }
    return bytes;
}

std::string printable(std::string_view text) {
    std::string out;
    out.reserve(text.size());
    for (size_t i = 0; i < text.size();) i += appendPrintable(text, i, out);
    return out;
}

std::string counted(size_t n, std::string_view thing) {
    return std::to_string(n) + " " + std::string(thing) + (n == 1 ? "" : "s");
}

} // namespace alpenglow
