// The bounds of procedurals that are not made yet (scene/unmade.h), as rays meet them.
#pragma once
#include "accel/accel.h"
#include <atomic>
#include <memory>
#include <span>
#include <vector>

namespace alpenglow::transport {

class Unmade {
public:
    struct Bound {
        geometry::Bounds box; ///< camera space, at all times of the shutter

        int number = 0; ///< scene::unmadeNumber()
    };
    explicit Unmade(std::vector<Bound>);
    /// How many of the bounds on its way a ray asks for, those that it comes to first. Before any ray is sent.
    void askFor(int most) const { most_ = most; }
    /// Whether a ray comes to some bound before `end`, in lengths of its direction: those that it asks for are noted. Thread
    /// safe.
    bool meets(const accel::Ray&, double end) const;
    /// Those that were noted, in ascending order.
    std::vector<int> met() const;

private:
    struct Node {
        geometry::Bounds box;
        uint32_t first = 0, count = 0; ///< bounds; count 0: the next node and that of this number are its children
    };
    void build(uint32_t first, uint32_t end);
    std::vector<Bound> bounds_; ///< in the order of the leaves
    std::vector<Node> nodes_;
    std::unique_ptr<std::atomic<uint8_t>[]> met_;
    mutable int most_ = 1;
};

} // namespace alpenglow::transport
