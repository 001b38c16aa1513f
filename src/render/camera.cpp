#include "render/camera.h"
#include "base/exact.h"
#include "base/limits.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::render {
namespace {

float pixelAspectOf(const scene::Options& o) {
    return o.pixelAspect > 0 && std::isfinite(o.pixelAspect) ? o.pixelAspect : 1; // negative asks for the device's own
}

/// Concentric map of the unit square to the unit disc (Shirley and Chiu, 1997): neighbours stay neighbours, so the strata do too.
Vec2 toDisc(Vec2 u) {
    double a = 2.0 * u.x - 1, b = 2.0 * u.y - 1;
    if (a == 0 && b == 0) return {0, 0};
    double r, phi;
    if (std::fabs(a) > std::fabs(b)) {
        r = a;
        phi = kPi / 4 * (b / a);
    } else {
        r = b;
        phi = kPi / 2 - kPi / 4 * (a / b);
    }
    const auto [s, c] = exact::sinCos(phi);
    return {float(r * c), float(r * s)};
}

} // namespace

void imageSize(const scene::Options& o, int* width, int* height) {
    *width = o.xres > 0 ? o.xres : 640;
    *height = o.yres > 0 ? o.yres : 480;
    if (!o.frameAspect || !(*o.frameAspect > 0) || !std::isfinite(*o.frameAspect)) return;
    double pa = pixelAspectOf(o), a = *o.frameAspect, format = *width * pa / *height;
    if (std::fabs(a - format) <= 1e-6 * format) return;
    if (a >= 1) *height = std::clamp(int(std::lround(*width * pa / a)), 1, limits::kImageSide);
    else *width = std::clamp(int(std::lround(*height * a / pa)), 1, limits::kImageSide);
}

Camera::Camera(const scene::Options& o, Diagnostics& diags) {
    auto bad = [&](const std::string& what) { diags.report(Severity::Error, Rie::Range, {}, what); };
    if (o.xres > limits::kImageSide || o.yres > limits::kImageSide)
        diags.report(Severity::Error, Rie::Limit, {},
                     "Format: a side of more than " + std::to_string(limits::kImageSide) + " pixels");
    scene::Options size = o;
    size.xres = std::min(o.xres, limits::kImageSide);
    size.yres = std::min(o.yres, limits::kImageSide);
    imageSize(size, &width_, &height_);
    pixelAspect_ = pixelAspectOf(o);

    double aspect = o.frameAspect && *o.frameAspect > 0 && std::isfinite(*o.frameAspect)
                        ? double(*o.frameAspect)
                        : double(width_) * pixelAspect_ / height_;
    right_ = aspect >= 1 ? aspect : 1;
    top_ = aspect >= 1 ? 1 : 1 / aspect;
    left_ = -right_;
    bottom_ = -top_;
    if (o.screenWindow && o.screenWindow->size() == 4) {
        const auto& w = *o.screenWindow;
        if (std::isfinite(w[0] + w[1] + w[2] + w[3]) && w[0] != w[1] && w[2] != w[3]) {
            left_ = w[0];
            right_ = w[1];
            bottom_ = w[2];
            top_ = w[3];
        } else bad("ScreenWindow: it has no area; the default is used");
    }
    pixel_ = std::max(std::fabs(right_ - left_) / width_, std::fabs(top_ - bottom_) / height_);

    // In float, as the numbers were given: 640 * 0.1 is 64 there, and more than 64 in double.
    float c[4];
    std::copy(o.crop, o.crop + 4, c);
    if (!(c[0] <= c[1] && c[2] <= c[3])) {
        bad("CropWindow: its lower limits are above its upper ones; the whole picture is rendered");
        c[0] = c[2] = 0;
        c[1] = c[3] = 1;
    }
    auto low = [](float v, int n) { return int(std::clamp(std::ceil(float(n) * v), 0.f, float(n - 1))); };
    auto high = [](float v, int n) { return int(std::clamp(std::ceil(float(n) * v - 1), 0.f, float(n - 1))) + 1; };
    window_ = {low(c[0], width_), low(c[2], height_), high(c[1], width_), high(c[3], height_)};
    if (window_.x1 <= window_.x0) window_.x1 = window_.x0 + 1; // narrower than a pixel: the pixel it lies in
    if (window_.y1 <= window_.y0) window_.y1 = window_.y0 + 1;

    perspective_ = o.projection == "perspective";
    if (!perspective_ && o.projection != "orthographic" && !o.projection.empty())
        diags.report(Severity::Error, Rie::Incapable, {},
                     "Projection \"" + o.projection + "\" is not known; orthographic is used",
                     nearestName(o.projection, {"perspective", "orthographic"}));
    fov_ = o.fov;
    if (perspective_ && !(fov_ > 0 && fov_ < 180)) {
        bad("Projection \"perspective\": fov must lie between 0 and 180 degrees; 90 is used");
        fov_ = 90;
    }
    tangent_ = exact::tan(fov_ * kPi / 360);
    near_ = o.clipNear > 0 && std::isfinite(o.clipNear) ? o.clipNear : 0;
    if (near_ <= 1e-9) near_ = 0; // RI_EPSILON: no plane was asked for
    if (o.clipFar < o.clipNear) bad("Clipping: far lies in front of near");
    else if (o.clipFar < 1e30f)
        diags.report(Severity::Info, Rie::NoError, {}, "Clipping: rays see what lies behind the far plane too");

    if (o.fstop > 0 && o.fstop < 1e30f) {
        if (o.focalLength > 0 && o.focalDistance > 0 && std::isfinite(o.focalLength) && std::isfinite(o.focalDistance)) {
            lensRadius_ = 0.5 * o.focalLength / o.fstop;
            focus_ = o.focalDistance;
        } else bad("DepthOfField: focal length and distance must be positive; everything is in focus");
    }
    if (o.shutterClose < o.shutterOpen) bad("Shutter: it closes before it opens; there is no motion blur");
    shutter_ = scene::Shutter(o);
    opening_ = ShutterOpening(o, diags);
    transform_ = o.worldToCamera;
    worldToCamera_ = scene::at(transform_, shutter_.open);
}

