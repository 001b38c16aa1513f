#include "shadeops/narrowruntime.h"
#include "base/diagnostics.h"
#include "base/file.h"
#include "base/installation.h"
#include <cstring>
#include <optional>
#include <utility>

namespace alpenglow::shadeops {
namespace {

NarrowRuntime readNarrow(int lanes, std::string_view hash) {
    constexpr size_t kMost = size_t(64) << 20;
    const std::string name = "alpenglow_runtime" + std::to_string(lanes) + ".bc";
    const std::string wish = ": build it by `ninja -C build/release narrow_lanes`, or leave out --lanes";
    const std::string file = moduleFile(name.c_str(), nullptr);
    if (file.empty())
        return {{},
                "shaders in 4 or 8 lanes need " + name + ", which is neither next to the program nor in lib/alpenglow" + wish};
    Diagnostics quiet;
    std::optional<std::vector<uint8_t>> bytes = readWholeFile(file, kMost, quiet);
    if (!bytes) return {{}, file + ", which shaders in 4 or 8 lanes need, cannot be read"};
    if (bytes->size() < hash.size() || std::memcmp(bytes->data() + (bytes->size() - hash.size()), hash.data(), hash.size()) != 0)
        return {{}, file + " was built from other sources than this program" + wish};
    bytes->resize(bytes->size() - hash.size());
    return {std::move(*bytes), {}};
}

} // namespace

const NarrowRuntime& narrowRuntime(int lanes, std::string_view hash) {
    static const NarrowRuntime four = readNarrow(4, hash);
    static const NarrowRuntime eight = readNarrow(8, hash);
    return lanes == 4 ? four : eight;
}

} // namespace alpenglow::shadeops
