// Which types turn into which, and what operators do with them (docs/design/rsl.md, "Conversions"). Costs order the ways a
// program can be read.
#pragma once
#include "rsl/names.h"
#include "shadeops/types.h"
#include <optional>

namespace alpenglow::rsl {
enum class ExprOp : uint8_t;
}
namespace alpenglow::rsl::front {

// Costs by weight: one of a kind outweighs some hundreds of those above it, which is more than people write in one expression.
inline constexpr int kPromotion = 1;                ///< a number meets a tuple in arithmetic: what `2 * c` means
inline constexpr int kConversion = 1 << 8;          ///< the least that is a conversion: a point where a vector is wanted
inline constexpr int kBroadcast = 16 * kConversion; ///< a number becomes a tuple of three alike
inline constexpr int kLastResort = 1 << 18; ///< Shadeop::lastResort; a tuple where arithmetic with a number makes a call a float
inline constexpr int kCompared = 1 << 19;   ///< a tuple is compared with a number
inline constexpr int kNever = 1 << 28;      ///< cost of a conversion that is not allowed
inline constexpr int kBases = 11;           ///< number of values of Base

/// Cost of an implicit conversion; 0 for the same type, kNever if there is none.
int implicitCost(Base from, Base to);
/// Cost of a written conversion `to x`.
int castCost(Base from, Base to);
/// Cost of use as a condition: Bool, or a number, or a tuple, against zero.
int conditionCost(Base from);

/// One meaning of a binary operator.
struct Operation {
    Base operand;          ///< both operands are brought to this type
    Base result;           ///< of the result
    int cost;              ///< of doing so
    bool promotes = false; ///< one is a number, the other a tuple
};
/// What `left op right` means, if anything.
std::optional<Operation> operation(ExprOp, Base left, Base right);
/// The operator as it is written.
const char* spelling(ExprOp);
/// Whether it is a point, vector or normal.
bool isPointLike(Base);

} // namespace alpenglow::rsl::front
