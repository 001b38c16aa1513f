// State of deferred procedurals: what is needed to expand them once a ray reaches their bound.
#pragma once
#include "ri/interpreter.h"

namespace alpenglow::ri {

/// A procedural as it was called.
struct Interpreter::Waiting {
    std::string kind;
    std::vector<std::string> arguments;
    std::vector<float> bound; ///< as it was given
    Call call;
    GraphicsState state;
    OpenArchives archives; ///< that were open
    bool replaying = false;
    std::string part;                     ///< of what is in it: scene::partOf()
    std::shared_ptr<const Lasting> names; ///< declarations, handles and their like, at the end of what it stands in
};

} // namespace alpenglow::ri
