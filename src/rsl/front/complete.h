// What follows from a message and the line it is about: the bytes that are meant, hints and fix-its.
#pragma once
#include "rsl/messages/message.h"

namespace alpenglow::rsl {

/// Fills in what is missing in a message of the compiler: the bytes of its line that it is about, and the fix-its that are
/// obvious (a name with a slip, a forgotten semicolon). `raised`: where it is still known, for hints and more fix-its.
void complete(Diagnostic&, const Raised* raised = nullptr);

} // namespace alpenglow::rsl
