// Borders of displaced shapes: points that were one to the bit before they were displaced are one after it, whatever shapes they
// are of. Each goes to the middle of where its surfaces took it, so that shapes with the same normals there stay as they are but
// for rounding, and those that meet in a fold (faces of a cube) stay closed, as PRMan stitches them.
#pragma once
#include "geometry/shape.h"
#include <mutex>

namespace alpenglow::geometry {

class Seams {
public:
    /// flat: where the vertices were. The mesh lives until close() or drop(). order: of all borders, so that threads change
    /// nothing. Thread safe.
    void add(TriMesh&, std::vector<uint32_t> vertex, std::vector<Vec3> flat, uint32_t order, const std::vector<double>& with);
    void drop(const TriMesh&);
    void close();

private:
    struct Border {
        TriMesh* mesh;
        std::vector<uint32_t> vertex;
        std::vector<Vec3> flat;
        uint32_t order;
        std::vector<double> with;
    };
    void closeAmong(std::span<Border>);
    std::mutex mutex_;
    std::vector<Border> borders_;
};

} // namespace alpenglow::geometry
