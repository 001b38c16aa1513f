#include "rsl/zerodivisors.h"
#include "rsl/front/visit.h"
#include "rsl/ir/build.h"
#include "rsl/passes/optimize.h"
#include "rsl/passes/zerodivision.h"
#include <algorithm>
#include <set>

namespace alpenglow::rsl {

namespace {

std::string text(float f) {
    char s[32];
    std::snprintf(s, sizeof s, "%.9g", double(f));
    return s;
}

bool isOneOf(const std::vector<std::string>& list, const std::string& name) {
    return std::find(list.begin(), list.end(), name) != list.end();
}

} // namespace

std::vector<std::string> zeroDivisors(const Program& program, const Shader& shader,
                                      const std::map<std::string, std::vector<float>>& numbers) {
    std::set<std::string> found;
    const auto divisor = [&](const Expr& e) {
        if (e.kind != ExprKind::Variable || !e.symbol || e.symbol->origin != Symbol::Origin::ShaderParameter) return;
        const auto known = numbers.find(e.symbol->name);
        if (known != numbers.end() && std::count(known->second.begin(), known->second.end(), 0.f) > 0) found.insert(known->first);
    };
    const auto expression = [&](const Expr& e) {
        if (e.op == ExprOp::Div && e.args.size() == 2) front::everyExpr(*e.args[1], divisor);
    };
    const auto body = [&](const Stmt& s) { front::everyExpr(s, expression); };
    if (shader.body) body(*shader.body);
    front::everyFunctionBody(program, body);
    return {found.begin(), found.end()};
}

void fixParameters(KernelOptions& options, const std::map<std::string, std::vector<float>>& numbers) {
    for (const auto& [name, v] : numbers)
        if ((v.size() == 1 || v.size() == 3) && !isOneOf(options.varyingParameters, name) &&
            !isOneOf(options.computedParameters, name)) {
            std::string all;
            for (const float f : v) all += text(f) + " ";
            options.stringParameters.emplace_back(name, all);
        }
}

std::vector<SourcePlace> divisionsByZero(const Program& program, const Shader& shader, KernelOptions options,
                                         const std::map<std::string, std::vector<float>>& numbers) {
    fixParameters(options, numbers);
    Diagnostics quiet, reported; // compiling the kernel has reported the others
    std::vector<SourcePlace> places;
    const auto kernel = buildKernel(program, shader, options, quiet);
    if (!kernel) return places;
    passes::simplify(*kernel, options);
    passes::warnOfZeroDivisions(*kernel, reported);
    for (const Diagnostic& d : reported.all()) places.push_back(d.place);
    return places;
}

} // namespace alpenglow::rsl
