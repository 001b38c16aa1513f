#include "rsl/passes/looplimit.h"
#include "base/limits.h"
#include "rsl/ir/complaint.h"
#include "rsl/ir/edit.h"

namespace alpenglow::rsl::passes {

void limitLoops(Kernel& k) {
    // Sites of their own at the end: the numbers of the others are in random numbers.
    forEach(k.body, [&](Inst* i) {
        if (i->op != Op::Loop) return;
        Site s = complaint(msg::kLoopLimit(limits::kLoopIterations));
        s.place = i->place;
        i->site = int(k.sites.size());
        k.sites.push_back(std::move(s));
    });
}

} // namespace alpenglow::rsl::passes
