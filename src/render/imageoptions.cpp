// Options and hider parameters for image samples.
#include "render/rendering.h"
#include "scene/scene.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::render {

void gridOf(const scene::Options& o, const RenderSettings& s, int* nx, int* ny) {
    if (const LensGrid lens = lensGridOf(o); lens.on()) {
        *nx = lens.x;
        *ny = lens.y;
        return;
    }
    auto whole = [](float v) { return v >= 1 ? int(std::min(v, 4096.f) + 0.5f) : 1; };
    *nx = whole(o.pixelSamplesX);
    *ny = whole(o.pixelSamplesY);
    if (s.spp > 0) {
        uint32_t spp = std::min(s.spp, 4096u * 4096u);
        *nx = int(std::ceil(std::sqrt(double(spp))));
        *ny = int((spp + uint32_t(*nx) - 1) / uint32_t(*nx));
    }
}

Jitter jitterOf(const scene::Options& o, Diagnostics& diags) {
    if (lensGridOf(o).on()) return Jitter::Middle;
    const scene::Param* p = scene::find(o.hiderParams, "jitter");
    if (!p)
        if (auto i = o.values.find("hider:jitter"); i != o.values.end()) p = &i->second;
    if (!p || p->numbers.empty()) return Jitter::Jittered;
    int j = int(p->numbers[0]);
    if (j >= 0 && j <= 2) return Jitter(j);
    diags.report(Severity::Error, Rie::Range, p->place, "hider parameter \"jitter\" must be 0, 1 or 2; 1 is used");
    return Jitter::Jittered;
}

bool shadesMicropolygons(const scene::Options& o, bool hidden, const Camera& camera, Diagnostics& diags) {
    const std::string otherwise = hidden ? "micropolygon" : "sample";
    const scene::Param* p = scene::find(o.hiderParams, "shading");
    if (!p && hidden)
        if (auto i = o.values.find("hidden:shading"); i != o.values.end()) p = &i->second;
    std::string how = p && !p->strings.empty() ? p->strings[0] : otherwise;
    if (how != "micropolygon" && how != "sample") {
        diags.report(Severity::Error, Rie::Range, p->place,
                     "\"shading\" of a hider is \"micropolygon\" or \"sample\"; \"" + otherwise + "\" is used");
        how = otherwise;
    }
    if (how == "sample") return false;
    if (!hidden && (camera.hasLens() || camera.lensGrid().on() || camera.shutterClose() > camera.shutterOpen())) {
        diags.report(Severity::Warning, Rie::Incapable, p->place,
                     "\"shading\" \"micropolygon\" is ignored: under raytrace a lens or an open shutter has every sample shaded "
                     "where and when it is",
                     "Hider \"hidden\" shades micropolygons once, when the shutter opens, and moves them");
        return false;
    }
    return !camera.stereo(); // each eye sees micropolygons of its own
}

Refinement refinementOf(const scene::Options& o, const Camera& camera, Diagnostics& diags) {
    Refinement r;
    const scene::Param* samples = scene::find(o.hiderParams, "aaSamples");
    const scene::Param* threshold = scene::find(o.hiderParams, "aaThreshold");
    const scene::Param* first = samples ? samples : threshold;
    if (!first || (samples && samples->numbers.empty())) return r;
    if (o.hider != "raytrace") {
        diags.report(Severity::Warning, Rie::Incapable, first->place,
                     "\"" + first->name + "\" requires the hider raytrace; it is ignored");
        return r;
    }
    r.side = !samples ? 3 : std::isnan(samples->numbers[0]) ? 0 : int(std::clamp(samples->numbers[0], 0.f, 100.f));
    if (r.side != 1 && (r.side < 3 || r.side > 9 || r.side % 2 == 0)) {
        const int near = std::clamp(r.side | 1, 1, 9);
        diags.report(Severity::Error, Rie::Range, first->place,
                     "hider parameter \"aaSamples\" is 1 (off), 3, 5, 7 or 9; " + std::to_string(near) + " is used");
        r.side = near;
    }
    if (threshold && !threshold->numbers.empty()) r.threshold = threshold->numbers[0];
    if (!(r.threshold >= 0)) {
        diags.report(Severity::Error, Rie::Range, threshold->place, "hider parameter \"aaThreshold\" must be >= 0; 0.3 is used");
        r.threshold = 0.3f;
    }
    if (r.on() && (camera.hasLens() || camera.lensGrid().on() || camera.shutterClose() > camera.shutterOpen())) {
        diags.report(Severity::Warning, Rie::Incapable, first->place,
                     "\"aaSamples\" is ignored: a lens or an open shutter takes the rays of PixelSamples in every pixel");
        r.side = 1;
    }
    return r;
}

} // namespace alpenglow::render
