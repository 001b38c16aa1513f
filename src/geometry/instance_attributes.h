#pragma once
#include "scene/fwd.h"
#include "scene/primitive.h"

namespace alpenglow::geometry {

/// The attributes of a primitive of an object in one of the object's instances: the instance's (ri.md 9.2), and over them what
/// was set between ObjectBegin and the primitive, whose shaders stand in the instance's space. Never null when the primitive has
/// some.
scene::AttributesRef instanceAttributes(const scene::Primitive& primitive, const scene::Instance& instance);

} // namespace alpenglow::geometry
