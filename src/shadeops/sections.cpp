// The sections that hold code, compiled into the program at 4 lanes: descriptors, and evaluateRuntime.
#define ALPENGLOW_DESCRIBE
#include "shadeops/host_runtime.h"
#include "shadeops/runtime.h"
#include <algorithm>
#include <map>

namespace alpenglow::rsl {
namespace {
const lanes4::RuntimeEntry* findEntry(std::string_view symbol) {
    static const auto table = [] {
        std::map<std::string_view, const lanes4::RuntimeEntry*> t;
        for (const auto& e : lanes4::kEntries) t[e.symbol] = &e;
        return t;
    }();
    const auto it = table.find(symbol);
    return it == table.end() ? nullptr : it->second;
}
} // namespace

RuntimeShape runtimeShape(std::string_view symbol) {
    const auto* entry = findEntry(symbol);
    return entry ? RuntimeShape{entry->in, entry->out} : RuntimeShape{};
}

std::vector<std::string_view> runtimeSymbols() {
    std::vector<std::string_view> list;
    for (const auto& e : lanes4::kEntries) list.push_back(e.symbol);
    return list;
}

bool evaluateRuntimeJet(std::string_view symbol, int order, const float* in, int inCount, float* out, int outCount) {
    static constexpr int kParts[] = {1, 3, 6};
    static constexpr int kMost = 64 * 6; // more components than any symbol has
    const auto* entry = findEntry(symbol);
    if (!entry || order < 0 || order > 2) return false;
    const int parts = kParts[order];
    if (inCount != entry->in * parts || outCount != entry->out * parts || inCount > kMost || outCount > kMost) return false;
    lanes4::vf a[kMost], r[kMost];
    for (int i = 0; i < inCount; ++i) a[i] = lanes4::vf(in[i]);
    entry->order[order](a, r);
    for (int i = 0; i < outCount; ++i) out[i] = r[i][0];
    return true;
}

bool evaluateRuntime(std::string_view symbol, const float* in, int inCount, float* out, int outCount) {
    return evaluateRuntimeJet(symbol, 0, in, inCount, out, outCount);
}

} // namespace alpenglow::rsl
