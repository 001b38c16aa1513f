// Categories of lights and co-shaders: the words of "__category", and expressions over them.
#pragma once
#include <string>
#include <string_view>

namespace alpenglow {

/// Whether a shader of these categories (words between commas) fits the expression (3Delight manual, 6.3). "": all; "a": those
/// of category a, "-a" all others, "a|b" both, "a&b" those that are of both, with parentheses where needed; "-" binds before "&",
/// and "&" before "|". A list "a,b,-c" means those of any of its words without "-", and of none with "-". An expression that
/// cannot be read means all: ask categoryError() first.
bool inCategory(std::string_view expression, std::string_view categories);

/// What is wrong with an expression, or "".
std::string categoryError(std::string_view expression);

} // namespace alpenglow
