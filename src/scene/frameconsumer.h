// Who takes the frames of a RIB stream.
#pragma once
#include "scene/fwd.h"
#include "scene/param.h"
#include <memory>
#include <string>
#include <vector>

namespace alpenglow::scene {

/// What a RIB stream does; ri/ calls it, render/ implements it.
class FrameConsumer {
public:
    virtual ~FrameConsumer() = default;
    /// WorldEnd. The frame is complete; the call returns when it is rendered (or refused).
    virtual void render(std::shared_ptr<const Frame>) = 0;
    /// MakeTexture and its kin, in stream order. kind = request name.
    virtual void makeTexture(const std::string& kind, const std::vector<std::string>& files, const ParamList& args,
                             const SourcePlace&) = 0;
    /// A world, or a Make request, of a frame that is not wanted: nothing is made.
    virtual void passOver(const Options&) {}
    virtual void passOverTexture(const std::vector<std::string>& /*files*/) {}
};

} // namespace alpenglow::scene
