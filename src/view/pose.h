// The viewpoint of a view: the scene's camera and changes by the mouse.
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
    /// Orbits around the pivot: degrees to the right (about the world axis that is initially upright), and down.
    void orbit(double right, double down);
    /// Nearer by a factor: 2 halves the distance to the pivot, or shows half as much under a projection without perspective.
    void dolly(double factor);
    /// Moves the scene by parts of the picture's height, to the right and up, at the distance of the pivot.
    void pan(double right, double up);
    /// Moves the pivot to the centre of the picture at this camera depth; no effect if not positive or not finite.
    void setDistance(double);
    /// Whether it has moved since the scene was read.
    bool moved() const { return moved_; }
    /// Applies the same changes to another version of the scene, if its own camera has not changed.
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
