// Region that camera rays can reach: the volume between the sides of the picture and the near plane. If no other rays are traced,
// geometry outside of it need not be diced.
#pragma once
#include "geometry/bounds.h"
#include "geometry/shape.h"
#include "scene/fwd.h"
#include <optional>

namespace alpenglow::geometry {

/// The planes of that region. Camera space.
class PictureSides {
public:
    /// From the frame's options, with margins for the widest filter and the lens. None: the camera moves, there are two eyes, or
    /// other rays exist (scene/anycamera.h).
    static std::optional<PictureSides> from(const scene::Options&);
    /// Whether no camera ray reaches the box, in camera space, or its surroundings of this width in pixels.
    bool outside(const Bounds&, double pixels) const;

private:
    bool perspective_ = false;
    double left_ = -1, right_ = 1, bottom_ = -1, top_ = 1; ///< on the screen; for perspective at z = 1
    double pixelX_ = 1, pixelY_ = 1;                       ///< on the screen
    double near_ = 0, lens_ = 0, focus_ = 1;
};

struct DiceOptions;

/// Parts of a static shape that no ray can reach, for any displacement within its bound.
class Unseen {
public:
    /// For a shape that is not diced yet.
    Unseen(const Shape&, const DiceOptions&);
    /// Whether nothing of the shape may be omitted.
    bool none() const { return !sides_; }
    /// Whether no ray reaches what lies in the box, camera space.
    bool operator()(Bounds) const;
    void lookAnywhere() { sides_ = nullptr; } ///< none() from now on

private:
    const PictureSides* sides_ = nullptr;
    double reach_ = 0, pixels_ = 0;
};

/// A box around a piece of a smooth surface from points on it, each with the vector to the start of the next one's part.
class ProbedBox {
public:
    /// Adds a point and the change of the surface over one step of the probing grid in u and in v.
    void add(const Vec3d& p, const Vec3d& alongU, const Vec3d& alongV);
    /// Around all points, with room for what lies between them.
    Bounds box() const;

private:
    Vec3d lo_{INFINITY, INFINITY, INFINITY}, hi_{-INFINITY, -INFINITY, -INFINITY}, pad_;
};

} // namespace alpenglow::geometry
