#include "world/turnedaway.h"

namespace alpenglow::transport {

TurnedAway::Tally& TurnedAway::of(const SourcePlace& call, const geometry::Shape& shape) {
    std::lock_guard lock(mutex_);
    return tallies_[call][&shape];
}

std::vector<World::TurnedAwayCall> TurnedAway::blocked() const {
    std::lock_guard lock(mutex_);
    std::vector<World::TurnedAwayCall> all;
    for (const auto& [call, shapes] : tallies_) {
        World::TurnedAwayCall f{call, {}, 0};
        for (const auto& [shape, t] : shapes)
            if (t.away && !t.facing && !t.open && (f.primitives++ == 0 || Before{}(shape->place(), f.primitive)))
                f.primitive = shape->place();
        if (f.primitives > 0) all.push_back(std::move(f));
    }
    return all;
}

} // namespace alpenglow::transport
