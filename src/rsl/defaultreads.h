// What the default of a shader's parameter depends on (rsl.md 2.1: "any expression using constants, uniform functions and earlier
// parameters; varying parameters get a default per sample").
#pragma once
#include "rsl/front/ast.h"
#include <set>
#include <string>

namespace alpenglow::rsl {

struct DefaultReads {
    bool sample = false;              ///< it differs from sample to sample: it reads a global variable, or draws a random number
    bool object = false;              ///< it names the space "object", which is another for each primitive
    std::set<std::string> parameters; ///< parameters of the shader that it reads
};

/// Reads the expression and the bodies of the functions that it calls. `e` may be null: it depends on nothing.
DefaultReads readsOfDefault(const Expr* e);

} // namespace alpenglow::rsl
