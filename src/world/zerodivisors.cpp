// Detects parameters that shaders divide by and that the scene has set to 0: the result of such a division is 0, and surfaces
// often render black.
#include "rsl/zerodivisors.h"
#include "rsl/compiler.h"
#include "world/mutableworld.h"

namespace alpenglow::world {

void MutableWorld::sayZeroDivisions(const ShaderInstance& i, const rsl::KernelOptions& o, Diagnostics& d) {
    const rsl::Program& program = i.program->program();
    const std::vector<std::string> zeros = rsl::zeroDivisors(program, i.program->shader(), i.parameters.numbers);
    if (zeros.empty()) return;
    std::string names, key = i.program->name();
    for (const std::string& name : zeros) names += (names.empty() ? "\"" : ", \"") + name + "\"";
    if (!zeroDivisors_.insert(key + names + i.place.file + std::to_string(i.place.line)).second) return;
    const std::string of = i.place.line > 0 ? " at " + i.place.file + ":" + std::to_string(i.place.line) : "";
    for (const SourcePlace& at : rsl::divisionsByZero(program, i.program->shader(), o, i.parameters.numbers))
        d.reportOnce("zero division:" + at.file + std::to_string(at.line) + ":" + std::to_string(at.column),
                     {Severity::Warning,
                      Rie::Math,
                      at,
                      "a division by 0, which gives 0: " + names + (zeros.size() == 1 ? " is 0" : " are 0") + of,
                      {},
                      {}});
}

} // namespace alpenglow::world
