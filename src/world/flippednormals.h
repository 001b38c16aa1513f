// Detects calls of occlusion(), indirectdiffuse() and gather() with normals that face away from the viewer.
#pragma once
#include "geometry/shape.h"
#include "world/world.h"
#include <atomic>
#include <map>
#include <mutex>

namespace alpenglow::world {

/// A hemisphere around a normal that faces away may be intended. But if all calls on a primitive do so and all rays are blocked,
/// or if the primitive occludes its own gathered light, it renders black without a message, because the shader or model has
/// flipped the normal. Thread safe.
class FlippedNormals {
public:
    /// For one call on one shape: whether any normal faced the viewer, any faced away, and any ray was unoccluded.
    struct Tally {
        std::atomic<bool> facing = false, away = false, open = false; ///< what was seen so far
        /// Sets a flag; does not write if it is set.
        static void set(std::atomic<bool>& flag) {
            if (!flag.load(std::memory_order_relaxed)) flag.store(true, std::memory_order_relaxed);
        }
    };
    /// Valid as long as this object.
    Tally& of(const SourcePlace& call, const std::string& shadeop, const geometry::Shape&);

    /// The calls of which that is true on some primitive. Call while no thread traces.
    std::vector<World::FlippedNormalsCall> blocked() const;

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

} // namespace alpenglow::world
