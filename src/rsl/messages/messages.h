// All messages of the compiler, by name: msg::kUndeclared and so on. The tables are the .inc files of this folder, by subject.
#pragma once
#include "rsl/messages/message.h"
#include <span>

namespace alpenglow::rsl::msg {

#define AL_SUBJECT(title, kind)
#define AL_KIND(name, id, shown, about, example) inline constexpr MessageKind kKind##name{id, Shown::shown, about, example, ""};
#define AL_KIND_ELSEWHERE(name, id, about, reason)                                                                               \
    inline constexpr MessageKind kKind##name{id, Shown::Elsewhere, about, "", reason};
#define AL_ERROR(name, kind, text, hint)                                                                                         \
    inline constexpr Message<countArguments(text)> k##name{{kKind##kind, Severity::Error, text, hint}};
#define AL_WARNING(name, kind, text, hint)                                                                                       \
    inline constexpr Message<countArguments(text)> k##name{{kKind##kind, Severity::Warning, text, hint}};
#include "rsl/messages/all.inc"

} // namespace alpenglow::rsl::msg

namespace alpenglow::rsl {

/// What the kinds from `first` on are about, up to the next subject.
struct MessageSubject {
    const char* title; ///< heading in docs/messages.md
    const MessageKind& first;
};
/// All subjects, in the order of the manual.
std::span<const MessageSubject> messageSubjects();
/// All kinds, in the order of the manual.
std::span<const MessageKind* const> messageKinds();
/// All texts, kind by kind.
std::span<const MessageText* const> messageTexts();
/// The kind of this id; null if there is none.
const MessageKind* messageKind(std::string_view id);

} // namespace alpenglow::rsl
