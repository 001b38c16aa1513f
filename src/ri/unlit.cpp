// Lights that an AttributeEnd has ended before anything could be lit by them.
#include "ri/interpreter.h"
#include "scene/deferred.h"
#include <fmt/format.h>
#include <set>
#include <utility>

namespace alpenglow::ri {

/// At the end of a block: lights that were on in it and are not on behind it.
void Interpreter::noteEnded(const Block& block) {
    if (!frame_ || state.attributes == block.saved.attributes) return;
    const scene::LightSet &inner = state.attributes->lights, &outer = block.saved.attributes->lights;
    if (inner == outer) return;
    for (const int l : inner)
        if (!outer.contains(l)) ended_.insert(l);
}

/// Says so of those that are on for no primitive of the frame. What is still to be made may be lit by any.
void Interpreter::sayUnlit(const scene::Frame& frame) {
    std::set<int> dark;
    std::swap(dark, ended_);
    const auto lit = [&](const scene::AttributesRef& a) {
        if (a && !dark.empty()) std::erase_if(dark, [&](int l) { return a->lights.contains(l); });
    };
    const auto look = [&](const std::vector<scene::PrimitiveRef>& list) {
        const scene::Attributes* last = nullptr; // most share those of the one before
        for (const auto& p : list) {
            if (scene::isDeferred(*p)) dark.clear();
            if (p->attributes.get() != last) lit(p->attributes);
            last = p->attributes.get();
        }
    };
    if (dark.empty() || frame.primitives.empty()) return;
    look(frame.primitives);
    for (const scene::Object& o : frame.objects) look(o.primitives);
    for (const scene::Instance& i : frame.instances) lit(i.attributes);
    for (const int l : dark) {
        if (size_t(l) >= frame.lights.size() || frame.lights[size_t(l)].area) continue;
        const scene::ShaderRef& shader = frame.lights[size_t(l)].shader;
        reporter.once("ri:unlit", Severity::Warning, Rie::Consistency, shader->place,
                      fmt::format("light \"{}\" shines on nothing: its AttributeEnd comes before any primitive", shader->name),
                      "a light lasts until the AttributeEnd of the block that it is in: use TransformBegin and TransformEnd "
                      "around it, or Illuminate behind the block");
    }
}

} // namespace alpenglow::ri
