#include "ri/userprojection.h"
#include "base/exact.h"
#include "scene/scene.h"
#include <cmath>

namespace alpenglow::ri {

namespace {

/// Columns of a matrix are linear functions of a point: how fast each grows.
double growth(const Matrix& m, int column) {
    return std::sqrt(m.m[0][column] * m.m[0][column] + m.m[1][column] * m.m[1][column] + m.m[2][column] * m.m[2][column]);
}

} // namespace

bool takeProjection(scene::Transform& worldToCamera, scene::Options& o) {
    constexpr double kNoise = 1e-6; // rounding of inverses in single precision
    if (o.projection == "perspective") return false;
    const Matrix first = worldToCamera.first();
    if (!(growth(first, 3) > kNoise * std::fabs(first.m[3][3])) || growth(first, 3) < kNoise) return false;
    double kx = 0, ky = 0;
    for (Matrix& m : worldToCamera.keys) {
        // Screen x = column 0 / column 3, y = column 1 / column 3, and column 3 grows with depth.
        const double depth = growth(m, 3), x = growth(m, 0), y = growth(m, 1);
        if (!(depth > 0) || !(x > 0) || !(y > 0) || !std::isfinite(depth + x + y)) return false;
        if (&m == &worldToCamera.keys.front()) kx = x / depth, ky = y / depth;
        Matrix a;
        for (int i = 0; i < 4; ++i) {
            a.m[i][0] = m.m[i][0] / x;
            a.m[i][1] = m.m[i][1] / y;
            a.m[i][2] = m.m[i][3] / depth;
            a.m[i][3] = i == 3;
        }
        m = a;
    }
    o.projection = "perspective";
    o.fov = float(2 * exact::atan(1 / ky) * 180 / kPi);
    if (std::fabs(kx / ky - 1) < kNoise) return true;
    const double aspect =
        o.frameAspect ? double(*o.frameAspect) : double(o.xres) * (o.pixelAspect > 0 ? o.pixelAspect : 1) / o.yres;
    const double right = aspect >= 1 ? aspect : 1, top = aspect >= 1 ? 1 : 1 / aspect;
    if (!o.screenWindow) o.screenWindow = std::vector<float>{float(-right), float(right), float(-top), float(top)};
    for (size_t i = 0; i < 2; ++i) (*o.screenWindow)[i] = float((*o.screenWindow)[i] * ky / kx);
    return true;
}

} // namespace alpenglow::ri
