// Attenuation of shadow rays by surfaces: a constant if known in advance, else a kernel.
#include "world/mutableworld.h"
#include "world/surfaces.h"
#include <algorithm>

namespace alpenglow::world {

void MutableWorld::sortByOpacity(std::span<const uint32_t> visibility) {
    mediaOverrule_ = std::any_of(media_.begin(), media_.end(), [&](const Medium& m) { return m.priority != media_[0].priority; });
    if (allOpaque_) return;
    for (size_t i = 0; i < shapes_.size(); ++i) {
        const bool opaque = bindings_[size_t(bindingOf_[i])].opacity.opaque();
        byOpacity_.opaque.push_back(opaque);
        byOpacity_.clear.push_back(!opaque);
        if (!opaque) byOpacity_.clearBounds.add(shapes_[i]->bounds());
    }
    constexpr size_t kFew = 24; // triangles: searched without a tree
    std::vector<geometry::ShapeRef> shapes;
    std::vector<uint32_t> seen;
    size_t triangles = 0;
    for (size_t i = 0; i < shapes_.size() && triangles <= kFew; ++i) {
        if (!byOpacity_.clear[i]) continue;
        triangles += shapes_[i]->exact() || shapes_[i]->placed() ? kFew : shapes_[i]->mesh().triangles();
        shapes.push_back(shapes_[i]);
        seen.push_back(visibility[i]);
        byOpacity_.numbers.push_back(uint32_t(i));
    }
    if (triangles > kFew || fades_ || accel_->hasSolids() || deferred_) return;
    Diagnostics reported; // messages come from the complete shader
    byOpacity_.few = std::make_unique<accel::Accel>(shapes, seen, reported);
    if (!byOpacity_.few->takesRows()) byOpacity_.few.reset();
}

void MutableWorld::findShadowVisibility(std::span<const uint32_t> visibility) {
    constexpr uint32_t kLobes = accel::kDiffuse | accel::kSpecular;
    std::vector<geometry::ShapeRef> shapes;
    std::vector<uint32_t> seen;
    for (size_t i = 0; i < shapes_.size(); ++i) {
        const uint32_t v = visibility[i];
        const Opacity& opacity = bindings_[size_t(bindingOf_[i])].opacity;
        shadowVisibility_.opacity |= opacity.differs;
        if (!(v & accel::kTransmission) && (v & kLobes)) {
            shapes.push_back(shapes_[i]);
            seen.push_back(v & kLobes);
        } else if ((v & accel::kTransmission) && (v & kLobes) != kLobes) {
            for (const uint32_t bit : {accel::kDiffuse, accel::kSpecular}) {
                if (v & bit) continue;
                std::vector<uint8_t>& only = shadowVisibility_.shadowsOnly[bit == accel::kSpecular];
                only.resize(shapes_.size());
                only[i] = 1;
            }
        }
    }
    if (shapes.empty() || accel_->hasSolids() || deferred_) return;
    Diagnostics reported; // the tree of all shapes has reported
    shadowVisibility_.lobesOnly = std::make_unique<accel::Accel>(shapes, seen, reported, true);
}

void WorldImpl::goOn(accel::Ray& ray, const accel::Hit& h) const {
    ray.tnear = std::nextafter(h.t, 0.f); // other surfaces may be at the same distance
    ray.passed = h.distance;
    ray.excludeShape = h.shape;
    ray.excludePrim = h.prim;
}

Opacity MutableWorld::opacityOf(const SurfaceBinding& b, const geometry::Shape& shape, std::string mode,
                                const std::vector<std::string>& varying, Evaluator& evaluator, Diagnostics& d) {
    const scene::Attributes& a = shape.attributes();
    const bool asked = !mode.empty();
    if (!asked) mode = "shader";
    for (const char* name :
         {"render:casts_shadows", "shade:transmissionhitmode", "visibility:transmission"}) // BMRT's, PRMan's, the older ones
        if (const scene::Param* p = a.value(name); p && !asked && !p->strings.empty()) mode = p->strings[0];
    InstanceRef surface = b.surface;
    std::string what = b.surfaceS.kernel->facts().opacity;
    BoundKernel k;
    const rsl::Shader& text = surface->program->shader();
    if (text.object && std::any_of(text.nested.begin(), text.nested.end(), [](const auto& f) { return f->name == "opacity"; })) {
        // The method opacity() determines shadows, whatever later methods do to Oi.
        auto alone = std::make_shared<ShaderInstance>(*surface);
        alone->parameters.strings[rsl::kOpacityAlone] = "1";
        surface = alone;
        k = kernel(*surface, {"Oi"}, varying, false, false, d);
        if (k) what = k.kernel->facts().opacity;
    }
    bool varies = shape.findPrimvar("Os") >= 0;
    Opacity result;
    if (mode != "shader") result.differs = what != (mode == "opaque" ? "1" : "Os");
    result.constant = mode == "opaque" ? Color(1) : a.opacity;
    if (mode == "opaque" || mode == "primitive" || (mode == "Os" && !varies) || (what == "Os" && !varies)) return result;
    if (what == "1") {
        result.constant = Color(1);
        return result;
    }
    if (!k) k = kernel(*surface, {"Oi"}, varying, false, false, d);
    if (!k || k.plan->Oi < 0) return result;
    if (k.kernel->facts().suspends) {
        d.reportOnce("opacity:" + b.surface->name, {Severity::Warning,
                                                    Rie::NoError,
                                                    b.surface->place,
                                                    "the opacity of shader \"" + b.surface->name +
                                                        "\" depends on traced rays; its shadow has the primitive's Opacity",
                                                    {},
                                                    {}});
        return result;
    }
    for (const SiteInfo& s : k.sites) result.differs |= s.kind == SiteKind::RayInfo || s.kind == SiteKind::RayLevel;
    bool constant = !varies && k.kernel->sites().empty();
    for (const auto& in : k.kernel->inputs()) {
        const rsl::InputName name = rsl::InputName::parse(in.name);
        const bool parameter =
            name.kind == rsl::InputName::Kind::Parameter && std::find(varying.begin(), varying.end(), name.name) == varying.end();
        constant &= parameter || in.name == "Os" || (in.name == "Cs" && shape.findPrimvar("Cs") < 0);
    }
    if (!constant) {
        result.kernel = std::move(k);
        return result;
    }
    std::vector<ShadePoint> point(1);
    point[0].shape = &shape;
    Color o;
    evaluator.run(k, nullptr, point, b.surface->view(), [&](const shading::Batch& batch) { o = batch.color(k.plan->Oi, 0); });
    for (int i = 0; i < 3; ++i) result.constant[i] = std::isfinite(o[i]) ? std::clamp(o[i], 0.f, 1.f) : 1;
    return result;
}

bool SurfaceBinder::vanishes(const SurfaceBinding& b) const {
    const BoundKernel& k = b.surfaceS;
    const auto& facts = k.kernel->facts();
    if (!k.kernel->inputs().empty() || !k.kernel->sites().empty() || facts.suspends || facts.lightLoops || b.displacement ||
        b.moveS || b.atmosphere.shader || b.areaLight >= 0 || b.matte || k.plan->Ci < 0 || k.plan->Oi < 0)
        return false;
    std::vector<ShadePoint> point(1);
    bool nothing = false;
    evaluator_.run(k, nullptr, point, b.surface->view(), [&](const shading::Batch& batch) {
        nothing = batch.color(k.plan->Ci, 0) == Color(0) && batch.color(k.plan->Oi, 0) == Color(0);
    });
    return nothing;
}

} // namespace alpenglow::world
