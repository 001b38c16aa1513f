// CSG solids: which points on the surfaces of parts are on the boundary of the solid. Internal to accel.
//
// For a ray, the inside of all parts of a solid is known from its crossings with their surfaces; at a crossing the solid starts
// or ends if the operations give different results before and behind it. Crossings that single precision cannot distinguish count
// as one, which belongs to the first part, so that parts may share a face.
#pragma once
#include "accel/accel.h"
#include <memory>
#include <vector>

namespace alpenglow::accel {

/// All solids of a world.
class Solids {
public:
    /// Null if no shape belongs to a solid with more than one part.
    static std::unique_ptr<Solids> of(const std::vector<geometry::ShapeRef>&, Diagnostics&);
    /// Whether the shape is a part of a solid.
    bool in(uint32_t shape) const { return partOf_[shape] != kNone; }
    /// Whether the solid starts or ends where the ray crosses the shape's surface. stop: once it is set, the result is undefined;
    /// may be null. A ray through very many surfaces takes long.
    bool keeps(const Ray&, uint32_t shape, double t, const StopFlag* stop) const;

private:
    struct Part {
        std::unique_ptr<Accel> surface;
        std::vector<uint32_t> shapes;
    };
    struct Node {
        int operation = 0; ///< scene::SolidOperation
        uint32_t part = kNone;
        std::vector<uint32_t> children; ///< indices in nodes_, by order in the request
        std::vector<int> order;
    };
    struct Whole {
        uint32_t root;
        std::vector<uint32_t> parts;
    };
    /// State at a crossing: inside a part before and behind it.
    struct Sides {
        bool before, behind;
    };
    Sides sidesOf(const Part&, const Ray&, double t, double near, const StopFlag* stop) const;
    template <class At> Sides resolve(uint32_t node, const At& at) const;
    std::vector<Part> parts_;
    std::vector<Node> nodes_;
    std::vector<Whole> wholes_;
    std::vector<uint32_t> partOf_, wholeOf_; ///< by shape, by part
};

} // namespace alpenglow::accel
