#include "cli/messagemanual.h"
#include "rsl/messages/messages.h"
#include <fmt/format.h>

namespace alpenglow::cli {
namespace {

using OrderedJson = nlohmann::ordered_json;
using rsl::MessageKind;
using rsl::MessageText;
using rsl::Shown;

std::vector<const MessageText*> textsOf(const MessageKind& kind) {
    std::vector<const MessageText*> all;
    for (const MessageText* t : rsl::messageTexts())
        if (&t->kind == &kind) all.push_back(t);
    return all;
}

/// The text with three points for each argument.
std::string shownText(const MessageText& t) {
    std::string out = t.text;
    for (size_t at = 0; (at = out.find("{}", at)) != std::string::npos; at += 3) out.replace(at, 2, "...");
    return out;
}

const char* severityName(const MessageText& t) { return t.severity == Severity::Warning ? "warning" : "error"; }

/// When the message comes, where that is not always; else "".
std::string whenText(const MessageKind& kind) {
    switch (kind.shown) {
    case Shown::Compile:
        return "";
    case Shown::Warnings:
    case Shown::Path:
        return "`compile -W` and editors say so.";
    case Shown::Code:
        return "It comes when code is made: in `compile` and `render`.";
    case Shown::Elsewhere:
        break;
    }
    return "It has no example: " + std::string(kind.reason) + ".";
}

/// The lines with blanks before them.
std::string indented(const std::string& text, const std::string& blanks) {
    std::string out;
    for (size_t at = 0; at < text.size();) {
        const size_t end = std::min(text.find('\n', at), text.size());
        out += blanks + text.substr(at, end - at) + "\n";
        at = end + 1;
    }
    return out;
}

/// The words in lines of a terminal, with blanks before them.
std::string wrapped(const std::string& text, const std::string& blanks) {
    constexpr size_t kColumns = 100;
    std::string out, line = blanks;
    for (size_t at = 0; at < text.size();) {
        const size_t end = std::min(text.find(' ', at), text.size());
        if (line.size() + end - at >= kColumns && line != blanks) {
            out += line + "\n";
            line = blanks;
        }
        line += (line == blanks ? "" : " ") + text.substr(at, end - at);
        at = end + 1;
    }
    return out + line + "\n";
}

std::string oneText(const MessageKind& kind) {
    std::string out = std::string(kind.id) + "\n";
    for (const MessageText* t : textsOf(kind)) {
        out += fmt::format("    {}: {}\n", severityName(*t), shownText(*t));
        if (*t->hint) out += fmt::format("      hint: {}\n", t->hint);
    }
    const std::string when = whenText(kind);
    out += "\n" + wrapped(kind.about + (when.empty() ? "" : " " + when), "    ");
    if (*kind.example) out += "\nExample:\n\n" + indented(kind.example, "    ");
    return out;
}

std::string oneMarkdown(const MessageKind& kind) {
    std::string out = fmt::format("### {}\n\n", kind.id);
    for (const MessageText* t : textsOf(kind)) out += fmt::format("- {}: `{}`\n", severityName(*t), shownText(*t));
    out += fmt::format("\n{}", kind.about);
    if (const std::string when = whenText(kind); !when.empty()) out += " " + when;
    return out + "\n" + (*kind.example ? fmt::format("\n```\n{}```\n", kind.example) : "");
}

OrderedJson oneJson(const MessageKind& kind) {
    OrderedJson texts = OrderedJson::array();
    for (const MessageText* t : textsOf(kind)) {
        OrderedJson j{{"severity", severityName(*t)}, {"text", t->text}};
        if (*t->hint) j["hint"] = t->hint;
        texts.push_back(std::move(j));
    }
    OrderedJson j{{"id", kind.id}, {"texts", std::move(texts)}, {"about", kind.about}};
    if (*kind.example) j["example"] = kind.example;
    return j;
}

} // namespace

std::string messageText(const std::string& id) {
    if (!id.empty()) {
        const MessageKind* kind = rsl::messageKind(id);
        return kind ? oneText(*kind) : "";
    }
    std::string out;
    for (const MessageKind* kind : rsl::messageKinds()) {
        const MessageText& first = *textsOf(*kind)[0];
        out += fmt::format("{:<24} {:<8} {}\n", kind->id, severityName(first), shownText(first));
    }
    return out;
}

OrderedJson messageJson(const std::string& id) {
    OrderedJson all = OrderedJson::array();
    for (const MessageKind* kind : rsl::messageKinds())
        if (id.empty() || id == kind->id) all.push_back(oneJson(*kind));
    return all;
}

std::string messagesPage() {
    std::string out =
        "# Messages of the compiler\n\n"
        "Every message about a shader has an id, which stands behind it in brackets and never changes. This page says what\n"
        "each means and what to do, with a program that has this message and no other. It is made from the table of messages\n"
        "by `alpenglow info --messages --markdown`; tests hold the page to the table and compile the programs.\n"
        "`alpenglow compile --explain ID` prints one of them. Editors show the id next to the message.\n\n"
        "`...` stands for names, types and numbers.\n";
    for (const MessageKind* kind : rsl::messageKinds()) {
        for (const rsl::MessageSubject& s : rsl::messageSubjects())
            if (kind == &s.first) out += fmt::format("\n## {}\n", s.title);
        out += "\n" + oneMarkdown(*kind);
    }
    return out;
}

std::vector<std::string> messageIds() {
    std::vector<std::string> ids;
    for (const MessageKind* kind : rsl::messageKinds()) ids.emplace_back(kind->id);
    return ids;
}

} // namespace alpenglow::cli
