#include "render/camera.h"
#include "base/exact.h"
#include "base/limits.h"
#include "scene/scene.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::render {
namespace {

float pixelAspectOf(const scene::Options& o) {
    return o.pixelAspect > 0 && std::isfinite(o.pixelAspect) ? o.pixelAspect : 1; // a negative value requests the device's own
}

/// Concentric map from the unit square to the unit disk (Shirley and Chiu, 1997); continuous, so it preserves strata.
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

constexpr size_t kRimSteps = 512;

} // namespace

Aperture::Aperture(int sides, double degrees, double roundness, double density)
    : sides_(sides < 3 ? 0 : sides), turn_(degrees * kPi / 180), roundness_(roundness), density_(density) {
    if (!sides_) return;
    double sum = 0;
    cumulative_.push_back(0);
    for (size_t i = 0; i < kRimSteps; ++i) {
        const double r = rim((double(i) + 0.5) / kRimSteps * kPi / sides_);
        cumulative_.push_back(sum += r * r);
    }
}

double Aperture::rim(double angle) const {
    const double straight = exact::cos(kPi / sides_) / exact::cos(angle);
    return straight + (1 - straight) * roundness_;
}

Vec2 Aperture::sample(Vec2 u) const {
    if (!sides_ && density_ == 0) return toDisc(u);
    // Angle and fraction of the distance to the rim. As density is linear, the flux up to x is a cubic in x.
    double x = std::sqrt(double(u.y));
    if (density_ != 0) {
        const double square = (1 - density_) / 2, cube = 2 * density_ / 3, target = u.y * (square + cube);
        double lo = 0, hi = 1;
        for (int i = 0; i < 60; ++i) {
            const double f = x * x * (square + cube * x) - target, slope = x * (2 * square + 3 * cube * x);
            (f < 0 ? lo : hi) = x;
            const double next = slope > 0 ? x - f / slope : lo;
            x = next > lo && next < hi ? next : 0.5 * (lo + hi);
        }
    }
    double angle = 2 * kPi * u.x, reach = 1;
    if (sides_) {
        const double at = u.x * 2 * sides_, side = std::floor(at), target = (at - side) * cumulative_.back();
        const auto above = std::upper_bound(cumulative_.begin(), cumulative_.end(), target);
        const size_t k = std::min(size_t(above - cumulative_.begin()), kRimSteps);
        const double step = (double(k - 1) + (target - cumulative_[k - 1]) / (cumulative_[k] - cumulative_[k - 1])) / kRimSteps;
        const double off = step * kPi / sides_;
        reach = rim(off);
        // Alternates between half sides: from the centre of a side backward, then forward.
        angle = kPi * (2 * std::floor(side / 2) + 1) / sides_ + (side - 2 * std::floor(side / 2) < 0.5 ? -off : off);
    }
    const auto [s, c] = exact::sinCos(angle + turn_);
    return {float(x * reach * c), float(x * reach * s)};
}

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

    // In float, as the numbers were given: 640 * 0.1 is 64 there, but more than 64 in double.
    float c[4];
    std::copy(o.crop, o.crop + 4, c);
    if (!(c[0] <= c[1] && c[2] <= c[3])) {
        bad("CropWindow: its lower limits exceed its upper ones; the complete picture is rendered");
        c[0] = c[2] = 0;
        c[1] = c[3] = 1;
    }
    auto low = [](float v, int n) { return int(std::clamp(std::ceil(float(n) * v), 0.f, float(n - 1))); };
    auto high = [](float v, int n) { return int(std::clamp(std::ceil(float(n) * v - 1), 0.f, float(n - 1))) + 1; };
    window_ = {low(c[0], width_), low(c[2], height_), high(c[1], width_), high(c[3], height_)};
    if (window_.x1 <= window_.x0) window_.x1 = window_.x0 + 1; // narrower than a pixel: use that pixel
    if (window_.y1 <= window_.y0) window_.y1 = window_.y0 + 1;

    setProjection(o, diags);
    near_ = o.clipNear > 0 && std::isfinite(o.clipNear) ? o.clipNear : 0;
    if (near_ <= 1e-9) near_ = 0; // RI_EPSILON: no near plane
    if (o.clipFar < o.clipNear) bad("Clipping: far is in front of near");
    else if (o.clipFar < 1e30f)
        diags.report(Severity::Info, Rie::NoError, {}, "Clipping: rays also see geometry behind the far plane");

    setLens(o, diags);
    if (o.shutterClose < o.shutterOpen) bad("Shutter: it closes before it opens; there is no motion blur");
    shutter_ = scene::Shutter(o);
    opening_ = ShutterOpening(o, diags);
    transform_ = o.worldToCamera;
    worldToCamera_ = scene::at(transform_, shutter_.open);
}

