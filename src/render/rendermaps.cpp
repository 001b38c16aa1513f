// Make requests of a scene: maps from pictures that were rendered before, or that exist.
#include "base/realpath.h"
#include "render/frameprocesses.h"
#include "render/renderer.h"
#include "render/rendering.h"
#include "texture/maketexture.h"
#include <algorithm>
#include <new>
#include <utility>

namespace alpenglow::render {

void Renderer::makeTexture(const std::string& kind, const std::vector<std::string>& files, const scene::ParamList& args,
                           const SourcePlace& place) {
    double now = clockSeconds();
    stats_.parseSec += now - parseMark_;
    passOverTexture(files);
    const int before = outcome_.textures;
    if (processes_) makeInProcess(kind, files, args, place);
    else runMakeRequest(kind, files, args, place);
    if (outcome_.textures > before) {
        const size_t map = kind == "MakeBrickMap" ? files.size() - 1 : kind == "MakeCubeFaceEnvironment" ? 6 : 1;
        written_.push_back(followedPath(files[map]));
    }
    parseMark_ = clockSeconds();
}

/// The reading process has no threads, and maps use several. Earlier frames may write or read the files that a map is made of, or
/// replaces.
void Renderer::makeInProcess(const std::string& kind, const std::vector<std::string>& files, const scene::ParamList& args,
                             const SourcePlace& place) {
    processes_->waitForFrames();
    processes_->openFrame();
    const RenderStats stats = stats_;
    try {
        handedOver_ = !processes_->start(kind, {{}, false, true}, true);
        if (!handedOver_) {
            beginProcess(true);
            stats_ = {};
            runMakeRequest(kind, files, args, place);
        }
    } catch (const std::exception& e) {
        outcome_.outOfMemory = true;
        diagnostics_.report(Severity::Severe, Rie::System, place, kind + " is given up: " + e.what());
    }
    endFrame();
    stats_ = stats;
    processes_->waitForFrames();
}

void Renderer::runMakeRequest(const std::string& kind, const std::vector<std::string>& files, const scene::ParamList& args,
                              const SourcePlace& place) {
    texture::MakeOptions m;
    m.policy.allowWrite = settings_.allowWrite;
    m.read = readPolicy();
    m.place = place;
    m.searchPath = {""};
    if (!settings_.scenePath.empty()) m.searchPath.push_back(settings_.scenePath);
    m.searchPath.insert(m.searchPath.end(), settings_.texturePaths.begin(), settings_.texturePaths.end());
    std::vector<float> numbers;
    for (const scene::Param& p : args)
        if (p.strings.empty()) numbers.insert(numbers.end(), p.numbers.begin(), p.numbers.end());
    int before = diagnostics_.errors();
    const size_t reported = diagnostics_.all().size();
    const auto unwritten = [](const Diagnostic& d) { return d.code == Rie::DiskFull || d.code == Rie::System; };
    const bool made = texture::runMakeRequest(kind, files, numbers, m, diagnostics_);
    outcome_.textures += made;
    const auto all = diagnostics_.all();
    outcome_.outputFailed |= !made && std::any_of(all.begin() + long(reported), all.end(), unwritten);
    if (!made && diagnostics_.errors() == before) diagnostics_.report(Severity::Error, Rie::BadFile, place, kind + " failed");
}

} // namespace alpenglow::render
