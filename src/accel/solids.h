// Solids: which points of their parts' surfaces bound the whole. Not for other rooms.
//
// All parts of a solid that a ray goes through are known by where it crosses their surfaces; at a crossing the whole begins or
// ends where the operations give another answer behind it than before it. Crossings as near to each other as single precision can
// tell are one, which belongs to the first part, so that parts may share a face.
#pragma once
#include "accel/accel.h"
#include <memory>
#include <vector>

namespace alpenglow::accel {

class Solids {
public:
    /// Null where no shape is of a solid of more than one part.
    static std::unique_ptr<Solids> of(const std::vector<geometry::ShapeRef>&, Diagnostics&);
    bool in(uint32_t shape) const { return partOf_[shape] != kNone; }
    /// Whether the whole begins or ends where the ray crosses the shape's surface.
    bool keeps(const Ray&, uint32_t shape, double t) const;

private:
    struct Part {
        std::unique_ptr<Accel> surface;
        std::vector<uint32_t> shapes;
    };
    struct Node {
        int operation = 0; ///< scene::SolidOperation
        uint32_t part = kNone;
        std::vector<uint32_t> children; ///< into nodes_, by their order in the request
        std::vector<int> order;
    };
    struct Whole {
        uint32_t root;
        std::vector<uint32_t> parts;
    };
    /// What a ray finds at a place: inside of a part before and behind it.
    struct Sides {
        bool before, behind;
    };
    Sides sidesOf(const Part&, const Ray&, double t, double near) const;
    template <class At> Sides resolve(uint32_t node, const At& at) const;
    std::vector<Part> parts_;
    std::vector<Node> nodes_;
    std::vector<Whole> wholes_;
    std::vector<uint32_t> partOf_, wholeOf_; ///< by shape, by part
};

} // namespace alpenglow::accel
