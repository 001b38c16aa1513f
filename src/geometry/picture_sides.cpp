#include "geometry/picture_sides.h"
#include "base/exact.h"
#include "base/limits.h"
#include "geometry/dice.h"
#include "scene/anycamera.h"
#include "scene/scene.h"
#include "scene/solids.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::geometry {

namespace {

/// Margin in pixels beyond the edge of the picture for filters and rounding, apart from filter widths. Facets that reach into the
/// picture from there have neighbours that share their points.
constexpr double kMargin = 8;

/// Half the widest filter of the frame, in pixels.
double filterReach(const scene::Options& o) {
    double widest = std::max({1.f, o.filter.xwidth, o.filter.ywidth});
    const auto look = [&](const scene::ParamList& params) {
        if (const scene::Param* p = scene::find(params, "filterwidth"))
            for (const float w : p->numbers) widest = std::max(widest, double(w));
    };
    for (const scene::Display& d : o.displays) look(d.params);
    for (const auto& [name, params] : o.displayChannelParams) look(params);
    return 0.5 * std::min(widest, limits::kFilterWidth);
}

} // namespace

std::optional<PictureSides> PictureSides::from(const scene::Options& o) {
    if (o.values.count(scene::kAnyCamera)) return {};
    PictureSides p;
    p.perspective_ = o.projection == "perspective";
    if ((!p.perspective_ && o.projection != "orthographic" && !o.projection.empty()) || o.worldToCamera.moves()) return {};
    for (const char* of : {"stereo", "eyeseparation"})
        if (scene::find(o.projectionParams, of)) return {};
    for (const char* of : {"lensDiameter", "lensSamples", "focalDist"})
        if (scene::find(o.hiderParams, of)) return {};
    double width = std::max(1, o.xres), height = std::max(1, o.yres);
    const double aspect = o.frameAspect ? double(*o.frameAspect) : width * o.pixelAspect / height;
    if (!(aspect > 0) || !std::isfinite(aspect) || !(o.pixelAspect > 0)) return {};
    if (o.frameAspect && aspect >= 1) height = std::max(1.0, width * o.pixelAspect / aspect); // as in the camera
    if (o.frameAspect && aspect < 1) width = std::max(1.0, height * aspect / o.pixelAspect);
    p.right_ = std::max(1.0, aspect), p.top_ = std::max(1.0, 1 / aspect);
    p.left_ = -p.right_, p.bottom_ = -p.top_;
    if (o.screenWindow && o.screenWindow->size() == 4) {
        const auto& w = *o.screenWindow;
        if (!std::isfinite(w[0] + w[1] + w[2] + w[3]) || w[0] == w[1] || w[2] == w[3]) return {};
        p.left_ = std::min(w[0], w[1]), p.right_ = std::max(w[0], w[1]);
        p.bottom_ = std::min(w[2], w[3]), p.top_ = std::max(w[2], w[3]);
    }
    p.pixelX_ = (p.right_ - p.left_) / width, p.pixelY_ = (p.top_ - p.bottom_) / height;
    const double reach = filterReach(o) + kMargin;
    p.left_ -= reach * p.pixelX_, p.right_ += reach * p.pixelX_;
    p.bottom_ -= reach * p.pixelY_, p.top_ += reach * p.pixelY_;
    if (p.perspective_) {
        if (!(o.fov > 0 && o.fov < 180)) return {};
        const double t = exact::tan(double(o.fov) * kPi / 360);
        for (double* d : {&p.left_, &p.right_, &p.bottom_, &p.top_, &p.pixelX_, &p.pixelY_}) *d *= t;
    }
    p.near_ = o.clipNear > 0 && std::isfinite(o.clipNear) ? double(o.clipNear) * 0.999 : 0;
    if (o.fstop > 0 && o.fstop < 1e30f && o.focalLength > 0 && o.focalDistance > 0)
        p.lens_ = 0.5 * double(o.focalLength) / o.fstop, p.focus_ = o.focalDistance;
    return p;
}

bool PictureSides::outside(const Bounds& b, double pixels) const {
    for (int i = 0; i < 3; ++i)
        if (!(b.lo[i] <= b.hi[i] && std::fabs(b.lo[i]) < 1e30f && std::fabs(b.hi[i]) < 1e30f)) return false;
    if (double(b.hi.z) < near_) return true;
    // Rays through a lens of radius r deviate from the centre ray by up to r |1 - z / focus|.
    const double z0 = std::max(0.0, double(b.lo.z)), z1 = std::max(0.0, double(b.hi.z));
    const double blur = lens_ * std::max(std::fabs(1 - z0 / focus_), std::fabs(1 - z1 / focus_));
    const double mx = pixels * pixelX_, my = pixels * pixelY_;
    // Minimum of x - side * z over the box, and of the opposite on the other side.
    const auto beyond = [&](double lo, double hi, double from, double to) {
        if (!perspective_) return lo > to + blur || hi < from - blur;
        const double right = lo - std::max(to * z0, to * z1), left = std::min(from * z0, from * z1) - hi;
        return right > blur || left > blur;
    };
    return beyond(b.lo.x, b.hi.x, left_ - mx, right_ + mx) || beyond(b.lo.y, b.hi.y, bottom_ - my, top_ + my);
}

Unseen::Unseen(const Shape& s, const DiceOptions& opt) {
    constexpr double kFacets = 4; // margin: about so many facets between omitted and visible parts
    const scene::Attributes& a = s.attributes();
    // Light comes from all of an emitter, and a solid's boundary separates inside from outside.
    if (!opt.picture || !opt.keys.empty() || a.areaLight >= 0 || !a.solid.empty()) return;
    reach_ = isDisplaced(s, opt) ? displacementReach(s, opt) : 0;
    if (!(reach_ >= 0)) return;
    sides_ = opt.picture;
    pixels_ = kFacets * diceEdge(a);
}

bool Unseen::operator()(Bounds b) const {
    if (!sides_ || b.empty()) return false;
    const float far = float(reach_ * 1.001);
    b.lo = b.lo - Vec3(far), b.hi = b.hi + Vec3(far);
    return sides_->outside(b, pixels_);
}

void ProbedBox::add(const Vec3d& p, const Vec3d& alongU, const Vec3d& alongV) {
    // The surface between probes is nearly straight; steps grow by less than this from one to the next.
    constexpr double kGrowth = 2;
    for (int i = 0; i < 3; ++i) {
        lo_[i] = std::min(lo_[i], p[i]), hi_[i] = std::max(hi_[i], p[i]);
        pad_[i] = std::max(pad_[i], kGrowth * (std::fabs(alongU[i]) + std::fabs(alongV[i])));
    }
}

Bounds ProbedBox::box() const {
    Bounds b;
    const Vec3d lo = lo_ - pad_, hi = hi_ + pad_;
    for (int i = 0; i < 3; ++i)
        if (!std::isfinite(lo[i]) || !std::isfinite(hi[i])) return {};
    b.add(Vec3(lo)), b.add(Vec3(hi));
    return b;
}

} // namespace alpenglow::geometry
