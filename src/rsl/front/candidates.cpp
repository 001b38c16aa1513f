// Why a function or shadeop does not fit a call: the words behind each candidate of a failed overload.
#include "rsl/front/checker.h"

namespace alpenglow::rsl::front {

namespace {
std::string counted(size_t n, const char* what) { return std::to_string(n) + " " + what + (n == 1 ? "" : "s"); }
} // namespace

std::string Checker::whyNot(const std::vector<ParameterView>& parameters, bool repeats, bool pairs, Expr& call) {
    const size_t n = call.args.size();
    if (n < parameters.size())
        return "it takes " + std::string(repeats || pairs ? "at least " : "") + counted(parameters.size(), "argument") + ", not " +
               std::to_string(n);
    size_t i = 0;
    for (; i < n; ++i) {
        const bool extra = i >= parameters.size();
        if (extra && (!repeats || parameters.empty())) break;
        const ParameterView& p = extra ? parameters.back() : parameters[i];
        if (extra && pairs && call.args[i]->kind == ExprKind::String && p.type.base != Base::String) break;
        if (argumentCost(*call.args[i], p, false) < kNever) continue;
        const std::string which = "argument " + std::to_string(i + 1);
        if (p.output && !isVariable(*call.args[i])) return which + " is an output and must be a variable";
        return which + " is " + describe(*call.args[i]) + ", not " + named(p.type, p.handle) +
               (p.output ? ", and what is put out is not converted" : "");
    }
    if (i == n) return "";
    if (!pairs) return "it takes " + counted(parameters.size(), "argument") + ", not " + std::to_string(n);
    return "behind argument " + std::to_string(i) + " stand pairs: a name in quotes, then its value";
}

} // namespace alpenglow::rsl::front
