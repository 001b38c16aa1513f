// What a user may ask of a render beside what the scene says. Defaults mean "as the scene says".
#pragma once
#include "base/readlog.h"
#include "base/stopflag.h"
#include "render/film.h"
#include "render/progress.h"
#include "scene/display.h"
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace alpenglow::render {

class Watcher;

struct RenderSettings {
    std::string output;                   ///< -o: one picture instead of the scene's displays; "" = the displays
    std::vector<scene::Display> displays; ///< --display TYPE:NAME:MODE, added to the scene's own
    int width = 0, height = 0;            ///< --format; 0 = the scene's
    double resolutionFactor = 1;
    std::optional<std::array<float, 4>> crop; ///< x0 x1 y0 y1 in 0..1
    std::string hider;                        ///< --hider
    uint32_t spp = 0;                         ///< samples per pixel; 0 = PixelSamples, or 64 under path when the scene is silent
    double noise = 0;                         ///< stop at this relative error (path); 0 = off
    double seconds = 0;                       ///< stop after this time (path); 0 = off
    std::optional<SampleRange> samples;       ///< only these samples of every pixel (path); writes a part file beside the picture
    std::optional<std::array<uint32_t, 2>> part; ///< {K, N}, 1 <= K <= N: the K-th of N equal parts of the samples, likewise
    uint64_t seed = 0;
    bool seedByFrame = false; ///< --seed frame: each frame has its number as its seed
    int threads = 0;          ///< 0 = all cores
    int lanes = 16;
    int maxDepth = -1;
    float sampleClamp = 0; ///< 0 = off
    bool direct = true, indirect = true, unbiased = false, localRoulette = false;
    std::optional<float> gamma;              ///< --gamma
    bool srgb = false;                       ///< --gamma srgb
    std::string savePattern;                 ///< a name with <spp> and <no> in it, for when -o names none; "" = the displays
    std::string statsFile;                   ///< JSON; "" = none
    std::string checkpoint;                  ///< part file, written after passes; "" = none
    bool resume = false;                     ///< begin with what the checkpoint holds
    bool restart = false;                    ///< replace a checkpoint that is there
    double checkpointSeconds = 30;           ///< least time between two writes
    std::optional<std::array<int, 2>> pixel; ///< --pixel: print radiances of this pixel instead of writing pictures
    std::optional<uint32_t> pixelSample;     ///< only this sample of it
    std::vector<std::string> shaderPaths, texturePaths; ///< after the scene's own search paths
    std::string dialect;                                ///< FrontOptions::dialect of the shaders
    std::string scenePath;                              ///< where the scene lies: the last place but one to look in; "" = nowhere
    std::string shippedShaders;                         ///< the last place to look for shaders in
    bool allowExec = false, allowWrite = false, allowRead = false;
    std::shared_ptr<ReadLog> reads; ///< gets every shader and map that is read or missed; may be null
    size_t memoryLimit = 0;         ///< what the process is bound to (base/memory.h), for messages; 0 = nothing
    ProgressMode progress = ProgressMode::Auto;
    bool quiet = false;
    std::string software = "Alpenglow"; ///< name, version and commit, for pictures and --stats
    std::string sceneFile, command;     ///< the scene being read and the command line, for the same
    bool stamp = false;                 ///< --stamp: pictures name command, host, date and seconds
    const StopFlag* stop = nullptr;     ///< non-zero: end soon and keep what is whole
    Watcher* watcher = nullptr;         ///< who looks on (watcher.h); null: nobody
};

} // namespace alpenglow::render
