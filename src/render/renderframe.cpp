// Renders one frame: preparation, rays, pictures and figures.
#include "base/limits.h"
#include "base/processors.h"
#include "base/realpath.h"
#include "display/driver.h"
#include "render/bakepass.h"
#include "render/curve.h"
#include "render/deeppass.h"
#include "render/digest.h"
#include "render/emptyresults.h"
#include "render/filmpicture.h"
#include "render/framework.h"
#include "render/imagertext.h"
#include "render/imaging.h"
#include "render/levels.h"
#include "render/outputnames.h"
#include "render/partfile.h"
#include "render/provenance.h"
#include "render/rendering.h"
#include "render/watcher.h"
#include "world/bakes.h"
#include "world/causticseeds.h"
#include "world/photonstore.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <tbb/global_control.h>

namespace alpenglow::render {
namespace {

using world::Hider;

/// Whether pictures are written to files.
bool writesFiles(const RenderSettings& s) { return !s.watcher || s.watcher->writes(); }

constexpr uint32_t kBakeSamples = 256; ///< maximum for a baked point: --noise and --time set no number

uint32_t pathSamples(const scene::Options& o, const RenderSettings& s) {
    if (s.spp > 0) return std::min(s.spp, limits::kSamplesPerPixel);
    if (s.noise > 0 || s.seconds > 0) return limits::kSamplesPerPixel;
    if (!o.pixelSamplesSet) return 64;
    double n = std::round(double(std::max(1.f, o.pixelSamplesX)) * double(std::max(1.f, o.pixelSamplesY)));
    return uint32_t(std::clamp(n, 1.0, double(limits::kSamplesPerPixel)));
}

/// The samples by --samples or --part; nothing: all. Parts have equal sizes; the last gets the remainder.
std::optional<SampleRange> partOf(const RenderSettings& s, uint32_t spp) {
    if (!s.part) return s.samples;
    const uint64_t k = (*s.part)[0], n = (*s.part)[1];
    return SampleRange{uint32_t((k - 1) * spp / n), uint32_t(k * spp / n)};
}

/// For frames with deep shadow maps only: no colour.
Reconstructions noImages(const Job& job) {
    Reconstructions r;
    Image black;
    black.window = job.camera.window();
    black.channels.resize(kImageFixedChannels);
    black.data.resize(black.window.pixels() * black.channels.size());
    r.images.push_back(std::move(black));
    r.of.assign(job.plan.pictures.size(), 0);
    return r;
}

} // namespace

Hider hiderOf(const scene::Options& o, Diagnostics& diags) {
    if (o.hider == "path" || o.hider == "photon") return Hider::Path;
    if (o.hider == "raytrace") return Hider::Raytrace;
    // What others call theirs: the painter's algorithm of RISpec, Pixie's two, and those of programs that came of it.
    constexpr std::array<std::string_view, 8> kSame = {"paint", "painter",  "stochastic",  "zbuffer",
                                                       "reyes", "scanline", "depthbuffer", "opengl"};
    if (o.hider != "hidden" && !o.hider.empty() && std::find(kSame.begin(), kSame.end(), o.hider) == kSame.end())
        diags.report(Severity::Error, Rie::Incapable, o.hiderPlace, "there is no hider \"" + o.hider + "\": \"hidden\" is used",
                     "the hiders are hidden, path, photon and raytrace");
    return Hider::Hidden;
}

void Renderer::renderFrame(std::shared_ptr<const scene::Frame> frame, FrameStats& stats) {
    if (settings_.stop && *settings_.stop) {
        outcome_.interrupted = true;
        return;
    }
    if (settings_.seedByFrame) settings_.seed = uint64_t(std::max(0, frame->options.frameNumber));
    auto work = std::make_unique<FrameWork>(std::move(frame), stats, diagnostics_);
    FrameWork& f = *work;
    if (f.o.hider != "photon" && !planFrame(f)) return;
    if (abandons(f) || !drawsHere(f)) return;
    drawFrame(f);
    if (!inProcess()) return;
    [[maybe_unused]] const FrameWork* kept = work.release(); // the process ends: destruction would copy its pages
}

void Renderer::drawFrame(FrameWork& f) {
    const int team = Team::startable(settings_.threads);
    if (team < settings_.threads)
        diagnostics_.reportOnce("threads", {Severity::Warning,
                                            Rie::System,
                                            {},
                                            "only " + std::to_string(team) + " of " + std::to_string(settings_.threads) +
                                                " threads can be started; rendering takes longer",
                                            {},
                                            {}});
    tbb::global_control threads(tbb::global_control::max_allowed_parallelism, size_t(team));
    if (f.o.hider == "photon") return renderPhotons(f, team);
    if (!buildFrame(f) || abandons(f)) return;
    declareBakes(f);
    drawPictures(f, team);
}

void Renderer::drawPictures(FrameWork& f, int team) {
    double cpu = processCpuSeconds();
    Job job(settings_, f.camera, f.plan, engine_, f.world, team, progress_, diagnostics_);
    if (f.o.abortsOnError) job.errorsAllowed = f.errorsBefore;
    job.what = f.plan.pictures.front().name;
    if (f.o.frameNumber > 0) job.what += " (frame " + std::to_string(f.o.frameNumber) + ")";
    if (f.o.imager) f.imager = imagerOf(f);
    describeFrame(f);
    if (settings_.watcher) settings_.watcher->begin({f.plan, f.picture, f.world, f.imager});
    makePhotonMaps(f, job);
    findRecords(job);
    makeWhatIsMet(f, job);
    if (!settings_.pixel) bakeGrids(job, f.path ? std::min(f.spp, kBakeSamples) : 1);
    if (settings_.pixel) {
        printPixel(job, f.o, f.wanted, f.path);
        ++outcome_.rendered;
    } else if ((f.plan.anyDeep() && !makeDepths(f, job)) || (f.plan.anyMattes() && !makeMattes(f, job))) {
        if (!abandons(f)) ++outcome_.refused;
        return;
    } else if (!f.path || f.plan.onlyDeep()) {
        if (!renderGrid(f, job)) return;
    } else if (!renderSamples(f, job)) {
        return;
    }
    if (!settings_.pixel && writesFiles(settings_)) writeBaked(f, job);
    stats_.cpuSec += processCpuSeconds() - cpu;
    sayProcedurals(*f.made, diagnostics_);
    takeFigures(f, job);
}

/// Plans pictures and files. Returns false if there is nothing to render, which is reported.
bool Renderer::planFrame(FrameWork& f) {
    f.spp = f.path ? pathSamples(f.o, settings_) : 0;
    if (!f.path) {
        gridOf(f.o, settings_, &f.nx, &f.ny);
        f.spp = uint32_t(f.nx) * uint32_t(f.ny);
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
    f.part = f.path ? partOf(settings_, f.spp) : std::nullopt;
    if (f.part && f.part->begin == f.part->end) {
        ++outcome_.refused;
        diagnostics_.report(Severity::Error, Rie::Range, {},
                            "--part: " + std::to_string(f.spp) + " samples cannot be split into " +
                                std::to_string((*settings_.part)[1]) + " parts; this one is empty");
        return false;
    }
    f.wanted = f.part.value_or(SampleRange{0, f.spp});
    std::string file = settings_.pixel ? "" : fileFor(f.o, f.wanted.end - f.wanted.begin);
    f.plan = planOutputs(f.o, settings_, f.path, file, diagnostics_);
    if (f.plan.pictures.empty()) {
        ++outcome_.refused;
        diagnostics_.report(Severity::Error, Rie::MissingData, {}, "no Display of this frame can be written; it is not rendered");
        return false;
    }
    if (!writesFiles(settings_)) return true;
    names_.nextWorld();
    f.checkpoint = f.path ? checkpointFile(f.o) : "";
    nameOutputs(f.plan, f.o);
    if (!canWrite(f.plan, f.checkpoint, f.part.has_value())) {
        ++outcome_.refused;
        outcome_.outputFailed = true;
        return false;
    }
    if (!mayReplace(f.checkpoint)) {
        ++outcome_.refused;
        return false;
    }
    return true;
}

world::Settings Renderer::engineSettings(const FrameWork& f) const {
    world::Settings t;
    t.hider = f.hider;
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
    t.read = readPolicy();
    t.reads = settings_.reads;
    t.pluginPaths = searchPaths(f.o, "rslplugin", settings_.shaderPaths, true);
    t.shaderPaths = searchPaths(f.o, "shader", settings_.shaderPaths, true);
    t.texturePaths = searchPaths(f.o, "texture", settings_.texturePaths, false);
    t.outputs = f.plan.engineOutputs;
    t.outputWidths = f.plan.engineWidths;
    t.lightPaths = f.plan.lightPaths;
    t.firstSeen = f.path && f.plan.needsFirstSeen();
    t.stop = settings_.stop;
    t.micropolygons = !f.path && shadesMicropolygons(f.o, f.hider == Hider::Hidden, f.camera, diagnostics_);
    return t;
}

/// Runs the imager of the frame; returns false if stopped.
std::function<bool(int, const float*, const float*, float*, float*, float*, float*)> Renderer::imagerOf(FrameWork& f) {
    return [&f, this, poll = static_cast<const StopFlag*>(nullptr),
            begun = false](int n, const float* x, const float* y, float* r, float* g, float* b, float* a) mutable {
        // A stop during rendering has been handled by now: it must not end the imager's loops.
        if (!begun) poll = settings_.stop && !*settings_.stop ? settings_.stop : nullptr;
        begun = true;
        f.world->runImager(n, x, y, r, g, b, a, diagnostics_, poll);
        if (!poll || !*poll) return true;
        outcome_.interrupted = true;
        diagnostics_.reportOnce("imager:stopped", {Severity::Warning,
                                                   Rie::NoError,
                                                   f.o.imager->place,
                                                   "interrupted while the imager was running; the picture is not written",
                                                   {},
                                                   {}});
        return false;
    };
}

void Renderer::describeFrame(FrameWork& f) {
    f.picture.width = f.camera.width();
    f.picture.height = f.camera.height();
    f.picture.window = f.camera.window();
    f.picture.pixelAspect = f.camera.pixelAspect();
    f.picture.worldToCamera = f.camera.worldToCamera();
    f.picture.worldToNDC = f.camera.worldToNDC();
    f.picture.imager = f.o.imager != nullptr;
    f.stats.frame = f.o.frameNumber;
    f.stats.seed = settings_.seed;
    f.stats.hider = f.path ? "path" : f.hider == Hider::Raytrace ? "raytrace" : "hidden";
    f.stats.sceneHash = sceneDigest(*f.frame, "");
    addProvenance(f.picture, settings_, *f.frame, f.stats.hider, f.stats.sceneHash);
    stats_.curve = curvesOf(f.plan);
    stats_.width = f.camera.window().width();
    stats_.height = f.camera.window().height();
}

/// Reports the pictures, or what prevented them.
void Renderer::writtenPictures(FrameWork& f, bool fine) {
    outcome_.outputFailed |= !fine;
    for (const OutputSpec& s : f.plan.pictures)
        if (fine) f.stats.pictures.push_back({s.name, s.type, s.channels()}), written_.push_back(followedPath(s.name));
    if (!fine) return;
    for (const OutputSpec& s : f.plan.pictures) // of an older picture: merge would mistake it for this one's
        if (!extensionOf(s.name).empty() && (f.checkpoint.empty() || !sameFile(sidecarName(s.name), f.checkpoint)))
            removePart(sidecarName(s.name));
}

FilmDescription Renderer::filmOf(const FrameWork& f) const {
    FilmDescription d;
    d.width = f.camera.width();
    d.height = f.camera.height();
    d.window = f.camera.window();
    d.seed = settings_.seed;
    d.channels = filmChannels(f.plan);
    d.negative = FilterSampler(f.plan.basis.filter).negativePart();
    if (f.part || !f.checkpoint.empty()) {
        char how[160];
        std::snprintf(how, sizeof how, "path depth %d clamp %.9g direct %d indirect %d unbiased %d local %d", f.settings.maxDepth,
                      double(f.settings.sampleClamp), f.settings.direct, f.settings.indirect, f.settings.unbiased,
                      f.settings.localRoulette);
        std::string all = how + (f.settings.dialect.empty() ? "" : " dialect " + f.settings.dialect);
        for (const scene::LightPaths::Source& l : f.plan.lights) all += " light " + l.expression;
        d.scene = sceneDigest(*f.frame, all);
    }
    return d;
}

/// Renders under path. Returns false if nothing could be rendered, which is reported.
bool Renderer::renderSamples(FrameWork& f, Job& job) {
    const FilmDescription d = filmOf(f);
    if (!Film::check(d, diagnostics_)) {
        ++outcome_.refused;
        outcome_.outOfMemory = true;
        return false;
    }
    std::unique_ptr<Film> film;
    const OutputPolicy anywhere{".", true};
    if (settings_.resume && !resume(f.checkpoint, d, film)) {
        ++outcome_.refused;
        return false;
    }
    if (!film && settings_.watcher) film = settings_.watcher->filmFor(d);
    if (!film) film = std::make_unique<Film>(d);
    film->metadata[kPicturesKey] = planToText(f.plan, f.picture);
    if (settings_.part) film->metadata[kWholeKey] = rangeText({0, f.spp});
    if (std::string seen = imagerToText(*f.frame, f.settings); !seen.empty()) film->metadata[kImagerKey] = std::move(seen);
    double saved = clockSeconds();
    auto keep = [&](Film& kept, bool now = false) {
        if (f.checkpoint.empty() || (!now && clockSeconds() - saved < settings_.checkpointSeconds)) return;
        outcome_.outputFailed |= !savePart(kept, f.checkpoint, anywhere, diagnostics_);
        saved = clockSeconds();
    };
    const bool goesOn = film->samplesPerPixel() > 0;
    if (goesOn) job.met = job.shone = true; // the first run has reported what is missing
    const uint64_t raysBefore = job.rayTotal;
    bool any = renderPath(job, *film, f.wanted, settings_.seed, keep);
    if (any && goesOn && !settings_.watcher && job.rayTotal == raysBefore) {
        Diagnostic done{
            Severity::Info, Rie::NoError, {f.checkpoint}, "the checkpoint has all samples: there is nothing to do", {}, {}};
        done.always = true;
        diagnostics_.report(std::move(done));
    }
    double renderSec = job.elapsed();
    stats_.renderSec += renderSec;
    noteInterrupted(job);
    if (abandons(f)) return false;
    if (job.outOfMemory) { // the old picture is better than few samples; a checkpoint can be continued
        if (any) keep(*film, true);
        std::rethrow_exception(job.outOfMemory);
    }
    if (!any) {
        ++outcome_.refused;
        if (job.interrupted && writesFiles(settings_))
            diagnostics_.report(Severity::Warning, Rie::NoError, {},
                                "interrupted before the first pass was complete; no picture is written");
    } else {
        writeFrameFilm(f, *film, renderSec);
    }
    const Film::Samples samples = film->samples();
    stats_.spp = uint64_t(samples.mean + 0.5);
    stats_.sppLeast = samples.least;
    stats_.sppMost = samples.most;
    if (!settings_.watcher || settings_.watcher->wantsNoise()) stats_.noise = noiseFigures(*film);
    stats_.saturated += film->saturated();
    f.nonFinite = film->nonFinite();
    if (settings_.watcher) settings_.watcher->finished(any ? std::move(film) : nullptr);
    return true;
}

/// Writes the picture of a film with a complete pass, and its part files.
void Renderer::writeFrameFilm(FrameWork& f, Film& film, double renderSec) {
    ++outcome_.rendered;
    if (auto first = film.firstDropped()) reportDropped(film.nonFinite(), first->x, first->y, first->sample);
    if (film.saturated())
        diagnostics_.report(Severity::Warning, Rie::Range, {},
                            std::to_string(film.saturated()) + " values beyond 2^60 were clamped");
    if (!writesFiles(settings_)) return;
    if (settings_.stamp) addStamp(f.picture, settings_, renderSec);
    awaitTurn(f);
    writtenPictures(f, writeFilm(film, f.plan, f.picture, f.imager, settings_.allowWrite, diagnostics_));
    if (f.part) {
        const OutputSpec& first = f.plan.pictures.front();
        outcome_.outputFailed |=
            !savePart(film, sidecarName(first.name), {".", settings_.allowWrite || first.userFile}, diagnostics_);
    }
    if (!f.checkpoint.empty()) outcome_.outputFailed |= !savePart(film, f.checkpoint, OutputPolicy{".", true}, diagnostics_);
}

/// Makes the pixels of deep shadow maps. If they are rejected (reported), the frame still has its other pictures. Returns false
/// if there are none.
bool Renderer::makeDepths(FrameWork& f, Job& job) {
    if (f.path) gridOf(f.o, settings_, &f.nx, &f.ny);
    f.picture.deep = seeDepths(job, f.nx, f.ny, jitterOf(f.o, diagnostics_), settings_.seed, deepShadowError(f.o, diagnostics_));
    noteInterrupted(job);
    if (job.interrupted && !job.aborted)
        diagnostics_.report(Severity::Warning, Rie::NoError, {},
                            "interrupted before the deep shadow map was complete; it is not written");
    if (f.picture.deep || job.interrupted) return f.picture.deep != nullptr;
    std::erase_if(f.plan.pictures, [](const OutputSpec& p) { return p.deep; });
    return !f.plan.pictures.empty();
}

/// Renders under hidden and raytrace. Returns false if an error ended it (abandons()).
bool Renderer::renderGrid(FrameWork& f, Job& job) {
    DroppedSamples dropped;
    Reconstructions made;
    if (f.plan.onlyDeep()) made = noImages(job);
    else
        made = renderImages(job, f.nx, f.ny, jitterOf(f.o, diagnostics_), refinementOf(f.o, job.camera, diagnostics_),
                            settings_.seed, &dropped, sampleMemory_);
    stats_.classic.subsampledPixels += made.refined.pixels;
    stats_.classic.subsampledRays += made.refined.rays;
    f.nonFinite = dropped.count;
    stats_.renderSec += job.elapsed();
    stats_.spp = stats_.sppLeast = stats_.sppMost = f.spp;
    stats_.noise = {}; // unknown: neighbouring pixels share samples
    noteInterrupted(job);
    if (abandons(f)) return false;
    if (!made.begun) { // a picture that is there is better than a black one
        ++outcome_.refused;
        if (writesFiles(settings_))
            diagnostics_.report(Severity::Warning, Rie::NoError, {},
                                "interrupted before any part was complete; no picture is written");
        if (settings_.watcher) settings_.watcher->finished(nullptr);
        return true;
    }
    ++outcome_.rendered;
    if (job.interrupted && writesFiles(settings_))
        diagnostics_.report(Severity::Warning, Rie::NoError, {}, "interrupted: unfinished parts of the picture are black");
    if (f.nonFinite) {
        const auto at = dropped.first.value_or(std::array{-1, -1, -1});
        reportDropped(f.nonFinite, at[2], at[1], at[0]);
    }
    f.picture.metadata["nonFinite"] = std::to_string(f.nonFinite);
    f.picture.metadata["spp"] = std::to_string(f.spp);
    f.picture.metadata["seed"] = std::to_string(settings_.seed);
    auto pixels = [&](const OutputSpec& s) -> const Image& { return made.images[made.of[size_t(&s - f.plan.pictures.data())]]; };
    if (settings_.watcher) {
        if (!job.interrupted) settings_.watcher->look({pixels, nullptr, nullptr, job.elapsed(), job.rayTotal, true});
        settings_.watcher->finished(nullptr);
    }
    if (!writesFiles(settings_)) return true;
    if (settings_.stamp) addStamp(f.picture, settings_, job.elapsed());
    awaitTurn(f);
    writtenPictures(f, writeOutputs(f.plan, f.picture, pixels, f.imager, settings_.allowWrite, diagnostics_));
    return true;
}

/// Writes the files of bake() and bake3d(), unless the frame was interrupted.
void Renderer::writeBaked(FrameWork& f, const Job& job) {
    if (!world::bakes(*f.world)) return;
    if (job.interrupted)
        return diagnostics_.report(Severity::Warning, Rie::NoError, {}, "interrupted: baked files are not written");
    awaitTurn();
    pointcloud::FileOwners others;
    for (const OutputSpec& s : f.plan.pictures) {
        const display::DriverDescriptor* driver = display::findDriver(s.type);
        if (driver && !driver->writes) continue;
        others[fileIdentity(s.name)] =
            s.place.line > 0 ? "the Display of " + s.place.file + ":" + std::to_string(s.place.line) : "the picture";
    }
    outcome_.outputFailed |= !world::writeBakes(*f.world, settings_.allowWrite, others, diagnostics_);
}

void Renderer::takeFigures(const FrameWork& f, Job& job) {
    integrator::Counters c = job.counters();
    stats_.totalRays += totalRays(c);
    stats_.rays["camera"] += c.camera;
    stats_.rays["diffuse"] += c.diffuse;
    stats_.rays["specular"] += c.specular;
    stats_.rays["transmission"] += c.transmission;
    stats_.rays["shadow"] += c.shadow;
    stats_.classic.primary += c.camera - std::min(c.camera, stats_.classic.subsampledRays);
    stats_.classic.reflected += c.reflected;
    stats_.classic.refracted += c.refracted;
    stats_.classic.totalReflected += c.totalReflected;
    stats_.classic.ignored += c.ignored;
    stats_.classic.tests += c.tests;
    stats_.classic.hits += c.hits;
    stats_.shading.points += c.points;
    stats_.shading.batches += c.batches;
    stats_.lanesUsed += double(c.lanesUsed);
    stats_.lanesRun += double(c.lanesRun);
    stats_.depthSum += double(c.depthSum);
    stats_.paths += double(c.paths);
    stats_.depth.maximum = std::max(stats_.depth.maximum, c.depthMax);
    stats_.threadBytes = std::max<uint64_t>(stats_.threadBytes, c.threadBytes);
    stats_.guide = {job.guide.photons, job.guide.cells, job.guide.lobes, c.guided, c.guidedLit, c.guidedLight};
    if (const world::PhotonStore* store = job.world->photons(); store && store->seeds)
        stats_.specular = {store->seeds->seeds(), c.searches, c.searchesFound, c.probes};
    stats_.lightGuide = {job.lightGuide.samples, job.lightGuide.lights, job.lightGuide.cells, job.lightGuide.used};
    stats_.nonFinite += f.nonFinite;
    if (!settings_.pixel) {
        sayEmptyPicture(job, *f.frame, diagnostics_);
        sayEmptyClouds(job, diagnostics_);
        sayTurnedAway(job, diagnostics_);
        sayOpenMedia(job, c, diagnostics_);
    }
    const world::World::Facts facts = f.world->facts(); // kernels may be compiled during rendering
    stats_.shading.kernels = facts.kernels;
    stats_.shading.affineKernels = facts.affine;
    stats_.shading.suspendingKernels = facts.suspending;
    stats_.shading.cacheHits = facts.cacheHits;
    for (const auto& m : f.world->mapsRead()) f.stats.textures.push_back({m.path, m.bytes, m.memory, m.scratch});
    if (c.overLimit)
        diagnostics_.report(Severity::Error, Rie::Limit, {},
                            std::to_string(c.overLimit) +
                                " ray calls exceeded the memory for waiting shaders and returned no light");
    if (c.depthCap && f.path)
        diagnostics_.report(Severity::Info, Rie::NoError, {},
                            std::to_string(c.depthCap) + " paths ended at the maximum depth, which is a bias (--max-depth)");
}

} // namespace alpenglow::render
