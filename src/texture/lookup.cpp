// Filtered lookups on a loaded texture.
#include "texture/lookup.h"
#include "base/limits.h"
#include "texture/texture.h"
#include <algorithm>
#include <bit>
#include <cmath>

namespace alpenglow::texture {
namespace {

/// Variance of a filter over a box of width 1: box of width 1; triangle of full width 2; gaussian exp(-2x^2) cut at width 2.
float varianceOf(Filter f) { return f == Filter::Box ? 1.0f / 12 : f == Filter::Triangle ? 1.0f / 6 : 0.1934f; }

/// Positions (in standard deviations of the whole) and weights of n probes along the major axis. Uniform for the box, else
/// (1 - x^2)^2, which is near a gaussian and needs no library function.
void placeProbes(int n, Filter f, float* position, float* weight) {
    float sum = 0, squares = 0;
    for (int i = 0; i < n; ++i) {
        float x = (float(2 * i + 1) - float(n)) / float(n), w = f == Filter::Box ? 1.0f : (1 - x * x) * (1 - x * x);
        position[i] = x;
        weight[i] = w;
        sum += w;
        squares += w * x * x;
    }
    float scale = squares > 0 ? std::sqrt(sum / squares) : 0.0f;
    for (int i = 0; i < n; ++i) {
        position[i] *= scale;
        weight[i] /= sum;
    }
}

static_assert(LaneProbes::kMost == limits::kTextureTaps);

const LaneProbes& allProbes() {
    static const std::unique_ptr<const LaneProbes> all = [] {
        auto p = std::make_unique<LaneProbes>();
        for (int f = 0; f < 3; ++f)
            for (int n = 1; n <= LaneProbes::kMost; ++n) placeProbes(n, Filter(f), p->position[f][n - 1], p->weight[f][n - 1]);
        return p;
    }();
    return *all;
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
    const int n = std::clamp(int(std::ceil(std::sqrt(1 + (length / u) * (length / u)) - 0.25f)), 1, limits::kTextureTaps);
    const float *positions = allProbes().position[int(o.filter)][n - 1], *weights = allProbes().weight[int(o.filter)][n - 1];
    float deviation = std::sqrt(spread), dx = ax * deviation / W, dy = ay * deviation / H;

    // Level l and part f of the next, so that the variances blend to the one wanted: 4^l (1 + 3f) = u^2. No logarithm.
    int exponent = 0, last = int(tex.levels.size()) - 1;
    float mantissa = 2 * std::frexp(u, &exponent), f = (mantissa * mantissa - 1) / 3;
    int l = std::clamp(exponent - 1, 0, last);
    if (exponent - 1 >= last) f = 0;
    for (int i = 0; i < n; ++i) {
        float ps = s + positions[i] * dx, pt = t + positions[i] * dy;
        tex.levels[size_t(l)].addBilinear(ps, pt, swrap, twrap, first, count, weights[i] * (1 - f), out, o.asLight);
        if (f > 0) tex.levels[size_t(l + 1)].addBilinear(ps, pt, swrap, twrap, first, count, weights[i] * f, out, o.asLight);
        if (curves) {
            tex.levels[size_t(l)].addCurves(ps, pt, swrap, twrap, first, count, weights[i] * (1 - f), dss, dst, dtt, o.asLight);
            if (f > 0)
                tex.levels[size_t(l + 1)].addCurves(ps, pt, swrap, twrap, first, count, weights[i] * f, dss, dst, dtt, o.asLight);
        }
        if (!slopes) continue;
        tex.levels[size_t(l)].addSlopes(ps, pt, swrap, twrap, first, count, weights[i] * (1 - f), ds, dt, o.asLight);
        if (f > 0) tex.levels[size_t(l + 1)].addSlopes(ps, pt, swrap, twrap, first, count, weights[i] * f, ds, dt, o.asLight);
    }
    for (int i = 0; slopes && i < count; ++i) { // between infinite texels there is no slope
        ds[i] = finiteOr(ds[i], 0);
        dt[i] = finiteOr(dt[i], 0);
    }
    for (int i = 0; curves && i < count; ++i)
        for (float* d : {dss, dst, dtt}) d[i] = finiteOr(d[i], 0);
}

void lookup(Handle h, int first, int count, float s, float t, const Footprint& fp, const LookupOptions& o, float* out,
            float* slopes, float* curves) {
    const Texture* tex = h;
    if (tex && tex->kind != Kind::Cube && !tex->tiles.empty()) {
        // Tiles are numbered in rows of ten; outside them, and where none was found, there is nothing.
        float fs = std::floor(finiteOr(s, -1)), ft = std::floor(finiteOr(t, -1));
        tex = tex->tileAt(fs, ft);
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

void lookupQuad(Handle h, int first, int count, const float s[4], const float t[4], const LookupOptions& o, float* out,
                float* slopes, float* curves) {
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

// One for each file made from lanes/lookup.inc.
void lookupLanes4(const LaneJob&, LookupLanes&, float*);
void lookupLanes8(const LaneJob&, LookupLanes&, float*);
void lookupLanes16(const LaneJob&, LookupLanes&, float*);

LookUpLanes lookUpLanes(int lanes) {
    static const bool v3 = __builtin_cpu_supports("x86-64-v3"), v4 = __builtin_cpu_supports("x86-64-v4");
    return lanes == 4 ? lookupLanes4 : lanes == 8 && v3 ? lookupLanes8 : lanes == 16 && v4 ? lookupLanes16 : nullptr;
}

void LookupLanes::set(const LookupOptions& o) {
    for (int i = 0; i < kLanes; ++i) {
        swidth[i] = o.swidth;
        twidth[i] = o.twidth;
        sblur[i] = o.sblur;
        tblur[i] = o.tblur;
        fill[i] = o.fill;
        filter[i] = o.filter;
    }
}

namespace {

/// Those of a mask that lie in one map that has levels.
void lookInOne(const Texture& tex, int first, int count, bool asLight, LookupLanes& l, LookUpLanes look) {
    const int skip = first < -count ? count : first < 0 ? -first : 0;
    const int present = first < -count ? 0 : std::clamp(int(tex.channels.size()) - (first + skip), 0, count - skip);
    for (uint32_t left = l.mask; left; left &= left - 1) {
        const int i = std::countr_zero(left);
        for (int c = 0; c < count; ++c)
            if (c < skip || c >= skip + present) l.out[c][i] = l.fill[i];
    }
    if (!present) return;
    constexpr size_t most = 32; // levels: sides are below 2^17
    LaneLevel levels[most];
    const size_t n = std::min(tex.levels.size(), most);
    for (size_t k = 0; k < n; ++k) {
        const Level& from = tex.levels[k];
        LaneLevel& to = levels[k];
        to.numbers = from.codes.empty() ? (asLight && !from.light.empty() ? from.light : from.values).data() : nullptr;
        to.codes = from.codes.data();
        for (int c = 0; c < present && to.codes; ++c) to.tables[c] = from.tableOf(first + skip + c, asLight).data();
        to.width = from.width;
        to.height = from.height;
        to.channels = from.channels;
    }
    const LaneJob job{
        levels,         int(n) - 1,         first + skip,
        present,        float(tex.width()), float(tex.height()),
        int(tex.swrap), int(tex.twrap),     {varianceOf(Filter::Box), varianceOf(Filter::Triangle), varianceOf(Filter::Gaussian)},
        &allProbes()};
    alignas(64) float found[LookupLanes::kLanes][4];
    look(job, l, found[0]);
    for (uint32_t left = l.mask; left; left &= left - 1) {
        const int i = std::countr_zero(left);
        for (int c = 0; c < present; ++c) l.out[skip + c][i] = found[i][c];
    }
}

LookUpLanes widestLanes() {
    static const LookUpLanes widest = [] {
        for (int lanes : {16, 8})
            if (const LookUpLanes f = lookUpLanes(lanes)) return f;
        return lookUpLanes(4);
    }();
    return widest;
}

} // namespace

void lookup2DLanes(Handle h, int first, int count, bool asLight, LookupLanes& l) {
    const LookUpLanes look = widestLanes();
    if (h && !h->levels.empty()) return lookInOne(*h, first, count, asLight, l, look);
    if (h && h->kind != Kind::Cube && !h->tiles.empty()) { // tile by tile; each lane's place on its own
        const uint32_t all = l.mask;
        const Texture* tiles[LookupLanes::kLanes] = {};
        for (uint32_t left = all; left; left &= left - 1) {
            const int i = std::countr_zero(left);
            const float column = std::floor(finiteOr(l.s[i], -1)), row = std::floor(finiteOr(l.t[i], -1));
            tiles[i] = h->tileAt(column, row);
            l.s[i] -= column;
            l.t[i] -= row;
        }
        for (uint32_t left = all; left;) {
            const Texture* tile = tiles[std::countr_zero(left)];
            l.mask = 0;
            for (uint32_t k = left; k; k &= k - 1)
                if (tiles[std::countr_zero(k)] == tile) l.mask |= k & (~k + 1);
            left &= ~l.mask;
            lookup2DLanes(tile, first, count, asLight, l);
        }
        l.mask = all;
        return;
    }
    for (uint32_t left = l.mask; left; left &= left - 1)
        for (int c = 0; c < count; ++c) l.out[c][std::countr_zero(left)] = l.fill[std::countr_zero(left)];
}

} // namespace alpenglow::texture
