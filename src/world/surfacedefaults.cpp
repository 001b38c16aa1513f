// Surface defaults: how derivatives are computed, and the headlight of scenes without light.
#include "scene/deferred.h"
#include "scene/scene.h"
#include "world/surfaces.h"
#include <algorithm>

namespace alpenglow::world {

bool SurfaceBinder::differences(const geometry::Shape& shape, bool byDefault) {
    const scene::Param* p = shape.attributes().value("shade:derivatives");
    if (!p || p->strings.empty()) return byDefault;
    const std::string& how = p->strings[0];
    if (how != "exact" && how != "differences")
        diagnostics_.reportOnce("derivatives:" + how,
                                {Severity::Warning,
                                 Rie::Range,
                                 p->place,
                                 "Attribute \"shade\" \"derivatives\" cannot be \"" + how + "\"; the default is used",
                                 "it can be \"exact\" or \"differences\"",
                                 {}});
    return how == "differences" || (how != "exact" && byDefault);
}

bool SurfaceBinder::needsHeadlight() {
    const auto& primitives = world_.frame().primitives;
    const auto shaded = [](const geometry::ShapeRef& s) { return s->attributes().surface != nullptr; };
    // Contents of deferred procedurals are unknown before rays reach them.
    if (world_.shapes_.empty() || !world_.lights_.empty() || std::any_of(world_.shapes_.begin(), world_.shapes_.end(), shaded) ||
        std::any_of(primitives.begin(), primitives.end(), [](const auto& p) { return p && scene::isProcedural(*p); }))
        return false;
    diagnostics_.reportOnce("headlight", {Severity::Info,
                                          Rie::NoError,
                                          {},
                                          "the scene has neither lights nor surface shaders: it is lit from the eye, as under "
                                          "\"hidden\"",
                                          "LightSource and Surface before the primitives light and shade them",
                                          {}});
    return true;
}

} // namespace alpenglow::world
