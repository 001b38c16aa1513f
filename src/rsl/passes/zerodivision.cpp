#include "rsl/passes/zerodivision.h"
#include "rsl/ir/edit.h"
#include "rsl/messages/messages.h"
#include <algorithm>

namespace alpenglow::rsl::passes {

bool waitsForWarning(const Inst& i) {
    if (i.op != Op::Div || i.index != kWrittenDivision || !isConst(i.args[1])) return false;
    const std::vector<float>& by = i.args[1]->numbers;
    return std::any_of(by.begin(), by.end(), [](float f) { return f == 0; });
}

int warnOfZeroDivisions(Kernel& k, Diagnostics& diagnostics) {
    int found = 0;
    forEach(k.body, [&](Inst* i) {
        if (!waitsForWarning(*i)) return;
        ++found;
        i->index = 0;
        const size_t f = static_cast<size_t>(i->place.file);
        const SourcePlace at{f < k.files.size() ? k.files[f] : std::string(), i->place.line, i->place.column};
        const std::vector<float>& by = i->args[1]->numbers;
        const bool all = std::all_of(by.begin(), by.end(), [](float c) { return c == 0; });
        diagnostics.reportOnce("zero division:" + at.file + std::to_string(at.line) + ":" + std::to_string(at.column),
                               diagnostic(all ? msg::kZeroDivision : msg::kZeroDivisionPart, Rie::Math, at));
    });
    return found;
}

} // namespace alpenglow::rsl::passes
