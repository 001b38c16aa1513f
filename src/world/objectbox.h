// The box of a primitive in its own space, which shaders fit textures to: attribute("geometry:boundingbox").
#pragma once
#include "scene/primitive.h"
#include <array>
#include <optional>

namespace alpenglow::transport {

inline constexpr const char kObjectBox[] = "geometry:boundingbox";

/// xmin xmax ymin ymax zmin zmax in object space, as RiBound has them: of the points that the primitive is given by, at all its
/// times, before displacement; quadrics as if they turned about whole. Nothing for what has no points and no box (blobbies).
std::optional<std::array<float, 6>> objectBox(const scene::Primitive&);

} // namespace alpenglow::transport
