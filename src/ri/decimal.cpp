#include "ri/decimal.h"
#include <cmath>
#include <fast_float/fast_float.h>
#include <fmt/compile.h>
#include <iterator>

namespace alpenglow::ri {
namespace {

double read(const char* from, const char* to) {
    double v = 0;
    fast_float::from_chars(from, to, v);
    return v;
}

constexpr size_t kRoom = 40; // bytes: more than any number takes

/// Writes to `out`, which has kRoom bytes. Returns the end.
template <class T> char* format(char* out, T v) { return fmt::format_to(out, FMT_COMPILE("{}"), v); }

char* write(char* out, double v) {
    constexpr double kSmall = 1e9;
    if (v > -kSmall && v < kSmall && v == double(int(v)) && (v != 0 || !std::signbit(v))) return format(out, int(v));
    return format(out, v);
}

} // namespace

double decimalOf(float f) {
    if (!std::isfinite(f)) return double(f);
    char text[kRoom];
    return read(text, format(text, f));
}

void appendNumber(std::string& to, double v) {
    char text[kRoom];
    to.append(text, size_t(write(text, v) - text));
}

void appendAsFloat(std::string& to, double v) {
    const float f = float(v);
    if (double(f) != v || v == std::floor(v)) return appendNumber(to, v);
    char text[kRoom];
    char* end = format(text, f);
    // So near to the middle between two floats that rounding twice decides otherwise?
    if (float(read(text, end)) != f) return appendNumber(to, v);
    to.append(text, size_t(end - text));
}

} // namespace alpenglow::ri
