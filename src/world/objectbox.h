// The bounding box of a primitive in object space, for attribute("geometry:boundingbox").
#pragma once
#include "scene/primitive.h"
#include "world/names.h"
#include <array>
#include <optional>

namespace alpenglow::world {

inline constexpr const char kObjectBox[] = "geometry:boundingbox"; ///< attribute() answers a primitive's box under this name

/// xmin xmax ymin ymax zmin zmax in object space, as in RiBound: of the primitive's points at all its times, before displacement;
/// quadrics with a full sweep. Returns nothing for primitives without points and box (blobbies).
std::optional<std::array<float, 6>> objectBox(const scene::Primitive&);

} // namespace alpenglow::world
