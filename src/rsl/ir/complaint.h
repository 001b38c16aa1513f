// Errors that show when a shader runs: a site of their own reports them (services_basic.cpp).
#pragma once
#include "rsl/ir/ir.h"
#include "rsl/messages/messages.h"

namespace alpenglow::rsl::ir {

/// The argument of a message that is known only then: the string that is the argument of the site's call.
inline constexpr const char* kWhenRun = "\1";

/// The site that reports the message, an error; at most one argument is kWhenRun. Its id is the value of the pair "id".
Site complaint(const Raised&);

} // namespace alpenglow::rsl::ir
