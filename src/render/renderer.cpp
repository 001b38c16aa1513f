#include "render/renderer.h"
#include "base/limits.h"
#include "base/memory.h"
#include "base/processors.h"
#include "display/driver.h"
#include "render/curve.h"
#include "render/digest.h"
#include "render/filmpicture.h"
#include "render/imagertext.h"
#include "render/imaging.h"
#include "render/lacks.h"
#include "render/levels.h"
#include "render/partfile.h"
#include "render/provenance.h"
#include "render/rendering.h"
#include "texture/maketexture.h"
#include <cmath>
#include <filesystem>
#include <new>
#include <tbb/global_control.h>
#include <utility>

namespace alpenglow::render {
namespace {

using transport::Hider;

std::string text(double v) {
    char t[40];
    std::snprintf(t, sizeof t, "%.9g", v);
    return t;
}

std::string folderOf(const std::string& path) {
    size_t slash = path.find_last_of('/');
    return slash == std::string::npos ? "." : slash == 0 ? "/" : path.substr(0, slash);
}

Hider hiderOf(const scene::Options& o, Diagnostics& diags) {
    if (o.hider == "path") return Hider::Path;
    if (o.hider == "raytrace") return Hider::Raytrace;
    if (o.hider != "hidden" && !o.hider.empty())
        diags.report(Severity::Error, Rie::Incapable, o.hiderPlace, "there is no hider \"" + o.hider + "\": \"hidden\" is used",
                     "the hiders are hidden, path and raytrace");
    return Hider::Hidden;
}

uint32_t pathSamples(const scene::Options& o, const RenderSettings& s) {
    if (s.spp > 0) return std::min(s.spp, limits::kSamplesPerPixel);
    if (s.noise > 0 || s.seconds > 0) return limits::kSamplesPerPixel;
    if (!o.pixelSamplesSet) return 64;
    double n = std::round(double(std::max(1.f, o.pixelSamplesX)) * double(std::max(1.f, o.pixelSamplesY)));
    return uint32_t(std::clamp(n, 1.0, double(limits::kSamplesPerPixel)));
}

/// The samples that --samples or --part asks for; nothing: all. Parts share the samples evenly, and a later part gets what is
/// left.
std::optional<SampleRange> partOf(const RenderSettings& s, uint32_t spp) {
    if (!s.part) return s.samples;
    const uint64_t k = (*s.part)[0], n = (*s.part)[1];
    return SampleRange{uint32_t((k - 1) * spp / n), uint32_t(k * spp / n)};
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
    settings_.scenePath = path == "-" ? "." : folderOf(path);
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
    if (s.localRoulette) o.filter = {"box", 1, 1}; // the preset: the seed has no other filter
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
            // Old scenes name folders from where they lie, whatever the folder the renderer is started in.
            if (!p.empty() && p[0] != '/' && !settings_.scenePath.empty() && settings_.scenePath != ".")
                all.push_back(settings_.scenePath + "/" + p);
        }
    all.insert(all.end(), after.begin(), after.end());
    return all;
}

void Renderer::render(std::shared_ptr<const scene::Frame> frame) {
    double now = clockSeconds();
    stats_.parseSec += now - parseMark_;
    stats_.errors = -diagnostics_.errors();
    stats_.warnings = -diagnostics_.warnings();
    FrameStats told;
    const int before = outcome_.rendered;
    const bool map = isMapPass(frame->options);
    ++(map ? maps_ : pictures_);
    RenderSettings all;
    if (map) all = std::exchange(settings_, settingsOfMaps(settings_));
    try {
        renderFrame(std::move(frame), told);
    } catch (const LimitReached&) {
        outcome_.outOfMemory = true;
        ++outcome_.refused;
        diagnostics_.report(Severity::Severe, Rie::Limit, {}, "a limit was reached; this frame is given up");
    } catch (const std::bad_alloc&) {
        outcome_.outOfMemory = true;
        ++outcome_.refused;
        diagnostics_.report(Severity::Severe, Rie::NoMem, {}, "out of memory; this frame is given up",
                            settings_.memoryLimit
                                ? "the limit is " + memorySizeText(settings_.memoryLimit) + "; --memory-limit sets another"
                                : "");
    } catch (const std::exception& e) { // of libraries that could not get what they need: threads, mostly
        outcome_.outOfMemory = true;
        ++outcome_.refused;
        diagnostics_.report(Severity::Severe, Rie::System, {}, std::string("this frame is given up: ") + e.what());
    }
    if (outcome_.rendered > before) closeFrame(std::move(told));
    if (map) settings_ = std::move(all);
    parseMark_ = clockSeconds();
}

void Renderer::closeFrame(FrameStats told) {
    stats_.errors += diagnostics_.errors();
    stats_.warnings += diagnostics_.warnings();
    stats_.threads = settings_.threads;
    stats_.peakMemoryBytes = peakMemoryBytes();
    stats_.settle();
    told.figures = stats_;
    told.scene = settings_.sceneFile;
    frames_.push_back(std::move(told));
    accumulate(all_, stats_);
    stats_ = {};
}

void Renderer::renderFrame(std::shared_ptr<const scene::Frame> frame, FrameStats& told) {
    if (settings_.stop && *settings_.stop) {
        outcome_.interrupted = true;
        return;
    }
    const scene::Options& o = frame->options;
    if (settings_.seedByFrame) settings_.seed = uint64_t(std::max(0, o.frameNumber));
    const int team = Team::startable(settings_.threads);
    if (team < settings_.threads)
        diagnostics_.reportOnce("threads", {Severity::Warning, Rie::System, {},
                                            "only " + std::to_string(team) + " of " + std::to_string(settings_.threads) +
                                                " threads can be started; the picture is the same, later", {}, {}});
    tbb::global_control threads(tbb::global_control::max_allowed_parallelism, size_t(team));

    Hider hider = hiderOf(o, diagnostics_);
    const bool path = hider == Hider::Path;
    Camera camera(o, diagnostics_);
    uint32_t spp = path ? pathSamples(o, settings_) : 0;
    int nx = 1, ny = 1;
    if (!path) {
        gridOf(o, settings_, &nx, &ny);
        spp = uint32_t(nx) * uint32_t(ny);
        auto only = [&](bool asked, const char* option) {
            if (asked)
                diagnostics_.report(Severity::Warning, Rie::Incapable, {},
                                    std::string(option) + " needs the hider \"path\"; it is ignored");
        };
        only(settings_.samples.has_value(), "--samples");
        only(settings_.part.has_value(), "--part");
        only(settings_.noise > 0, "--noise");
        only(settings_.seconds > 0, "--time");
        only(!settings_.checkpoint.empty(), "--checkpoint");
    }
    const std::optional<SampleRange> part = path ? partOf(settings_, spp) : std::nullopt;
    if (part && part->begin == part->end) {
        ++outcome_.refused;
        diagnostics_.report(Severity::Error, Rie::Range, {},
                            "--part: " + std::to_string(spp) + " samples cannot be split into " +
                                std::to_string((*settings_.part)[1]) + " parts; this one is empty");
        return;
    }
    const SampleRange wanted = part.value_or(SampleRange{0, spp});
    std::string file = settings_.pixel ? "" : fileFor(o, wanted.end - wanted.begin);
    OutputPlan plan = planOutputs(o, settings_, path, file, diagnostics_);
    if (plan.pictures.empty()) {
        ++outcome_.refused;
        diagnostics_.report(Severity::Error, Rie::MissingData, {}, "no Display of this frame can be made; it is not rendered");
        return;
    }
    names_.nextWorld();
    const std::string checkpoint = path ? checkpointFile(o) : "";
    nameOutputs(plan, o);
    if (!canWrite(plan, checkpoint, part.has_value())) {
        ++outcome_.refused;
        outcome_.outputFailed = true;
        return;
    }
    if (!mayReplace(checkpoint)) {
        ++outcome_.refused;
        return;
    }

    transport::Settings t;
    t.hider = hider;
    t.seed = settings_.seed;
    t.lanes = settings_.lanes;
    t.maxDepth = settings_.maxDepth;
    t.sampleClamp = settings_.sampleClamp;
    t.direct = settings_.direct;
    t.indirect = settings_.indirect;
    t.unbiased = settings_.unbiased;
    t.localRoulette = settings_.localRoulette;
    t.dialect = settings_.dialect;
    t.allowExec = settings_.allowExec;
    t.read = readPolicyOf(settings_.scenePath, settings_.allowRead);
    t.reads = settings_.reads;
    t.pluginPaths = searchPaths(o, "rslplugin", settings_.shaderPaths, true);
    t.shaderPaths = searchPaths(o, "shader", settings_.shaderPaths, true);
    t.texturePaths = searchPaths(o, "texture", settings_.texturePaths, false);
    t.outputs = plan.engineOutputs;
    t.outputWidths = plan.engineWidths;
    t.stop = settings_.stop;
    auto world = engine_.build(drawnLevels(frame, camera), t, diagnostics_);
    if (!world) {
        if (settings_.stop && *settings_.stop) outcome_.interrupted = true;
        ++outcome_.refused;
        return;
    }
    plan.resolve(world->outputWidths(), diagnostics_);
    sayMissingOutputs(plan, *world, diagnostics_);
    transport::World::Facts facts = world->facts();
    stats_.buildSec += facts.buildSec;
    stats_.compileSec += facts.compileSec;

    double cpu = processCpuSeconds();
    Job job(settings_, camera, plan, engine_, world, team, progress_, diagnostics_);
    job.what = plan.pictures.front().name;
    if (o.frameNumber > 0) job.what += " (frame " + std::to_string(o.frameNumber) + ")";
    Imager imager;
    if (o.imager)
        imager = [&, poll = static_cast<const StopFlag*>(nullptr), begun = false](
                     int n, const float* x, const float* y, float* r, float* g, float* b, float* a) mutable {
            // A stop that was asked for while rendering is obeyed by now: it must not end the imager's loops.
            if (!begun) poll = settings_.stop && !*settings_.stop ? settings_.stop : nullptr;
            begun = true;
            world->runImager(n, x, y, r, g, b, a, diagnostics_, poll);
            if (!poll || !*poll) return true;
            outcome_.interrupted = true;
            diagnostics_.reportOnce("imager:stopped", {Severity::Warning,
                                                       Rie::NoError,
                                                       o.imager->place,
                                                       "interrupted while the imager was running; the picture is not written",
                                                       {},
                                                       {}});
            return false;
        };
    PictureFacts picture;
    picture.width = camera.width();
    picture.height = camera.height();
    picture.window = camera.window();
    picture.pixelAspect = camera.pixelAspect();
    picture.worldToCamera = camera.worldToCamera();
    picture.worldToNDC = camera.worldToNDC();
    picture.imager = o.imager != nullptr;
    told.frame = o.frameNumber;
    told.seed = settings_.seed;
    told.hider = path ? "path" : hider == Hider::Raytrace ? "raytrace" : "hidden";
    told.sceneHash = sceneDigest(*frame, "");
    addProvenance(picture, settings_, *frame, told.hider, told.sceneHash);
    const auto written = [&](bool fine) { // the pictures, or what was in their way
        outcome_.outputFailed |= !fine;
        for (const OutputSpec& s : plan.pictures)
            if (fine) told.pictures.push_back({s.name, s.type, s.channels()});
    };

    stats_.curve = curvesOf(plan);
    stats_.width = camera.window().width();
    stats_.height = camera.window().height();
    uint64_t nonFinite = 0;
    if (settings_.pixel) {
        printPixel(job, o, wanted, path);
        ++outcome_.rendered;
    } else if (path) {
        FilmDescription d;
        d.width = camera.width();
        d.height = camera.height();
        d.window = camera.window();
        d.seed = settings_.seed;
        d.channels = filmChannels(plan);
        if (part || !checkpoint.empty()) {
            char how[160];
            std::snprintf(how, sizeof how, "path depth %d clamp %.9g direct %d indirect %d unbiased %d local %d", t.maxDepth,
                          double(t.sampleClamp), t.direct, t.indirect, t.unbiased, t.localRoulette);
            d.scene = sceneDigest(*frame, how + (t.dialect.empty() ? "" : " dialect " + t.dialect));
        }
        if (!Film::check(d, diagnostics_)) {
            ++outcome_.refused;
            outcome_.outOfMemory = true;
            return;
        }
        std::unique_ptr<Film> film;
        const OutputPolicy anywhere{".", true};
        if (settings_.resume && !resume(checkpoint, d, film)) {
            ++outcome_.refused;
            return;
        }
        if (!film) film = std::make_unique<Film>(d);
        film->metadata[kPicturesKey] = planToText(plan, picture);
        if (settings_.part) film->metadata[kWholeKey] = rangeText({0, spp});
        if (std::string seen = imagerToText(*frame, t); !seen.empty()) film->metadata[kImagerKey] = std::move(seen);
        double saved = clockSeconds();
        auto keep = [&](Film& f, bool now = false) {
            if (checkpoint.empty() || (!now && clockSeconds() - saved < settings_.checkpointSeconds)) return;
            outcome_.outputFailed |= !savePart(f, checkpoint, anywhere, diagnostics_);
            saved = clockSeconds();
        };
        bool any = renderPath(job, *film, wanted, settings_.seed, keep);
        double renderSec = job.elapsed();
        stats_.renderSec += renderSec;
        outcome_.interrupted |= job.interrupted;
        if (job.outOfMemory) { // the old picture is better than few samples; a checkpoint goes on later
            if (any) keep(*film, true);
            std::rethrow_exception(job.outOfMemory);
        }
        if (!any) {
            ++outcome_.refused;
            if (job.interrupted)
                diagnostics_.report(Severity::Warning, Rie::NoError, {},
                                    "interrupted before the first pass was whole; nothing is written");
        } else {
            ++outcome_.rendered;
            if (auto first = film->firstDropped()) reportDropped(film->nonFinite(), first->x, first->y, first->sample);
            if (film->saturated())
                diagnostics_.report(Severity::Warning, Rie::Range, {},
                                    std::to_string(film->saturated()) + " values beyond 2^60 were cut there");
            if (settings_.stamp) addStamp(picture, settings_, renderSec);
            written(writeFilm(*film, plan, picture, imager, settings_.allowWrite, diagnostics_));
            if (part) {
                const OutputSpec& first = plan.pictures.front();
                outcome_.outputFailed |=
                    !savePart(*film, sidecarName(first.name), {".", settings_.allowWrite || first.userFile}, diagnostics_);
            }
            if (!checkpoint.empty()) outcome_.outputFailed |= !savePart(*film, checkpoint, anywhere, diagnostics_);
        }
        stats_.spp = film->samplesPerPixel();
        stats_.noise = noiseFigures(*film);
        stats_.saturated += film->saturated();
        nonFinite = film->nonFinite();
    } else {
        DroppedSamples dropped;
        Reconstructions made = renderImages(job, nx, ny, jitterOf(o, diagnostics_), settings_.seed, &dropped);
        nonFinite = dropped.count;
        stats_.renderSec += job.elapsed();
        stats_.spp = spp;
        stats_.noise = {}; // not known: neighbouring pixels share samples
        outcome_.interrupted |= job.interrupted;
        ++outcome_.rendered;
        if (job.interrupted)
            diagnostics_.report(Severity::Warning, Rie::NoError, {},
                                "interrupted: what was not reached stays black in the picture");
        if (nonFinite) {
            const auto at = dropped.first.value_or(std::array{-1, -1, -1});
            reportDropped(nonFinite, at[2], at[1], at[0]);
        }
        picture.metadata["nonFinite"] = std::to_string(nonFinite);
        picture.metadata["spp"] = std::to_string(spp);
        picture.metadata["seed"] = std::to_string(settings_.seed);
        auto pixels = [&](const OutputSpec& s) -> const Image& {
            return made.images[made.of[size_t(&s - plan.pictures.data())]];
        };
        if (settings_.stamp) addStamp(picture, settings_, job.elapsed());
        written(writeOutputs(plan, picture, pixels, imager, settings_.allowWrite, diagnostics_));
    }
    stats_.cpuSec += processCpuSeconds() - cpu;

    transport::Counters c = job.counters();
    stats_.totalRays += totalRays(c);
    stats_.rays["camera"] += c.camera;
    stats_.rays["diffuse"] += c.diffuse;
    stats_.rays["specular"] += c.specular;
    stats_.rays["transmission"] += c.transmission;
    stats_.rays["shadow"] += c.shadow;
    stats_.shading.points += c.points;
    stats_.shading.batches += c.batches;
    stats_.lanesUsed += double(c.lanesUsed);
    stats_.lanesRun += double(c.lanesRun);
    stats_.depthSum += double(c.depthSum);
    stats_.paths += double(c.paths);
    stats_.depth.maximum = std::max(stats_.depth.maximum, c.depthMax);
    stats_.nonFinite += nonFinite;
    if (!settings_.pixel) sayEmptyPicture(job, *frame, diagnostics_);
    facts = world->facts(); // kernels may be compiled while rendering
    stats_.shading.kernels = facts.kernels;
    stats_.shading.affineKernels = facts.affine;
    stats_.shading.suspendingKernels = facts.suspending;
    stats_.shading.cacheHits = facts.cacheHits;
    if (c.overLimit)
        diagnostics_.report(Severity::Error, Rie::Limit, {},
                            std::to_string(c.overLimit) +
                                " ray calls were beyond the memory for waiting shaders and brought nothing");
    if (c.depthCap && path)
        diagnostics_.report(Severity::Info, Rie::NoError, {},
                            std::to_string(c.depthCap) + " paths were cut at the greatest depth, which is a bias (--max-depth)");
}

void Renderer::reportDropped(uint64_t count, int x, int y, int64_t sample) {
    const std::string at = std::to_string(x) + "," + std::to_string(y) + "," + std::to_string(sample);
    diagnostics_.report(
        Severity::Warning, Rie::Math, {},
        std::to_string(count) +
            (count == 1 ? " sample was not finite and is left out" : " samples were not finite and are left out") +
            (sample < 0 ? "" : "; the first is made by --pixel " + at + " --seed " + std::to_string(settings_.seed)));
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
    Jitter jitter = jitterOf(o, diagnostics_);
    if (!path && end > uint32_t(nx * ny)) {
        diagnostics_.report(Severity::Error, Rie::Range, {}, "--pixel: a pixel has " + std::to_string(nx * ny) + " samples");
        return;
    }
    double sum[4] = {0, 0, 0, 0};
    for (uint32_t s = begin; s < end && !job.pollStop(); ++s) {
        float weight = 1;
        transport::CameraRay ray;
        if (path) ray = pathRay(job.camera, filter, settings_.seed, x, y, s, &weight);
        else {
            Vec2 p = stratifiedOffset(settings_.seed, x, y, int(s), nx, ny, jitter);
            ray = imageRay(job.camera, {float(x) + p.x, float(y) + p.y}, settings_.seed, x, y, s);
        }
        transport::SampleResult r;
        if (!job.trace(0, {&ray, 1}, {&r, 1})) break;
        Color c = clampSample(r.color, settings_.sampleClamp);
        for (int k = 0; k < 3; ++k) sum[k] += double(c[k] * weight);
        sum[3] += double((r.opacity.x + r.opacity.y + r.opacity.z) / 3 * weight);
    }
    outcome_.interrupted |= job.interrupted;
    double n = end - begin;
    if (print_ && !job.interrupted)
        print_(text(sum[0] / n) + " " + text(sum[1] / n) + " " + text(sum[2] / n) + " " + text(sum[3] / n));
    stats_.renderSec += job.elapsed();
    stats_.spp = end - begin;
}

void Renderer::makeTexture(const std::string& kind, const std::vector<std::string>& files, const scene::ParamList& args,
                           const SourcePlace& place) {
    double now = clockSeconds();
    stats_.parseSec += now - parseMark_;
    passOverTexture(files);
    texture::MakeOptions m;
    m.policy.allowWrite = settings_.allowWrite;
    m.read = readPolicyOf(settings_.scenePath, settings_.allowRead);
    m.place = place;
    m.searchPath = {""};
    if (!settings_.scenePath.empty()) m.searchPath.push_back(settings_.scenePath);
    m.searchPath.insert(m.searchPath.end(), settings_.texturePaths.begin(), settings_.texturePaths.end());
    std::vector<float> numbers;
    for (const scene::Param& p : args)
        if (p.strings.empty()) numbers.insert(numbers.end(), p.numbers.begin(), p.numbers.end());
    int before = diagnostics_.errors();
    if (texture::runMakeRequest(kind, files, numbers, m, diagnostics_)) ++outcome_.textures;
    else if (diagnostics_.errors() == before) diagnostics_.report(Severity::Error, Rie::BadFile, place, kind + " failed");
    parseMark_ = clockSeconds();
}

RenderStats Renderer::stats() const {
    RenderStats s = all_, rest = stats_; // rest: a frame that was given up, maps made after the last one
    if (frames_.empty()) s = rest;
    else s.parseSec += rest.parseSec;
    s.threads = settings_.threads;
    s.peakMemoryBytes = peakMemoryBytes();
    s.settle();
    s.errors = diagnostics_.errors();
    s.warnings = diagnostics_.warnings();
    return s;
}

bool Renderer::writeStats() {
    if (settings_.statsFile.empty()) return true;
    auto out = OutputFile::open(settings_.statsFile, {".", true}, diagnostics_);
    if (!out) return !(outcome_.outputFailed = true);
    std::string json = statsJson(stats(), frames_, settings_);
    out->write(json.data(), json.size());
    if (out->commit(diagnostics_)) return true;
    outcome_.outputFailed = true;
    return false;
}

} // namespace alpenglow::render
