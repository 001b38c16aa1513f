// Why a function or shadeop does not fit a call: the words behind each candidate of a failed overload.
#include "base/printable.h"
#include "rsl/front/checker.h"
#include <algorithm>
#include <utility>

namespace alpenglow::rsl::front {

/// Arguments that the shader does not write between the parentheses: what a method is called for.
static size_t unwritten(const std::string& function) { return function.find("->") != function.npos; }

std::string Checker::signatureText(const Function& f) const {
    std::string list;
    for (size_t i = unwritten(f.name); i < f.parameters.size(); ++i) {
        const Symbol& p = *f.parameters[i];
        list += (list.empty() ? "" : ", ") + std::string(p.output ? "output " : "") + structures_.text(p.type);
    }
    return structures_.text(f.result) + " " + f.name + "(" + list + ")";
}

std::string Checker::whyNot(const std::vector<ParameterView>& parameters, bool repeats, bool pairs, Expr& call) {
    const size_t n = call.args.size(), skipped = unwritten(call.text);
    if (n < parameters.size())
        return "it takes " + std::string(repeats || pairs ? "at least " : "") + counted(parameters.size() - skipped, "argument") +
               ", not " + std::to_string(n - skipped);
    size_t i = skipped;
    for (; i < n; ++i) {
        const bool extra = i >= parameters.size();
        if (extra && (!repeats || parameters.empty())) break;
        const ParameterView& p = extra ? parameters.back() : parameters[i];
        if (extra && pairs && call.args[i]->kind == ExprKind::String && p.type.base != Base::String) break;
        if (argumentCost(*call.args[i], p, false) < kNever) continue;
        const std::string which = "argument " + std::to_string(i + 1 - skipped);
        if (p.output && !isVariable(*call.args[i])) return which + " is an output and must be a variable";
        return which + " is " + describe(*call.args[i]) + ", not " + structures_.text(p.type) +
               (p.output ? ", and what is put out is not converted" : "");
    }
    if (i == n) return "";
    if (!pairs) return "it takes " + counted(parameters.size() - skipped, "argument") + ", not " + std::to_string(n - skipped);
    return "behind argument " + std::to_string(i) + " stand pairs: a name in quotes, then its value";
}

void Checker::noMatch(Expr& e, const std::vector<std::string>& candidates, std::vector<std::string> notes, bool outputsOnly) {
    std::string given;
    for (size_t i = unwritten(e.text); i < e.args.size(); ++i) given += (given.empty() ? "" : ", ") + describe(*e.args[i]);
    std::string hint = "it can be called as";
    for (size_t i = 0; i < candidates.size() && i < 6; ++i) hint += (i ? "; " : " ") + candidates[i];
    if (candidates.size() > 6) hint += "; and " + std::to_string(candidates.size() - 6) + " more";
    const Raised what = outputsOnly     ? msg::kOutputArgument(e.text)
                        : given.empty() ? msg::kNoMatchingEmptyCall(e.text)
                                        : msg::kNoMatchingCall(e.text, given);
    for (const auto& p : program_.plugins)
        if (p->find(e.text)) notes.push_back("'" + e.text + "' is a function of plug-in \"" + p->name + "\": " + p->path);
    sources_.report(e.place, what, hint, std::move(notes));
}

} // namespace alpenglow::rsl::front
