// What calls of C need to know of the graphics state: how long values are, and which blocks are open. A target that executes its
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

class Sketch {
public:
    Sketch();
    Sketch(Declarations, int colorSamples, scene::AttributesRef);

    Declarations declarations;
    int colorSamples = 3;
    /// Bases and their steps are right, nothing else is.
    scene::AttributesRef attributes;

    /// Takes in a call. What is wrong with it where it stands, or "": an End without its Begin, or of a block in which others are
    /// open.
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
