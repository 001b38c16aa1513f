// The sections that hold code, compiled into the program at 4 lanes: descriptors, and evaluateRuntime. Without derivatives: the
// functions on jets take three quarters of the compilation, and only tests call them (tests/shadeops/jets_runtime.h).
#define ALPENGLOW_DESCRIBE
#define ALPENGLOW_ORDERS 1
#include "shadeops/host_runtime.h"
#include "shadeops/runtime.h"
#include <algorithm>
#include <map>

namespace alpenglow::shadeops {
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

bool evaluateRuntime(std::string_view symbol, const float* in, int inCount, float* out, int outCount) {
    static constexpr int kMost = 64; // more components than any symbol has
    const auto* entry = findEntry(symbol);
    if (!entry || inCount != entry->in || outCount != entry->out || inCount > kMost || outCount > kMost) return false;
    lanes4::vf a[kMost], r[kMost];
    for (int i = 0; i < inCount; ++i) a[i] = lanes4::vf(in[i]);
    entry->order[0](a, r);
    for (int i = 0; i < outCount; ++i) out[i] = r[i][0];
    return true;
}

} // namespace alpenglow::shadeops
