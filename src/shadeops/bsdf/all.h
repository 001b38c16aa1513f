// The distributions of bsdf() (docs/design/rsl.md, "Distributions"), one file each, and their descriptors.
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
namespace alpenglow::rsl {
std::vector<Shadeop> bsdfShadeops() {
    return {bsdfUniform(), bsdfCosine(),   bsdfOrenNayar(), bsdfBlinn(), bsdfAshikhminShirley(), bsdfCookTorrance(), bsdfWard(),
            bsdfGgx(),     bsdfBeckmann(), bsdfGlass(),     bsdfHair()};
}
} // namespace alpenglow::rsl
#endif
