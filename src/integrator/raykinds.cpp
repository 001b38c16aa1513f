// What kind of ray a call asks for, where that is known only when it runs.
#include "integrator/engine.h"
#include "world/raysets.h"
#include <bit>

namespace alpenglow::transport {

using shading::RaySet;

const uint8_t* Engine::shapesOf(int32_t subset, int32_t exclude, const scene::Attributes* from) {
    // What the shape of the point says counts where the call names no subset.
    const auto [known, fresh] = subsetsKnown_.try_emplace({subset, exclude, from}, nullptr);
    if (!fresh) return known->second;
    std::string wanted = rsl::internedString(subset);
    if (wanted.empty() && from) wanted = attributeText(*from, "grouping:tracesubset");
    return known->second = world_->subsets_.find(*world_, wanted, rsl::internedString(exclude));
}

RaySet Engine::raySetOf(const SiteInfo& s, const std::function<float(int)>& f, const geometry::Shape* from, RayType& type,
                        int32_t& label) {
    const RaySite& r = *s.rays;
    RaySet set = r.set;
    const auto id = [&](int row) { return std::bit_cast<int32_t>(f(row)); };
    const auto word = [&](int row) -> const std::string& { return rsl::internedString(id(row)); };
    type = r.rays;
    label = r.label >= 0 ? id(r.label) : s.label;
    if (r.type >= 0)
        if (const std::string& t = word(r.type); !t.empty()) type = rayTypeOf(t);
    if (r.sides >= 0)
        if (const auto sides = sidesOf(word(r.sides))) set.sides = *sides;
    if (r.mode >= 0)
        if (const auto mode = modeOf(word(r.mode))) set.mode = *mode;
    const int32_t subset = r.subset >= 0 ? id(r.subset) : r.subsetId, exclude = r.exclude >= 0 ? id(r.exclude) : r.excludeId;
    const bool ofShape = subset == 0 && from && world_->traceSubsets_;
    if (r.subset >= 0 || r.exclude >= 0 || ofShape) set.only = shapesOf(subset, exclude, ofShape ? &from->attributes() : nullptr);
    return set;
}

} // namespace alpenglow::transport
