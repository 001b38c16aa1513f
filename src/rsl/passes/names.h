// Passes use the names of the IR without a prefix.
#pragma once
#include "rsl/ir/ir.h"

namespace alpenglow::rsl::passes {
using namespace ir;
}
