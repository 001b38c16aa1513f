// The list of lobes. trace() and the lighting shadeops know them by name, the statistics tests by this list.
#pragma once
#include "transport/lobes/cone.h"
#include "transport/lobes/diffuse.h"
#include "transport/lobes/facets.h"
#include "transport/lobes/glass.h"
#include "transport/lobes/hair.h"
#include "transport/lobes/orennayar.h"
#include "transport/lobes/phong.h"
#include "transport/lobes/phonglobe.h"
#include "transport/lobes/specular.h"

namespace alpenglow::transport::AL_NAMESPACE {
// static: files of one width and different processors must not share it.
static constexpr LobeLanes kLobes[] = {
    lanesOf<Diffuse>(),    lanesOf<Specular>(),  lanesOf<Phong>(), lanesOf<UniformCone>(),      lanesOf<CosineCone>(),
    lanesOf<PhongTrace>(), lanesOf<OrenNayar>(), lanesOf<Blinn>(), lanesOf<AshikhminShirley>(), lanesOf<CookTorrance>(),
    lanesOf<Ward>(),       lanesOf<Glass>(),     lanesOf<Hair>()};
} // namespace alpenglow::transport::AL_NAMESPACE
