// Converts raster positions to rays, and world positions to the raster. Formulas: docs/design/ri.md, "Camera".
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

/// A lens aperture of radius 1, by the four numbers of Hider "aperture" (PRMan): number of sides, below 3 a circle; rotation in
/// degrees; roundness, from 0 (straight blades) to 1 (circle); density, the radial distribution of light: 0 uniform, 1 growing
/// linearly from 0 at the centre, -1 falling linearly to 0 at the rim.
class Aperture {
public:
    Aperture() = default;
    /// As above.
    Aperture(int sides, double degrees, double roundness, double density);
    /// Samples a point in proportion to the light through the aperture, from two numbers in [0, 1).
    Vec2 sample(Vec2) const;

private:
    double rim(double angle) const; ///< angle from the centre of a side
    int sides_ = 0;
    double turn_ = 0, roundness_ = 0, density_ = 0;
    std::vector<double> cumulative_; ///< area from the centre of a side to a corner, at uniform angles
};

/// Hider "raytrace" "lensSamples", as in SLProject's ray tracer: x by y rays through the centre of every pixel, from a uniform
/// grid on the lens, equal in all pixels. 1 by 1: a pinhole.
struct LensGrid {
    int x = 0, y = 0; ///< 0: PixelSamples sets the number of rays, each with its own lens position
    /// There is a grid.
    bool on() const { return x > 0; }
};
/// Empty under other hiders, or if the numbers are not counts (the camera reports that).
LensGrid lensGridOf(const scene::Options&);

/// The camera of a frame. Immutable.
class Camera {
public:
    /// Invalid values (sizes, windows, angles that are not positive) are reported and replaced by RI's defaults. Projections
    /// other than "perspective" and "orthographic" are reported and treated as orthographic. "perspective" makes a stereo pair by
    /// "stereo" ("sidebyside", "topbottom", "left", "right"), "eyeseparation" and "focaldistance", the distance at which the
    /// pictures coincide.
    Camera(const scene::Options&, Diagnostics&);

    int width() const { return width_; } ///< of the complete picture, pixels
    /// Pixels.
    int height() const { return height_; }
    /// Width divided by height of a pixel.
    float pixelAspect() const { return pixelAspect_; }
    /// The pixels of CropWindow.
    const Window& window() const { return window_; }
    /// From DepthOfField, or from Hider "raytrace" "lensDiameter".
    bool hasLens() const { return lensRadius_ > 0; }
    /// Of Hider "raytrace"; off for others.
    const LensGrid& lensGrid() const { return lensGrid_; }
    bool stereo() const { return stereo_ != Stereo::None; } ///< a stereo pair, or one picture of it
    /// In the units of Shutter.
    double shutterOpen() const { return shutter_.open; }
    double shutterClose() const { return shutter_.close; }

    /// The ray through a raster position. lens: two numbers in [0, 1) for the point on the lens; time01: one for the shutter. The
    /// ray starts at the near plane, in camera space at shutter open, where the scene is stored; `cosine` refers to the camera at
    /// the ray's time. width and spread describe half the larger side of a pixel.
    integrator::CameraRay ray(double rx, double ry, Vec2 lens, float time01) const;
    /// Whether rays differ by raster position only: one eye without motion, and no lens.
    bool plain() const { return stereo_ == Stereo::None && !(lensRadius_ > 0) && !transform_.moves(); }
    /// ray() of a plain() camera at shutter open for many raster positions: out[i] for the i-th, with the same bits.
    void plainRays(std::span<const Vec2> raster, integrator::CameraRay* out) const;

    /// Half-spaces in camera space whose intersection contains everything that rays of a part of the picture can hit. Empty:
    /// unknown (a lens, a moving camera, a stereo pair).
    std::vector<geometry::Plane> sides(const Window&) const;

    const Matrix& worldToCamera() const { return worldToCamera_; } ///< at shutter open
    /// World to NDC: (0,0) upper left, (1,1) lower right of the whole picture; z as RiPerspective leaves it.
    Matrix worldToNDC() const;

private:
    Matrix cameraToFirst(double time) const;
    void setProjection(const scene::Options&, Diagnostics&);
    void setLens(const scene::Options&, Diagnostics&);
    void setHiderLens(const scene::Options&, Diagnostics&);
    /// Position of the eye for a raster position: its x; converts the position to that in the single picture.
    double eyeOf(double& rx, double& ry) const;

    int width_ = 640, height_ = 480;
    float pixelAspect_ = 1;
    Window window_;
    bool perspective_ = false;
    double left_ = -1, right_ = 1, bottom_ = -1, top_ = 1;
    double pixel_ = 1;              ///< larger side of a pixel on the screen
    double fov_ = 90, tangent_ = 1; ///< degrees; tan(fov / 2)
    double near_ = 0;
    double lensRadius_ = 0, focus_ = 1;
    LensGrid lensGrid_;
    scene::Shutter shutter_;
    ShutterOpening opening_;
    Aperture aperture_;
    enum class Stereo { None, Left, Right, SideBySide, TopBottom } stereo_ = Stereo::None;
    double eyes_ = 0, convergence_ = 1; ///< distance between the eyes; distance where both pictures coincide
    scene::Transform transform_;
    Matrix worldToCamera_;
};

/// Sides of the picture in pixels: Format's, or what FrameAspectRatio makes of them when it differs from the format's own aspect:
/// a >= 1 keeps the width, a < 1 the height (docs/design/ri.md).
void imageSize(const scene::Options&, int* width, int* height);

} // namespace alpenglow::render
