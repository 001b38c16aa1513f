#include "texture/kernels.h"
#include "base/exact.h"
#include "base/vec.h"
#include "texture/lookup.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

namespace alpenglow::texture {
namespace {

constexpr double kBesselRadius = 3.2383154841662362; ///< third zero of J1(pi r)

/// Mitchell and Netravali's cubics; support 2.
double cubic(double t, double B, double C) {
    if (t < 1) return ((12 - 9 * B - 6 * C) * t * t * t + (-18 + 12 * B + 6 * C) * t * t + (6 - 2 * B)) / 6;
    if (t < 2) return ((-B - 6 * C) * t * t * t + (6 * B + 30 * C) * t * t + (-12 * B - 48 * C) * t + (8 * B + 24 * C)) / 6;
    return 0;
}

double sincOf(double x) {
    const double p = kPi * x;
    return std::fabs(p) < 1e-4 ? 1 - p * p / 6 : exact::sin(p) / p;
}

/// J1 by the trapezoid rule on (1/pi) int_0^pi cos(t - x sin t) dt, which converges exponentially.
double besselOf(double x) {
    const int n = 24 + int(x);
    double sum = 0; // the ends, (1 + cos pi) / 2, cancel
    for (int i = 1; i < n; ++i) {
        const double t = kPi * i / n;
        sum += exact::cos(t - x * exact::sin(t));
    }
    return sum / n;
}

/// RISpec 3.2, appendix E, at the usual widths of these filters: disk 1, the cubics, sinc and lanczos 4.
double shapeAt(Filter f, double r) {
    switch (f) {
    case Filter::CatmullRom:
    case Filter::SeparableCatmullRom:
        return cubic(r, 0, .5);
    case Filter::Mitchell:
        return cubic(r, 1.0 / 3, 1.0 / 3);
    case Filter::Sinc:
        return sincOf(r) * exact::cos(kPi * r / 8);
    case Filter::Lanczos:
        return sincOf(r) * sincOf(r / 2);
    case Filter::Bessel:
        return r < 1e-8 ? kPi : exact::cos(kPi / 2 * r / kBesselRadius) * 2 * besselOf(kPi * r) / r;
    default:
        return 1;
    }
}

struct Shapes {
    std::array<std::array<float, Kernel2::kSteps + 1>, kFilters> rows{};
    std::array<Kernel2, kFilters> kernels{};
    Shapes() {
        for (int k = 0; k < kFilters; ++k) {
            const auto f = Filter(k);
            const double radius = f == Filter::Disk ? .5 : f == Filter::Bessel ? kBesselRadius : 2;
            for (int i = 0; i <= Kernel2::kSteps; ++i)
                rows[size_t(k)][size_t(i)] = float(shapeAt(f, radius * i / Kernel2::kSteps));
            const bool radial = f == Filter::Disk || f == Filter::CatmullRom || f == Filter::Bessel;
            kernels[size_t(k)] = {float(radius), radial, f == Filter::Disk ? 8.f : 4.f, rows[size_t(k)].data()};
        }
    }
};

} // namespace

float Kernel2::at(float r) const {
    if (!(r < radius)) return 0;
    const float x = r / radius * float(kSteps);
    const int i = int(x);
    return row[i] + (x - float(i)) * (row[std::min(i + 1, kSteps)] - row[i]);
}

const Kernel2& filterKernel(Filter f) {
    static const std::unique_ptr<const Shapes> all = std::make_unique<Shapes>();
    return all->kernels[size_t(f)];
}

namespace {

/// A kernel over the ellipse of a lookup. Places are in texels of level 0.
struct KernelPlace {
    const Kernel2& kernel;
    Vec2 centre, axis; ///< axis: unit, of `major`
    float major, minor;
    float soft; ///< of a disk: its edge is as wide as a texel
    float at(float dx, float dy) const {
        const float x = std::fabs(dx * axis.x + dy * axis.y) / major, y = std::fabs(dy * axis.x - dx * axis.y) / minor;
        if (!kernel.radial) return kernel.at(x) * kernel.at(y);
        const float r = std::sqrt(x * x + y * y);
        return soft > 0 ? std::clamp((kernel.radius - r) / soft + .5f, 0.f, 1.f) : kernel.at(r);
    }
    /// Range of a row at height dy above the centre that the filter covers.
    std::pair<float, float> reach(float dy) const {
        const float r = kernel.radius + soft / 2;
        float low = -1e30f, high = 1e30f;
        const auto cut = [&](float slope, float offset, float size) { // |slope x + offset| <= size
            if (!(std::fabs(slope) > 1e-6f)) return;
            const float a = (-size - offset) / slope, b = (size - offset) / slope;
            low = std::max(low, std::min(a, b)), high = std::min(high, std::max(a, b));
        };
        cut(axis.x, dy * axis.y, r * major);
        cut(-axis.y, dy * axis.x, r * minor);
        return {low, high};
    }
    float height() const { return (kernel.radius + soft / 2) * (major * std::fabs(axis.y) + minor * std::fabs(axis.x)); }
};

/// Calls f(x, y, weight) for the texels of a level, of endless rows, that the kernel covers.
template <class F> void eachTexel(const KernelPlace& k, float width, float height, F f) { // of a texel, in texels of level 0
    const int top = int(std::ceil((k.centre.y - k.height()) / height - .5f)),
              bottom = int(std::floor((k.centre.y + k.height()) / height - .5f));
    for (int y = top; y <= bottom; ++y) {
        const float dy = (float(y) + .5f) * height - k.centre.y;
        const auto [low, high] = k.reach(dy);
        const int from = int(std::ceil((k.centre.x + low) / width - .5f)),
                  to = int(std::floor((k.centre.x + high) / width - .5f));
        for (int x = from; x <= to; ++x)
            if (const float w = k.at((float(x) + .5f) * width - k.centre.x, dy); w != 0) f(x, y, w);
    }
}

/// Reduces a coordinate so that texel indices around it are small.
float nearMap(float coordinate, Wrap wrap) {
    if (!std::isfinite(coordinate)) return 0;
    if (wrap == Wrap::Periodic) return coordinate - std::floor(coordinate);
    if (wrap == Wrap::Mirror) return coordinate - 2 * std::floor(coordinate * .5f);
    return std::clamp(coordinate, -100.f, 101.f); // constant beyond
}

} // namespace

void shapedLookup(const Texture& tex, float s, float t, const Ellipse& e, Filter filter, Wrap swrap, Wrap twrap,
                  const Sums& sums) {
    if (!(e.major > 0)) return sums.add(tex, {}, s, t, swrap, twrap, 1); // no footprint: interpolation only
    constexpr float kMost = 16;                                          // texels along a side of the footprint
    const Kernel2& kernel = filterKernel(filter);
    const float W = float(tex.width()), H = float(tex.height());
    const float major = std::sqrt(e.major), minor = std::sqrt(e.minor);
    float u = std::max({1.0f, minor / kernel.texels, major / std::max(kMost, kernel.texels)});
    // As in probedLookup(): a footprint that covers the map means all of it.
    const float k = 2 * std::sqrt(e.across / 12);
    if (k > 0.5f) u = std::max(u, std::max(W, H) * (2 * k - 1));
    const LevelBlend blend = blendOf(u, int(tex.levels.size()) - 1);
    s = nearMap(s, swrap), t = nearMap(t, twrap);
    for (int i = 0; i < (blend.next > 0 ? 2 : 1); ++i) {
        const Level& level = tex.levels[size_t(blend.level + i)];
        const float width = W / float(level.width), height = H / float(level.height), least = std::max(width, height);
        // With more texels of the last level only the map's mean is visible.
        const auto side = [&](float size) { return std::clamp(size, least, 2 * kMost * least); };
        KernelPlace place{kernel, {s * W, t * H}, {e.x, e.y}, side(major), side(minor), 0};
        if (filter == Filter::Disk) place.soft = least / place.minor;
        float whole = 0;
        eachTexel(place, width, height, [&](int, int, float w) { whole += w; });
        const float part = (i ? blend.next : 1 - blend.next) / whole;
        eachTexel(place, width, height, [&](int x, int y, float w) {
            w *= part;
            level.addTexel(x, y, swrap, twrap, sums.first, sums.count, w, sums.out, sums.asLight);
            const float atS = (float(x) + .5f) / float(level.width), atT = (float(y) + .5f) / float(level.height);
            if (sums.ds) level.addSlopes(atS, atT, swrap, twrap, sums.first, sums.count, w, sums.ds, sums.dt, sums.asLight);
            if (sums.dss)
                level.addCurves(atS, atT, swrap, twrap, sums.first, sums.count, w, sums.dss, sums.dst, sums.dtt, sums.asLight);
        });
    }
}

} // namespace alpenglow::texture
