#include "render/filmpicture.h"
#include "render/imagertext.h"
#include "render/noise.h"
#include "render/partfile.h"

namespace alpenglow::render {
namespace {

std::string number(double v) {
    char text[40];
    std::snprintf(text, sizeof text, "%.9g", v);
    return text;
}

/// The world that runs the imager of a merged film. Null: there is none, or it cannot be made (reported).
std::shared_ptr<const transport::World> imagerWorld(const Film& film, const std::string& file, const MergeSettings& settings, Diagnostics& diags) {
    const auto text = film.metadata.find(kImagerKey);
    if (text == film.metadata.end()) {
        diags.report(Severity::Error, Rie::Incapable, {file}, "the scene has an imager shader, of which the part file says nothing; it is not run");
        return nullptr;
    }
    auto scene = imagerFromText(text->second, file, diags);
    if (!scene) return nullptr;
    auto& paths = scene->settings.shaderPaths;
    paths.insert(paths.begin(), settings.shaderPaths.begin(), settings.shaderPaths.end());
    scene->settings.allowExec = settings.allowExec;
    return transport::World::build(scene->frame, scene->settings, diags);
}

} // namespace

std::string sidecarName(const std::string& picture) { return picture + ".part"; }

bool writeFilm(const Film& film, const OutputPlan& plan, PictureFacts facts, const Imager& imager, bool allowWrite,
               Diagnostics& diags) {
    facts.width = film.description().width;
    facts.height = film.description().height;
    facts.window = film.window();
    std::string ranges;
    for (SampleRange r : film.ranges())
        ranges += (ranges.empty() ? "" : ",") + std::to_string(r.begin) + ":" + std::to_string(r.end);
    NoiseFigures n = noiseFigures(film);
    facts.metadata["spp"] = std::to_string(film.samplesPerPixel());
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

MergeResult mergePictures(const std::vector<std::string>& parts, const std::string& output, const MergeSettings& settings, Diagnostics& diags) {
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
        diags.report(Severity::Error, Rie::BadFile, {files.front()}, "the part file's channels are not those of its pictures");
        return MergeResult::NoInput;
    }
    if (!output.empty()) {
        plan->first.pictures.assign(1, singleOutput(output, plan->first.basis, diags));
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
    // What is not the beginning of a sequence may be merged further.
    const auto& r = film->ranges();
    if (written && (r.size() != 1 || r.front().begin != 0) && !plan->first.pictures.empty())
        written = savePart(*film, sidecarName(plan->first.pictures.front().name), {".", true}, diags);
    return written ? MergeResult::Done : MergeResult::NoOutput;
}

} // namespace alpenglow::render
