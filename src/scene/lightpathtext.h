// A parsed light path expression: the positions of events, and which positions may follow each.
#pragma once
#include "scene/lightpaths.h"
#include <bitset>

namespace alpenglow::scene {

/// A set of events: all whose letters are among these. Bits are those of PathEvent and PathScattering.
struct PathEvents {
    uint8_t events = 0xff, scatterings = 0xff; ///< sets of bits
    std::vector<std::string> labels;           ///< one of them; empty: any event
    bool notLabels = false;                    ///< none of them
    /// Whether an event with these labels is in the set.
    bool has(PathEvent, PathScattering, std::span<const std::string> carried) const;
};

/// A position in the expression.
struct PathPosition {
    std::vector<PathEvents> any; ///< it is in one of these
    bool negated = false;        ///< or in none
    /// Whether an event with these labels may be at the position.
    bool has(PathEvent, PathScattering, std::span<const std::string> carried) const;
};

using PathPositions = std::bitset<LightPaths::kMostPositions>; ///< a set of positions

/// A parsed expression.
struct LightPathText {
    std::vector<PathPosition> positions; ///< from left to right
    PathPositions first, last;           ///< where a path may begin and end
    std::vector<PathPositions> follow;   ///< by position
    bool empty = false;                  ///< the path without events is one
    bool straight = false;               ///< it names s; else straight passages are as if they were not there
};

/// Reads an expression. `room`: positions that it may have. Returns nothing after an error, which is reported.
std::optional<LightPathText> readLightPath(const std::string& text, size_t room, const SourcePlace&, Diagnostics&);

} // namespace alpenglow::scene
