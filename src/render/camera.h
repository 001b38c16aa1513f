// From the raster to rays, and from the world to the raster. Formulas: docs/design/ri.md, "Camera".
//
// Camera space is left-handed: eye at the origin, +z into the scene, +x right, +y up. Raster y grows downward; pixel (i, j)
// covers [i, i+1) x [j, j+1).
#pragma once
#include "base/diagnostics.h"
#include "integrator/integrator.h"
#include "render/film.h"
#include "render/shutter.h"
#include "scene/motion.h"
#include <vector>

namespace alpenglow::render {

/// The opening of a lens of radius 1, by the four numbers of Hider "aperture" (PRMan): sides, below 3 a circle; degrees by which
/// it is turned; roundness, 0 straight blades to 1 a circle; density, how the light through it grows from the middle to the rim:
/// 0 even, 1 from nothing, -1 to nothing, linearly.
class Aperture {
public:
    Aperture() = default;
    Aperture(int sides, double degrees, double roundness, double density);
    /// A point for two numbers of [0,1), as dense as light comes through.
    Vec2 sample(Vec2) const;

private:
    double rim(double angle) const; ///< angle from the middle of a side
    int sides_ = 0;
    double turn_ = 0, roundness_ = 0, density_ = 0;
    std::vector<double> cumulative_; ///< of the area from the middle of a side to a corner, even steps of the angle
};

/// Hider "raytrace" "lensSamples", as SLProject's ray tracer has it: x by y rays through the middle of every pixel, from places
/// that are spread evenly over the lens, the same in all pixels. 1 by 1: a pinhole.
struct LensGrid {
    int x = 0, y = 0; ///< 0: PixelSamples says how many rays there are, each from a place of its own
    bool on() const { return x > 0; }
};
/// None under other hiders or with numbers that are no counts (the camera reports them).
LensGrid lensGridOf(const scene::Options&);

class Camera {
public:
    /// Impossible values (sizes, windows, angles that are not positive) are reported and replaced by RI's defaults. Projections
    /// other than "perspective" and "orthographic" are reported and treated as orthographic. "perspective" has a stereo pair by
    /// "stereo" ("sidebyside", "topbottom", "left", "right"), "eyeseparation" and "focaldistance", where the eyes' pictures
    /// coincide.
    Camera(const scene::Options&, Diagnostics&);

    int width() const { return width_; } ///< of the whole picture, pixels
    int height() const { return height_; }
    float pixelAspect() const { return pixelAspect_; }
    /// The pixels of CropWindow.
    const Window& window() const { return window_; }
    /// DepthOfField has one, or Hider "raytrace" "lensDiameter".
    bool hasLens() const { return lensRadius_ > 0; }
    const LensGrid& lensGrid() const { return lensGrid_; }
    bool stereo() const { return stereo_ != Stereo::None; } ///< a pair of pictures, or one of it
    double shutterOpen() const { return shutter_.open; }
    double shutterClose() const { return shutter_.close; }

    /// The ray through a raster position. lens: two numbers of [0,1) for the point on the lens; time01: one for the shutter.
    /// The ray starts at the near plane. Origin and direction are in camera space when the shutter
    /// opens, where the scene is kept; `cosine` belongs to the camera at the ray's own time. width and spread describe
    /// half the larger side of a pixel.
    transport::CameraRay ray(double rx, double ry, Vec2 lens, float time01) const;
    /// Whether rays differ by their places alone: one eye that stands still, and no lens.
    bool plain() const { return stereo_ == Stereo::None && !(lensRadius_ > 0) && !transform_.moves(); }
    /// ray() of such a camera, when the shutter opens, for many raster positions: out[i] for the i-th, with the same bits.
    void plainRays(std::span<const Vec2> raster, transport::CameraRay* out) const;

    /// Half-spaces in camera space that hold between them all that rays of a part of the picture can meet. Empty: nothing is
    /// known (a lens, a camera that moves, a stereo pair).
    std::vector<geometry::Plane> sides(const Window&) const;

    const Matrix& worldToCamera() const { return worldToCamera_; } ///< when the shutter opens
    /// World to NDC: (0,0) upper left, (1,1) lower right of the whole picture; z as RiPerspective leaves it.
    Matrix worldToNDC() const;

private:
    Matrix cameraToFirst(double time) const;
    void setProjection(const scene::Options&, Diagnostics&);
    void setLens(const scene::Options&, Diagnostics&);
    void setHiderLens(const scene::Options&, Diagnostics&);
    /// The eye that a raster position is seen by: its x; the position becomes that in the picture of both.
    double eyeOf(double& rx, double& ry) const;

    int width_ = 640, height_ = 480;
    float pixelAspect_ = 1;
    Window window_;
    bool perspective_ = false;
    double left_ = -1, right_ = 1, bottom_ = -1, top_ = 1;
    double pixel_ = 1;              ///< the larger side of a pixel on the screen
    double fov_ = 90, tangent_ = 1; ///< degrees; tan(fov / 2)
    double near_ = 0;
    double lensRadius_ = 0, focus_ = 1;
    LensGrid lensGrid_;
    scene::Shutter shutter_;
    ShutterOpening opening_;
    Aperture aperture_;
    enum class Stereo { None, Left, Right, SideBySide, TopBottom } stereo_ = Stereo::None;
    double eyes_ = 0, convergence_ = 1; ///< distance of the eyes; where both see the same
    scene::Transform transform_;
    Matrix worldToCamera_;
};

/// Sides of the picture in pixels: Format's, or what FrameAspectRatio makes of them when it differs from the format's own aspect:
/// a >= 1 keeps the width, a < 1 the height (docs/design/ri.md).
void imageSize(const scene::Options&, int* width, int* height);

} // namespace alpenglow::render
