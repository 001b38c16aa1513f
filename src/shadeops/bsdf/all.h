// The list of the distributions of bsdf() and trace() (docs/design/rsl.md, "Distributions"), one file each.
#pragma once
#include "shadeops/bsdf/ashikhmin_shirley.h"
#include "shadeops/bsdf/beckmann.h"
#include "shadeops/bsdf/blinn.h"
#include "shadeops/bsdf/cook_torrance.h"
#include "shadeops/bsdf/cosine.h"
#include "shadeops/bsdf/ggx.h"
#include "shadeops/bsdf/glass_ggx.h"
#include "shadeops/bsdf/hair.h"
#include "shadeops/bsdf/oren_nayar.h"
#include "shadeops/bsdf/uniform.h"
#include "shadeops/bsdf/ward.h"

#ifdef ALPENGLOW_DESCRIBE
namespace alpenglow::shadeops {
/// All distributions of bsdf(), in the order of messages and manuals.
std::span<const Distribution> distributions() {
    static const std::vector<Distribution> list = {bsdfUniform(),          bsdfCosine(),       bsdfOrenNayar(), bsdfBlinn(),
                                                   bsdfAshikhminShirley(), bsdfCookTorrance(), bsdfWard(),      bsdfGgx(),
                                                   bsdfBeckmann(),         bsdfGlass(),        bsdfHair()};
    return list;
}
/// By the name in shaders; null: there is none.
const Distribution* findDistribution(std::string_view name) {
    for (const Distribution& d : distributions())
        if (d.name == name) return &d;
    return nullptr;
}
/// The shadeops of the section, one for each distribution.
std::vector<Shadeop> bsdfShadeops() {
    std::vector<Shadeop> list;
    for (const Distribution& d : distributions()) list.push_back(d.formula);
    return list;
}
} // namespace alpenglow::shadeops
#endif
