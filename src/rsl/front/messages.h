// The kinds of messages of the RSL front end and of the compiler behind it: each has a stable id, independent of its wording.
#pragma once
#include "base/diagnostics.h"
#include <span>
#include <string_view>

namespace alpenglow::rsl {

/// One kind of message. In the pattern '*' stands for any text, also none.
struct MessageKind {
    const char* id;      ///< lower case words joined by '-'; never changed once published
    const char* pattern; ///< what all its messages look like
};
/// In the order in which they are tried.
std::span<const MessageKind> messageKinds();

/// The id for the words of a message; "rsl-error" for words that no kind describes.
const char* messageId(std::string_view message);

/// Fills in what follows from the words and the line of a message of the compiler, where it is missing: its id, the bytes of its
/// line that it is about, and the fix-its that are obvious (a name with a slip, a forgotten semicolon).
void complete(Diagnostic&);

} // namespace alpenglow::rsl
