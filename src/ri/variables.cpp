// Variables in the texts of requests: Option "ribparse" "varsubst" (PRMan; of "rib" in ricpp).
#include "base/limits.h"
#include "ri/interpreter.h"
#include "ri/requests/request.h"
#include <cctype>
#include <fmt/format.h>

namespace alpenglow::ri {

/// Replaces the variables of a text by their values. mark: the character before a name.
void Interpreter::putVariables(std::string& text, char mark, const SourcePlace& place) {
    const auto letter = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == ':'; };
    std::string out;
    size_t at = 0;
    while (at < text.size() && out.size() <= limits::kTokenBytes) {
        const size_t begin = std::min(text.find(mark, at), text.size());
        out.append(text, at, begin - at);
        at = begin;
        if (at == text.size()) break;
        const bool braces = at + 1 < text.size() && text[at + 1] == '{';
        const size_t from = at + (braces ? 2 : 1);
        size_t to = from;
        while (to < text.size() && letter(text[to])) ++to;
        while (!braces && to > from && text[to - 1] == ':') --to; // "$folder:$other": a list
        const bool whole = to > from && (!braces || (to < text.size() && text[to] == '}'));
        const size_t end = to + (braces && whole ? 1 : 0);
        const std::string name = text.substr(from, to - from);
        const auto value = whole ? variable(name, true) : std::nullopt;
        if (value) out += value->isString ? value->text : fmt::format("{}", value->number);
        else out.append(text, at, std::max(end, from) - at);
        if (whole && !value)
            reporter.once("ri:variable:" + name, Severity::Warning, Rie::BadToken, place,
                          fmt::format("{}{} is not set: it stays in the text", mark, name),
                          "Option \"user\" \"string " + name + "\", or a variable of the environment");
        at = std::max(end, from);
    }
    if (out.size() > limits::kTokenBytes)
        return reporter.error(Rie::Limit, place, "a text with its variables is too long; they stay in it");
    text = std::move(out);
}

Call Interpreter::withVariables(const Call& given) {
    Call call = given;
    const std::string_view name = call.request->name;
    if (name == "IfBegin" || name == "ElseIf") return call; // they name variables
    if (name == "Option" && call.given(0) && (call.text(0) == "ribparse" || call.text(0) == "rib")) return call;
    const auto mark = options.values.find("ribparse:varsubst");
    if (mark == options.values.end() || mark->second.strings.empty() || mark->second.strings[0].empty()) return call;
    const char c = mark->second.strings[0][0];
    for (Argument& a : call.arguments)
        for (std::string& s : a.strings) putVariables(s, c, call.place);
    for (RawParam& p : call.params)
        for (std::string& s : p.value.strings) putVariables(s, c, call.at(p));
    return call;
}

} // namespace alpenglow::ri
