#include "rsl/nonlinear.h"
#include "rsl/front/ast.h"
#include "rsl/ir/build.h"
#include "rsl/messages/messages.h"
#include "rsl/passes/optimize.h"
#include <algorithm>
#include <set>
#include <tuple>

namespace alpenglow::rsl {

namespace {

/// The name of a request to the light transport, as users write it in shaders.
std::string spoken(const std::string& op) {
    if (op == "lightvisibility") return "the light of an illuminance loop";
    return "the result of " + op + "()";
}

/// "a (line 3)" without the line, when it is that of the message itself.
std::string without(std::string why, int line) {
    const std::string tail = " (line " + std::to_string(line) + ")";
    if (why.ends_with(tail)) why.resize(why.size() - tail.size());
    return why;
}

} // namespace

std::vector<Diagnostic> nonlinearUses(const Program& program, const Shader& shader, KernelOptions options) {
    options.path = true;
    Diagnostics quiet; // other messages are reported when the kernel is made
    const auto kernel = buildKernel(program, shader, options, quiet);
    std::vector<Diagnostic> all;
    if (!kernel) return all;
    passes::optimize(*kernel, options, quiet);
    if (kernel->facts.affine) return all;
    // A lobe that had to be written out as a loop over the lights is named, not what is found inside the loop.
    const size_t lobes = kernel->facts.direct.size();
    std::set<std::tuple<int, int, int>> seen;
    for (size_t number = 0; number < kernel->facts.nonLinear.size(); ++number) {
        const auto& n = kernel->facts.nonLinear[number];
        const Place& at = n.place;
        // The text of a shadeop of ours, written out: of a lobe it is named already, of others the shader is.
        const bool ours =
            at.line <= 0 || at.file < 0 || size_t(at.file) >= program.files.size() || program.files[size_t(at.file)][0] == '<';
        if (ours && number >= lobes && lobes > 0) continue;
        if (!seen.insert({n.place.file, n.place.line, n.place.column}).second) continue;
        const Place& p = ours ? shader.place : at;
        Diagnostic d = diagnostic(msg::kNotAffine(spoken(n.op), without(n.why, p.line)), Rie::Syntax, {});
        if (p.line > 0 && p.file >= 0 && size_t(p.file) < program.files.size())
            d.place = {program.files[size_t(p.file)], p.line, p.column};
        d.hint = number < lobes
                     ? "it brings direct light only then; sums and products with what does not depend on light bring all of it"
                     : "the shader waits for its rays then; sums and products with what does not depend on light need no waiting";
        all.push_back(std::move(d));
    }
    std::stable_sort(all.begin(), all.end(), [](const Diagnostic& a, const Diagnostic& b) {
        return std::tie(a.place.file, a.place.line, a.place.column) < std::tie(b.place.file, b.place.line, b.place.column);
    });
    return all;
}

} // namespace alpenglow::rsl
