// How many values a primitive variable has, by class (docs/design/ri.md).
#pragma once
#include "scene/primitive.h"
#include <cstdint>

namespace alpenglow::scene {

/// Values of a primitive variable, by class.
struct VariableCounts {
    int64_t uniform = 1, varying = 0, vertex = 0, faceVarying = 0; ///< numbers of values
    /// Elements of a variable of this class; constant: 1.
    int64_t of(Class c) const;
};

/// Counts from the primitive's own arguments (for Polygon and Points from the length of P or Pw; mesh steps from its attributes'
/// bases). Returns false if the arguments contradict each other, with the reason for messages in *why (may be null). Kinds
/// without vertices of their own (Procedural, Geometry, Volume) count 1 of everything.
bool variableCounts(const Primitive& p, VariableCounts* counts, std::string* why);

} // namespace alpenglow::scene
