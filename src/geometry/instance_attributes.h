#pragma once
#include "scene/fwd.h"
#include "scene/primitive.h"

namespace alpenglow::geometry {

/// Attributes of a primitive of an object in one of the object's instances: the instance's (RISpec 3.2, 5.10), and over them what
/// was set between ObjectBegin and the primitive, whose shaders stand in the instance's space. Never null when the primitive has
/// some.
scene::AttributesRef instanceAttributes(const scene::Primitive& primitive, const scene::Instance& instance);

} // namespace alpenglow::geometry
