// Members that the displacement() of a class sets and its other methods read: two kernels, one object.
#pragma once
#include "rsl/front/ast.h"
#include <string>
#include <vector>

namespace alpenglow::rsl {

/// The names of the members and parameters of a class that its displacement() writes, or its begin() from the surface as it was
/// before it moved, and that the methods of `surface` may read; in the order in which they are declared. Both are shaders of the
/// same class, `displacement` and `surface` those two kinds of it; nothing for shaders that are no classes.
std::vector<std::string> membersLeft(const Shader& displacement, const Shader& surface);

/// The member or parameter of that name; null where there is none.
const Symbol* ownMember(const Shader&, const std::string& name);

} // namespace alpenglow::rsl
