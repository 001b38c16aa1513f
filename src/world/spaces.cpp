// Coordinate systems: of the camera, named ones, and the matrices between them.
#include "base/exact.h"
#include "scene/scene.h"
#include "world/lightobjects.h"
#include "world/mutableworld.h"
#include <set>

namespace alpenglow::world {

namespace {

// Screen window: docs/design/ri.md; frame aspect from FrameAspectRatio or the format.
void screenWindow(const scene::Options& o, double w[4]) {
    if (o.screenWindow && o.screenWindow->size() == 4) {
        for (int i = 0; i < 4; ++i) w[i] = (*o.screenWindow)[size_t(i)];
        return;
    }
    double pa = o.pixelAspect > 0 ? o.pixelAspect : 1, a = o.frameAspect ? *o.frameAspect : o.xres * pa / std::max(o.yres, 1);
    if (!(a > 0)) a = 1;
    double x = a >= 1 ? a : 1, y = a >= 1 ? 1 : 1 / a;
    w[0] = -x;
    w[1] = x;
    w[2] = -y;
    w[3] = y;
}

} // namespace

void MutableWorld::setCamera(const scene::Options& o) {
    shutter_ = scene::Shutter(o);
    worldToCamera_ = scene::at(o.worldToCamera, shutter_.open);
    cameraToWorld_ = inverse(worldToCamera_);
    double sw[4];
    screenWindow(o, sw);
    double near = o.clipNear, far = std::min(double(o.clipFar), 1e30);
    if (o.projection == "perspective") {
        double k = 1 / exact::tan(o.fov * kPi / 360);
        Matrix m;
        m.m[0][0] = m.m[1][1] = k;
        m.m[2][2] = far / (far - near);
        m.m[2][3] = 1;
        m.m[3][2] = -far * near / (far - near);
        m.m[3][3] = 0;
        cameraToScreen_ = m;
    } else {
        cameraToScreen_ = translateMatrix(0, 0, -near) * scaleMatrix(1, 1, 1 / (far - near));
    }
    screenToNdc_ = translateMatrix(-sw[0], -sw[3], 0) * scaleMatrix(1 / (sw[1] - sw[0]), -1 / (sw[3] - sw[2]), 1);
    ndcToRaster_ = scaleMatrix(o.xres, o.yres, 1);
}
bool WorldImpl::knowsSpace(const std::string& name) const {
    static const std::set<std::string> kOwn = {"current", "camera", "eye",    "world", "screen",
                                               "NDC",     "raster", "object", "shader"};
    Matrix m;
    return placeOf(name, m) || kOwn.count(name) || frame_->coordinateSystems.count(name) ||
           frame_->options.cameraSpaces.count(name);
}

void MutableWorld::keepSpaces(std::span<const rsl::InputName> spaces) {
    for (const rsl::InputName& s : spaces)
        if (Matrix m; matrix(s.from, s.to, m)) spaces_[s.from].emplace(s.to, m);
}

bool WorldImpl::matrix(const std::string& from, const std::string& to, Matrix& out) const {
    if (const auto kept = spaces_.find(from); kept != spaces_.end())
        if (const auto there = kept->second.find(to); there != kept->second.end()) {
            out = there->second;
            return true;
        }
    auto toCurrent = [&](const std::string& name, Matrix& m) {
        if (name == "current" || name == "camera" || name == "eye") {
            m = Matrix{};
            return true;
        }
        if (placeOf(name, m)) return true;
        if (name == "world") {
            m = worldToCamera_;
            return true;
        }
        if (name == "screen") {
            m = inverse(cameraToScreen_);
            return true;
        }
        if (name == "NDC") {
            m = inverse(screenToNdc_) * inverse(cameraToScreen_);
            return true;
        }
        if (name == "raster") {
            m = inverse(ndcToRaster_) * inverse(screenToNdc_) * inverse(cameraToScreen_);
            return true;
        }
        if (auto i = frame_->coordinateSystems.find(name); i != frame_->coordinateSystems.end()) {
            m = scene::at(i->second, shutter_.open) * worldToCamera_;
            return true;
        }
        if (auto i = frame_->options.cameraSpaces.find(name); i != frame_->options.cameraSpaces.end()) {
            m = scene::at(i->second, shutter_.open);
            return true;
        }
        if (name == "object" || name == "shader") {
            m = worldToCamera_;
            return true;
        } // no object here (imagers, lights): world
        return false;
    };
    Matrix a, b;
    bool known = toCurrent(from, a);
    bool knownTo = toCurrent(to, b);
    if (!known || !knownTo) {
        diagnostics_->reportOnce("unknown space " + (known ? to : from),
                                 {Severity::Warning,
                                  Rie::BadHandle,
                                  {},
                                  "unknown coordinate system \"" + (known ? to : from) + "\"; taken as \"current\"",
                                  {},
                                  {}});
    }
    if (to == "screen") b = Matrix{}, out = a * cameraToScreen_;
    else if (to == "NDC") out = a * cameraToScreen_ * screenToNdc_;
    else if (to == "raster") out = a * cameraToScreen_ * screenToNdc_ * ndcToRaster_;
    else out = a * inverse(b);
    return known && knownTo;
}

} // namespace alpenglow::world
