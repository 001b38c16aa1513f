#pragma once
#include "scene/fwd.h"
#include "scene/primitive.h"

namespace alpenglow::geometry {

/// Attributes of an object's primitive in an instance: those of the instance (RISpec 3.2, 5.10), overridden by those set between
/// ObjectBegin and the primitive, whose shaders are in the instance's space. Not null if the primitive has some.
scene::AttributesRef instanceAttributes(const scene::Primitive& primitive, const scene::Instance& instance);

} // namespace alpenglow::geometry
