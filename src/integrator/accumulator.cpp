// Adds light to targets. All light passes through this file.
#include "integrator/accumulator.h"
#include "integrator/context.h"
#include "integrator/lightpathstates.h"
#include "integrator/stageset.h"
#include <algorithm>

namespace alpenglow::integrator {

Accumulator::Accumulator(const StageSet& s) : Stage(s.context), paths_(s.paths) {}

void Accumulator::begin(size_t samples) {
    results.resize(samples);
    lightTargets.clear();
    partTargets.clear();
    aovSplits.clear();
}

void Accumulator::contribute(Sched& sched, const Contribution& d) {
    if (!isFinite(d.light) && d.event != LightEvent::Output) // the target counts those
        return notFinite(d.path, d.event == LightEvent::Sampled ? "light that is sampled" : "light", d.of);
    // Rays of the caustic guide carry only the light of lights that they hit; all other light belongs to the lobe's own ray.
    if (d.path && d.path->guided()) {
        if (d.event != LightEvent::Met && d.event != LightEvent::Sky) return;
        ++counters_.guidedLit;
        counters_.guidedLight += uint64_t(std::clamp(double(luminance(d.light)), 0.0, 1e9) / Counters::kLightUnit);
    }
    sched.add(d.target, d.light);
    contributePart(sched, d.path, d.end, d.light);
    for (int32_t share = d.share; share >= 0; share = aovSplits[size_t(share)].next)
        sched.add(aovSplits[size_t(share)].target, d.light * aovSplits[size_t(share)].ratio);
}

void Accumulator::contributePart(Sched& sched, const PathRay* path, uint16_t end, const Color& light) {
    if (end == 0 || !path || !path->sample || !isFinite(light)) return;
    const size_t parts = size_t(paths_.automaton->parts());
    sched.add(partTargets[size_t(path->sample->path) * parts + size_t(paths_.automaton->part(end))], light);
}

void Accumulator::notFinite(const PathRay* ray, const std::string& what, const SourcePlace& place) {
    ++counters_.nonFinite;
    if (ray && ray->sample && ray->sample->path >= 0) invalidSamples.push_back(ray->sample->path);
    diagnostics_.reportOnce(
        "nonfinite:" + what + place.file + std::to_string(place.line),
        {Severity::Warning, Rie::Math, place, what + " is not a finite number; affected samples are dropped", {}, {}});
}

void Accumulator::notFinite(const PathRay* ray, const char* what, const ShaderInstance* of) {
    if (!of) return notFinite(ray, what, SourcePlace{});
    notFinite(ray, std::string(what) + " of shader \"" + of->name + "\"", of->place);
}

void Accumulator::notFinite(const BatchContext& c, const PathRay& ray, uint32_t site) {
    if (site >= c.bound->sites.size()) return notFinite(&ray, "light that is scattered in a medium", nullptr); // no call site
    const rsl::ir::Site& s = *c.bound->sites[site].site;
    const auto& files = c.bound->kernel->files();
    notFinite(&ray, "light of " + s.op + "(), or its weight,",
              {s.place.file < int(files.size()) ? files[size_t(s.place.file)] : "", s.place.line, s.place.column});
}

/// Splits light that passed a volume shader: light of the surface behind it (`met`), and the volume's own.
void Accumulator::contributeThroughVolume(Sched& sched, const PathRay& ray, const Color& met, const Color& shown) {
    if (ray.guided()) return;
    contributePart(sched, &ray, paths_.next(ray.path, paths_.object), ray.weight * met);
    contributePart(sched, &ray, paths_.next(paths_.next(ray.path, paths_.volume), paths_.object), ray.weight * (shown - met));
}

} // namespace alpenglow::integrator
