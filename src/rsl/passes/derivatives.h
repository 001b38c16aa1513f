// Which values must carry d/du, d/dv, and how often: backwards from Du and Dv (docs/design/rsl.md, "Derivatives").
#pragma once
#include "base/diagnostics.h"
#include "rsl/ir/ir.h"
#include "rsl/passes/names.h"

namespace alpenglow::rsl::passes {

/// Sets Inst::order and Input::order. Results of rays and lights count as constant, warned once each; so does a
/// derivative of third order. Either form.
void orderDerivatives(Kernel&, Diagnostics&);

/// For each Call of a kernel (function null) or of one function: the orders wanted of its results. Of a function, `results` says
/// what is wanted of its own.
using CallOrders = std::vector<std::pair<Inst*, std::vector<uint8_t>>>;
/// Orders of a function whose results are wanted to these orders.
CallOrders callOrders(Kernel&, Inst* function, const std::vector<uint8_t>& results);

} // namespace alpenglow::rsl::passes
