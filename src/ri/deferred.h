// State of deferred procedurals: what is needed to expand them once a ray reaches their bound.
#pragma once
#include "ri/interpreter.h"

namespace alpenglow::ri {

/// A procedural as it was called.
struct Interpreter::Waiting {
    std::string kind;                     ///< "DelayedReadArchive", "RunProgram", "DynamicLoad"
    std::vector<std::string> arguments;   ///< of that procedural
    std::vector<float> bound;             ///< as it was given
    Call call;                            ///< the call, for messages
    GraphicsState state;                  ///< at the call
    OpenArchives archives;                ///< that were open
    bool replaying = false;               ///< its archive was being read again
    std::string part;                     ///< of what is in it: scene::partOf()
    std::shared_ptr<const Lasting> names; ///< declarations, handles and their like, at the end of what it stands in
};

} // namespace alpenglow::ri
