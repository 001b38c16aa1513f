// The list of lobes. trace() and the lighting shadeops find them by name; the statistical tests run over the list.
#pragma once
#include "lobes/kinds/cone.h"
#include "lobes/kinds/diffuse.h"
#include "lobes/kinds/facets.h"
#include "lobes/kinds/glass.h"
#include "lobes/kinds/hair.h"
#include "lobes/kinds/orennayar.h"
#include "lobes/kinds/phase.h"
#include "lobes/kinds/phong.h"
#include "lobes/kinds/phonglobe.h"
#include "lobes/kinds/smith.h"
#include "lobes/kinds/specular.h"

namespace alpenglow::transport::AL_NAMESPACE {
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
                                       lanesOf<PhaseBesideLight>(),
                                       lanesOf<GgxReflection>(),
                                       lanesOf<BeckmannReflection>()};
} // namespace alpenglow::transport::AL_NAMESPACE
