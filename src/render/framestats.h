// The figures of a run, frame by frame: what --stats writes. docs/statistics.md lists the keys.
#pragma once
#include "render/settings.h"
#include "render/stats.h"
#include <vector>

namespace alpenglow::render {

/// One frame that was rendered.
struct FrameStats {
    int frame = 0;                ///< number of its FrameBegin; 0: a world without one
    std::string scene, sceneHash; ///< the file; provenance.h
    std::string hider;            ///< "path"
    uint64_t seed = 0;
    struct Picture {
        std::string file, type;
        std::vector<std::string> channels;
    };
    std::vector<Picture> pictures; ///< those that were written
    struct Texture {
        std::string file;
        uint64_t fileBytes = 0, memoryBytes = 0, scratchBytes = 0;
    };
    std::vector<Texture> textures; ///< maps that were read, by name
    RenderStats figures;           ///< of this frame alone
};

/// Adds a frame's figures to those of the frames before: times, rays and counts are sums, memory the most, size, samples and
/// noise the last frame's.
void accumulate(RenderStats& all, const RenderStats& frame);

/// What --stats writes: the figures of all frames together, what made them, and under "frames" each frame with its own.
std::string statsJson(const RenderStats& all, const std::vector<FrameStats>&, const RenderSettings&);

} // namespace alpenglow::render
