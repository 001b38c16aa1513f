// Environment maps: latitude-longitude and cube faces. Known limit: reduced levels weight texels by area on the map, not by solid
// angle, so very wide blurs overweight the poles. A footprint stays on one cube face.
#include "base/exact.h"
#include "texture/lookup.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::texture {
namespace {

/// Angle of (x, y) in [0, 2 pi); by series, so that it is the same with every C library. Error below 1e-9.
double angleOf(double y, double x) {
    double ax = std::fabs(x), ay = std::fabs(y);
    if (ax == 0 && ay == 0) return 0;
    bool steep = ay > ax;
    double q = steep ? ax / ay : ay / ax, offset = 0; // in [0, 1]
    if (q > 0.41421356237309503) {                    // tan(pi/8): rotates by pi/4 toward 0
        q = (q - 1) / (q + 1);
        offset = kPi / 4;
    }
    double q2 = q * q, sum = 0;
    for (int k = 12; k >= 0; --k) sum = (k % 2 ? -1.0 : 1.0) / (2 * k + 1) + q2 * sum;
    double angle = offset + q * sum;
    if (steep) angle = kPi / 2 - angle;
    if (x < 0) angle = kPi - angle;
    return y < 0 ? 2 * kPi - angle : angle;
}

/// Axes of the cube faces: right, up and outward.
struct Face {
    Vec3 right, up, out;
};
constexpr Face faces[6] = {{{0, 0, -1}, {0, 1, 0}, {1, 0, 0}}, {{0, 0, 1}, {0, 1, 0}, {-1, 0, 0}},
                           {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}, {{1, 0, 0}, {0, 0, 1}, {0, -1, 0}},
                           {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},  {{-1, 0, 0}, {0, 1, 0}, {0, 0, -1}}};

const Texture* faceMap(Handle h, int face) {
    auto i = h->tiles.find(face);
    return i == h->tiles.end() || i->second->levels.empty() ? nullptr : i->second.get();
}

void fillAll(int count, const LookupOptions& o, float* out, float* slopes, float* curves) {
    for (int c = 0; c < count; ++c) out[c] = o.fill;
    if (slopes) std::fill_n(slopes, 3 * count, 0.0f);
    if (curves) std::fill_n(curves, 6 * count, 0.0f);
}

/// How (s, t) change with the direction, by its components. differentiate(direction, change, ds, dt).
struct Jacobian {
    Vec3 s, t;
    template <class Differentiate> Jacobian(const Vec3& d, Differentiate differentiate) {
        // Differences that differentiate() would clamp are next to a pole: uses small steps, and 0 if even these are clamped.
        const float step = length(d) / 1024;
        for (int k = 0; k < 3; ++k) {
            float a = 0, b = 0;
            if (step > 0) differentiate(d, Vec3(k == 0, k == 1, k == 2) * step, a, b);
            s[k] = std::fabs(a) < 1 ? a / step : 0;
            t[k] = std::fabs(b) < 1 ? b / step : 0;
            if (!std::isfinite(s[k]) || !std::isfinite(t[k])) s[k] = t[k] = 0;
        }
    }
};

/// The lookup, with slopes and curves by s and t turned into those by the direction.
template <class Differentiate>
void look(const Texture& tex, int first, int count, float s, float t, const Footprint& fp, const LookupOptions& o, Wrap swrap,
          const Vec3& d, Differentiate differentiate, float* out, float* slopes, float* curves) {
    filteredLookup(tex, first, count, s, t, fp, o, swrap, Wrap::Clamp, out, slopes, curves);
    if (!slopes) return;
    const Jacobian by(d, differentiate);
    if (curves) {
        // The change of the Jacobian: differences over a small step of the direction.
        const float step = length(d) / 256;
        Vec3 s2[3], t2[3];
        for (int k = 0; k < 3; ++k) {
            const Vec3 e = Vec3(k == 0, k == 1, k == 2) * step;
            const Jacobian after(d + e, differentiate), before(d - e, differentiate);
            s2[k] = step > 0 ? (after.s - before.s) / (2 * step) : Vec3();
            t2[k] = step > 0 ? (after.t - before.t) / (2 * step) : Vec3();
        }
        for (int c = 0; c < count; ++c) { // three runs are read before six are written
            const float ss = curves[c], st = curves[count + c], tt = curves[2 * count + c], ds = slopes[c],
                        dt = slopes[count + c];
            float run[6];
            int n = 0;
            for (int k = 0; k < 3; ++k)
                for (int l = k; l < 3; ++l) {
                    const float v = ss * by.s[k] * by.s[l] + st * (by.s[k] * by.t[l] + by.t[k] * by.s[l]) +
                                    tt * by.t[k] * by.t[l] + 0.5f * (ds * (s2[k][l] + s2[l][k]) + dt * (t2[k][l] + t2[l][k]));
                    run[n++] = std::isfinite(v) ? v : 0;
                }
            for (int r = 0; r < 6; ++r) curves[r * count + c] = run[r];
        }
    }
    for (int c = 0; c < count; ++c) { // the third run is free; the other two are read before they are written
        const float bs = slopes[c], bt = slopes[count + c];
        for (int k = 0; k < 3; ++k) slopes[k * count + c] = bs * by.s[k] + bt * by.t[k];
    }
}

/// The footprint of four corners, as changes from their mean (lookupQuad has the reason).
template <class Differentiate> Footprint quadFootprint(const Vec3 d[4], const Vec3& mean, Differentiate differentiate) {
    Footprint fp;
    for (int i = 0; i < 4; ++i) {
        float ds, dt;
        differentiate(mean, d[i] - mean, ds, dt);
        fp.ss += ds * ds;
        fp.st += ds * dt;
        fp.tt += dt * dt;
    }
    return fp;
}

} // namespace

