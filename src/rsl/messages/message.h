// Messages of the compiler: their kinds, their texts and what is raised. The table of all of them is messages.h.
#pragma once
#include "base/diagnostics.h"
#include <concepts>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace alpenglow::rsl {

/// How messages of a kind come to light; their examples are compiled accordingly.
enum class Shown {
    Compile,  ///< whenever a shader is read
    Warnings, ///< by `compile -W` and in editors
    Code,     ///< when code is made, with the co-shaders that are bound
    Path,     ///< by `compile -W` and in editors, where the hider "path" would wait for light
    Elsewhere ///< by no example that stands alone
};

/// One kind of message: what `alpenglow compile --explain ID` and docs/messages.md tell about it.
struct MessageKind {
    const char* id;    ///< lower case words joined by '-'; never changed once published
    Shown shown;       ///< where and whether it appears
    const char* about; ///< what is wrong, and what to do
    const char*
        example;        ///< a program with this message and no other; the classes in it are bound as co-shaders under their names
    const char* reason; ///< Shown::Elsewhere: why there is no example
};

/// One text of a kind. "{}" stands for an argument.
struct MessageText {
    const MessageKind& kind;
    Severity severity; ///< of the message
    const char* text;
    const char* hint; ///< or ""
};

/// A message with its arguments, ready to be reported at a place.
struct Raised {
    const MessageText* message;
    std::vector<std::string> arguments;
    /// The message's text with its arguments.
    std::string text() const;
};

/// What may stand for a "{}" of a message.
struct MessageArgument {
    std::string text; ///< as it appears
    /// From texts and whole numbers.
    MessageArgument(std::string s) : text(std::move(s)) {}
    MessageArgument(std::string_view s) : text(s) {}
    MessageArgument(const char* s) : text(s) {}
    MessageArgument(char c) : text(1, c) {}
    template <std::integral I>
        requires(!std::same_as<I, char> && !std::same_as<I, bool>)
    MessageArgument(I n) : text(std::to_string(n)) {}
};

/// How many arguments a text takes.
constexpr int countArguments(std::string_view text) {
    int n = 0;
    for (size_t at = 0; (at = text.find("{}", at)) != std::string_view::npos; at += 2) ++n;
    return n;
}

/// A text with the number of its arguments, which the compiler of C++ holds its calls to: report(place, kUndeclared(name)).
template <int N> struct Message : MessageText {
    /// The message with these arguments.
    template <class... A>
        requires(sizeof...(A) == N)
    Raised operator()(A&&... a) const {
        Raised r{this, {}};
        r.arguments.reserve(N);
        (r.arguments.push_back(MessageArgument(std::forward<A>(a)).text), ...);
        return r;
    }
    /// The message without arguments.
    operator Raised() const
        requires(N == 0)
    {
        return {this, {}};
    }
};

/// The diagnostic of a message, without length and fix-its. `hint` "": the one of the message, if any.
Diagnostic diagnostic(const Raised&, Rie, SourcePlace, std::string hint = {});

} // namespace alpenglow::rsl
