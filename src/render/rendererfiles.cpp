// The files of a run: their names, whether they can be written, and existing ones.
#include "display/driver.h"
#include "render/filmpicture.h"
#include "render/frameprocesses.h"
#include "render/outputnames.h"
#include "render/partfile.h"
#include "render/renderer.h"
#include "scene/scene.h"
#include <filesystem>
#include <utility>

namespace alpenglow::render {

namespace {

/// Differences between two renders: "seed (3, not 4)".
std::string differing(const FilmDescription& a, const FilmDescription& b) {
    const auto size = [](int w, int h) { return std::to_string(w) + "x" + std::to_string(h); };
    if (a.width != b.width || a.height != b.height)
        return "size of picture (" + size(a.width, a.height) + ", not " + size(b.width, b.height) + ")";
    if (a.window != b.window) return "crop window";
    if (a.seed != b.seed) return "seed (" + std::to_string(a.seed) + ", not " + std::to_string(b.seed) + ")";
    if (a.channels != b.channels) return "set of outputs";
    return "scene, or options that change the picture";
}

} // namespace

std::string Renderer::fileFor(const scene::Options& o, uint32_t spp) {
    if (settings_.output == "-") return "-"; // one frame after the other
    if (!settings_.output.empty()) {
        if (isNumbered(o)) {
            if (numbersFrame()) return numberedName(settings_.output, o.frameNumber);
            firstPicture_ = {o.frameNumber, ""};
            return settings_.output;
        }
        numberFirstPicture();
        const bool numbered = saved_++ > 0 || hasFrameNumber(settings_.output);
        return numbered ? numberedName(settings_.output, saved_) : settings_.output;
    }
    if (settings_.savePattern.empty()) return "";
    std::string name = settings_.savePattern;
    auto put = [&](const std::string& key, const std::string& value) {
        if (size_t at = name.find(key); at != std::string::npos) name.replace(at, key.size(), value);
    };
    put("<spp>", std::to_string(spp));
    put("<no>", std::to_string(saved_++));
    return name;
}

bool Renderer::numbersFrame() {
    if (++framesForOutput_ == 1 && saved_ == 0 && !hasFrameNumber(settings_.output)) return false;
    numberFirstPicture();
    return true;
}

void Renderer::numberFirstPicture() {
    if (!firstPicture_) return;
    waitForFrames(); // it must exist
    const FirstPicture first = *std::exchange(firstPicture_, {});
    std::error_code e;
    // A file that could not be written does not exist; a name may also refer to a device.
    if (first.file.empty() || !std::filesystem::is_regular_file(first.file, e)) return;
    names_.release(first.file);
    scene::Options o;
    o.frameNumber = first.frame;
    o.inFrame = true;
    const std::string name = names_.take("display", numberedName(first.file, first.frame), false, o, {}, &diagnostics_);
    for (const auto& [from, to] : {std::pair{first.file, name}, {sidecarName(first.file), sidecarName(name)}}) {
        if (!std::filesystem::exists(from, e)) continue;
        std::filesystem::rename(from, to, e);
        if (!e) continue;
        outcome_.outputFailed = true;
        diagnostics_.report(Severity::Error, Rie::System, {from}, "cannot be renamed to " + to + ": " + e.message());
        return;
    }
    for (FrameStats& f : frames_)
        for (FrameStats::Picture& p : f.pictures)
            if (p.file == first.file) p.file = name;
    diagnostics_.report(Severity::Info, Rie::NoError, {first.file}, "is now " + name + ", as another frame follows");
}

std::string Renderer::checkpointFile(const scene::Options& o) {
    const std::string& name = settings_.checkpoint;
    if (name.empty()) return name;
    const bool plain = !isNumbered(o) && checkpoints_++ == 0;
    return names_.take("checkpoint", plain ? name : numberedName(name, isNumbered(o) ? o.frameNumber : checkpoints_), false, o,
                       {}, &diagnostics_);
}

void Renderer::nameOutputs(OutputPlan& plan, const scene::Options& o) {
    for (OutputSpec& s : plan.pictures) {
        const display::DriverDescriptor* driver = display::findDriver(s.type);
        const bool first = firstPicture_ && firstPicture_->file.empty() && s.name == settings_.output;
        if (!driver || driver->writes) s.name = names_.take("display", s.name, s.map, o, s.place, &diagnostics_);
        if (first) firstPicture_->file = s.name;
    }
}

void Renderer::passOver(const scene::Options& given) {
    scene::Options o = given;
    if (!read_.empty()) markRead(o);
    names_.nextWorld();
    const bool one = !settings_.output.empty() && !isMapPass(o);
    if (one && settings_.output != "-") numbersFrame();
    if (one) names_.take("display", numberedName(settings_.output, o.frameNumber), false, o, {}, nullptr);
    for (const NamedDisplay& d : displaysOf(o, isMapPass(o) ? settingsOfMaps(settings_) : settings_, !one))
        names_.take("display", d.display.name, isMap(d.display), o, d.display.place, nullptr);
}

void Renderer::passOverTexture(const std::vector<std::string>& files) {
    for (const std::string& f : files) names_.release(f);
}

ReadPolicy Renderer::readPolicy() const {
    ReadPolicy policy = readPolicyOf(settings_.scenePath, settings_.allowRead);
    policy.folders.insert(policy.folders.end(), written_.begin(), written_.end()); // each includes its subfolders
    if (inProcess()) policy.before = [p = processes_](const std::string& name) { p->awaitRead(name); };
    return policy;
}

void Renderer::finish() {
    const std::string given = pictureOptions(settings_);
    if (maps_ == 0 || pictures_ > 0 || given.empty()) return;
    diagnostics_.report(
        Severity::Warning, Rie::NoError, {},
        given + ": without effect; the scene makes maps only (depth, shadow, or what a Make request reads), and those "
                "stay as the scene says",
        "a Display of the mode \"rgba\" makes a picture");
}

bool Renderer::canBegin() {
    const OutputPolicy anywhere{".", true};
    bool all = true;
    for (const std::string& name : {settings_.statsFile, settings_.checkpoint, settings_.pixel ? "" : settings_.output})
        if (!name.empty() && name != "-") all &= OutputFile::canBeWritten(name, anywhere, diagnostics_);
    outcome_.outputFailed |= !all;
    return all;
}

bool Renderer::canWrite(const OutputPlan& plan, const std::string& checkpoint, bool part) {
    const OutputPolicy anywhere{".", true};
    bool all = true;
    const auto attempt = [&](const std::string& name, const OutputPolicy& policy, const SourcePlace& place) {
        all &= OutputFile::canBeWritten(name, policy, diagnostics_, place);
    };
    if (!settings_.statsFile.empty()) attempt(settings_.statsFile, anywhere, {});
    if (!checkpoint.empty()) attempt(checkpoint, anywhere, {});
    if (settings_.pixel) return all; // no picture is written
    for (const OutputSpec& s : plan.pictures) {
        const display::DriverDescriptor* driver = display::findDriver(s.type);
        if (driver && !driver->writes) continue;
        const OutputPolicy policy{".", settings_.allowWrite || s.userFile};
        attempt(s.name, policy, s.place);
        if (part && &s == &plan.pictures.front()) attempt(sidecarName(s.name), policy, s.place);
    }
    return all;
}

bool Renderer::resume(const std::string& checkpoint, const FilmDescription& wanted, std::unique_ptr<Film>& film) {
    if (std::error_code e; !std::filesystem::exists(checkpoint, e)) {
        Diagnostic begins{Severity::Info,
                          Rie::NoError,
                          {checkpoint},
                          "there is no checkpoint yet; rendering starts from the beginning",
                          {},
                          {}};
        begins.always = true;
        diagnostics_.report(std::move(begins));
        return true;
    }
    film = loadPart(checkpoint, diagnostics_);
    if (film && film->description() == wanted) return true;
    if (film)
        diagnostics_.report(
            Severity::Error, Rie::Consistency, {checkpoint},
            "the checkpoint belongs to another " + differing(film->description(), wanted) +
                "; it is not changed, and nothing is rendered",
            "render the scene it belongs to, choose another file, or replace it with --restart instead of --resume");
    else
        diagnostics_.report(Severity::Warning, Rie::NoError, {checkpoint},
                            "the checkpoint is not changed, and nothing is rendered",
                            "--restart instead of --resume starts from the beginning and replaces it");
    film.reset();
    return false;
}

bool Renderer::mayReplace(const std::string& checkpoint) {
    std::error_code e;
    if (settings_.resume || settings_.restart || checkpoint.empty() || !std::filesystem::exists(checkpoint, e)) return true;
    diagnostics_.report(Severity::Error, Rie::BadFile, {checkpoint},
                        "the checkpoint already exists; it is not changed, and nothing is rendered",
                        "--resume continues it, --restart starts from the beginning and replaces it");
    return false;
}

} // namespace alpenglow::render
