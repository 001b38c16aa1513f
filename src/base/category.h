// Categories of lights and co-shaders: the words of "__category", and expressions over them.
#pragma once
#include <string>
#include <string_view>

namespace alpenglow {

/// Whether a shader with these categories (words separated by commas) matches the expression (3Delight manual, 6.3). "": all;
/// "a": category a; "-a": all others; "a|b": either; "a&b": both; parentheses group; "-" binds tighter than "&", and "&" tighter
/// than "|". A list "a,b,-c" matches any of its words without "-", and none with "-". Invalid expressions match all: check
/// categoryError() first.
bool inCategory(std::string_view expression, std::string_view categories);

/// The error in an expression, or "".
std::string categoryError(std::string_view expression);

} // namespace alpenglow
