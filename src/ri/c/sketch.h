// The part of the graphics state that calls of C depend on: numbers of values, and open blocks. A target that executes its
// calls asks its interpreter; one that keeps them (a file, an inline archive) follows them here.
#pragma once
#include "ri/call.h"
#include "ri/declare.h"
#include "scene/fwd.h"
#include "scene/scene.h"
#include <optional>
#include <string>
#include <vector>

namespace alpenglow::ri {

/// Follows the state over the calls that note() gets.
class Sketch {
public:
    Sketch(); ///< the state at the begin of a stream
    /// The state in the middle of a stream.
    Sketch(Declarations, int colorSamples, scene::AttributesRef);

    Declarations declarations; ///< those in effect
    int colorSamples = 3;      ///< numbers of a colour
    /// Only bases and their steps are kept up to date.
    scene::AttributesRef attributes;

    /// Follows a call. Returns what is wrong with it at this position, for messages, or "": an End without its Begin, or of a
    /// block in which others are open.
    std::string note(const Call&);
    /// The Begin of the innermost open block; "" when there is none.
    std::string open() const { return blocks_.empty() ? std::string() : std::string(blocks_.back().begin); }

private:
    struct Block {
        std::string_view begin;
        scene::AttributesRef attributes;
        int colorSamples;
    };
    std::string end(std::string_view begin);
    void basis(const Call&);
    std::vector<Block> blocks_;
};

} // namespace alpenglow::ri
