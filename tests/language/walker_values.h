// Values of the walker (walker.h): their conversions and operators.
#pragma once
#include "walker.h"
#include <string>

namespace alpenglow::rsl::walking {

/// Throws that the walker does not know this.
[[noreturn]] void unknown(const std::string& what);
/// How many numbers a value of this type has; 0 for strings.
int width(Base);
Walked number(float);
Walked truth(bool);
/// 0, or the empty string.
Walked zero(Base);
/// Numbers spread over tuples and over the diagonals of matrices.
Walked converted(const Walked&, Base to);
/// Of values that have been converted to the type in which they meet.
Walked binary(ExprOp, const Walked& a, const Walked& b);
/// The element that an index means: the nearest there is.
size_t nearest(float index, size_t length);

} // namespace alpenglow::rsl::walking