Matrix Camera::cameraToFirst(double time) const { return inverse(scene::at(transform_, time)) * worldToCamera_; }

transport::CameraRay Camera::ray(double rx, double ry, Vec2 lens, float time01) const {
    double xs = left_ + (right_ - left_) * rx / width_, ys = top_ - (top_ - bottom_) * ry / height_;
    double pixel = pixel_;
    Vec3d origin, direction;
    if (perspective_) {
        direction = {xs * tangent_, ys * tangent_, 1};
        pixel *= tangent_;
    } else {
        origin = {xs, ys, 0};
        direction = {0, 0, 1};
    }
    if (lensRadius_ > 0) {
        Vec3d inFocus = origin + direction * focus_;
        Vec2 d = toDisc(lens);
        origin += Vec3d(d.x * lensRadius_, d.y * lensRadius_, 0);
        direction = (inFocus - origin) / focus_; // z stays 1
    }
    origin += direction * near_;
    double l = length(direction), cosine = direction.z / l, start = near_ * l;
    direction /= l;

    transport::CameraRay r;
    const double part = opening_.at(double(time01));
    r.shutter = float(part);
    r.time = float(shutter_.at(part));
    // A pixel's side grows with depth, and depth with the cosine times the way.
    r.spread = perspective_ ? float(0.5 * pixel * cosine) : 0;
    r.width = perspective_ ? float(0.5 * pixel * near_) : float(0.5 * pixel);
    if (transform_.moves()) {
        Matrix m = cameraToFirst(shutter_.at(part));
        origin = transformPoint(m, origin);
        direction = transformVector(m, direction);
        double stretch = length(direction);
        if (stretch > 0) {
            direction /= stretch;
            cosine /= stretch;
            start *= stretch;
            r.width *= float(stretch);
        }
    }
    r.origin = Vec3(origin);
    r.direction = Vec3(direction);
    r.cosine = float(cosine);
    r.start = float(start);
    return r;
}

Matrix Camera::worldToNDC() const {
    Matrix m = worldToCamera_;
    if (perspective_) m = m * perspectiveMatrix(fov_);
    return m * translateMatrix(-left_, -top_, 0) * scaleMatrix(1 / (right_ - left_), 1 / (bottom_ - top_), 1);
}

} // namespace alpenglow::render