void Camera::setProjection(const scene::Options& o, Diagnostics& diags) {
    auto bad = [&](const std::string& what) { diags.report(Severity::Error, Rie::Range, {}, what); };
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
    const scene::Param* stereo = scene::find(o.projectionParams, "stereo");
    if (!stereo || stereo->strings.empty() || stereo->strings[0].empty()) return;
    static constexpr std::pair<std::string_view, Stereo> kKinds[] = {
        {"sidebyside", Stereo::SideBySide}, {"topbottom", Stereo::TopBottom}, {"left", Stereo::Left}, {"right", Stereo::Right}};
    for (const auto& [name, kind] : kKinds)
        if (stereo->strings[0] == name) stereo_ = kind;
    if (stereo_ == Stereo::None)
        return bad("Projection \"stereo\": \"" + stereo->strings[0] + "\" is not known: sidebyside, topbottom, left or right");
    const auto number = [&](const char* name, double otherwise) {
        const scene::Param* p = scene::find(o.projectionParams, name);
        if (!p || p->numbers.empty()) return otherwise;
        if (p->numbers[0] > 0 && std::isfinite(p->numbers[0])) return double(p->numbers[0]);
        bad(std::string("Projection \"") + name + "\" must be positive");
        return otherwise;
    };
    convergence_ = number("focaldistance", o.focalDistance > 0 && std::isfinite(o.focalDistance) ? o.focalDistance : 10);
    eyes_ = number("eyeseparation", convergence_ / 30); // common in photography
    if (!perspective_) bad("Projection: a stereo pair needs \"perspective\""), stereo_ = Stereo::None;
}

LensGrid lensGridOf(const scene::Options& o) {
    constexpr float kMostOfSide = 256; // 65,536 rays per pixel
    const scene::Param* p = o.hider == "raytrace" ? scene::find(o.hiderParams, "lensSamples") : nullptr;
    if (!p || p->numbers.empty()) return {};
    const float x = p->numbers[0], y = p->numbers.size() > 1 ? p->numbers[1] : x;
    const auto good = [&](float n) { return n >= 1 && n <= kMostOfSide && n == std::floor(n); };
    return good(x) && good(y) ? LensGrid{int(x), int(y)} : LensGrid{};
}

