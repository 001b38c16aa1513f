// Filtered lookups on a loaded texture.
#include "texture/lookup.h"
#include "base/limits.h"
#include "texture/texture.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::texture {
namespace {

/// Variance of a filter over a box of width 1: box of width 1; triangle of full width 2; gaussian exp(-2x^2) cut at width 2.
float varianceOf(Filter f) { return f == Filter::Box ? 1.0f / 12 : f == Filter::Triangle ? 1.0f / 6 : 0.1934f; }

/// Positions (in standard deviations of the whole) and weights of n probes along the major axis.
struct Probes {
    int n = 1;
    float position[limits::kTextureTaps], weight[limits::kTextureTaps];
};

/// Uniform for the box, else (1 - x^2)^2, which is near a gaussian and needs no library function.
void placeProbes(Probes& p, Filter f) {
    float sum = 0, squares = 0;
    for (int i = 0; i < p.n; ++i) {
        float x = (float(2 * i + 1) - float(p.n)) / float(p.n), w = f == Filter::Box ? 1.0f : (1 - x * x) * (1 - x * x);
        p.position[i] = x;
        p.weight[i] = w;
        sum += w;
        squares += w * x * x;
    }
    float scale = squares > 0 ? std::sqrt(sum / squares) : 0.0f;
    for (int i = 0; i < p.n; ++i) {
        p.position[i] *= scale;
        p.weight[i] /= sum;
    }
}

float finiteOr(float v, float other) { return std::isfinite(v) ? v : other; }

} // namespace

Footprint Footprint::sides(float dsdx, float dtdx, float dsdy, float dtdy) {
    return {dsdx * dsdx + dsdy * dsdy, dsdx * dtdx + dsdy * dtdy, dtdx * dtdx + dtdy * dtdy};
}

void filteredLookup(const Texture& tex, int first, int count, float s, float t, const Footprint& fp, const LookupOptions& o,
                    Wrap swrap, Wrap twrap, float* out, float* slopes, float* curves) {
    for (int c = 0; c < count; ++c) out[c] = 0;
    float *ds = slopes, *dt = slopes ? slopes + count : nullptr;
    float *dss = curves, *dst = curves ? curves + count : nullptr, *dtt = curves ? curves + 2 * count : nullptr;
    if (slopes) std::fill_n(slopes, 2 * count, 0.0f);
    if (curves) std::fill_n(curves, 3 * count, 0.0f);
    int skip = first < -count ? count : first < 0 ? -first : 0; // a negative channel exists as little as one beyond the last
    int present = first < -count ? 0 : std::clamp(int(tex.channels.size()) - (first + skip), 0, count - skip);
    for (int c = 0; c < count; ++c)
        if (c < skip || c >= skip + present) out[c] = o.fill;
    if (!present) return;
    first += skip;
    out += skip;
    if (slopes) {
        ds += skip;
        dt += skip;
    }
    if (curves) {
        dss += skip;
        dst += skip;
        dtt += skip;
    }
    count = present;
    float W = float(tex.width()), H = float(tex.height());
    // Squared widths in texels of level 0. A footprint beyond a thousand maps is the average of all.
    constexpr float most = 1e6f;
    float sw = finiteOr(o.swidth, 1), tw = finiteOr(o.twidth, 1), sb = finiteOr(o.sblur, 0), tb = finiteOr(o.tblur, 0);
    float ss = std::min(finiteOr(fp.ss * sw * sw, most) + sb * sb, most),
          tt = std::min(finiteOr(fp.tt * tw * tw, most) + tb * tb, most);
    float st = finiteOr(fp.st * sw * tw, 0), bound = std::sqrt(ss * tt);
    st = std::clamp(st, -bound, bound);
    float a = ss * W * W, b = st * W * H, c = tt * H * H;
    // Eigenvalues: squared widths along the axes of the ellipse; (ax, ay): the major axis.
    float mean = (a + c) / 2, diff = (a - c) / 2, root = std::sqrt(diff * diff + b * b);
    float major = mean + root, minor = std::max(0.0f, mean - root);
    float ax = diff >= 0 ? diff + root : std::fabs(b), ay = diff >= 0 ? b : (b < 0 ? diff - root : root - diff);
    float al = std::sqrt(ax * ax + ay * ay);
    if (al > 0) {
        ax /= al;
        ay /= al;
    } else {
        ax = 1;
        ay = 0;
    }

    // Trilinear interpolation at texel size u has variance u^2/4 (box 1/12 + tent 1/6). u: that of the filter across the minor
    // axis, at least a texel, and large enough for the probes to cover the major axis without gaps.
    constexpr float cap = float(limits::kTextureTaps);
    float v = varianceOf(o.filter);
    float u = std::max({1.0f, 2 * std::sqrt(v * minor), std::sqrt(12 * v * major / (cap * cap + 2))});
    // A footprint that covers the map in every direction means the whole map, not its edges again and again: from half a map (k)
    // on, the level goes to the last, continuously.
    float widest = std::max(ss, tt), k = widest > 0 ? 2 * std::sqrt(v * std::max(0.0f, (ss * tt - st * st) / widest)) : 0.0f;
    if (k > 0.5f) u = std::max(u, std::max(W, H) * (2 * k - 1));
    float spread = std::max(0.0f, v * major - u * u / 4); // variance left to the probes
    // n uniform probes at distance d have variance d^2 (n^2 - 1) / 12; d <= u. Tails of the smooth weights take 1.53 times the
    // length.
    float length = std::sqrt(12 * spread) * (o.filter == Filter::Box ? 1.0f : 1.53f);
    Probes probes;
    probes.n = std::clamp(int(std::ceil(std::sqrt(1 + (length / u) * (length / u)) - 0.25f)), 1, limits::kTextureTaps);
    placeProbes(probes, o.filter);
    float deviation = std::sqrt(spread), dx = ax * deviation / W, dy = ay * deviation / H;

    // Level l and part f of the next, so that the variances blend to the one wanted: 4^l (1 + 3f) = u^2. No logarithm.
    int exponent = 0, last = int(tex.levels.size()) - 1;
    float mantissa = 2 * std::frexp(u, &exponent), f = (mantissa * mantissa - 1) / 3;
    int l = std::clamp(exponent - 1, 0, last);
    if (exponent - 1 >= last) f = 0;
    for (int i = 0; i < probes.n; ++i) {
        float ps = s + probes.position[i] * dx, pt = t + probes.position[i] * dy;
        tex.levels[size_t(l)].addBilinear(ps, pt, swrap, twrap, first, count, probes.weight[i] * (1 - f), out, o.asLight);
        if (f > 0)
            tex.levels[size_t(l + 1)].addBilinear(ps, pt, swrap, twrap, first, count, probes.weight[i] * f, out, o.asLight);
        if (curves) {
            tex.levels[size_t(l)].addCurves(ps, pt, swrap, twrap, first, count, probes.weight[i] * (1 - f), dss, dst, dtt,
                                            o.asLight);
            if (f > 0)
                tex.levels[size_t(l + 1)].addCurves(ps, pt, swrap, twrap, first, count, probes.weight[i] * f, dss, dst, dtt,
                                                    o.asLight);
        }
        if (!slopes) continue;
        tex.levels[size_t(l)].addSlopes(ps, pt, swrap, twrap, first, count, probes.weight[i] * (1 - f), ds, dt, o.asLight);
        if (f > 0)
            tex.levels[size_t(l + 1)].addSlopes(ps, pt, swrap, twrap, first, count, probes.weight[i] * f, ds, dt, o.asLight);
    }
    for (int i = 0; slopes && i < count; ++i) { // between infinite texels there is no slope
        ds[i] = finiteOr(ds[i], 0);
        dt[i] = finiteOr(dt[i], 0);
    }
    for (int i = 0; curves && i < count; ++i)
        for (float* d : {dss, dst, dtt}) d[i] = finiteOr(d[i], 0);
}

