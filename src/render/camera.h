// From the raster to rays, and from the world to the raster. Source: reference ri.md 3.1 and 6.
//
// Camera space is left-handed: eye at the origin, +z into the scene, +x right, +y up. Raster y grows downward; pixel (i, j)
// covers [i, i+1) x [j, j+1).
#pragma once
#include "base/diagnostics.h"
#include "render/film.h"
#include "render/shutter.h"
#include "scene/motion.h"
#include "transport/integrator.h"

namespace alpenglow::render {

class Camera {
public:
    /// Impossible values (sizes, windows, angles that are not positive) are reported and replaced by RI's defaults. Projections
    /// other than "perspective" and "orthographic" are reported and treated as orthographic.
    Camera(const scene::Options&, Diagnostics&);

    int width() const { return width_; } ///< of the whole picture, pixels
    int height() const { return height_; }
    float pixelAspect() const { return pixelAspect_; }
    /// The pixels of CropWindow.
    const Window& window() const { return window_; }
    bool hasLens() const { return lensRadius_ > 0; }
    double shutterOpen() const { return shutter_.open; }
    double shutterClose() const { return shutter_.close; }

    /// The ray through a raster position. lens: two numbers of [0,1) for the point on the lens; time01: one for the shutter.
    /// The ray starts at the near plane. Origin and direction are in camera space when the shutter
    /// opens, where the scene is kept; `cosine` belongs to the camera at the ray's own time. width and spread describe
    /// half the larger side of a pixel.
    transport::CameraRay ray(double rx, double ry, Vec2 lens, float time01) const;

    const Matrix& worldToCamera() const { return worldToCamera_; } ///< when the shutter opens
    /// World to NDC: (0,0) upper left, (1,1) lower right of the whole picture; z as RiPerspective leaves it.
    Matrix worldToNDC() const;

private:
    Matrix cameraToFirst(double time) const;

    int width_ = 640, height_ = 480;
    float pixelAspect_ = 1;
    Window window_;
    bool perspective_ = false;
    double left_ = -1, right_ = 1, bottom_ = -1, top_ = 1;
    double pixel_ = 1; ///< the larger side of a pixel on the screen
    double fov_ = 90, tangent_ = 1; ///< degrees; tan(fov / 2)
    double near_ = 0;
    double lensRadius_ = 0, focus_ = 1;
    scene::Shutter shutter_;
    ShutterOpening opening_;
    scene::Transform transform_;
    Matrix worldToCamera_;
};

/// Sides of the picture in pixels: Format's, or what FrameAspectRatio makes of them when it differs from the format's own aspect:
/// a >= 1 keeps the width, a < 1 the height (ri.md 6).
void imageSize(const scene::Options&, int* width, int* height);

} // namespace alpenglow::render
