#include "render/curve.h"
#include "display/driver.h"
#include <algorithm>

namespace alpenglow::render {
namespace {

using Source = OutputVariable::Source;

/// Format of the file that a display writes; nothing: not a picture file.
std::optional<display::Format> formatOf(const OutputSpec& s) {
    const display::DriverDescriptor* d = display::findDriver(s.type);
    const std::string driver = d ? d->names.front() : "file"; // unknown types are written by extension
    if (d && d->format) return d->format;
    if (driver == "null" || driver == "zfile" || driver == "shadow") return {};
    return display::formatOfExtension(s.name).value_or(display::Format::Tiff);
}

std::string powerText(const OutputSpec& s) {
    char text[64];
    if (s.gain == 1 && s.gamma == 1) return "none";
    if (s.gain == 1) std::snprintf(text, sizeof text, "gamma %.4g", double(s.gamma));
    else std::snprintf(text, sizeof text, "gain %.4g, gamma %.4g", double(s.gain), double(s.gamma));
    return text;
}

} // namespace

bool isLookedAt(const OutputSpec& s) {
    const auto format = formatOf(s);
    if (!format || *format == display::Format::Exr) return false;
    if (std::none_of(s.variables.begin(), s.variables.end(), [](const OutputVariable& v) { return v.shown(); })) return false;
    // A TIFF with depth in addition to colours has floats.
    return *format != display::Format::Tiff ||
           (!s.rgba.floating() && s.rgba.max <= 255 && s.rgba.min >= 0 && !(s.has(Source::Z) && s.z.floating()));
}

void chooseCurve(OutputSpec& s, const OutputBasis& b) {
    s.srgb = false;
    s.curve.clear();
    if (!isLookedAt(s)) return;
    if (b.srgbAsked) {
        s.srgb = true;
        s.gamma = 1;
        s.curve = "sRGB, by --gamma";
    } else if (b.gammaGiven) s.curve = powerText(s) + ", by --gamma";
    else if (s.ownExposure) s.curve = powerText(s) + ", by the display's exposure";
    else if (b.exposureGiven) s.curve = powerText(s) + ", by Exposure";
    else if (s.quantizeAsked || b.rgba.set) s.curve = "none, by Quantize";
    else if (!b.path) s.curve = "none: numbers are as shaders compute them (--gamma srgb changes that)";
    else {
        s.srgb = true;
        s.curve = "sRGB";
    }
}

std::string curvesOf(const OutputPlan& plan) {
    std::vector<std::pair<std::string, std::string>> all; // curve, names
    for (const OutputSpec& s : plan.pictures) {
        if (s.curve.empty()) continue;
        auto same = std::find_if(all.begin(), all.end(), [&](const auto& c) { return c.first == s.curve; });
        if (same == all.end()) all.emplace_back(s.curve, s.name);
        else same->second += " " + s.name;
    }
    if (all.empty()) return "none: the numbers are light";
    if (all.size() == 1) return all.front().first;
    std::string text;
    for (const auto& [curve, names] : all) text += (text.empty() ? "" : "; ") + curve + " (" + names + ")";
    return text;
}

} // namespace alpenglow::render
