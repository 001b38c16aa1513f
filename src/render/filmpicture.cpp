#include "render/filmpicture.h"
#include "base/limits.h"
#include "base/realpath.h"
#include "display/driver.h"
#include "render/imagertext.h"
#include "render/noise.h"
#include "render/partfile.h"
#include <algorithm>

namespace alpenglow::render {
namespace {

std::string number(double v) {
    char text[40];
    std::snprintf(text, sizeof text, "%.9g", v);
    return text;
}

/// The world that runs the imager of a merged film. Returns null if there is no imager, or if the world cannot be made
/// (reported).
std::shared_ptr<const world::World> imagerWorld(const Film& film, const std::string& file, const MergeSettings& settings,
                                                Diagnostics& diags) {
    const auto text = film.metadata.find(kImagerKey);
    if (text == film.metadata.end()) {
        diags.report(Severity::Error, Rie::Incapable, {file},
                     "the scene has an imager shader that the part file does not describe; it is not run");
        return nullptr;
    }
    auto scene = imagerFromText(text->second, file, diags);
    if (!scene) return nullptr;
    auto& paths = scene->settings.shaderPaths;
    paths.insert(paths.begin(), settings.shaderPaths.begin(), settings.shaderPaths.end());
    scene->settings.allowExec = settings.allowExec;
    return integrator::buildWorld(scene->frame, scene->settings, diags);
}

std::string rangesText(const std::vector<SampleRange>& ranges) {
    std::string all;
    for (const SampleRange& r : ranges) all += (all.empty() ? "" : ",") + rangeText(r);
    return all;
}

/// Reports samples that no part has. Returns true if there are any.
bool reportGaps(const Film& film, const MergeSettings& settings, Diagnostics& diags) {
    const std::vector<SampleRange>& have = film.ranges();
    if (have.empty()) return false;
    SampleRange whole{0, have.back().end};
    if (const auto text = film.metadata.find(kWholeKey); text != film.metadata.end())
        if (auto w = rangeFromText(text->second)) whole.end = std::max(whole.end, w->end);
    whole = settings.expect.value_or(whole);
    const std::vector<SampleRange> missing = missingSamples(have, whole);
    if (!missing.empty())
        diags.report(settings.expect ? Severity::Error : Severity::Warning, Rie::MissingData, {},
                     "no part has the samples " + rangesText(missing) + " of " + rangeText(whole) +
                         "; the picture is written without them",
                     "render them with --samples " + rangeText(missing.front()) + (missing.size() > 1 ? " and so on" : "") +
                         ", and merge them with this picture");
    if (settings.expect && (have.front().begin < whole.begin || have.back().end > whole.end))
        diags.report(Severity::Error, Rie::Consistency, {},
                     "the parts have the samples " + rangesText(have) + ", which is more than --expect " + rangeText(whole));
    return !missing.empty();
}

} // namespace

std::string rangeText(SampleRange r) { return std::to_string(r.begin) + ":" + std::to_string(r.end); }

std::optional<SampleRange> rangeFromText(const std::string& text) {
    unsigned long begin = 0, end = 0;
    int read = 0;
    if (std::sscanf(text.c_str(), "%9lu:%9lu%n", &begin, &end, &read) != 2 || size_t(read) != text.size() || end <= begin ||
        end > limits::kSamplesPerPixel)
        return {};
    return SampleRange{uint32_t(begin), uint32_t(end)};
}

std::vector<SampleRange> missingSamples(const std::vector<SampleRange>& ranges, SampleRange whole) {
    std::vector<SampleRange> missing;
    uint32_t at = whole.begin;
    for (const SampleRange& r : ranges) {
        if (r.begin > at && at < whole.end) missing.push_back({at, std::min(r.begin, whole.end)});
        at = std::max(at, r.end);
    }
    if (at < whole.end) missing.push_back({at, whole.end});
    return missing;
}

std::string sidecarName(const std::string& picture) { return picture + ".part"; }

bool writeFilm(const Film& film, const OutputPlan& plan, PictureFacts facts, const Imager& imager, bool allowWrite,
               Diagnostics& diags) {
    facts.width = film.description().width;
    facts.height = film.description().height;
    facts.window = film.window();
    const std::string ranges = rangesText(film.ranges());
    NoiseFigures n = noiseFigures(film);
    const Film::Samples samples = film.samples();
    facts.metadata["spp"] = number(samples.mean);
    if (film.spread()) facts.metadata["adaptive"] = std::to_string(samples.least) + " to " + std::to_string(samples.most);
    facts.metadata["samples"] = ranges;
    facts.metadata["seed"] = std::to_string(film.description().seed);
    if (n.known) facts.metadata["noise"] = number(n.noise);
    facts.metadata["coverage"] = number(n.coverage);
    facts.metadata["noiseRSE"] = number(n.noiseRSE);
    facts.metadata["noiseQMC"] = number(n.noiseQMC);
    facts.metadata["nonFinite"] = std::to_string(film.nonFinite());
    std::map<DepthFilter, Image> images;
    auto pixels = [&](const OutputSpec& s) -> const Image& {
        auto i = images.find(s.depth);
        if (i == images.end()) i = images.emplace(s.depth, filmImage(film, plan, s.depth)).first;
        return i->second;
    };
    return writeOutputs(plan, facts, pixels, imager, allowWrite, diags);
}

/// Replaces the pictures that -o replaces by one, as displaysOf() does.
static void nameOutput(OutputPlan& plan, const std::string& output, Diagnostics& diags) {
    std::vector<OutputSpec> kept{singleOutput(output, plan.basis, diags)};
    for (OutputSpec& s : plan.pictures) {
        const display::DriverDescriptor* driver = display::findDriver(s.type);
        const bool writes = !driver || driver->writes, first = &s == &plan.pictures.front();
        const auto all = [&](auto is) { return std::all_of(s.variables.begin(), s.variables.end(), is); };
        using Shown = OutputVariable::Source;
        const bool plain = all([](const auto& v) { return v.source == Shown::Ci || v.source == Shown::Alpha; });
        const bool map = all([](const auto& v) { return v.source == Shown::Z; });
        if (writes && (map || (!first && (s.userFile || !plain)))) kept.push_back(std::move(s));
    }
    plan.pictures = std::move(kept);
}

MergeResult mergePictures(const std::vector<std::string>& parts, const std::string& output, const MergeSettings& settings,
                          Diagnostics& diags) {
    std::vector<std::string> files;
    for (const std::string& p : parts) files.push_back(p.size() > 5 && p.ends_with(".part") ? p : sidecarName(p));
    std::unique_ptr<Film> film = mergeParts(files, diags);
    if (!film) return MergeResult::NoInput;
    auto text = film->metadata.find(kPicturesKey);
    if (text == film->metadata.end()) {
        diags.report(Severity::Error, Rie::BadFile, {files.front()}, "the part file does not say which pictures it belongs to");
        return MergeResult::NoInput;
    }
    auto plan = planFromText(text->second, files.front(), diags);
    if (!plan) return MergeResult::NoInput;
    if (filmChannels(plan->first) != film->description().channels) {
        diags.report(Severity::Error, Rie::BadFile, {files.front()}, "the part file's channels do not match its pictures");
        return MergeResult::NoInput;
    }
    const bool gaps = reportGaps(*film, settings, diags);
    if (!output.empty()) {
        nameOutput(plan->first, output, diags);
        plan->first.resolve(plan->first.engineWidths, diags);
    }
    Imager imager;
    if (plan->second.imager)
        if (auto world = imagerWorld(*film, files.front(), settings, diags))
            imager = [world, &diags](int n, const float* x, const float* y, float* r, float* g, float* b, float* a) {
                world->runImager(n, x, y, r, g, b, a, diags);
                return true;
            };
    bool written = writeFilm(*film, plan->first, plan->second, imager, settings.allowWrite, diags);
    // Incomplete sequences may be merged further.
    const auto& r = film->ranges();
    const std::string part = plan->first.pictures.empty() ? "" : sidecarName(plan->first.pictures.front().name);
    const bool whole = !gaps && r.size() == 1 && r.front().begin == 0;
    if (written && !whole && !part.empty()) written = savePart(*film, part, {".", true}, diags);
    else if (written && std::none_of(files.begin(), files.end(), [&](const std::string& f) { return sameFile(f, part); }))
        removePart(part); // of an older picture
    return written ? MergeResult::Done : MergeResult::NoOutput;
}

} // namespace alpenglow::render
