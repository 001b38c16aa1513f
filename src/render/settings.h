// The user's options for a render. Defaults mean "as in the scene".
#pragma once
#include "base/readlog.h"
#include "base/stopflag.h"
#include "render/film.h"
#include "render/progress.h"
#include "scene/display.h"
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace alpenglow::render {

class Watcher;

/// What the command line sets, for all frames.
struct RenderSettings {
    std::string output;                       ///< -o: one picture instead of the scene's displays; "" = the displays
    std::vector<scene::Display> displays;     ///< --display TYPE:NAME:MODE, added to the scene's own
    int width = 0, height = 0;                ///< --format; 0 = the scene's
    double resolutionFactor = 1;              ///< factor of both sides of the picture
    std::optional<std::array<float, 4>> crop; ///< x0 x1 y0 y1 in 0..1
    std::string hider;                        ///< --hider
    uint32_t spp = 0;                   ///< samples per pixel; 0: PixelSamples, or 64 under path if the scene does not set them
    double noise = 0;                   ///< stop at this relative error (path); 0 = off
    double seconds = 0;                 ///< stop after this time (path); 0 = off
    std::optional<SampleRange> samples; ///< only these samples of every pixel (path); writes a part file next to the picture
    /// {K, N}, 1 <= K <= N: the K-th of N equal sample ranges; also writes a part file
    std::optional<std::array<uint32_t, 2>> part;
    uint64_t seed = 0;
    bool seedByFrame = false;                                                     ///< --seed frame: the seed is the frame number
    int threads = 0;                                                              ///< 0 = all cores
    int lanes = 16;                                                               ///< of kernels: 4, 8, 16
    int maxDepth = -1;                                                            ///< bounces; -1: the scene's
    float sampleClamp = 0;                                                        ///< 0 = off
    bool direct = true, indirect = true, unbiased = false, localRoulette = false; ///< flags of these names
    std::optional<float> gamma;                                                   ///< --gamma
    bool srgb = false;                                                            ///< --gamma srgb
    std::string savePattern;                            ///< a name with <spp> and <no> in it, used without -o; "" = the displays
    std::string statsFile;                              ///< JSON; "" = none
    std::string checkpoint;                             ///< part file, written after passes; "" = none
    bool resume = false;                                ///< start from the contents of the checkpoint
    bool restart = false;                               ///< replace an existing checkpoint
    double checkpointSeconds = 30;                      ///< shortest time between two writes
    std::optional<std::array<int, 2>> pixel;            ///< --pixel: print radiances of this pixel instead of writing pictures
    std::optional<uint32_t> pixelSample;                ///< only this sample of it
    std::vector<std::string> shaderPaths, texturePaths; ///< after the scene's own search paths
    /// Searched last of all: folders that the environment names. They find what is nowhere else.
    std::vector<std::string> lastShaderPaths, lastTexturePaths;
    std::map<std::string, std::string> environment; ///< the variables that name them, for --stats
    std::string dialect;                            ///< FrontOptions::dialect of the shaders
    std::string scenePath;                          ///< folder of the scene: last but one in the search path; "" = none
    std::string shippedShaders;                     ///< last folder in the search path of shaders
    bool allowExec = false, allowWrite = false, allowRead = false; ///< flags of these names
    std::shared_ptr<ReadLog> reads;             ///< records every shader and map that is read or missing; may be null
    size_t memoryLimit = 0;                     ///< memory limit of the process (base/memory.h), for messages; 0 = none
    ProgressMode progress = ProgressMode::Auto; ///< how it is shown
    bool quiet = false;                         ///< no messages below errors
    std::string software = "Alpenglow";         ///< name, version and commit, for pictures and --stats
    std::string sceneFile, command;             ///< the current scene file and the command line, for pictures and --stats
    bool stamp = false;                         ///< --stamp: pictures name command, host, date and seconds
    const StopFlag* stop = nullptr;             ///< non-zero: end soon and keep what is complete
    Watcher* watcher = nullptr;                 ///< a viewer (watcher.h); null: none
};

} // namespace alpenglow::render