int cubeFace(const Vec3& d, float cot, float& s, float& t) {
    float x = std::fabs(d.x), y = std::fabs(d.y), z = std::fabs(d.z);
    int face = x >= y && x >= z ? (d.x >= 0 ? 0 : 1) : y >= z ? (d.y >= 0 ? 2 : 3) : d.z >= 0 ? 4 : 5;
    float ahead = dot(d, faces[face].out);
    if (!(ahead > 0) || !std::isfinite(ahead)) {
        s = t = 0.5f;
        return face;
    }
    s = 0.5f + 0.5f * cot * dot(d, faces[face].right) / ahead;
    t = 0.5f - 0.5f * cot * dot(d, faces[face].up) / ahead;
    return face;
}

void cubeDifferentiate(int face, const Vec3& d, const Vec3& change, float cot, float& ds, float& dt) {
    const Face& f = faces[face];
    double a = dot(Vec3d(d), Vec3d(f.out)), da = dot(Vec3d(change), Vec3d(f.out));
    auto one = [&](const Vec3& axis) {
        double v = dot(Vec3d(d), Vec3d(axis)), dv = dot(Vec3d(change), Vec3d(axis));
        double r = 0.5 * double(cot) * (dv * a - v * da) / (a * a);
        return std::isfinite(r) ? float(std::clamp(r, -1.0, 1.0)) : 0.0f;
    };
    ds = one(f.right);
    dt = -one(f.up);
}

void environment(Handle h, const LatLong& map, int first, int count, const Vec3& d, const Vec3& ddx, const Vec3& ddy,
                 const LookupOptions& o, float* out, float* slopes, float* curves) {
    if (!h || h->kind != Kind::Cube) return environmentLatLong(h, map, first, count, d, ddx, ddy, o, out, slopes, curves);
    float s, t, dsdx, dtdx, dsdy, dtdy;
    int face = cubeFace(d, h->fovCotangent, s, t);
    const Texture* tex = faceMap(h, face);
    if (!tex) return fillAll(count, o, out, slopes, curves);
    cubeDifferentiate(face, d, ddx, h->fovCotangent, dsdx, dtdx);
    cubeDifferentiate(face, d, ddy, h->fovCotangent, dsdy, dtdy);
    const auto by = [&](const Vec3& at, const Vec3& c, float& a, float& b) {
        cubeDifferentiate(face, at, c, h->fovCotangent, a, b);
    };
    look(*tex, first, count, s, t, Footprint::sides(dsdx, dtdx, dsdy, dtdy), o, Wrap::Clamp, d, by, out, slopes, curves);
}

