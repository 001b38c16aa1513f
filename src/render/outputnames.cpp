#include "render/outputnames.h"
#include "base/file.h"
#include "display/drivers/picture.h"
#include "scene/scene.h"
#include <algorithm>
#include <cctype>
#include <cstdio>

namespace alpenglow::render {
namespace {

/// Place of the frame number in a name: [begin, end), width and padding. end = 0: none.
struct NumberPlace {
    size_t begin = 0, end = 0;
    int width = 0;
    bool zeros = true;
};

NumberPlace numberPlace(const std::string& name) {
    constexpr size_t kWidest = 16;
    for (size_t at = name.find_first_of("%#"); at != std::string::npos; at = name.find_first_of("%#", at + 1)) {
        if (name[at] == '#') {
            const size_t end = std::min(name.find_first_not_of('#', at), name.size());
            return {at, end, int(std::min(end - at, kWidest)), true};
        }
        size_t end = at + 1;
        int width = 0;
        const bool zeros = end < name.size() && name[end] == '0';
        while (end < name.size() && name[end] >= '0' && name[end] <= '9' && end - at < 4)
            width = 10 * width + (name[end++] - '0');
        if (end < name.size() && name[end] == 'd' && width <= int(kWidest)) return {at, end + 1, width, zeros};
    }
    return {};
}

/// Inserts .text before the extension of a name.
std::string beforeExtension(const std::string& name, const std::string& text) {
    const std::string e = extensionOf(name);
    const size_t dot = name.size() - (e.empty() ? 0 : e.size() + 1);
    return name.substr(0, dot) + "." + text + name.substr(dot);
}

} // namespace

bool hasFrameNumber(const std::string& name) { return numberPlace(name).end > 0; }

std::string withFrame(const std::string& name, int frame) {
    const NumberPlace p = numberPlace(name);
    if (p.end == 0) return name;
    char digits[32];
    std::snprintf(digits, sizeof digits, p.zeros ? "%0*d" : "%*d", p.width, frame);
    return name.substr(0, p.begin) + digits + name.substr(p.end);
}

std::string numberedName(const std::string& name, int number) {
    if (hasFrameNumber(name)) return withFrame(name, number);
    char digits[32];
    std::snprintf(digits, sizeof digits, "%04d", number);
    return beforeExtension(name, digits);
}

std::string extensionOf(const std::string& file) {
    const size_t slash = file.find_last_of('/'), dot = file.find_last_of('.');
    if (dot == std::string::npos || (slash != std::string::npos && dot < slash)) return "";
    std::string e = file.substr(dot + 1);
    for (char& c : e) c = char(std::tolower(static_cast<unsigned char>(c)));
    return e;
}

bool isNumbered(const scene::Options& o) { return o.inFrame || o.frameNumber != 0; }

bool isMap(const scene::Display& d) {
    if (d.read) return true;
    const display::DriverDescriptor* driver = display::findDriver(d.type);
    if (driver == &display::zfileDriver || driver == &display::deepDriver) return true;
    return d.mode == "z" && driver != &display::framebufferDriver && !(driver && !driver->writes);
}

bool isMapPass(const scene::Options& o) {
    const auto writes = [](const scene::Display& d) {
        const display::DriverDescriptor* driver = display::findDriver(d.type);
        return !driver || driver->writes;
    };
    bool any = false;
    for (const scene::Display& d : o.displays) {
        if (writes(d) && !isMap(d)) return false;
        any |= isMap(d);
    }
    return any;
}

RenderSettings settingsOfMaps(const RenderSettings& s) {
    RenderSettings m = s;
    const RenderSettings none;
    m.output = m.savePattern = m.checkpoint = "";
    m.displays.clear();
    m.width = m.height = 0;
    m.resolutionFactor = 1;
    m.crop.reset();
    m.hider.clear();
    m.spp = 0;
    m.noise = m.seconds = 0;
    m.samples.reset();
    m.sampleClamp = none.sampleClamp;
    m.localRoulette = false;
    m.gamma.reset();
    m.srgb = false;
    m.resume = false;
    m.pixel.reset();
    m.pixelSample.reset();
    return m;
}

std::string pictureOptions(const RenderSettings& s) {
    std::string all;
    const auto add = [&](bool given, const char* name) {
        if (given) all += (all.empty() ? "" : ", ") + std::string(name);
    };
    add(!s.output.empty(), "-o");
    add(!s.displays.empty(), "--display");
    add(s.width > 0, "--format");
    add(s.resolutionFactor != 1, "--resolution-factor");
    add(s.crop.has_value(), "--crop");
    add(s.gamma.has_value() || s.srgb, "--gamma");
    add(!s.hider.empty(), "--hider");
    add(s.spp > 0, "--spp");
    add(s.pixel.has_value(), "--pixel");
    return all;
}

/// Whether -o keeps a display: not the first, with a file that holds more than the picture.
static bool isBeside(const scene::Display& d, const scene::Options& o, const RenderSettings& s) {
    if (s.output.empty() || &d == &o.displays.front()) return false;
    const display::DriverDescriptor* driver = display::findDriver(d.type);
    if (driver == &display::cryptomatteDriver) return true;
    return (!driver || driver->writes) && d.mode != "rgb" && d.mode != "rgba" && d.mode != "a";
}

std::vector<NamedDisplay> displaysOf(const scene::Options& o, const RenderSettings& settings, bool pictures) {
    std::vector<NamedDisplay> all;
    for (const scene::Display& d : o.displays)
        if (pictures || isMap(d) || isBeside(d, o, settings)) all.push_back({d, false});
    for (const scene::Display& d : settings.displays) {
        all.push_back({d, true});
        all.back().display.name = isNumbered(o) ? numberedName(d.name, o.frameNumber) : withFrame(d.name, o.frameNumber);
    }
    if (pictures && all.empty()) all.push_back({});
    for (const auto& [handle, d] : o.mattes) all.push_back({d, false});
    for (NamedDisplay& n : all) {
        if (n.user) continue;
        std::string& name = n.display.name;
        if (!name.empty() && name[0] == '+') name.erase(0, 1);
        name = withFrame(name, o.frameNumber);
    }
    return all;
}

bool OutputNames::mayTake(const std::string& name, bool map) const {
    const auto i = owners_.find(fileIdentity(name));
    return i == owners_.end() || (map && i->second.map && i->second.world != world_);
}

std::string OutputNames::take(const std::string& kind, const std::string& name, bool map, const scene::Options& o,
                              const SourcePlace& place, Diagnostics* diags) {
    std::string chosen = name;
    if (name == "-") return name; // standard output: one after the other
    if (!mayTake(name, map)) {
        const Owner earlier = owners_[fileIdentity(name)];
        const bool sameWorld = earlier.world == world_;
        const std::string base = sameWorld || !isNumbered(o) ? name : numberedName(name, o.frameNumber);
        chosen = base;
        for (int k = 2; !mayTake(chosen, map); ++k) chosen = beforeExtension(base, std::to_string(k));
        std::string who = sameWorld ? "another output" : "an earlier frame";
        if (earlier.place.line > 0)
            who = (sameWorld ? "the display" : "the earlier frame") + std::string(" of ") + earlier.place.file + ":" +
                  std::to_string(earlier.place.line);
        if (diags)
            diags->report(Severity::Warning, Rie::BadFile, place,
                          kind + " \"" + name + "\": " + who + " writes that file; this one is written as \"" + chosen + "\"",
                          sameWorld ? "give each a name of its own" : "#### or %04d in a name becomes the number of the frame");
    }
    owners_[fileIdentity(chosen)] = {world_, map, place};
    return chosen;
}

void OutputNames::release(const std::string& name) { owners_.erase(fileIdentity(name)); }

} // namespace alpenglow::render
