// The runtime for 4 and 8 lanes: files next to the program's modules, because a render is asked for it by --lanes alone.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace alpenglow::shadeops {

/// The file of one lane width.
struct NarrowRuntime {
    std::vector<uint8_t> bytes; ///< bitcode; empty when `lack` says why
    std::string lack;           ///< what is missing and what to do; "" when nothing is
};

/// alpenglow_runtime4.bc or alpenglow_runtime8.bc, for `lanes` of 4 or 8, read by the first call. The file ends in the text of
/// bitcode/hash.txt: when that is not `hash`, the program's own, the file is of other sources and not taken.
const NarrowRuntime& narrowRuntime(int lanes, std::string_view hash);

} // namespace alpenglow::shadeops
