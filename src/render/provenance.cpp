#include "render/provenance.h"
#include "scene/scene.h"
#include <cmath>
#include <ctime>
#include <fmt/format.h>
#include <unistd.h>

namespace alpenglow::render {

std::string pixelOptions(const RenderSettings& s) {
    std::string t;
    const auto add = [&](const std::string& option) { t += (t.empty() ? "" : " ") + option; };
    if (!s.hider.empty()) add("--hider " + s.hider);
    if (s.width > 0 && s.height > 0) add(fmt::format("--format {}x{}", s.width, s.height));
    if (s.resolutionFactor != 1) add(fmt::format("--resolution-factor {}", s.resolutionFactor));
    if (s.crop) add(fmt::format("--crop {},{},{},{}", (*s.crop)[0], (*s.crop)[1], (*s.crop)[2], (*s.crop)[3]));
    if (s.maxDepth >= 0) add(fmt::format("--max-depth {}", s.maxDepth));
    if (s.sampleClamp > 0) add(fmt::format("--sample-clamp {}", s.sampleClamp));
    if (!s.direct) add("--no-direct");
    if (!s.indirect) add("--no-indirect");
    if (s.unbiased) add("--unbiased");
    if (s.localRoulette) add("--preset slproject");
    if (s.gamma) add(fmt::format("--gamma {}", *s.gamma));
    if (s.srgb) add("--gamma srgb");
    if (!s.dialect.empty()) add("--dialect " + s.dialect);
    return t;
}

void addProvenance(PictureFacts& p, const RenderSettings& s, const scene::Frame& frame, const std::string& hider,
                   const std::string& sceneHash) {
    auto& m = p.metadata;
    m["Software"] = s.software;
    m["hider"] = hider;
    m["sceneHash"] = sceneHash;
    if (!s.sceneFile.empty()) m["scene"] = s.sceneFile;
    if (frame.options.frameNumber > 0) m["frame"] = std::to_string(frame.options.frameNumber);
    if (frame.options.projection == "perspective") m["fov"] = fmt::format("{:.9g}", frame.options.fov);
    if (s.sampleClamp > 0) m["sampleClamp"] = fmt::format("{}", s.sampleClamp); // the picture is biased
    if (const std::string options = pixelOptions(s); !options.empty()) m["options"] = options;
}

void addStamp(PictureFacts& p, const RenderSettings& s, double seconds) {
    auto& m = p.metadata;
    m["command"] = s.command;
    m["host"] = hostName();
    m["date"] = dateText();
    m["seconds"] = fmt::format("{:.3f}", std::isfinite(seconds) ? seconds : 0);
    m["threads"] = std::to_string(s.threads);
}

std::string hostName() {
    char name[256] = "";
    return gethostname(name, sizeof name - 1) == 0 ? name : "";
}

std::string dateText() {
    const std::time_t now = std::time(nullptr);
    std::tm utc{};
    gmtime_r(&now, &utc);
    char text[32];
    return std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc) ? text : "";
}

} // namespace alpenglow::render
