#include "integrator/gatherrows.h"
#include "integrator/intersector.h"
#include "integrator/opacities.h"
#include "integrator/stageset.h"
#include "world/raysets.h"
#include <bit>
#include <set>

namespace alpenglow::integrator {

void putGathered(float* row, const GatherSite::Output& o, std::initializer_list<float> numbers) {
    if (int(numbers.size()) != o.rows || o.elements || o.open || o.kind == rsl::ir::Kind::String) return; // different type
    row[o.at] = 1;
    std::copy(numbers.begin(), numbers.end(), row + o.at + 1);
}
void putGathered(float* row, const GatherSite::Output& o, const Vec3& v) { putGathered(row, o, {v.x, v.y, v.z}); }

/// Writes a value of any type that fits the variable.
void putGathered(float* row, const GatherSite::Output& o, const ShaderValue& t) {
    using rsl::ir::Kind;
    const bool array = o.elements > 0 || o.open, text = o.kind == Kind::String;
    if (t.kind && (*t.kind != o.kind || (t.elements > 0) != array)) return;
    const size_t size = text ? t.texts.size() : t.numbers.size(), each = text ? 1 : size_t(rsl::ir::components(o.kind));
    const size_t most = size_t(std::max(1, o.elements)) * each;
    if (size == 0 || (!t.kind && !array && size != most) || (!array && size < most)) return;
    float* to = row + o.at;
    *to++ = 1;
    const size_t elements = std::min(size, most) / each;
    if (o.open) *to++ = float(elements);
    for (size_t k = 0; k < std::min(size, most); ++k)
        to[k] = text ? std::bit_cast<float>(rsl::internString(t.texts[k])) : t.numbers[k];
}

/// Writes the values of a ray that need no shader.
void writeRayValues(const GatherSite& g, float* row, const Vec3& origin, const Vec3& dir, float distance) {
    for (const GatherSite::Output& o : g.outputs) {
        if (o.of == GatherSite::Of::Origin) putGathered(row, o, origin);
        else if (o.of == GatherSite::Of::Direction) putGathered(row, o, dir);
        else if (o.of == GatherSite::Of::Length) putGathered(row, o, {distance});
    }
}

void writeHitValues(const WorldImpl& world, const GatherSite& g, float* row, const accel::Hit& hit, const Vec3& dir) {
    static const std::set<std::string> fixed = {"u", "v", "s", "t", "Ng", "dPdu", "dPdv", "I"};
    const geometry::Shape& shape = *world.shapes()[hit.shape];
    std::optional<geometry::SurfacePoint> at;
    for (const GatherSite::Output& o : g.outputs) {
        if (o.of != GatherSite::Of::Primitive && o.of != GatherSite::Of::Attribute && o.of != GatherSite::Of::Surface) continue;
        const std::string& name = rsl::internedString(o.id);
        if (o.of == GatherSite::Of::Surface && !fixed.count(name)) continue; // written by the shader
        if (name == "I") {
            putGathered(row, o, dir * float(hit.distance));
            continue;
        }
        if (o.of == GatherSite::Of::Attribute) {
            const SurfaceBinding& b = world.bindings()[size_t(world.bindingOf()[hit.shape])];
            if (const auto i = attributeOf(world, shape.attributes(), name, nullptr, &b)) putGathered(row, o, ShaderValue(*i));
            continue;
        }
        if (!at) at = world.accel().point(hit);
        if (const auto t = primitiveVariable(shape, *at, name)) putGathered(row, o, *t);
        else if (name == "u" || name == "v") putGathered(row, o, {name == "u" ? at->u : at->v});
        else if (name == "Ng" || name == "dPdu" || name == "dPdv")
            putGathered(row, o, name == "Ng" ? at->Ng : name == "dPdu" ? at->dPdu : at->dPdv);
    }
}

void endGatherRay(const GatherSite& g, const shading::TargetValue& v, float* row) {
    for (const GatherSite::Output& o : g.outputs) {
        if (o.of == GatherSite::Of::Light) putGathered(row, o, v.radiance);
        else if (o.of == GatherSite::Of::Opacity) putGathered(row, o, Color(1) - v.transmission);
    }
}

bool firstOpaque(const StageSet& set, accel::Ray ray, const ShadowRay& as, const Color& threshold, accel::Hit& hit) {
    Color through(1);
    for (int layers = 0; layers < limits::kShadowLayers; ++layers) {
        if (!set.intersector.intersect(ray, hit)) return false;
        if (!(maxComponent(threshold) > 0)) return true;
        const SurfaceBinding& b = set.context.world.bindings()[size_t(set.context.world.bindingOf()[hit.shape])];
        const Opacity& o = b.opacityFor(as.kind->set.mode);
        Color taken = o.constant;
        if (o.kernel) {
            const OpacityQuery q{set.context.world.bindingOf()[hit.shape], hit, &as, &o.kernel};
            set.opacities.opacities({&q, 1}, {&taken, 1});
        }
        through *= Color(1) - taken;
        if (1 - through.x >= threshold.x && 1 - through.y >= threshold.y && 1 - through.z >= threshold.z) return true;
        set.context.world.goOn(ray, hit);
    }
    return false;
}

} // namespace alpenglow::integrator
