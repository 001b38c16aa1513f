#include "rsl/nonlinear.h"
#include "rsl/front/ast.h"
#include "rsl/ir/build.h"
#include "rsl/passes/optimize.h"

namespace alpenglow::rsl {

std::optional<Diagnostic> nonlinearUse(const Program& program, const Shader& shader, KernelOptions options) {
    options.path = true;
    Diagnostics quiet; // what there is to say besides is said when the kernel is made
    const auto kernel = buildKernel(program, shader, options, quiet);
    if (!kernel) return std::nullopt;
    ir::optimize(*kernel, options, quiet);
    // A lobe that had to be written out as a loop over the lights is named, not what is found inside the loop.
    const bool lobe = !kernel->facts.direct.empty();
    const std::string why = lobe ? kernel->facts.direct[0] : kernel->facts.whyNot;
    if (why.empty() || kernel->facts.affine) return std::nullopt;
    Diagnostic d;
    d.severity = Severity::Warning;
    d.code = Rie::Syntax;
    const Place& p = lobe ? kernel->facts.directPlace : kernel->facts.whyNotPlace;
    if (p.line > 0 && p.file >= 0 && size_t(p.file) < program.files.size()) d.place = {program.files[size_t(p.file)], p.line, p.column};
    const size_t end = why.find_first_of(",:");
    d.message = "under path the result of " + why.substr(0, end) + " is used non-linearly: " +
                (why.find(": ") == std::string::npos ? why : why.substr(why.find(": ") + 2));
    d.id = "not-affine";
    d.hint = "the shader waits for its rays then; only sums and products with what does not depend on light need no waiting";
    return d;
}

} // namespace alpenglow::rsl
