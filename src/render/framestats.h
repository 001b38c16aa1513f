// Figures of a run, frame by frame, for --stats. docs/statistics.md lists the keys.
#pragma once
#include "render/settings.h"
#include "render/stats.h"
#include <vector>

namespace alpenglow::render {

/// A rendered frame.
struct FrameStats {
    int frame = 0;                ///< number of its FrameBegin; 0: a world outside of frames
    std::string scene, sceneHash; ///< the file; provenance.h
    std::string hider;            ///< "path"
    uint64_t seed = 0;            ///< of all random numbers
    /// A picture that was written.
    struct Picture {
        std::string file, type;            ///< file name; display type
        std::vector<std::string> channels; ///< in the order of the file
    };
    std::vector<Picture> pictures; ///< those written
    /// A map that was read.
    struct Texture {
        std::string file;                                          ///< of the file
        uint64_t fileBytes = 0, memoryBytes = 0, scratchBytes = 0; ///< on disk; in memory; in a scratch file
    };
    std::vector<Texture> textures; ///< maps read, by name
    RenderStats figures;           ///< of this frame only
};

/// Adds a frame's figures to those of earlier frames: times, rays and counts are summed; memory is the maximum; size, samples and
/// noise are those of the last frame.
void accumulate(RenderStats& all, const RenderStats& frame);

/// The contents of --stats: figures of all frames together, provenance, and under "frames" each frame with its own.
std::string statsJson(const RenderStats& all, const std::vector<FrameStats>&, const RenderSettings&);

} // namespace alpenglow::render
