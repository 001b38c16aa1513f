// What came of the frames of a run.
#pragma once
#include "render/framestats.h"
#include <cstdint>
#include <optional>

namespace alpenglow::render {

struct Outcome {
    int rendered = 0;          ///< frames of which something could be rendered
    int refused = 0;           ///< frames of which nothing could be
    int textures = 0;          ///< Make requests that were obeyed
    bool outputFailed = false; ///< a file could not be written
    bool outOfMemory = false;
    bool interrupted = false;
    void add(const Outcome& o) {
        rendered += o.rendered;
        refused += o.refused;
        textures += o.textures;
        outputFailed |= o.outputFailed;
        outOfMemory |= o.outOfMemory;
        interrupted |= o.interrupted;
    }
};

/// What a process has made of a frame, or of a Make request.
struct FrameResult {
    Outcome outcome;
    std::optional<FrameStats> told; ///< of a frame of which something was rendered
    double parseSec = 0;            ///< of another
    uint64_t grown = 0;             ///< bytes that its process took for it; 0 where it took them at once
};

} // namespace alpenglow::render
