// Lobes: what a vertex does to light. One file each in lobes/; each is one LobeKind, known to trace() and the lighting shadeops by
// name. The value of a lobe is f cos (design decision 4): the shadeop's result is the integral of L f cos over directions, so
// diffuse() of radiance 1 from everywhere is 1 and a light's Cl (irradiance / pi) is scored pi f cos Cl.
#pragma once
#include "base/vec.h"
#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace alpenglow::transport {

/// What the distributions that trace() has in common with bsdf() take beside the rest (rsl.md 12.4). Current space.
struct DistributionParams {
    float roughness = 0, roughnessv = 0;
    Vec3 udir;
    Color eta{0}, k{0};       ///< index of refraction and extinction; glass-ggx and hair: the first channel of eta
    Color absorption{0};      ///< hair
    std::vector<float> lobes; ///< glass-ggx: weights of reflection and refraction; hair: four numbers a lobe
    int part = -1;            ///< glass-ggx: 0 reflection, 1 refraction; hair: the lobe; -1: all
};

/// Parameters of a lobe at one vertex, in current space. Which are used is said by the kind.
struct LobeParams {
    Vec3 axis;            ///< normal, mirror or cone direction; unit
    Vec3 wo;              ///< toward the viewer; unit
    Vec3 horizon;         ///< normal of the plane that cuts the lobe; used when hasHorizon
    float a = 0;          ///< roughness, exponent or cone half angle
    bool hasHorizon = false;
    std::shared_ptr<const DistributionParams> more; ///< kinds with `distribution` need it; null for others
};

struct LobeKind {
    std::string_view name;
    std::string_view doc;
    /// A single direction: fcos and pdf are 0 everywhere, sample returns it with weight albedo().
    bool (*isDelta)(const LobeParams&);
    /// f cos for light arriving from unit direction w; >= 0; per steradian.
    float (*fcos)(const LobeParams&, Vec3 w);
    /// Density of sample() per solid angle.
    float (*pdf)(const LobeParams&, Vec3 w);
    /// Draws a direction; false: this draw brings nothing (it counts as a sample of value 0).
    bool (*sample)(const LobeParams&, Vec2 u, Vec3& w);
    /// About the integral of fcos; for choosing between lobes and for the energy rule. Exact is not needed, > 0 is.
    float (*albedo)(const LobeParams&);
    /// Half angle in radians of the lobe's spread, for the footprint of rays behind it (design decision 7).
    float (*spread)(const LobeParams&);
    /// The value by channel, where channels differ; fcos is then the largest. Null: fcos for all.
    Color (*colour)(const LobeParams&, Vec3 w) = nullptr;
    bool distribution = false; ///< reads LobeParams::more
};
/// f cos by channel.
inline Color lobeValue(const LobeKind& k, const LobeParams& p, Vec3 w) { return k.colour ? k.colour(p, w) : Color(k.fcos(p, w)); }

std::span<const LobeKind* const> lobeKinds();
/// By the name trace() or a lighting shadeop knows it under; null when unknown.
const LobeKind* findLobe(std::string_view name);

} // namespace alpenglow::transport
