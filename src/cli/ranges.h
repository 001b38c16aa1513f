// Checks of numbers on the command line, with texts of our own: "takes a number from 0.01 to 100, not 0".
#pragma once
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <string>

namespace alpenglow::cli {

/// The number that a text is; false when it is none ("5%", "", "x").
inline bool numberOf(const std::string& text, double* n) {
    char* end = nullptr;
    *n = std::strtod(text.c_str(), &end);
    return end != text.c_str() && *end == 0 && *n - *n == 0;
}

/// A check by a predicate; `what` follows "takes".
template <class Good> CLI::Validator numberCheck(Good good, const std::string& what) {
    return CLI::Validator(
        [=](std::string& text) {
            double n = 0;
            return numberOf(text, &n) && good(n) ? std::string()
                                                 : fmt::format("takes {}, not {}", what, text.empty() ? "nothing" : text);
        },
        "");
}

/// Accepts numbers from `least` to `most`; the second one whole numbers only.
inline CLI::Validator between(double least, double most) {
    return numberCheck([=](double n) { return n >= least && n <= most; }, fmt::format("a number from {} to {}", least, most));
}
inline CLI::Validator wholeBetween(double least, double most) {
    return numberCheck([=](double n) { return n >= least && n <= most && n == std::floor(n); },
                       fmt::format("a whole number from {:.0f} to {:.0f}", least, most));
}
/// `example`: "0.02 for 2 %".
inline CLI::Validator positive(const std::string& example = "") {
    return numberCheck([](double n) { return n > 0; }, "a number above 0" + (example.empty() ? "" : ", for example " + example));
}
/// Accepts numbers from 0 on.
inline CLI::Validator notNegative() {
    return numberCheck([](double n) { return n >= 0; }, "a number that is 0 or more");
}

} // namespace alpenglow::cli
