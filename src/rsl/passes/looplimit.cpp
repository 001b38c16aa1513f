#include "rsl/passes/looplimit.h"
#include "base/limits.h"
#include "rsl/ir/edit.h"

namespace alpenglow::rsl::ir {

void limitLoops(Kernel& k) {
    // Sites of their own at the end: the numbers of the others are in random numbers.
    forEach(k.body, [&](Inst* i) {
        if (i->op != Op::Loop) return;
        Site s;
        s.op = "complaint";
        s.strings = {"this loop is left after " + std::to_string(limits::kLoopIterations) +
                     " turns at one point, those of loops inside of it counted, with the values that its variables have then; "
                     "its condition does not become false"};
        s.place = i->place;
        i->site = int(k.sites.size());
        k.sites.push_back(std::move(s));
    });
}

} // namespace alpenglow::rsl::ir
