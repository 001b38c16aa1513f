#include "render/renderer.h"
#include "base/limits.h"
#include "base/memory.h"
#include "base/processors.h"
#include "base/realpath.h"
#include "base/zipname.h"
#include "display/driver.h"
#include "render/curve.h"
#include "render/digest.h"
#include "render/emptyresults.h"
#include "render/filmpicture.h"
#include "render/frameprocesses.h"
#include "render/imagertext.h"
#include "render/imaging.h"
#include "render/levels.h"
#include "render/partfile.h"
#include "render/photonpass.h"
#include "render/provenance.h"
#include "render/rendering.h"
#include "scene/scene.h"
#include <cmath>
#include <filesystem>
#include <new>
#include <tbb/global_control.h>
#include <utility>

namespace alpenglow::render {
namespace {

std::string text(double v) {
    char t[40];
    std::snprintf(t, sizeof t, "%.9g", v);
    return t;
}

std::string folderOf(const std::string& path) {
    size_t slash = path.find_last_of('/');
    return slash == std::string::npos ? "." : slash == 0 ? "/" : path.substr(0, slash);
}

} // namespace

Renderer::Renderer(RenderSettings s, Engine e, Diagnostics& d, Progress& p, Print print)
    : settings_(std::move(s)), engine_(std::move(e)), diagnostics_(d), progress_(p), print_(std::move(print)),
      parseMark_(clockSeconds()) {
    if (settings_.threads <= 0) settings_.threads = defaultThreads();
    if (!settings_.statsFile.empty()) names_.take("statistics", settings_.statsFile, false, {}, {}, nullptr);
}

Renderer::~Renderer() = default;

void Renderer::setScene(const std::string& path, const std::set<std::string>& read) {
    read_.clear();
    for (const std::string& name : read) read_.insert(fileIdentity(name));
    const auto inside = zipName(path);
    settings_.scenePath = path == "-" ? "." : folderOf(inside ? inside->zip : path);
    settings_.sceneFile = path;
    parseMark_ = clockSeconds();
}

void Renderer::markRead(scene::Options& o) const {
    for (scene::Display& d : o.displays) {
        const std::string name = d.name.starts_with('+') ? d.name.substr(1) : d.name;
        d.read = read_.contains(fileIdentity(withFrame(name, o.frameNumber)));
    }
}

void Renderer::override(scene::Options& o) const {
    if (!read_.empty()) markRead(o);
    if (isMapPass(o)) {
        if (o.hider == "path") o.hider = "hidden"; // depth needs no light
        return;
    }
    const RenderSettings& s = settings_;
    if (s.width > 0 && s.height > 0) {
        o.xres = s.width;
        o.yres = s.height;
        o.formatSet = true;
        o.frameAspect.reset();
    }
    if (s.resolutionFactor != 1 && s.resolutionFactor > 0) {
        o.xres = std::max(1, int(o.xres * s.resolutionFactor));
        o.yres = std::max(1, int(o.yres * s.resolutionFactor));
    }
    if (s.crop) std::copy(s.crop->begin(), s.crop->end(), o.crop);
    if (!s.hider.empty()) o.hider = s.hider;
    if (s.localRoulette) o.filter = {"box", 1, 1}; // the preset: SLProject has no other filter
}

std::vector<std::string> Renderer::searchPaths(const scene::Options& o, const char* kind, const std::vector<std::string>& own,
                                               bool shaders) const {
    std::vector<std::string> after = own;
    if (!settings_.scenePath.empty()) after.push_back(settings_.scenePath);
    after.push_back(".");
    if (shaders && !settings_.shippedShaders.empty()) after.push_back(settings_.shippedShaders);
    std::vector<std::string> all;
    if (auto i = o.values.find(std::string("searchpath:") + kind); i != o.values.end() && !i->second.strings.empty())
        for (const std::string& p : splitSearchPath(i->second.strings[0], after)) {
            all.push_back(p);
            // Old scenes name folders relative to their own, independent of the current folder.
            if (!p.empty() && p[0] != '/' && !settings_.scenePath.empty() && settings_.scenePath != ".")
                all.push_back(settings_.scenePath + "/" + p);
        }
    all.insert(all.end(), after.begin(), after.end());
    const std::vector<std::string>& last = shaders ? settings_.lastShaderPaths : settings_.lastTexturePaths;
    all.insert(all.end(), last.begin(), last.end());
    return all;
}

void Renderer::render(std::shared_ptr<const scene::Frame> frame) {
    double now = clockSeconds();
    stats_.parseSec += now - parseMark_;
    stats_.errors = -diagnostics_.errors();
    stats_.warnings = -diagnostics_.warnings();
    FrameStats stats;
    if (processes_) processes_->openFrame();
    const int before = outcome_.rendered;
    const bool map = isMapPass(frame->options);
    ++(map ? maps_ : pictures_);
    RenderSettings all;
    if (map) all = std::exchange(settings_, settingsOfMaps(settings_));
    try {
        renderFrame(std::move(frame), stats);
    } catch (const LimitReached&) {
        outcome_.outOfMemory = true;
        ++outcome_.refused;
        diagnostics_.report(Severity::Severe, Rie::Limit, {}, "a limit was reached; this frame is given up");
    } catch (const std::bad_alloc&) {
        outcome_.outOfMemory = true;
        ++outcome_.refused;
        diagnostics_.report(Severity::Severe, Rie::NoMem, {}, "out of memory; this frame is given up",
                            settings_.memoryLimit ? "the limit is " + memorySizeText(settings_.memoryLimit) + ofEachFrame() +
                                                        "; --memory-limit sets another"
                                                  : "");
    } catch (const std::exception& e) { // of libraries that could not get resources: mostly threads
        outcome_.outOfMemory = true;
        ++outcome_.refused;
        diagnostics_.report(Severity::Severe, Rie::System, {}, std::string("this frame is given up: ") + e.what());
    }
    if (!processes_ || inProcess()) {
        if (outcome_.rendered > (processes_ ? 0 : before)) closeFrame(std::move(stats));
    }
    if (processes_) endFrame();
    if (map) settings_ = std::move(all);
    parseMark_ = clockSeconds();
}

void Renderer::closeFrame(FrameStats stats) {
    stats_.errors += diagnostics_.errors();
    stats_.warnings += diagnostics_.warnings();
    stats_.threads = settings_.threads;
    stats_.peakMemoryBytes = peakMemoryBytes();
    stats_.finalise();
    stats.figures = stats_;
    stats.scene = settings_.sceneFile;
    frames_.push_back(std::move(stats));
    accumulate(all_, stats_);
    stats_ = {};
}

void Renderer::reportDropped(uint64_t count, int x, int y, int64_t sample) {
    const std::string at = std::to_string(x) + "," + std::to_string(y) + "," + std::to_string(sample);
    diagnostics_.report(
        Severity::Warning, Rie::Math, {},
        std::to_string(count) +
            (count == 1 ? " sample was not finite and is dropped" : " samples were not finite and are dropped") +
            (sample < 0 ? "" : "; reproduce the first with --pixel " + at + " --seed " + std::to_string(settings_.seed)));
}

void Renderer::printPixel(Job& job, const scene::Options& o, SampleRange wanted, bool path) {
    auto [x, y] = *settings_.pixel;
    const Window& w = job.camera.window();
    if (!w.contains(x, y)) {
        diagnostics_.report(Severity::Error, Rie::Range, {},
                            "--pixel " + std::to_string(x) + "," + std::to_string(y) + " lies outside " + std::to_string(w.x0) +
                                ".." + std::to_string(w.x1 - 1) + ", " + std::to_string(w.y0) + ".." + std::to_string(w.y1 - 1));
        return;
    }
    uint32_t begin = wanted.begin, end = begin + std::min(wanted.end - wanted.begin, 1u << 20);
    if (settings_.pixelSample) {
        begin = *settings_.pixelSample;
        end = begin + 1;
    }
    FilterSampler filter(job.plan.basis.filter);
    int nx, ny;
    gridOf(o, settings_, &nx, &ny);
    ImageRays image(job.camera, settings_.seed, nx, ny, jitterOf(o, diagnostics_));
    if (!path && end > uint32_t(nx * ny)) {
        diagnostics_.report(Severity::Error, Rie::Range, {}, "--pixel: a pixel has " + std::to_string(nx * ny) + " samples");
        return;
    }
    double sum[2][5] = {}; // of samples with weight above and below 0: colour, alpha, weights
    std::array<uint32_t, kReplicas> counts{};
    CausticPasses caustics(job);
    for (uint32_t s = begin; s < end && !job.pollStop(); ++s) {
        if (path && !caustics.ready(s, 1)) break;
        float weight = 1;
        integrator::CameraRay ray;
        if (path) ray = pathRay(job.camera, filter, settings_.seed, x, y, s, &weight);
        else {
            image.clear();
            image.ask(x, y, int(s));
            image.make();
            ray = image.rays()[0];
        }
        integrator::SampleResult r;
        bool whole = job.trace(0, {&ray, 1}, {&r, 1});
        while (whole && job.unfinished(0)) whole = job.makeMet() && job.trace(0, {&ray, 1}, {&r, 1});
        if (!whole) break;
        Color c = clampSample(r.color, settings_.sampleClamp);
        ++counts[s % kReplicas];
        const float alpha = (r.opacity.x + r.opacity.y + r.opacity.z) / 3;
        const double values[5] = {c.x, c.y, c.z, alpha, 1};
        for (size_t k = 0; k < 5; ++k) sum[weight < 0][k] += values[k] * std::fabs(double(weight));
    }
    noteInterrupted(job);
    const auto scales = signScales(filter.negativePart().value_or(0), counts, sum[0][4], sum[1][4]);
    const auto mean = [&](size_t k) { return text(scales[0] * sum[0][k] + scales[1] * sum[1][k]); };
    if (print_ && !job.interrupted) print_(mean(0) + " " + mean(1) + " " + mean(2) + " " + mean(3));
    stats_.renderSec += job.elapsed();
    stats_.spp = end - begin;
}

RenderStats Renderer::stats() const {
    RenderStats s = all_, rest = stats_; // rest: an abandoned frame, maps made after the last one
    if (frames_.empty()) s = rest;
    else s.parseSec += rest.parseSec;
    s.threads = settings_.threads;
    s.peakMemoryBytes = std::max(s.peakMemoryBytes, peakMemoryBytes());
    s.finalise();
    const Diagnostics& messages = processes_ ? processes_->messages() : diagnostics_;
    s.errors = messages.errors();
    s.warnings = messages.warnings();
    return s;
}

std::string Renderer::statsText() const { return statsJson(stats(), frames_, settings_); }

bool Renderer::writeStats() {
    if (settings_.statsFile.empty()) return true;
    auto out = OutputFile::open(settings_.statsFile, {".", true}, diagnostics_);
    if (!out) return !(outcome_.outputFailed = true);
    const std::string json = statsText();
    out->write(json.data(), json.size());
    if (out->commit(diagnostics_)) return true;
    outcome_.outputFailed = true;
    return false;
}

} // namespace alpenglow::render
