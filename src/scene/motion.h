// Arithmetic of what moves: transforms and primitives at a time, and over the shutter.
#pragma once
#include "scene/fwd.h"
#include "scene/primitive.h"

namespace alpenglow::scene {

/// m at a time: linear between keys, element by element; the end keys outside.
Matrix at(const Transform& m, double time);
/// a, then b (row vectors: a * b), with a key wherever either has one.
Transform compose(const Transform& a, const Transform& b);

/// When the shutter is open, in units of motion blocks: Shutter (RISpec 3.2, 4.1.1), Option "shutter" "offset". One that closes
/// before it opens never opens for longer than its first instant.
struct Shutter {
    double open = 0, close = 0; ///< times
    /// It is open for longer than an instant.
    bool opens() const { return close > open; }
    /// The time of a fraction of the open shutter: 0 open, 1 close.
    double at(double part) const { return open + (close - open) * part; }
    /// Of the frame's options.
    explicit Shutter(const Options&);
    Shutter() = default;
};

/// What of a moving transform falls into the shutter, with times of 0 (open) to 1 (close): keys at both ends and those between.
/// One key where nothing moves then.
Transform overShutter(const Transform&, const Shutter&);

/// A moving primitive at a time: its numbers and the numbers of its variables, linear between the keys; the first key's
/// otherwise. A key's own, not a copy, where the time is that of a key; the primitive itself where it does not move.
PrimitiveRef primitiveAt(const PrimitiveRef&, double time);
/// The times of 0 to 1 within the shutter at which a primitive has keys, 0 and 1 among them; only 0 where it does not move then.
std::vector<float> keysOverShutter(const Primitive&, const Shutter&);

} // namespace alpenglow::scene
