#include "rsl/messages/messages.h"
#include <algorithm>

namespace alpenglow::rsl {

std::string Raised::text() const {
    std::string out;
    std::string_view rest = message->text;
    for (const std::string& a : arguments) {
        const size_t hole = rest.find("{}");
        out.append(rest.substr(0, hole)).append(a);
        rest.remove_prefix(hole + 2);
    }
    return out.append(rest);
}

Diagnostic diagnostic(const Raised& r, Rie code, SourcePlace place, std::string hint) {
    Diagnostic d;
    d.severity = r.message->severity;
    d.code = code;
    d.place = std::move(place);
    d.message = r.text();
    d.hint = hint.empty() ? r.message->hint : std::move(hint);
    d.id = r.message->kind.id;
    return d;
}

namespace {

#define AL_SUBJECT(title, kind)
#define AL_KIND(name, id, shown, about, example) &msg::kKind##name,
#define AL_KIND_ELSEWHERE(name, id, about, reason) &msg::kKind##name,
#define AL_ERROR(name, kind, text, hint)
#define AL_WARNING(name, kind, text, hint)
constexpr const MessageKind* kKinds[] = {
#include "rsl/messages/all.inc"
};

#define AL_SUBJECT(title, kind)
#define AL_KIND(name, id, shown, about, example)
#define AL_KIND_ELSEWHERE(name, id, about, reason)
#define AL_ERROR(name, kind, text, hint) &msg::k##name,
#define AL_WARNING(name, kind, text, hint) &msg::k##name,
constexpr const MessageText* kTexts[] = {
#include "rsl/messages/all.inc"
};

#define AL_SUBJECT(title, kind) {title, msg::kKind##kind},
#define AL_KIND(name, id, shown, about, example)
#define AL_KIND_ELSEWHERE(name, id, about, reason)
#define AL_ERROR(name, kind, text, hint)
#define AL_WARNING(name, kind, text, hint)
constexpr MessageSubject kSubjects[] = {
#include "rsl/messages/all.inc"
};

} // namespace

std::span<const MessageSubject> messageSubjects() { return kSubjects; }

std::span<const MessageKind* const> messageKinds() { return kKinds; }

std::span<const MessageText* const> messageTexts() { return kTexts; }

const MessageKind* messageKind(std::string_view id) {
    const auto found = std::ranges::find_if(kKinds, [&](const MessageKind* k) { return id == k->id; });
    return found == std::end(kKinds) ? nullptr : *found;
}

} // namespace alpenglow::rsl
