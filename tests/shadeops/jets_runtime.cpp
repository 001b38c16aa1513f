#define AL_NAMESPACE jets4 // the program has another lanes4::kEntries
#include "jets_runtime.h"
#include "shadeops/descriptor.h"
#include "shadeops/runtime.h"
#include <map>

namespace alpenglow::shadeops {

bool evaluateRuntimeJet(std::string_view symbol, int order, const float* in, int inCount, float* out, int outCount) {
    static constexpr int kParts[] = {1, 3, 6};
    static constexpr int kMost = 64 * 6; // more components than any symbol has
    static const auto entries = [] {
        std::map<std::string_view, const jets4::RuntimeEntry*> t;
        for (const auto& e : jets4::kEntries) t[e.symbol] = &e;
        return t;
    }();
    if (order == 0) return evaluateRuntime(symbol, in, inCount, out, outCount);
    const auto it = entries.find(symbol);
    if (it == entries.end() || order < 0 || order > 2) return false;
    const jets4::RuntimeEntry& entry = *it->second;
    const int parts = kParts[order];
    if (inCount != entry.in * parts || outCount != entry.out * parts || inCount > kMost || outCount > kMost) return false;
    jets4::vf a[kMost], r[kMost];
    for (int i = 0; i < inCount; ++i) a[i] = jets4::vf(in[i]);
    entry.order[order](a, r);
    for (int i = 0; i < outCount; ++i) out[i] = r[i][0];
    return true;
}

} // namespace alpenglow::shadeops
