#include "texture/shadow.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::texture {
namespace {

constexpr float kNoSurface = 1e30f; ///< a depth from here on: no surface; RI_INFINITY is 1e38

/// Projection to NDC; false at or behind the eye plane.
bool project(const Matrix& m, const Vec3d& p, double& x, double& y) {
    double w = p.x * m.m[0][3] + p.y * m.m[1][3] + p.z * m.m[2][3] + m.m[3][3];
    if (!(w > 1e-12)) return false;
    x = (p.x * m.m[0][0] + p.y * m.m[1][0] + p.z * m.m[2][0] + m.m[3][0]) / w;
    y = (p.x * m.m[0][1] + p.y * m.m[1][1] + p.z * m.m[2][1] + m.m[3][1]) / w;
    return std::isfinite(x) && std::isfinite(y);
}

/// Bilinear fraction of the four texels around (s, t) whose depth passes the test; texels outside do not.
template <class Test> double part(const Level& map, double s, double t, Test&& test) {
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
            if (test(depth)) sum += (i ? fx : 1 - fx) * (j ? fy : 1 - fy);
        }
    return sum;
}

/// Opacity of a deep map at depth z, by channel.
Vec3d deepPart(const Texture& map, double s, double t, double z) {
    const int width = map.width(), height = map.height();
    const double x = std::clamp(s * width - 0.5, -2.0, width + 1.0), y = std::clamp(t * height - 0.5, -2.0, height + 1.0);
    const int x0 = int(std::floor(x)), y0 = int(std::floor(y));
    const double fx = x - x0, fy = y - y0;
    Vec3d sum(0.0);
    for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 2; ++i) {
            const int px = x0 + i, py = y0 + j;
            if (px < 0 || py < 0 || px >= width || py >= height) continue;
            double left[3];
            map.deep->transmittanceAt(size_t(py) * size_t(width) + size_t(px), z, left);
            sum = sum + Vec3d(1 - left[0], 1 - left[1], 1 - left[2]) * ((i ? fx : 1 - fx) * (j ? fy : 1 - fy));
        }
    return sum;
}

/// How many comparisons there are along one side of their grid.
int gridOf(const ShadowOptions& o) {
    return int(std::ceil(std::sqrt(std::clamp(std::isfinite(o.samples) ? double(o.samples) : 1.0, 1.0, 1024.0))));
}

/// Low-discrepancy numbers in [0, 1), multiples of the golden ratio, uncorrelated with grid positions.
double spread(int i) {
    const double g = 0.6180339887498949 * (i + 0.5);
    return g - std::floor(g);
}

/// Samples a regular grid over a box in NDC: bilinear comparison makes it continuous, without noise.
Color overBox(const Texture& of, double s, double t, double ws, double wt, double z, const ShadowOptions& o) {
    const Level& map = of.levels[0];
    ws = std::isfinite(ws) ? std::clamp(ws, 0.0, 1.0) : 0;
    wt = std::isfinite(wt) ? std::clamp(wt, 0.0, 1.0) : 0;
    int k = gridOf(o);
    if (ws * map.width < 0.5 && wt * map.height < 0.5 && o.bias0 == o.bias1) k = 1;
    double sum = 0;
    Vec3d sums(0.0);
    for (int j = 0; j < k; ++j)
        for (int i = 0; i < k; ++i) {
            const double at = z - o.bias0 - (double(o.bias1) - o.bias0) * spread(j * k + i);
            const double atS = s + ((i + 0.5) / k - 0.5) * ws, atT = t + ((j + 0.5) / k - 0.5) * wt;
            if (of.deep) sums = sums + deepPart(of, atS, atT, at);
            else sum += part(map, atS, atT, [&](double depth) { return at > depth; });
        }
    return of.deep ? Color(sums / (double(k) * k)) : Color(float(sum / (double(k) * k)));
}