void environmentQuad(Handle h, const LatLong& map, int first, int count, const Vec3 d[4], const LookupOptions& o, float* out,
                     float* slopes, float* curves) {
    if (!h || h->kind != Kind::Cube) return environmentLatLongQuad(h, map, first, count, d, o, out, slopes, curves);
    Vec3 mean = (d[0] + d[1] + d[2] + d[3]) * 0.25f;
    float s, t;
    int face = cubeFace(mean, h->fovCotangent, s, t);
    const Texture* tex = faceMap(h, face);
    if (!tex) return fillAll(count, o, out, slopes, curves);
    const auto by = [&](const Vec3& at, const Vec3& c, float& ds, float& dt) {
        cubeDifferentiate(face, at, c, h->fovCotangent, ds, dt);
    };
    look(*tex, first, count, s, t, quadFootprint(d, mean, by), o, Wrap::Clamp, mean, by, out, slopes, curves);
}

void LatLong::project(const Vec3& d, float& s, float& t) const {
    Vec3d v(d);
    double m = std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
    if (!(m > 0) || !std::isfinite(m)) {
        s = t = 0.5f;
        return;
    }
    v /= m;
    double x = dot(v, Vec3d(zero)), y = dot(v, Vec3d(quarter)), z = dot(v, Vec3d(pole));
    s = float(angleOf(y, x) / (2 * kPi));
    t = float(angleOf(std::sqrt(x * x + y * y), z) / kPi);
}

void LatLong::differentiate(const Vec3& d, const Vec3& change, float& ds, float& dt) const {
    Vec3d v(d), c(change);
    double x = dot(v, Vec3d(zero)), y = dot(v, Vec3d(quarter)), z = dot(v, Vec3d(pole));
    double cx = dot(c, Vec3d(zero)), cy = dot(c, Vec3d(quarter)), cz = dot(c, Vec3d(pole));
    double r2 = x * x + y * y, r = std::sqrt(r2), all = r2 + z * z;
    double turn = x * cy - y * cx, dr = r > 0 ? (x * cx + y * cy) / r : std::sqrt(cx * cx + cy * cy);
    double s = r2 > 0 ? turn / r2 / (2 * kPi) : dr > 0 ? 1.0 : 0.0;
    ds = float(std::clamp(s, -1.0, 1.0));
    dt = all > 0 ? float(std::clamp((z * dr - r * cz) / all / kPi, -1.0, 1.0)) : 0.0f;
    if (std::isnan(ds)) ds = 0;
    if (std::isnan(dt)) dt = 0;
}

Vec3 LatLong::direction(float s, float t) const {
    double phi = 2 * kPi * double(s), theta = kPi * double(t);
    const exact::SinCos round = exact::sinCos(phi), down = exact::sinCos(theta);
    Vec3d d = Vec3d(zero) * (round.cos * down.sin) + Vec3d(quarter) * (round.sin * down.sin) + Vec3d(pole) * down.cos;
    return Vec3(d);
}

void environmentLatLong(Handle h, const LatLong& map, int first, int count, const Vec3& direction, const Vec3& ddx,
                        const Vec3& ddy, const LookupOptions& o, float* out, float* slopes, float* curves) {
    if (!h || h->levels.empty()) return fillAll(count, o, out, slopes, curves);
    float s, t, dsdx, dtdx, dsdy, dtdy;
    map.project(direction, s, t);
    map.differentiate(direction, ddx, dsdx, dtdx);
    map.differentiate(direction, ddy, dsdy, dtdy);
    const auto by = [&](const Vec3& at, const Vec3& c, float& a, float& b) { map.differentiate(at, c, a, b); };
    look(*h, first, count, s, t, Footprint::sides(dsdx, dtdx, dsdy, dtdy), o, Wrap::Periodic, direction, by, out, slopes, curves);
}

void environmentLatLongQuad(Handle h, const LatLong& map, int first, int count, const Vec3 d[4], const LookupOptions& o,
                            float* out, float* slopes, float* curves) {
    if (!h || h->levels.empty()) return fillAll(count, o, out, slopes, curves);
    Vec3 mean = (d[0] + d[1] + d[2] + d[3]) * 0.25f;
    float s, t;
    map.project(mean, s, t);
    const auto by = [&](const Vec3& at, const Vec3& c, float& ds, float& dt) { map.differentiate(at, c, ds, dt); };
    look(*h, first, count, s, t, quadFootprint(d, mean, by), o, Wrap::Periodic, mean, by, out, slopes, curves);
}

} // namespace alpenglow::texture
