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
    /// A Make request that is passed over: the files that it would read, and last the one that it would write.
    virtual void passOverTexture(const std::vector<std::string>& /*files*/) {}
    /// Frames may be drawn while what is behind them is read. When this returns, those are that may write a file of this name,
    /// which is read next.
    virtual void beforeRead(const std::string& /*name*/) {}
};

} // namespace alpenglow::scene
