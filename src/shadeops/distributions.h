// The distributions of bsdf() and trace() (docs/design/rsl.md, "Distributions"). Each has a file in bsdf/, which declares it.
#pragma once
#include "shadeops/descriptor.h"
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace alpenglow::shadeops {

/// A distribution: what the compiler must know to call its formula.
struct Distribution {
    std::string name; ///< of "distribution", as shaders write it
    /// The hidden shadeop "__bsdf_NAME". Its parameters are found by their names: l, n (of a fibre: tip), wo, udir, roughness,
    /// roughnessv, eta (float or color), k, cone, absorption. With `lobe`, "lobe" and the numbers of a lobe but its weight
    /// follow. Its result, or each output parameter, is a part of the value per steradian, the cosine included.
    Shadeop formula;
    float eta = 0;           ///< index of refraction of a call that gives none
    int parts = 1;           ///< most parts that a call gives whose result is an array
    std::vector<float> lobe; ///< the numbers of one lobe by default, its weight first; empty: there are no lobes
    int lobes = 0;           ///< lobes of a call that gives none
    bool surface = true;     ///< false: a fibre, which "horizon" does not cut
};

/// All, in the order of messages and of manuals. Built once, immutable.
std::span<const Distribution> distributions();
/// Null if bsdf() has none of this name.
const Distribution* findDistribution(std::string_view name);

inline constexpr const char kPhongOfTrace[] = "slphong"; ///< trace() alone

/// Whether bsdf(), or trace() if `ofTrace`, knows the name.
inline bool isDistribution(std::string_view name, bool ofTrace) {
    return findDistribution(name) || (ofTrace && name == kPhongOfTrace);
}
/// The names of bsdf(), in one line.
inline std::string distributionNames(const char* between) {
    std::string all;
    for (const Distribution& d : distributions()) all += (all.empty() ? "" : between) + d.name;
    return all;
}
/// The message for a name that is no distribution.
inline std::string noDistribution(const std::string& op, std::string_view name) {
    return op + "(): there is no distribution \"" + std::string(name) + "\"";
}
inline std::string knownDistributions() { return "the distributions are " + distributionNames(", "); }

} // namespace alpenglow::shadeops
