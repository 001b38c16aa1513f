// The list of lobes. trace() and the lighting shadeops find them by name; the statistical tests run over the list.
#pragma once
#include "bsdf/kinds/ashikhminshirley.h"
#include "bsdf/kinds/beckmann.h"
#include "bsdf/kinds/blinn.h"
#include "bsdf/kinds/cone.h"
#include "bsdf/kinds/cooktorrance.h"
#include "bsdf/kinds/diffuse.h"
#include "bsdf/kinds/ggx.h"
#include "bsdf/kinds/glass.h"
#include "bsdf/kinds/hair.h"
#include "bsdf/kinds/orennayar.h"
#include "bsdf/kinds/phase.h"
#include "bsdf/kinds/phong.h"
#include "bsdf/kinds/phonglobe.h"
#include "bsdf/kinds/specular.h"
#include "bsdf/kinds/ward.h"

namespace alpenglow::bsdf::AL_NAMESPACE {
// static: files for different processors must not share it.
static constexpr LobeLanes kLobes[] = {lanesOf<Diffuse>(),
                                       lanesOf<Specular>(),
                                       lanesOf<Phong>(),
                                       lanesOf<UniformCone>(),
                                       lanesOf<CosineCone>(),
                                       lanesOf<PhongTrace>(),
                                       lanesOf<OrenNayar>(),
                                       lanesOf<Blinn>(),
                                       lanesOf<AshikhminShirley>(),
                                       lanesOf<CookTorrance>(),
                                       lanesOf<Ward>(),
                                       lanesOf<Glass>(),
                                       lanesOf<Hair>(),
                                       lanesOf<HenyeyGreenstein>(),
                                       lanesOf<PhaseTowardLight>(),
                                       lanesOf<GgxReflection>(),
                                       lanesOf<BeckmannReflection>()};
} // namespace alpenglow::bsdf::AL_NAMESPACE
