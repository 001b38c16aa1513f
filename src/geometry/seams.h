// Borders of displaced shapes: points that coincided bit by bit before displacement are joined again, for any shapes. Each moves
// to the mean of the positions by its surfaces, so shapes with the same normals there are unchanged except for rounding, and
// folds (faces of a cube) stay closed, as PRMan stitches them.
#pragma once
#include "geometry/shape.h"
#include <mutex>

namespace alpenglow::geometry {

/// The borders of all shapes of a world while they are displaced.
class Seams {
public:
    /// flat: undisplaced vertices. The mesh must live until close() or drop(). order: of all borders, so that threads change
    /// nothing. Thread safe.
    void add(TriMesh&, std::vector<uint32_t> vertex, std::vector<Vec3> flat, uint32_t order, const std::vector<double>& with);
    /// Forgets the borders of a mesh.
    void drop(const TriMesh&);
    /// Moves the points that coincided, after the last add().
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
