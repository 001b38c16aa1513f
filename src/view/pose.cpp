#include "view/pose.h"
#include "scene/scene.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::view {

Pose::Pose(const scene::Options& o) : home_(o.worldToCamera.first()), view_(home_) {
    double best = -1;
    for (const Vec3d axis : {Vec3d{0, 1, 0}, Vec3d{0, 0, 1}, Vec3d{1, 0, 0}}) { // a tie is the y axis'
        const double y = transformVector(home_, axis).y;
        if (std::fabs(y) <= best + 1e-6) continue;
        best = std::fabs(y);
        up_ = axis * (y < 0 ? -1.0 : 1.0);
    }
    perspective_ = o.projection == "perspective";
    double fov = o.fov;
    if (const scene::Param* p = scene::find(o.projectionParams, "fov"); p && !p->numbers.empty()) fov = p->numbers[0];
    const double aspect = double(std::max(o.xres, 1)) * o.pixelAspect / std::max(o.yres, 1);
    height_ = 2 / std::max(1e-6, std::min(1.0, aspect)); // the shorter side is 2
    if (aspect >= 1) height_ = 2;
    if (o.screenWindow && o.screenWindow->size() == 4) height_ = std::fabs((*o.screenWindow)[3] - (*o.screenWindow)[2]);
    if (perspective_) height_ *= std::tan(std::clamp(fov, 0.1, 179.0) * M_PI / 360);
    // If the origin of the world is in front of the camera, it is a good guess of the subject.
    const double z = transformPoint(home_, {0, 0, 0}).z;
    distance_ = z > 1e-3 && std::isfinite(z) ? z : 1;
}

void Pose::orbit(double right, double down) {
    const Vec3d axis = transformVector(view_, up_);
    view_ = view_ * translateMatrix(0, 0, -distance_) * rotateMatrix(-right, axis.x, axis.y, axis.z) *
            rotateMatrix(-down, 1, 0, 0) * translateMatrix(0, 0, distance_);
    moved_ = true;
}

void Pose::dolly(double factor) {
    if (!(factor > 0) || !std::isfinite(factor)) return;
    factor = std::clamp(factor, 0.01, 100.0);
    if (perspective_) {
        const double nearer = distance_ / factor;
        view_ = view_ * translateMatrix(0, 0, nearer - distance_);
        distance_ = nearer;
    } else zoom_ = std::clamp(zoom_ * factor, 1e-6, 1e6);
    moved_ = true;
}

void Pose::pan(double right, double up) {
    const double unit = height_ * (perspective_ ? distance_ : 1 / zoom_);
    view_ = view_ * translateMatrix(right * unit, up * unit, 0);
    moved_ = true;
}

void Pose::setDistance(double d) {
    if (d > 0 && std::isfinite(d) && d < 1e30) distance_ = d;
}

void Pose::keepFrom(const Pose& old) {
    if (!old.moved_) return;
    bool singular = false;
    const Matrix turn = inverse(old.home_, &singular) * old.view_;
    if (singular) return;
    view_ = home_ * turn;
    distance_ = old.distance_;
    zoom_ = old.zoom_;
    moved_ = true;
}

void Pose::apply(scene::Options& o) const {
    if (!moved_) return;
    const Matrix turn = inverse(home_) * view_;
    for (Matrix& key : o.worldToCamera.keys) key = key * turn;
    if (perspective_ || zoom_ == 1) return;
    if (!o.screenWindow || o.screenWindow->size() != 4) {
        const float a = float(std::max(o.xres, 1)) * o.pixelAspect / float(std::max(o.yres, 1));
        o.screenWindow = a >= 1 ? std::vector<float>{-a, a, -1, 1} : std::vector<float>{-1, 1, -1 / a, 1 / a};
    }
    std::vector<float>& w = *o.screenWindow;
    for (int k : {0, 2}) {
        const float middle = (w[size_t(k)] + w[size_t(k) + 1]) / 2, half = (w[size_t(k) + 1] - w[size_t(k)]) / 2 / float(zoom_);
        w[size_t(k)] = middle - half;
        w[size_t(k) + 1] = middle + half;
    }
}

Matrix Pose::to(const Pose& other) const { return inverse(view_) * other.view_; }

namespace {

class Turned final : public render::Tracer {
public:
    Turned(std::unique_ptr<render::Tracer> of, const Matrix& m) : of_(std::move(of)), m_(m) {}
    bool trace(std::span<const integrator::CameraRay> rays, std::span<integrator::SampleResult> results,
               const StopFlag* stop) override {
        rays_.assign(rays.begin(), rays.end());
        for (integrator::CameraRay& r : rays_) {
            const Vec3d o = transformPoint(m_, {r.origin.x, r.origin.y, r.origin.z});
            const Vec3d d = transformVector(m_, {r.direction.x, r.direction.y, r.direction.z});
            const double length = std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
            r.origin = {float(o.x), float(o.y), float(o.z)};
            r.direction = {float(d.x / length), float(d.y / length), float(d.z / length)};
        }
        return of_->trace(rays_, results, stop);
    }
    const integrator::Counters& counters() const override { return of_->counters(); }

private:
    std::unique_ptr<render::Tracer> of_;
    Matrix m_;
    std::vector<integrator::CameraRay> rays_;
};

} // namespace

std::unique_ptr<render::Tracer> turned(std::unique_ptr<render::Tracer> of, const Matrix& toBuilt) {
    return std::make_unique<Turned>(std::move(of), toBuilt);
}

} // namespace alpenglow::view