/// SLProject's lens, which replaces that of DepthOfField.
void Camera::setHiderLens(const scene::Options& o, Diagnostics& diags) {
    const scene::Param *diameter = scene::find(o.hiderParams, "lensDiameter"),
                       *samples = scene::find(o.hiderParams, "lensSamples"), *distance = scene::find(o.hiderParams, "focalDist");
    const scene::Param* first = diameter ? diameter : samples ? samples : distance;
    if (!first) return;
    if (o.hider != "raytrace") {
        diags.report(Severity::Warning, Rie::Incapable, first->place,
                     "\"" + first->name + "\" requires the hider raytrace; it is ignored", "DepthOfField works with all hiders");
        return;
    }
    const auto bad = [&](const scene::Param& p, const char* rule) {
        diags.report(Severity::Error, Rie::Range, p.place, "hider parameter \"" + p.name + "\" " + rule);
    };
    const auto positive = [](const scene::Param& p) { return !p.numbers.empty() && p.numbers[0] > 0 && p.numbers[0] < 1e30f; };
    if (distance && !positive(*distance)) bad(*distance, "must be a distance > 0; that of DepthOfField is used");
    else if (distance) focus_ = distance->numbers[0];
    if (diameter && (diameter->numbers.empty() || !(diameter->numbers[0] >= 0 && diameter->numbers[0] < 1e30f)))
        bad(*diameter, "must be a length >= 0; that of DepthOfField is used");
    else if (diameter && diameter->numbers[0] > 0 && !(distance && positive(*distance)) && !(lensRadius_ > 0))
        bad(*diameter, "needs \"focalDist\", the distance in focus; everything is in focus");
    else if (diameter) lensRadius_ = 0.5 * diameter->numbers[0];
    lensGrid_ = lensGridOf(o);
    if (samples && !lensGrid_.on()) bad(*samples, "must be two integers from 1 to 256; PixelSamples is used");
    if (lensGrid_.x * lensGrid_.y == 1) lensRadius_ = 0;
}

void Camera::setLens(const scene::Options& o, Diagnostics& diags) {
    auto bad = [&](const std::string& what) { diags.report(Severity::Error, Rie::Range, {}, what); };
    if (o.fstop > 0 && o.fstop < 1e30f) {
        if (o.focalLength > 0 && o.focalDistance > 0 && std::isfinite(o.focalLength) && std::isfinite(o.focalDistance)) {
            lensRadius_ = 0.5 * o.focalLength / o.fstop;
            focus_ = o.focalDistance;
        } else bad("DepthOfField: focal length and distance must be positive; everything is in focus");
    }
    setHiderLens(o, diags);
    const scene::Param* a = scene::find(o.hiderParams, "aperture");
    if (!a)
        if (auto i = o.values.find("hider:aperture"); i != o.values.end()) a = &i->second;
    if (!a || a->numbers.empty()) return;
    double n[4] = {};
    for (size_t i = 0; i < std::min<size_t>(4, a->numbers.size()); ++i) n[i] = a->numbers[i];
    const bool good =
        std::isfinite(n[0] + n[1] + n[2] + n[3]) && n[0] >= 0 && n[0] <= 1000 && n[2] >= 0 && n[2] <= 1 && std::fabs(n[3]) <= 1;
    if (!good) return bad("Hider \"aperture\": sides 0 to 1000, degrees, roundness 0 to 1, density -1 to 1; the lens is round");
    aperture_ = Aperture(int(n[0]), n[1], n[2], n[3]);
}

double Camera::eyeOf(double& rx, double& ry) const {
    const double half = 0.5 * eyes_;
    switch (stereo_) {
    case Stereo::None:
        return 0;
    case Stereo::Left:
        return -half;
    case Stereo::Right:
        return half;
    case Stereo::SideBySide: {
        const bool right = 2 * rx >= width_;
        rx = 2 * rx - (right ? width_ : 0);
        return right ? half : -half;
    }
    case Stereo::TopBottom: {
        const bool right = 2 * ry >= height_;
        ry = 2 * ry - (right ? height_ : 0);
        return right ? half : -half;
    }
    }
    return 0;
}

std::vector<geometry::Plane> Camera::sides(const Window& w) const {
    if (lensRadius_ > 0 || stereo() || transform_.moves()) return {};
    constexpr double kMargin = 1e-3; // pixels: larger than the rounding errors of rays
    const auto x = [&](double rx) { return (left_ + (right_ - left_) * rx / width_) * (perspective_ ? tangent_ : 1); };
    const auto y = [&](double ry) { return (top_ - (top_ - bottom_) * ry / height_) * (perspective_ ? tangent_ : 1); };
    const auto [left, right] = std::minmax({x(w.x0 - kMargin), x(w.x1 + kMargin)});
    const auto [bottom, top] = std::minmax({y(w.y0 - kMargin), y(w.y1 + kMargin)});
    std::vector<geometry::Plane> planes{{Vec3(0, 0, 1), float(-near_ * (1 - 1e-6))}};
    const auto add = [&](float nx, float ny, double at) { // n.p >= at, or at z
        if (perspective_) planes.push_back({Vec3(nx, ny, float(-at)), 0});
        else planes.push_back({Vec3(nx, ny, 0), float(-at)});
    };
    add(1, 0, left), add(-1, 0, -right), add(0, 1, bottom), add(0, -1, -top);
    return planes;
}

