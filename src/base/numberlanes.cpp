#include "base/numberlanes.h"

namespace alpenglow {

// One for each file compiled from lanes/numbers.inc.
void drawNumbers4(NumberBlock*, uint64_t);
void drawNumbers8(NumberBlock*, uint64_t);
void drawNumbers16(NumberBlock*, uint64_t);

DrawNumbers drawNumbers(int lanes) {
    static const bool v3 = __builtin_cpu_supports("x86-64-v3"), v4 = __builtin_cpu_supports("x86-64-v4");
    return lanes == 4 ? drawNumbers4 : lanes == 8 && v3 ? drawNumbers8 : lanes == 16 && v4 ? drawNumbers16 : nullptr;
}

void drawBlocks(std::span<NumberBlock> blocks) {
    static const DrawNumbers widest = [] {
        for (int lanes : {16, 8})
            if (const DrawNumbers d = drawNumbers(lanes)) return d;
        return drawNumbers(4);
    }();
    if (!blocks.empty()) widest(blocks.data(), blocks.size());
}

void NumberRows::draw() { drawBlocks(std::span(blocks_).first((count_ + kSize - 1) / kSize)); }

} // namespace alpenglow
