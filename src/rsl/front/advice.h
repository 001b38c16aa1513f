// What helps with a message and can be seen in its line: hints, and fix-its that need more than the name in a hint.
#pragma once
#include "rsl/messages/message.h"

namespace alpenglow::rsl {

/// Whether a name may contain this character: a letter, a digit or an underscore (ASCII).
inline bool isWord(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_'; }

/// What stands between the quotes of "did you mean 'x'?", either kind of quotes; or nothing.
std::string suggestion(const std::string& hint);

/// Adds a hint to a message of the compiler if its line shows what the author intended, and removes one that helps
/// nobody. `written` is the token that begins at byte `at` of the line.
void advise(Diagnostic&, const Raised&, const std::string& written, size_t at);

/// Adds a fix-it where the cure is obvious.
void addFix(Diagnostic&, const Raised&, const std::string& written, size_t at);

} // namespace alpenglow::rsl
