// Calls on constant strings, and trace() in parts.
#include "base/limits.h"
#include "rsl/ir/builder.h"
#include <algorithm>
#include <cstdio>

namespace alpenglow::rsl::ir {

/// concat and format of constants; null when something is not constant.
Inst* Builder::foldString(const std::string& op, const std::vector<Inst*>& args) {
    for (const Inst* a : args)
        if (a->op != Op::ConstString && !(a->op == Op::Const && a->kind == Kind::Float)) return nullptr;
    std::string out;
    if (op == "concat") {
        for (const Inst* a : args) out += a->text;
        if (out.size() > limits::kTokenBytes) return nullptr; // cut off and reported when it runs
        return leaves_.string(out);
    }
    if (op != "format" || args.empty() || args[0]->op != Op::ConstString) return nullptr;
    const std::string& p = args[0]->text;
    size_t next = 1;
    for (size_t i = 0; i < p.size(); ++i) {
        if (p[i] != '%') {
            out += p[i];
            continue;
        }
        if (i + 1 < p.size() && p[i + 1] == '%') {
            out += '%';
            ++i;
            continue;
        }
        // Only the plain conversions; widths and precisions are the service's business.
        if (i + 1 >= p.size() || next >= args.size()) return nullptr;
        const Inst* a = args[next++];
        const char c = p[++i];
        if (c == 's' && a->op == Op::ConstString) out += a->text;
        else if (c == 'd' && a->op == Op::Const) {
            char text[64];
            std::snprintf(text, sizeof text, "%.0f", static_cast<double>(a->numbers[0]));
            out += text;
        } else return nullptr;
    }
    return leaves_.string(out);
}

/// The form of trace() whose result is an array: a request for each part of the distribution.
std::vector<Inst*> Builder::traceParts(const Expr& written) {
    const Expr& e = withNames(written);
    std::string name = "uniform";
    std::optional<int> numbers; // of "lobeparameters"
    for (const NamedArg& p : e.pairs) {
        if (!p.value) continue;
        if (p.name == "distribution" || p.name == "bsdf") {
            const Inst* v = expr(*p.value, Kind::String);
            name = v->op == Op::ConstString ? v->text : "";
        } else if (p.name == "lobeparameters" && p.value->type.array) {
            numbers = arrayLength(array(*p.value));
        }
    }
    const Distribution* const m = findDistribution(name);
    if (!m || m->parts == 1) {
        report(e.place, name.empty() ? Raised(msg::kTracePartsConstant) : msg::kTraceParts(name));
        return {service(e, Op::Request)};
    }
    int count = m->parts;
    if (!m->lobe.empty()) count = std::clamp(numbers ? *numbers / static_cast<int>(m->lobe.size()) : m->lobes, 1, m->parts);
    std::vector<Inst*> parts;
    for (int i = 0; i < count; ++i) parts.push_back(service(e, Op::Request, i));
    return parts;
}

} // namespace alpenglow::rsl::ir
