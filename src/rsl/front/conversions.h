// Which types turn into which, and what operators do with them: rsl.md sections 3 and 4. Costs order the ways a program can be
// read.
#pragma once
#include "shadeops/types.h"
#include <optional>

namespace alpenglow::rsl {
enum class ExprOp : uint8_t;
}
namespace alpenglow::rsl::front {

inline constexpr int kNever = 1 << 24;
inline constexpr int kBases = 9;

/// Cost of an implicit conversion; 0 for the same type, kNever if there is none.
int implicitCost(Base from, Base to);
/// Cost of a written conversion `to x`.
int castCost(Base from, Base to);
/// Cost of use as a condition: Bool, or a number, or a tuple, against zero.
int conditionCost(Base from);

struct Operation {
    Base operand; ///< both operands are brought to this type
    Base result;
    int cost;     ///< of doing so
};
/// What `left op right` means, if anything.
std::optional<Operation> operation(ExprOp, Base left, Base right);
const char* spelling(ExprOp);

} // namespace alpenglow::rsl::front
