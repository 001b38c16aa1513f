// What the default of a shader's parameter depends on: constants, uniform functions, earlier parameters, and of a varying one
// the sample (docs/language.md, "Uniform and varying").
#pragma once
#include "rsl/front/ast.h"
#include <set>
#include <string>

namespace alpenglow::rsl {

/// The result of readsOfDefault().
struct DefaultReads {
    bool sample = false;              ///< it differs from sample to sample: it reads a global variable, or draws a random number
    bool object = false;              ///< it names the space "object", which is another for each primitive
    std::set<std::string> parameters; ///< parameters of the shader that it reads
};

/// Reads the expression and the bodies of the functions that it calls. `e` may be null: it depends on nothing.
DefaultReads readsOfDefault(const Expr* e);

} // namespace alpenglow::rsl
