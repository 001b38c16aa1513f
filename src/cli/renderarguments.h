// The arguments of render.
#pragma once
#include "render/settings.h"
#include <string>
#include <utility>
#include <vector>

namespace CLI {
class App;
}

namespace alpenglow::cli {

/// Options as they are given, and the settings that checkRenderArguments() makes of them.
struct RenderArguments {
    render::RenderSettings settings;
    /// Texts of the options of these names.
    std::vector<std::string> scenes, searchPaths, displays, rib, filters;
    std::vector<std::string> lastArchivePaths, lastProceduralPaths; ///< of the environment, after all others
    /// Texts of the options of these names.
    std::string format, crop, samples, part, frames, pixel, preset, memory, folder, seed, progress = "auto";
    std::string gamma, preview;
    std::vector<std::pair<std::string, int>> tev; ///< hosts and ports
    /// Flags of these names.
    bool noDirect = false, noIndirect = false, watch = false, quiet = false, verbose = false, noRc = false;
    std::vector<int> frameList; ///< of --frames, ascending
    double modelTime = 0;       ///< seconds of the animation of a model
    int framesAtOnce = 1;       ///< 1 to limits::kFramesAtOnce
};

/// Describes the options to the parser, which writes them to the arguments; these outlive it.
void addRenderOptions(CLI::App&, RenderArguments&);
/// To be called when the command line was read: checks what the parser cannot. Throws CLI::ValidationError.
void checkRenderArguments(RenderArguments&, const CLI::App&);
/// The same for a program without a command line that draws (libalpenglow): options as a shell would split this text, no scenes.
/// What is wrong with them, or "".
std::string readRenderOptions(const std::string& text, RenderArguments&);

} // namespace alpenglow::cli