Matrix Camera::cameraToFirst(double time) const { return inverse(scene::at(transform_, time)) * worldToCamera_; }

integrator::CameraRay Camera::ray(double rx, double ry, Vec2 lens, float time01) const {
    const double eye = stereo_ == Stereo::None ? 0 : eyeOf(rx, ry);
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
    if (eye != 0) { // off the axis: the eyes are parallel
        origin.x += eye;
        direction.x -= eye / convergence_;
    }
    if (lensRadius_ > 0) {
        Vec3d inFocus = origin + direction * focus_;
        Vec2 d = aperture_.sample(lens);
        origin += Vec3d(d.x * lensRadius_, d.y * lensRadius_, 0);
        direction = (inFocus - origin) / focus_; // z stays 1
    }
    origin += direction * near_;
    double l = length(direction), cosine = direction.z / l, start = near_ * l;
    direction /= l;

    integrator::CameraRay r;
    const double part = opening_.at(double(time01));
    r.shutter = float(part);
    r.time = float(shutter_.at(part));
    // The side of a pixel grows with depth, and depth with cosine times distance.
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

void Camera::plainRays(std::span<const Vec2> raster, integrator::CameraRay* out) const {
    constexpr size_t kAtOnce = 16; // loops over these are vectorised
    const integrator::CameraRay like = ray(0, 0, {0.5f, 0.5f}, 0);
    const double width = right_ - left_, height = top_ - bottom_, tangent = perspective_ ? tangent_ : 1;
    for (size_t first = 0; first < raster.size(); first += kAtOnce) {
        double x[kAtOnce] = {}, y[kAtOnce] = {}, l[kAtOnce];
        const size_t n = std::min(kAtOnce, raster.size() - first);
        for (size_t i = 0; i < n; ++i) x[i] = double(raster[first + i].x), y[i] = double(raster[first + i].y);
        for (size_t i = 0; i < kAtOnce; ++i) {
            x[i] = (left_ + width * x[i] / width_) * tangent;
            y[i] = (top_ - height * y[i] / height_) * tangent;
        }
        if (!perspective_) {
            for (size_t i = 0; i < n; ++i) {
                out[first + i] = like;
                out[first + i].origin = Vec3(Vec3d(x[i], y[i], near_));
            }
            continue;
        }
        for (size_t i = 0; i < kAtOnce; ++i) l[i] = std::sqrt(x[i] * x[i] + y[i] * y[i] + 1);
        const double pixel = 0.5 * (pixel_ * tangent_);
        for (size_t i = 0; i < n; ++i) {
            integrator::CameraRay& r = out[first + i] = like;
            const double cosine = 1 / l[i];
            r.spread = float(pixel * cosine);
            r.origin = Vec3(Vec3d(x[i] * near_, y[i] * near_, near_));
            r.direction = Vec3(Vec3d(x[i] / l[i], y[i] / l[i], cosine));
            r.cosine = float(cosine);
            r.start = float(near_ * l[i]);
        }
    }
}

Matrix Camera::worldToNDC() const {
    Matrix m = worldToCamera_;
    if (perspective_) m = m * perspectiveMatrix(fov_);
    return m * translateMatrix(-left_, -top_, 0) * scaleMatrix(1 / (right_ - left_), 1 / (bottom_ - top_), 1);
}

} // namespace alpenglow::render
