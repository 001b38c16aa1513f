#include "world/flippednormals.h"

namespace alpenglow::world {

FlippedNormals::Tally& FlippedNormals::of(const SourcePlace& call, const std::string& shadeop, const geometry::Shape& shape) {
    std::lock_guard lock(mutex_);
    Call& of = tallies_[call];
    of.shadeop = shadeop;
    return of.shapes[&shape];
}

std::vector<World::FlippedNormalsCall> FlippedNormals::blocked() const {
    std::lock_guard lock(mutex_);
    std::vector<World::FlippedNormalsCall> all;
    for (const auto& [call, of] : tallies_) {
        World::FlippedNormalsCall f{call, {}, of.shadeop, 0};
        for (const auto& [shape, t] : of.shapes)
            if (t.away && !t.facing && !t.open && (f.primitives++ == 0 || Before{}(shape->place(), f.primitive)))
                f.primitive = shape->place();
        if (f.primitives > 0) all.push_back(std::move(f));
    }
    return all;
}

} // namespace alpenglow::world
