#include "texture/shadow.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::texture {
namespace {

/// Projection to NDC; false at or behind the eye plane.
bool project(const Matrix& m, const Vec3d& p, double& x, double& y) {
    double w = p.x * m.m[0][3] + p.y * m.m[1][3] + p.z * m.m[2][3] + m.m[3][3];
    if (!(w > 1e-12)) return false;
    x = (p.x * m.m[0][0] + p.y * m.m[1][0] + p.z * m.m[2][0] + m.m[3][0]) / w;
    y = (p.x * m.m[0][1] + p.y * m.m[1][1] + p.z * m.m[2][1] + m.m[3][1]) / w;
    return std::isfinite(x) && std::isfinite(y);
}

/// Bilinear part of the four texels around (s, t) that shadow depth z; texels outside do not.
double shadowed(const Level& map, double s, double t, double z) {
    double x = std::clamp(s * map.width - 0.5, -2.0, map.width + 1.0),
           y = std::clamp(t * map.height - 0.5, -2.0, map.height + 1.0);
    int x0 = int(std::floor(x)), y0 = int(std::floor(y));
    double fx = x - x0, fy = y - y0, sum = 0;
    for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 2; ++i) {
            int px = x0 + i, py = y0 + j;
            if (px < 0 || py < 0 || px >= map.width || py >= map.height) continue;
            size_t at = (size_t(py) * size_t(map.width) + size_t(px)) * size_t(map.channels);
            double depth = map.codes.empty() ? double(map.values[at]) : double(map.codes[at]) / 255;
            if (z > depth) sum += (i ? fx : 1 - fx) * (j ? fy : 1 - fy);
        }
    return sum;
}

} // namespace

float shadowLookup(Handle h, const Vec3d& p, const Vec3d& ddx, const Vec3d& ddy, const ShadowOptions& o) {
    double s, t, xs, xt, ys, yt;
    if (!h || h->levels.empty() || !h->worldToCamera || !h->worldToNDC || !project(*h->worldToNDC, p, s, t)) return 0;
    if (!project(*h->worldToNDC, p + ddx, xs, xt)) {
        xs = s;
        xt = t;
    }
    if (!project(*h->worldToNDC, p + ddy, ys, yt)) {
        ys = s;
        yt = t;
    }
    double z = transformPoint(*h->worldToCamera, p).z - double(o.bias);
    double ws = std::min(1.0, (std::fabs(xs - s) + std::fabs(ys - s)) * double(o.swidth) + double(o.sblur));
    double wt = std::min(1.0, (std::fabs(xt - t) + std::fabs(yt - t)) * double(o.twidth) + double(o.tblur));
    if (!(ws >= 0)) ws = 0;
    if (!(wt >= 0)) wt = 0;
    // A regular grid over the footprint: bilinear comparison makes it continuous, and the same everywhere.
    int k = int(std::ceil(std::sqrt(std::clamp(std::isfinite(o.samples) ? double(o.samples) : 1.0, 1.0, 1024.0))));
    if (ws * h->width() < 0.5 && wt * h->height() < 0.5) k = 1;
    double sum = 0;
    for (int j = 0; j < k; ++j)
        for (int i = 0; i < k; ++i)
            sum += shadowed(h->levels[0], s + ((i + 0.5) / k - 0.5) * ws, t + ((j + 0.5) / k - 0.5) * wt, z);
    return float(sum / (double(k) * k));
}

} // namespace alpenglow::texture
