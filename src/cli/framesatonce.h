// The processes of render --frames-at-once.
#pragma once
#include "base/memory.h"
#include "render/frameprocesses.h"
#include "render/settings.h"
#include "ri/reader.h"
#include <memory>
#include <optional>

namespace alpenglow::cli {

/// The processes of a run, or none if frames are drawn one by one.
class FramesAtOnce {
public:
    /// most: frames that are drawn at the same time; 1: one by one. `messages` prints messages and must outlive this object.
    FramesAtOnce(int most, const render::RenderSettings&, Diagnostics& messages);
    FramesAtOnce(const FramesAtOnce&) = delete;
    FramesAtOnce& operator=(const FramesAtOnce&) = delete;
    /// Null: frames are drawn one by one.
    render::FrameProcesses* processes() { return processes_ ? &*processes_ : nullptr; }
    /// Messages reported here are printed in the order of the frames.
    Diagnostics& reported() { return processes_ ? reported_ : messages_; }
    /// Sets the reader, which must outlive all frames.
    void setReader(ri::RibReader& r) { reader_ = &r; }

private:
    void begin(bool alone);
    Diagnostics& messages_;
    Diagnostics reported_;
    std::optional<render::FrameProcesses> processes_;
    std::optional<MemoryLimit> share_; ///< in a process: of the run's memory
    size_t memory_;                    ///< of the run, bytes; 0: unlimited
    int threads_;                      ///< of the run
    ri::RibReader* reader_ = nullptr;
};

} // namespace alpenglow::cli
