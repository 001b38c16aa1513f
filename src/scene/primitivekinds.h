// The kinds of primitives: how counts of variables and a box follow from the arguments of a request, and what other folders ask
// of a kind. primitivekinds.cpp has one entry for each.
#pragma once
#include "scene/counts.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string_view>

namespace alpenglow::scene {

/// A box in object space that grows: xmin xmax ymin ymax zmin zmax, as in RiBound.
struct ObjectBox {
    std::array<float, 6> b{INFINITY, -INFINITY, INFINITY, -INFINITY, INFINITY, -INFINITY}; ///< empty at first
    bool any = false;                                                                      ///< whether a point has been added
    /// Adds a point; ignores one that is not finite.
    void add(float x, float y, float z) {
        const float p[3] = {x, y, z};
        if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(z)) return;
        any = true;
        for (size_t k = 0; k < 3; ++k) {
            b[2 * k] = std::min(b[2 * k], p[k]);
            b[2 * k + 1] = std::max(b[2 * k + 1], p[k]);
        }
    }
    /// Adds a solid of revolution about z.
    void turn(float radius, float from, float to) {
        add(-std::fabs(radius), -std::fabs(radius), from);
        add(std::fabs(radius), std::fabs(radius), to);
    }
};

/// Properties of a kind that code asks for instead of its name.
enum PrimitiveTrait : unsigned {
    kQuadric = 1,      ///< its numbers define a surface swept about z
    kMesh = 2,         ///< faces index its points
    kHasPoints = 4,    ///< has exactly one of "P", "Pw", "Pz"
    kPatch = 8,        ///< may have "Pz"
    kTakesBasis = 16,  ///< Basis shapes it
    kPieces = 32,      ///< consists of pieces that rays hit one by one
    kTurnsToEye = 64,  ///< its pieces face the viewer unless rays decide
    kMayBeEmpty = 128, ///< exporters write it without faces or points for what is hidden
    kSurface = 256     ///< depends on nothing outside of its request but attributes, and is no volume
};

/// What there is to know about the request of a primitive without its geometry.
struct PrimitiveKind {
    std::string_view name; ///< of the request
    unsigned traits;       ///< PrimitiveTrait
    /// Counts of variables; see variableCounts().
    bool (*counts)(const Primitive&, VariableCounts*, std::string* why);
    /// Adds the box that the numbers of a request define; null: the kind has points. Missing numbers count as 0.
    void (*box)(std::span<const float> numbers, ObjectBox&) = nullptr;
    std::span<const std::string_view> arguments = {}; ///< parameters that hold arguments of the request, not variables
};

/// Null for what is not listed: requests that make primitives when they are expanded (Procedural).
const PrimitiveKind* primitiveKind(std::string_view name);
/// Whether the kind of this name has the trait.
inline bool has(std::string_view kind, PrimitiveTrait t) {
    const PrimitiveKind* k = primitiveKind(kind);
    return k && (k->traits & t);
}

} // namespace alpenglow::scene
