// The names of the distributions of bsdf() and trace() (docs/design/rsl.md, "Distributions"). Their formulas stand in bsdf/.
#pragma once
#include <algorithm>
#include <string>
#include <string_view>

namespace alpenglow::rsl {

inline constexpr const char* kDistributions[] = {"uniform",           "cosine",        "oren-nayar", "blinn",
                                                 "ashikhmin-shirley", "cook-torrance", "ward",       "ggx",
                                                 "beckmann",          "glass-ggx",     "hair"};
inline constexpr const char kPhongOfTrace[] = "slphong"; ///< trace() alone

inline bool isDistribution(std::string_view name, bool ofTrace) {
    return std::find(std::begin(kDistributions), std::end(kDistributions), name) != std::end(kDistributions) ||
           (ofTrace && name == kPhongOfTrace);
}
/// All of bsdf(), in one line.
inline std::string distributionNames(const char* between) {
    std::string all;
    for (const char* name : kDistributions) all += (all.empty() ? "" : between) + std::string(name);
    return all;
}
/// The message for a name that is no distribution.
inline std::string noDistribution(const std::string& op, std::string_view name) {
    return op + "(): there is no distribution \"" + std::string(name) + "\"";
}
inline std::string knownDistributions() { return "the distributions are " + distributionNames(", "); }

} // namespace alpenglow::rsl
