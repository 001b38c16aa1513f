// Why a function or shadeop does not fit a call: the words behind each candidate of a failed overload.
#include "base/printable.h"
#include "rsl/front/checker.h"
#include <algorithm>
#include <utility>

namespace alpenglow::rsl {

std::string toString(const Whole& w, const Program& program) {
    const bool known = w.structure >= 0 && size_t(w.structure) < program.structs.size();
    return (known ? program.structs[size_t(w.structure)].name : "a structure") +
           (w.array ? "[" + (w.array > 0 ? std::to_string(w.array) : "") + "]" : "");
}

int extensions(const Whole& given, const Whole& wanted, const Program& program) {
    if (given.structure < 0 || wanted.structure < 0 || (given.array != 0) != (wanted.array != 0)) return -1;
    const auto& all = program.structs;
    int s = given.structure;
    for (int steps = 0; s >= 0 && size_t(s) < all.size() && size_t(steps) <= all.size(); ++steps, s = all[size_t(s)].base)
        if (s == wanted.structure) return steps;
    return -1;
}

namespace front {

namespace {

/// What was written at one place among arguments or parameters: a value, or a structure, which by now is as many as it has
/// members.
struct Written {
    size_t at;
    bool structure;
};

/// `wholeAt(i)`: Whole of the i-th, which describes the structure that begins there, if one does.
template <class F> std::vector<Written> asWritten(size_t count, F wholeAt) {
    std::vector<Written> all;
    for (size_t i = 0; i < count;) {
        const Whole& w = wholeAt(i);
        if (!w.self) all.push_back({i, w.structure >= 0});
        i += size_t(std::max(w.members, 1));
    }
    return all;
}

} // namespace

std::string Checker::signatureText(const Function& f) const {
    const auto parameters = asWritten(f.parameters.size(), [&](size_t i) { return f.parameters[i]->whole; });
    std::string result = toString(f.result), list;
    for (const Symbol* p : f.parameters)
        if (p->whole.self && p->name.starts_with("(result)")) result = toString(p->whole, program_);
    for (const Written& w : parameters) {
        const Symbol& p = *f.parameters[w.at];
        list += (list.empty() ? "" : ", ") + std::string(p.output ? "output " : "") +
                (w.structure ? toString(p.whole, program_) : toString(p.type));
    }
    return result + " " + f.name + "(" + list + ")";
}

std::string Checker::whyNot(const std::vector<ParameterView>& parameters, bool repeats, bool pairs, Expr& call) {
    const size_t n = call.args.size();
    const auto given = asWritten(n, [&](size_t i) { return call.args[i]->whole; });
    const auto taken = asWritten(parameters.size(), [&](size_t i) { return parameters[i].whole; });
    const auto structure = [](const Written& w) { return w.structure; };
    if (given.size() != n || taken.size() != parameters.size() || std::ranges::any_of(given, structure) ||
        std::ranges::any_of(taken, structure)) {
        if (given.size() != taken.size())
            return "it takes " + counted(taken.size(), "argument") + ", not " + std::to_string(given.size());
        for (size_t k = 0; k < given.size(); ++k) {
            Expr& a = *call.args[given[k].at];
            const ParameterView& p = parameters[taken[k].at];
            const bool plain = !given[k].structure && !taken[k].structure;
            if (!plain && extensions(a.whole, p.whole, program_) >= 0) continue;
            if (plain && argumentCost(a, p, false) < kNever) continue;
            const std::string which = "argument " + std::to_string(k + 1);
            if (plain && p.output && !isVariable(a)) return which + " is an output and must be a variable";
            return which + " is " + (given[k].structure ? toString(a.whole, program_) : describe(a)) + ", not " +
                   (taken[k].structure ? toString(p.whole, program_) : toString(p.type)) +
                   (p.output ? ", and what is put out is not converted" : "");
        }
        const auto result = [](const Whole& w) { return w.self && w.structure >= 0; };
        for (size_t k = std::min(n, parameters.size()); k-- > 0;)
            if (const Whole &want = call.args[k]->whole, &have = parameters[k].whole; result(want) && result(have))
                if (extensions(have, want, program_) < 0)
                    return "it gives " + toString(have, program_) + ", not " + toString(want, program_);
        return "a structure does not fit";
    }
    if (n < parameters.size())
        return "it takes " + std::string(repeats || pairs ? "at least " : "") + counted(parameters.size(), "argument") +
               ", not " + std::to_string(n);
    size_t i = 0;
    for (; i < n; ++i) {
        const bool extra = i >= parameters.size();
        if (extra && (!repeats || parameters.empty())) break;
        const ParameterView& p = extra ? parameters.back() : parameters[i];
        if (extra && pairs && call.args[i]->kind == ExprKind::String && p.type.base != Base::String) break;
        if (argumentCost(*call.args[i], p, false) < kNever) continue;
        const std::string which = "argument " + std::to_string(i + 1);
        if (p.output && !isVariable(*call.args[i])) return which + " is an output and must be a variable";
        return which + " is " + describe(*call.args[i]) + ", not " + toString(p.type) +
               (p.output ? ", and what is put out is not converted" : "");
    }
    if (i == n) return "";
    if (!pairs) return "it takes " + counted(parameters.size(), "argument") + ", not " + std::to_string(n);
    return "behind argument " + std::to_string(i) + " stand pairs: a name in quotes, then its value";
}

void Checker::noMatch(Expr& e, const std::vector<std::string>& candidates, std::vector<std::string> notes, bool outputsOnly) {
    std::string given;
    for (const Written& w : asWritten(e.args.size(), [&](size_t i) { return e.args[i]->whole; })) {
        Expr& a = *e.args[w.at];
        given += (given.empty() ? "" : ", ") + (w.structure ? toString(a.whole, program_) : describe(a));
    }
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

} // namespace front
} // namespace alpenglow::rsl