void lookup(Handle h, int first, int count, float s, float t, const Footprint& fp, const LookupOptions& o, float* out, float* slopes,
          float* curves) {
    const Texture* tex = h;
    if (tex && tex->kind != Kind::Cube && !tex->tiles.empty()) {
        // Tiles are numbered in rows of ten; outside them, and where none was found, there is nothing.
        float fs = std::floor(finiteOr(s, -1)), ft = std::floor(finiteOr(t, -1));
        bool inside = fs >= 0 && fs < 10 && ft >= 0 && ft < 10;
        auto i = inside ? tex->tiles.find(1001 + int(fs) + 10 * int(ft)) : tex->tiles.end();
        tex = i == tex->tiles.end() ? nullptr : i->second.get();
        s -= fs;
        t -= ft;
    }
    if (!tex || tex->levels.empty()) {
        for (int c = 0; c < count; ++c) out[c] = o.fill;
        if (slopes) std::fill_n(slopes, 2 * count, 0.0f);
        if (curves) std::fill_n(curves, 3 * count, 0.0f);
        return;
    }
    filteredLookup(*tex, first, count, s, t, fp, o, tex->swrap, tex->twrap, out, slopes, curves);
}

void lookup2D(Handle h, int first, int count, float s, float t, float dsdx, float dtdx, float dsdy, float dtdy,
              const LookupOptions& o, float* out, float* slopes, float* curves) {
    lookup(h, first, count, s, t, Footprint::sides(dsdx, dtdx, dsdy, dtdy), o, out, slopes, curves);
}

void lookupQuad(Handle h, int first, int count, const float s[4], const float t[4], const LookupOptions& o, float* out, float* slopes,
          float* curves) {
    float ms = (s[0] + s[1] + s[2] + s[3]) / 4, mt = (t[0] + t[1] + t[2] + t[3]) / 4;
    // Corners of a parallelogram lie at +-a/2 +-b/2: the sum of their outer products is that of a and b.
    Footprint fp;
    for (int i = 0; i < 4; ++i) {
        float x = s[i] - ms, y = t[i] - mt;
        fp.ss += x * x;
        fp.st += x * y;
        fp.tt += y * y;
    }
    lookup(h, first, count, ms, mt, fp, o, out, slopes, curves);
}

void lookup2DLanes(Handle h, int first, int count, int n, const unsigned char* active, const float* s, const float* t,
                   const float* dsdx, const float* dtdx, const float* dsdy, const float* dtdy, const LookupOptions* options,
                   bool perLane, float* out) {
    float few[16];
    std::vector<float> many(count > 16 ? size_t(count) : 0);
    float* one = count > 16 ? many.data() : few;
    for (int i = 0; i < n; ++i) {
        if (active && !active[i]) continue;
        lookup2D(h, first, count, s[i], t[i], dsdx[i], dtdx[i], dsdy[i], dtdy[i], options[perLane ? i : 0], one);
        for (int c = 0; c < count; ++c) out[c * n + i] = one[c];
    }
}

} // namespace alpenglow::texture
