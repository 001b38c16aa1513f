// Deferred procedurals: primitives of a frame that are replaced by their content once
// a ray comes to their bound.
#pragma once
#include "scene/primitive.h"

namespace alpenglow::scene {

/// Kind of such a primitive, which stays in the frame, before its content, when that is made. ints: its number in this frame,
/// then 1 when its content follows, else 0. numbers: its bound, six numbers in object space, grown by how far its attributes
/// let displacement move points. strings: what it is made from, by name.
inline constexpr const char* kDeferred = "Procedural";

/// Whether it is such a primitive, with its content or without.
inline bool isProcedural(const Primitive& p) { return p.kind == kDeferred && p.ints.size() == 2 && p.numbers.size() == 6; }
/// Whether its content is missing so far.
inline bool isDeferred(const Primitive& p) { return isProcedural(p) && p.ints[1] == 0; }
/// Its number in the frame; requires isProcedural().
inline int deferredNumber(const Primitive& p) { return p.ints[0]; }

/// The way to the procedural that something was made by ("3/1": the second of those in the fourth), or "" for what the scene
/// holds itself. What depends on it does not depend on which others have been made.
inline const std::string& partOf(const Attributes& a) { return a.part; }

} // namespace alpenglow::scene
