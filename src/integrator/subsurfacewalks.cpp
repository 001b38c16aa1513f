// Reads parameters of subsurface() calls, and Attribute "subsurface" of shapes.
#include "integrator/subsurfacewalks.h"
#include "integrator/context.h"
#include "integrator/occlusioncalls.h"
#include "integrator/stageset.h"
#include "integrator/subsurface.h"
#include "world/raysets.h"

namespace alpenglow::integrator {

SubsurfaceWalks::SubsurfaceWalks(const StageSet& s) : Stage(s.context), set_(s), occlusion_(s.occlusion) {}

static constexpr int kSamplesElsewhere = 16; ///< samples of a call under hidden and raytrace

int SubsurfaceWalks::groupNamed(const std::string& name) {
    return groups_.try_emplace(name, int(groups_.size()) + 1).first->second;
}

const SubsurfaceWalks::OfShape& SubsurfaceWalks::ofShape(const scene::Attributes& a) {
    std::shared_ptr<const OfShape>& known = shapes_[&a];
    if (known) return *known;
    auto s = std::make_shared<OfShape>(a);
    const std::string name = attributeText(a, "subsurface:groupname");
    s->group = groupNamed(!name.empty() ? name : '\1' + std::to_string(shapes_.size()));
    known = s;
    return *known;
}

void SubsurfaceWalks::request(BatchContext& c, const SiteInfo& s, const ShadePoint& p, const std::function<float(int)>& f,
                              LobeVertex& l) {
    const SubsurfaceSite& site = *s.subsurface;
    const OfShape& of = ofShape(p.shape->attributes());
    const float many = of.samples > 0 ? float(of.samples) : rules_.pickOne ? 1 : float(kSamplesElsewhere);
    const float samples = site.samples < 0 ? many : f(site.samples);
    l.samples = occlusion_.samplesOf(std::max(1.f, samples), p.shape, s, c); // not a number: 1
    l.rays = &kSpecularKind; // of a single walk: with --no-indirect the light of lights still counts
    l.lights = false;
    l.subsurface = int32_t(media.size());
    media.push_back(mediumOf(s, p, f));
}

SubsurfaceMedium SubsurfaceWalks::mediumOf(const SiteInfo& s, const ShadePoint& p, const std::function<float(int)>& f) {
    const SubsurfaceSite& site = *s.subsurface;
    const OfShape& of = ofShape(p.shape->attributes());
    SubsurfaceMedium b = subsurfaceMediumOf(site, of, f, albedoInversions);
    b.group = site.group.empty() ? of.group : groupNamed(site.group);
    const auto triple = [&](int row) { return row < 0 ? Vec3() : Vec3(f(row), f(row + 1), f(row + 2)); };
    b.normal = normalizeOr(triple(site.normal), Vec3());
    b.from = triple(site.point);
    // For a displaced surface, the facet and the shader's point may differ by a micropolygon.
    const float apart = p.surface.displaced ? length(p.surface.dPdu) * p.du + length(p.surface.dPdv) * p.dv : 0;
    const float away = length(b.from - p.P);
    b.ownOrigin = std::isfinite(away) && away > geometry::roundingError(p.P) + 4 * p.surface.pError + apart;
    return b;
}

void SubsurfaceWalks::walk(BatchContext& c, Sched& sched) {
    const std::vector<SubsurfaceMedium> ofLobes = std::exchange(media, {});
    const std::vector<WalkAsked> asked = std::exchange(walks, {});
    if (!asked.empty()) Walks(set_, c, asked, ofLobes).run(sched);
}

void SubsurfaceWalks::clear() {
    walks.clear();
    media.clear();
}

} // namespace alpenglow::integrator
