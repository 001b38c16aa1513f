// The oracle: a plain path tracer of the Muttenzer box. Planes and spheres met in double, materials and light written out. It
// shares nothing with the renderer but the arithmetic of C++. World space, right-handed, y up (docs/design/muttenzer-box.md).
// box_oracle_embree.h has a second way to meet the box, for box_bench.
#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <random>

namespace oracle {

struct V {
    double x = 0, y = 0, z = 0;
};
inline V operator+(V a, V b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline V operator-(V a, V b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline V operator*(V a, double s) { return {a.x * s, a.y * s, a.z * s}; }
inline V operator*(V a, V b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
inline double dot(V a, V b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline V unit(V a) { return a * (1 / std::sqrt(dot(a, a))); }

enum Material { Diffuse, Mirror, Glass, Light };
struct Hit {
    double t = 1e30;
    V p, n;
    Material m = Diffuse;
    V albedo;
};

/// The way to meet that knows the box: each plane and sphere asked in turn, in double. The tests' way.
struct Analytic {
    bool spheres = true;
    static constexpr double kOff = 1e-7; ///< rays start this far from what they leave
#ifdef ORACLE_COUNTS_RAYS
    mutable uint64_t rays = 0; ///< calls of meet()
#endif

    bool meet(V o, V d, Hit& h) const {
#ifdef ORACLE_COUNTS_RAYS
        ++rays;
#endif
        h.t = 1e30;
        auto plane = [&](int axis, double at, double sign, V albedo) {
            double oa = axis == 0 ? o.x : axis == 1 ? o.y : o.z, da = axis == 0 ? d.x : axis == 1 ? d.y : d.z;
            if (da == 0) return;
            double t = (at - oa) / da;
            if (!(t > 1e-9) || t >= h.t) return;
            V p = o + d * t;
            const double e = 1e-9;
            if (p.x < -1.48 - e || p.x > 1.48 + e || p.y < -1.25 - e || p.y > 1.19 + e || p.z < -1.55 - e || p.z > 1.79 + e)
                return;
            h = {t, p, {axis == 0 ? sign : 0, axis == 1 ? sign : 0, axis == 2 ? sign : 0}, Diffuse, albedo};
        };
        V grey{.75, .75, .75};
        plane(1, -1.25, 1, grey);
        plane(1, 1.19, -1, grey);
        plane(2, -1.55, 1, grey);
        plane(0, -1.48, 1, {.75, .25, .25});
        plane(0, 1.48, -1, {.25, .25, .75});
        if (d.y != 0) {
            double t = (1.18 - o.y) / d.y;
            V p = o + d * t;
            if (t > 1e-9 && t < h.t && std::fabs(p.x) <= .5 && std::fabs(p.z - .25) <= .325) h = {t, p, {0, -1, 0}, Light, {}};
        }
        if (spheres) {
            auto sphere = [&](V c, double r, Material m) {
                V oc = o - c;
                double b = dot(oc, d), disc = b * b - dot(oc, oc) + r * r;
                if (disc <= 0) return;
                double s = std::sqrt(disc);
                for (double t : {-b - s, -b + s})
                    if (t > 1e-7 && t < h.t) {
                        V p = o + d * t;
                        h = {t, p, (p - c) * (1 / r), m, {1, 1, 1}};
                        return;
                    }
            };
            sphere({-.65, -.75, -.55}, .5, Mirror);
            sphere({.73, -.80, .10}, .45, Glass);
        }
        return h.t < 1e30;
    }
    /// Whether something stands within `distance`.
    bool hides(V o, V d, double distance) const {
        Hit h;
        return meet(o, d, h) && h.t < distance - 1e-5;
    }
};

/// The path tracer over any way to meet.
template <class Meet> struct Tracer : Meet {
    bool indirect = true;      ///< false: direct light only
    int freeBounces = 4;       ///< roulette decides behind hits past this one (the camera's hit is 0)
    bool rootRoulette = false; ///< the chance to go on is 1.5 sqrt(throughput), the renderer's rule; false: the throughput
    static constexpr double kLe = 7;
    using Meet::meet, Meet::hides, Meet::kOff;

    template <class Rng> static double u01(Rng& r) { return std::uniform_real_distribution<double>(0, 1)(r); }

    static V cosine(V n, double a, double b) {
        V t = std::fabs(n.x) > .5 ? V{0, 1, 0} : V{1, 0, 0};
        V s = unit(t - n * dot(t, n)), q{n.y * s.z - n.z * s.y, n.z * s.x - n.x * s.z, n.x * s.y - n.y * s.x};
        double r = std::sqrt(a), f = 2 * M_PI * b;
        return unit(s * (r * std::cos(f)) + q * (r * std::sin(f)) + n * std::sqrt(std::max(0.0, 1 - a)));
    }

    /// Radiance leaving the light's sample toward p, reflected by a diffuse surface at p: one sample of the rectangle.
    template <class Rng> V direct(V p, V n, V albedo, Rng& rng) const {
        V q{u01(rng) - .5, 1.18, .25 + .65 * (u01(rng) - .5)}, d = q - p;
        double d2 = dot(d, d), l = std::sqrt(d2);
        d = d * (1 / l);
        double cs = dot(d, n), cl = d.y; // light faces -y
        if (cs <= 0 || cl <= 0) return {};
        if (hides(p + n * kOff, d, l)) return {};
        return albedo * (kLe / M_PI * cs * cl / d2 * .65);
    }

    /// Light sampling only at diffuse vertices; light met directly counts from camera, mirror and glass.
    template <class Rng> V radiance(V o, V d, Rng& rng, int cap = 64) const {
        V sum, w{1, 1, 1};
        bool countLight = true;
        for (int depth = 0; depth < cap; ++depth) {
            Hit h;
            if (!meet(o, d, h)) return sum;
            if (h.m == Light) {
                if (countLight && dot(d, h.n) < 0) sum = sum + w * kLe;
                return sum;
            }
            if (h.m == Diffuse) {
                if (dot(h.n, d) > 0) h.n = h.n * -1;
                sum = sum + w * direct(h.p, h.n, h.albedo, rng);
                if (!indirect) return sum;
                w = w * h.albedo;
                d = cosine(h.n, u01(rng), u01(rng));
                o = h.p + h.n * kOff;
                countLight = false;
            } else if (h.m == Mirror) {
                d = unit(d - h.n * (2 * dot(d, h.n)));
                o = h.p + h.n * kOff;
                countLight = true;
            } else {
                bool in = dot(d, h.n) > 0;
                V n = in ? h.n * -1 : h.n;
                double eta = in ? 1.5 : 1 / 1.5, c = -dot(d, n), k = 1 - eta * eta * (1 - c * c);
                V r = d + n * (2 * c);
                double F = 1;
                if (k > 0) {
                    double ct = std::sqrt(k), rs = (eta * c - ct) / (eta * c + ct), rp = (eta * ct - c) / (eta * ct + c);
                    F = .5 * (rs * rs + rp * rp);
                }
                if (u01(rng) < F) {
                    d = unit(r);
                    o = h.p + n * kOff;
                } else {
                    d = unit(d * eta + n * (eta * c - std::sqrt(k)));
                    o = h.p - n * kOff;
                }
                countLight = true;
            }
            if (depth > freeBounces) {
                double most = std::max(w.x, std::max(w.y, w.z)), q = std::min(1.0, rootRoulette ? 1.5 * std::sqrt(most) : most);
                if (u01(rng) >= q) return sum;
                w = w * (1 / q);
            }
        }
        return sum;
    }

    /// Camera ray through raster (x, y) of 640 x 480.
    static void camera(double x, double y, V& o, V& d) {
        double t = std::tan(13.5 * M_PI / 180);
        o = {0, 0, 7.2};
        d = unit({(x / 320 - 1) * t * 4 / 3, (1 - y / 240) * t, -1});
    }

    /// What a white diffuse point would send out: for places that the camera does not see. `albedo` is the surface's own.
    template <class Rng> V leaving(V p, V n, V albedo, Rng& rng) const {
        V sum = direct(p, n, albedo, rng);
        if (!indirect) return sum;
        V d = cosine(n, u01(rng), u01(rng));
        // Light met by this ray was counted by direct(); met through mirror or glass it is indirect and counts.
        Hit h;
        V o = p + n * kOff;
        if (meet(o, d, h) && h.m == Light) return sum;
        return sum + albedo * radiance(o, d, rng);
    }
};

using Box = Tracer<Analytic>;

struct Mean {
    double n = 0;
    V s, q;
    void add(V v) {
        n++;
        s = s + v;
        q = q + v * v;
    }
    V mean() const { return s * (1 / n); }
    V se() const {
        V m = mean(), e = q * (1 / n) - m * m;
        return {std::sqrt(std::max(0.0, e.x) / n), std::sqrt(std::max(0.0, e.y) / n), std::sqrt(std::max(0.0, e.z) / n)};
    }
};

} // namespace oracle
