// Bounds of deferred procedurals (scene/deferred.h) for rays.
#pragma once
#include "accel/accel.h"
#include "world/names.h"
#include <atomic>
#include <memory>
#include <span>
#include <vector>

namespace alpenglow::world {

/// All bounds of a world, in a tree, and which of them rays have reached.
class DeferredBounds {
public:
    /// The bound of one procedural.
    struct Bound {
        geometry::Bounds box; ///< camera space, over the shutter interval

        int number = 0; ///< scene::deferredNumber()
    };
    /// most: bounds along its way that a ray records, nearest first; at least 1.
    DeferredBounds(std::vector<Bound>, int most);
    /// Whether a ray reaches a bound before `end`, in units of its direction; records these bounds. Thread safe: marks in met()
    /// are only ever set, and no ray reads them.
    bool intersects(const accel::Ray&, double end) const;
    /// The recorded numbers, ascending.
    std::vector<int> met() const;

private:
    struct Node {
        geometry::Bounds box;
        uint32_t first = 0, count = 0; ///< range in bounds_; count 0: children are the next node and the node `first`
    };
    void build(uint32_t first, uint32_t end);
    std::vector<Bound> bounds_; ///< in order of the leaves
    std::vector<Node> nodes_;
    std::unique_ptr<std::atomic<uint8_t>[]> met_;
    const size_t most_;
};

} // namespace alpenglow::world
