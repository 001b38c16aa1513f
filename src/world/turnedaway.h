// Calls of occlusion(), indirectdiffuse() and gather() whose normals face away from the viewer.
#pragma once
#include "geometry/shape.h"
#include "world/world.h"
#include <atomic>
#include <map>
#include <mutex>

namespace alpenglow::transport {

/// A hemisphere about a normal that faces away is what was asked for; but where all of a primitive asks so and all rays are
/// blocked, or what looks for light has the primitive itself before it, the primitive is black in silence, for the shader (or the
/// model) has turned the normal. Thread safe.
class TurnedAway {
public:
    /// Of one call on one shape: whether any normal faced the viewer, any faced away, and any ray came through.
    struct Tally {
        std::atomic<bool> facing = false, away = false, open = false;
        static void set(std::atomic<bool>& flag) {
            if (!flag.load(std::memory_order_relaxed)) flag.store(true, std::memory_order_relaxed);
        }
    };
    /// Lives as long as this.
    Tally& of(const SourcePlace& call, const std::string& shadeop, const geometry::Shape&);

    std::vector<World::TurnedAwayCall> blocked() const;

private:
    struct Before {
        bool operator()(const SourcePlace& a, const SourcePlace& b) const {
            return std::tie(a.file, a.line, a.column) < std::tie(b.file, b.line, b.column);
        }
    };
    mutable std::mutex mutex_;
    struct Call {
        std::string shadeop;
        std::map<const geometry::Shape*, Tally> shapes;
    };
    std::map<SourcePlace, Call, Before> tallies_;
};

} // namespace alpenglow::transport
