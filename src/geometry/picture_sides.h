// What camera rays can come to: the room between the sides of the picture and the near plane. Where no other ray is sent, what
// lies outside of it need not be diced.
#pragma once
#include "geometry/bounds.h"
#include "geometry/shape.h"
#include "scene/fwd.h"
#include <optional>

namespace alpenglow::geometry {

class PictureSides {
public:
    /// From the frame's options, with room for the widest filter and the lens. None: the camera moves, there are two eyes, or
    /// others look (scene/anycamera.h).
    static std::optional<PictureSides> from(const scene::Options&);
    /// No ray of the camera comes to the box, in camera space, nor to what lies so many pixels beside it.
    bool outside(const Bounds&, double pixels) const;

private:
    bool perspective_ = false;
    double left_ = -1, right_ = 1, bottom_ = -1, top_ = 1; ///< on the screen; a perspective one lies at z = 1
    double pixelX_ = 1, pixelY_ = 1;                       ///< on the screen
    double near_ = 0, lens_ = 0, focus_ = 1;
};

struct DiceOptions;

/// Which parts of a still shape no ray can come to, wherever its shader moves them within its bound.
class Unseen {
public:
    Unseen(const Shape&, const DiceOptions&);
    /// Nothing of the shape may be left out.
    bool none() const { return !sides_; }
    bool operator()(Bounds) const;
    void lookAnywhere() { sides_ = nullptr; } ///< none() from now on

private:
    const PictureSides* sides_ = nullptr;
    double reach_ = 0, pixels_ = 0;
};

/// A box about a piece of a smooth surface by points of it, each with the way to where the next one's part begins.
class ProbedBox {
public:
    void add(const Vec3d& p, const Vec3d& alongU, const Vec3d& alongV);
    Bounds box() const;

private:
    Vec3d lo_{INFINITY, INFINITY, INFINITY}, hi_{-INFINITY, -INFINITY, -INFINITY}, pad_;
};

} // namespace alpenglow::geometry