/// Fraction of an area light that is hidden from a point. On the segment from the point to each of k x k positions on the source
/// the map is tested at uniform steps: a surface is hit if the segment is behind it by at most the depth of a step, or the
/// thickness of surfaces.
Color overSource(const Texture& h, const Vec3d& p, const std::array<Vec3d, 4>& source, const ShadowOptions& o) {
    constexpr int kSteps = 64;
    const int k = gridOf(o);
    Vec3d sum(0.0);
    for (int n = 0; n < k * k; ++n) {
        const double u = (n % k + 0.5) / k, v = (n / k + 0.5) / k;
        const Vec3d q = (source[0] * (1 - u) + source[1] * u) * (1 - v) + (source[3] * (1 - u) + source[2] * u) * v;
        const double bias = o.bias0 + (double(o.bias1) - o.bias0) * spread(n);
        // Largest depth behind a surface at the first step after crossing it.
        const double deep = std::fabs(transformPoint(*h.worldToCamera, q).z - transformPoint(*h.worldToCamera, p).z) / kSteps;
        const double gap = std::max(double(o.gapbias), deep * (1 + 1e-9));
        double blocked = 0;
        Vec3d left(1.0); // for a deep map: each step applies the opacity between it and the gap before it
        for (int i = 0; i < kSteps && blocked < 1; ++i) {
            const Vec3d at = p + (q - p) * ((i + 0.5) / kSteps);
            double s, t;
            if (!project(*h.worldToNDC, at, s, t)) break;
            const double z = transformPoint(*h.worldToCamera, at).z;
            if (h.deep) {
                const Vec3d near = deepPart(h, s, t, z - bias - gap), far = deepPart(h, s, t, z - bias);
                for (int c = 0; c < 3; ++c) left[c] *= near[c] < 1 ? (1 - far[c]) / (1 - near[c]) : 1;
            } else
                blocked =
                    std::max(blocked, part(h.levels[0], s, t, [&](double d) { return z - bias > d && z - bias - d <= gap; }));
        }
        sum = sum + (h.deep ? Vec3d(1.0) - left : Vec3d(blocked));
    }
    return Color(sum / (double(k) * k));
}

/// For a map with faces, the face whose centre is nearest to the point; the map itself without faces. Null: no face sees the
/// point.
const Texture* faceOf(Handle h, const Vec3d& p) {
    if (!h) return nullptr;
    const auto usable = [](const Texture& t) { return !t.levels.empty() && t.worldToCamera && t.worldToNDC; };
    if (h->tiles.empty()) return usable(*h) ? h : nullptr;
    const Texture* best = nullptr;
    double nearest = 0.5 + 1e-9, s, t;
    for (const auto& [number, face] : h->tiles)
        if (usable(*face) && project(*face->worldToNDC, p, s, t))
            if (const double off = std::max(std::fabs(s - 0.5), std::fabs(t - 0.5)); off < nearest) {
                nearest = off;
                best = face.get();
            }
    return best;
}

bool finite(const Vec3d& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

} // namespace

std::optional<std::pair<float, float>> depthsOf(const Texture& of) {
    if (of.deep || of.levels.empty()) return std::nullopt;
    const Level& map = of.levels[0];
    std::pair<float, float> range(kNoSurface, 0.f);
    const int across = std::max(1, map.width / 64), down = std::max(1, map.height / 64);
    for (int y = down / 2; y < map.height; y += down)
        for (int x = across / 2; x < map.width; x += across) {
            const size_t at = (size_t(y) * size_t(map.width) + size_t(x)) * size_t(map.channels);
            const float z = map.codes.empty() ? map.values[at] : float(map.codes[at]) / 255;
            if (z < kNoSurface) range = {std::min(range.first, z), std::max(range.second, z)};
        }
    if (range.first == kNoSurface) return std::nullopt;
    return range;
}

Color shadowLookup(Handle map, const Vec3d& p, const Vec3d& ddx, const Vec3d& ddy, const ShadowOptions& o) {
    const Texture* h = faceOf(map, p);
    double s, t, xs, xt, ys, yt;
    if (!h || !project(*h->worldToNDC, p, s, t)) return Color(0);
    if (o.source) return overSource(*h, p, *o.source, o);
    if (!project(*h->worldToNDC, p + ddx, xs, xt)) {
        xs = s;
        xt = t;
    }
    if (!project(*h->worldToNDC, p + ddy, ys, yt)) {
        ys = s;
        yt = t;
    }
    const double ws = (std::fabs(xs - s) + std::fabs(ys - s)) * double(o.swidth) + double(o.sblur);
    const double wt = (std::fabs(xt - t) + std::fabs(yt - t)) * double(o.twidth) + double(o.tblur);
    return overBox(*h, s, t, ws, wt, transformPoint(*h->worldToCamera, p).z, o);
}

Color shadowLookupQuad(Handle map, const Vec3d world[4], const ShadowOptions& o) {
    const Vec3d middle = (world[0] + world[1] + world[2] + world[3]) * 0.25;
    const Texture* h = faceOf(map, middle);
    if (!h || !finite(middle)) return Color(0);
    if (o.source) return overSource(*h, middle, *o.source, o);
    double s0 = 1e300, s1 = -1e300, t0 = 1e300, t1 = -1e300, z = 0;
    for (int i = 0; i < 4; ++i) {
        double s, t;
        if (!project(*h->worldToNDC, world[i], s, t)) return Color(0);
        s0 = std::min(s0, s), s1 = std::max(s1, s);
        t0 = std::min(t0, t), t1 = std::max(t1, t);
        z += transformPoint(*h->worldToCamera, world[i]).z / 4;
    }
    return overBox(*h, (s0 + s1) / 2, (t0 + t1) / 2, (s1 - s0) * double(o.swidth) + double(o.sblur),
                   (t1 - t0) * double(o.twidth) + double(o.tblur), z, o);
}

} // namespace alpenglow::texture
