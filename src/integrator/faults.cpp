// Values that are not finite numbers. What a shader, a light or a lobe makes of them spoils the whole camera sample:
// Integrator::trace() gives it back as not a number, so that the film leaves it out, counts it and names it (--pixel x,y,sample).
#include "integrator/engine.h"

namespace alpenglow::transport {

void Engine::notFinite(const PathRay* ray, const std::string& what, const SourcePlace& place) {
    ++counters.nonFinite;
    if (ray && ray->sample && ray->sample->path >= 0) spoiled_.push_back(ray->sample->path);
    diagnostics_.reportOnce(
        "nonfinite:" + what + place.file + std::to_string(place.line),
        {Severity::Warning, Rie::Math, place, what + " is not a finite number; samples that meet it are left out", {}, {}});
}

void Engine::notFinite(const PathRay* ray, const char* what, const ShaderInstance* of) {
    if (!of) return notFinite(ray, what, SourcePlace{});
    notFinite(ray, std::string(what) + " of shader \"" + of->name + "\"", of->place);
}

void Engine::notFinite(const BatchContext& c, const PathRay& ray, uint32_t site) {
    if (site >= c.bound->sites.size()) return notFinite(&ray, "light that is scattered in a medium", nullptr); // no call's
    const rsl::ir::Site& s = *c.bound->sites[site].site;
    const auto& files = c.bound->kernel->files();
    notFinite(&ray, "light of " + s.op + "(), or its weight,",
              {s.place.file < int(files.size()) ? files[size_t(s.place.file)] : "", s.place.line, s.place.column});
}

} // namespace alpenglow::transport
