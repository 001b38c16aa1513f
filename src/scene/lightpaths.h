// Light path expressions: which light an output of a frame shows, by the events on its path from the camera to the light.
// All expressions of a frame are one automaton: a path carries a number, and every event takes it to the next. docs/lightpaths.md
// Sources: Heckbert's regular expressions for paths (SIGGRAPH 1990), in the notation of OSL and PRMan.
#pragma once
#include "base/diagnostics.h"
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace alpenglow::scene {

/// What can happen to a path: C R T V L B O.
enum class PathEvent : uint8_t {
    Camera,
    Reflection,
    Transmission,
    Volume, ///< what a volume shader adds
    Light,  ///< a light with a place or a direction
    Sky,    ///< a light without a place; "L" is this, too
    Object  ///< what a surface gives by itself
};
/// How a surface scattered: D G S s; None: no scattering.
enum class PathScattering : uint8_t { None, Diffuse, Glossy, Singular, Straight };

/// The text of an expression where `source` is one ("lpe:C<RD>L", "color lpe:..."), without what stands before it; else nothing.
std::optional<std::string> lightPathIn(const std::string& source);
/// The expression of a word: "direct", "indirect"; "other" is a word without an expression. Else nothing.
std::optional<std::string> lightPathOfWord(std::string_view word);

/// The automaton of the light path expressions of a frame (docs/light.md): states of paths, and the part of the outputs in which
/// light that ends in a state counts. Immutable.
class LightPaths {
public:
    /// The most of what all expressions of a frame may need together. More is an error.
    static constexpr size_t kMostPositions = 1024;        ///< letters and brackets, repetitions written out
    static constexpr size_t kMostTable = size_t(1) << 18; ///< states times kinds of events
    static constexpr size_t kMostStates = 4096;           ///< of the automaton
    static constexpr size_t kMostLabels = 32;             ///< named in expressions
    static constexpr size_t kMostOutputs = 64;            ///< expressions
    static constexpr size_t kMostParts = 64;              ///< different sums of outputs
    static constexpr size_t kMostLength = 4096;           ///< characters of an expression
    static constexpr int kMostDepth = 64;                 ///< parentheses in parentheses

    using State = uint16_t;           ///< index of a state
    static constexpr State kNone = 0; ///< of unclassified light: next() keeps it
    static constexpr State kDead = 1; ///< no expression can match any more

    /// "other": all that no expression of the frame matches.
    struct Source {
        std::string expression;
        SourcePlace place; ///< of the request, for messages
    };
    /// Expressions that are wrong, or too large together, are reported, and their outputs have no parts.
    LightPaths(std::span<const Source>, Diagnostics&);

    /// The number of a label that some expression names; -1: none does.
    int label(std::string_view) const;
    /// Whether some expression names a label.
    bool hasLabels() const { return !labels_.empty(); }
    /// The number of an event with up to two labels, by label(). Pairs of event and scattering that are none are Object.
    int symbol(PathEvent, PathScattering = PathScattering::None, int labelA = -1, int labelB = -1) const;
    /// Behind the camera.
    State begin() const { return begin_; }
    /// The state behind an event, which symbol() numbers.
    State next(State s, int symbol) const { return s == kNone ? kNone : table_[size_t(s) * classes_ + classOf_[size_t(symbol)]]; }
    /// Whether some expression names s: then a shadow ray has to know how many surfaces it went straight through.
    bool countsStraight() const { return countsStraight_; }

    /// Light is in one part each, by where its path ends: outputs are sums of parts.
    int parts() const { return parts_; }
    /// The part of light whose path ends in this state, below parts().
    int part(State s) const { return partOf_[s]; }
    /// The parts of an output, ascending.
    const std::vector<int>& partsOf(size_t output) const { return partsOf_[output]; }

private:
    bool build(std::span<const struct LightPathText>, std::string& why);
    bool makeParts(std::span<const uint64_t> accepts, std::string& why);

    std::vector<std::string> labels_;
    size_t classes_ = 1;
    std::vector<uint16_t> classOf_; ///< by symbol
    std::vector<State> table_;      ///< by state and class
    std::vector<uint8_t> partOf_;   ///< by state
    std::vector<std::vector<int>> partsOf_;
    State begin_ = kNone;
    int parts_ = 1;
    bool countsStraight_ = false;
};

} // namespace alpenglow::scene
