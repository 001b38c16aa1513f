// Patterns that are expressions of SeExpr (Disney's expression language; its published documentation) as RSL.
#pragma once
#include "base/diagnostics.h"
#include <optional>
#include <string>
#include <vector>

namespace alpenglow::rsl::front {

/// A variable that the scene gives an expression.
struct SeExprVariable {
    std::string name;   ///< without the $
    bool color = false; ///< three numbers; else one
};

/// A surface shader with these parameters and the outputs of a pattern, resultRGB, resultR, resultG and resultB. place: of the
/// text, for messages. Nothing after an error, which is reported.
std::optional<std::string> rslFromSeExpr(const std::string& expression, const std::vector<SeExprVariable>&,
                                         const SourcePlace& place, Diagnostics&);

} // namespace alpenglow::rsl::front
