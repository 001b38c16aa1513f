// Where a view looks from: the scene's camera, and what the mouse has done to it since.
#pragma once
#include "base/matrix.h"
#include "render/engine.h"
#include "scene/fwd.h"

namespace alpenglow::view {

/// Row vectors; camera space as scene.h has it (left-handed, +z into the scene, +y up).
class Pose {
public:
    /// As the scene has it.
    explicit Pose(const scene::Options&);
    /// Turns what is in front of the pivot about it: degrees to the right (about the world's axis that is upright at first), and
    /// down.
    void orbit(double right, double down);
    /// Nearer by a factor: 2 halves the distance to the pivot, or shows half as much under a projection without perspective.
    void dolly(double factor);
    /// Moves the scene by parts of the picture's height, to the right and up, at the distance of the pivot.
    void pan(double right, double up);
    /// The pivot is in the middle of the picture, at this depth of the camera; not positive or not finite: it stays.
    void setDistance(double);
    /// Whether it has moved since the scene was read.
    bool moved() const { return moved_; }
    /// The same turn of another version of the scene, where its own camera did not move meanwhile.
    void keepFrom(const Pose& old);
    /// The frame's options with this camera.
    void apply(scene::Options&) const;
    /// From this camera's space to that of `other`: where a world that was built for it is to be looked into.
    Matrix to(const Pose& other) const;
    const Matrix& view() const { return view_; } ///< world to camera
    double zoom() const { return zoom_; }        ///< without perspective: how much larger the picture is

private:
    Matrix home_, view_;
    Vec3d up_{0, 1, 0}; ///< of the world
    double distance_ = 1, zoom_ = 1;
    double height_ = 2; ///< of the picture at distance 1, or without perspective
    bool perspective_ = true, moved_ = false;
};

/// The engine's, for a world that was built for another camera: rays are taken there first. Depths are that camera's.
std::unique_ptr<render::Tracer> turned(std::unique_ptr<render::Tracer>, const Matrix& toBuilt);

} // namespace alpenglow::view
