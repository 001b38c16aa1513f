#include "lanes/stages.h"

namespace alpenglow::lanes {

// One for each file compiled from lanes/stages.inc.
const Stages& stages_4v2();
const Stages& stages_8v3();
const Stages& stages_16v4();

const Stages* stages(int lanes) {
    static const bool v3 = __builtin_cpu_supports("x86-64-v3"), v4 = __builtin_cpu_supports("x86-64-v4");
    return lanes == 4 ? &stages_4v2() : lanes == 8 && v3 ? &stages_8v3() : lanes == 16 && v4 ? &stages_16v4() : nullptr;
}

const Stages& stages() {
    static const Stages& widest = *[] {
        for (int lanes : {16, 8})
            if (const Stages* s = stages(lanes)) return s;
        return stages(4);
    }();
    return widest;
}

} // namespace alpenglow::lanes
