// Results of the frames of a run.
#pragma once
#include "render/framestats.h"
#include <cstdint>
#include <optional>

namespace alpenglow::render {

/// Counts over frames.
struct Outcome {
    int rendered = 0;          ///< frames with some rendered output
    int refused = 0;           ///< frames without any
    int textures = 0;          ///< Make requests carried out
    bool outputFailed = false; ///< a file could not be written
    bool outOfMemory = false;  ///< memory did not suffice
    bool interrupted = false;  ///< the user stopped it
    /// Adds those of another run of frames.
    void add(const Outcome& o) {
        rendered += o.rendered;
        refused += o.refused;
        textures += o.textures;
        outputFailed |= o.outputFailed;
        outOfMemory |= o.outOfMemory;
        interrupted |= o.interrupted;
    }
};

/// Result of a process for a frame, or for a Make request.
struct FrameResult {
    Outcome outcome;                 ///< counts of that frame alone
    std::optional<FrameStats> stats; ///< for a rendered frame
    double parseSec = 0;             ///< for other frames
    uint64_t grown = 0;              ///< memory in bytes that its process allocated for it; 0 if allocated at once
};

} // namespace alpenglow::render
