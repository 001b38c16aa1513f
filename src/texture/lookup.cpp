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

/// Positions (in standard deviations of the complete kernel) and weights of n probes along the major axis. Uniform for the box,
/// else (1 - x^2)^2, which approximates a gaussian without library functions.
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

/// The footprint as an ellipse, including the effect of the options.
static Ellipse ellipseOf(const Footprint& fp, const LookupOptions& o, float W, float H) {
    // Squared widths in texels of level 0. A footprint beyond a thousand maps is the average of all.
    constexpr float most = 1e6f;
    float sw = finiteOr(o.swidth, 1), tw = finiteOr(o.twidth, 1), sb = finiteOr(o.sblur, 0), tb = finiteOr(o.tblur, 0);
    float ss = std::min(finiteOr(fp.ss * sw * sw, most) + sb * sb, most),
          tt = std::min(finiteOr(fp.tt * tw * tw, most) + tb * tb, most);
    float st = finiteOr(fp.st * sw * tw, 0), bound = std::sqrt(ss * tt);
    st = std::clamp(st, -bound, bound);
    float a = ss * W * W, b = st * W * H, c = tt * H * H;
    // Eigenvalues: squared widths along the axes of the ellipse.
    Ellipse e;
    float mean = (a + c) / 2, diff = (a - c) / 2, root = std::sqrt(diff * diff + b * b);
    e.major = mean + root, e.minor = std::max(std::max(0.0f, mean - root), e.major * o.squeeze);
    float ax = diff >= 0 ? diff + root : std::fabs(b), ay = diff >= 0 ? b : (b < 0 ? diff - root : root - diff);
    float al = std::sqrt(ax * ax + ay * ay);
    if (al > 0) e.x = ax / al, e.y = ay / al;
    float widest = std::max(ss, tt);
    if (widest > 0) e.across = std::max(0.0f, (ss * tt - st * st) / widest);
    return e;
}

LevelBlend blendOf(float u, int last) {
    // Level l and part f of the next, so that the variances blend to the one wanted: 4^l (1 + 3f) = u^2. No logarithm.
    int exponent = 0;
    float mantissa = 2 * std::frexp(u, &exponent), f = (mantissa * mantissa - 1) / 3;
    return {std::clamp(exponent - 1, 0, last), exponent - 1 >= last ? 0 : f};
}

void Sums::add(const Texture& tex, const LevelBlend& b, float s, float t, Wrap swrap, Wrap twrap, float weight) const {
    const auto each = [&](const auto& f) {
        f(tex.levels[size_t(b.level)], weight * (1 - b.next));
        if (b.next > 0) f(tex.levels[size_t(b.level + 1)], weight * b.next);
    };
    each([&](const Level& l, float w) { l.addBilinear(s, t, swrap, twrap, first, count, w, out, asLight); });
    if (dss) each([&](const Level& l, float w) { l.addCurves(s, t, swrap, twrap, first, count, w, dss, dst, dtt, asLight); });
    if (ds) each([&](const Level& l, float w) { l.addSlopes(s, t, swrap, twrap, first, count, w, ds, dt, asLight); });
}

/// A lookup with a filter defined by its variance.
static void probedLookup(const Texture& tex, float s, float t, const Ellipse& e, Filter filter, Wrap swrap, Wrap twrap,
                         const Sums& sums) {
    const float W = float(tex.width()), H = float(tex.height());
    // Trilinear interpolation at texel size u has variance u^2/4 (box 1/12 + tent 1/6). u: size of the filter across the minor
    // axis, at least a texel, and large enough for the probes to cover the major axis without gaps.
    constexpr float cap = float(limits::kTextureTaps);
    float v = varianceOf(filter);
    float u = std::max({1.0f, 2 * std::sqrt(v * e.minor), std::sqrt(12 * v * e.major / (cap * cap + 2))});
    // A footprint that covers the map in every direction represents the complete map, without repeated edges: from half a map (k)
    // on, the level approaches the last one continuously.
    float k = 2 * std::sqrt(v * e.across);
    if (k > 0.5f) u = std::max(u, std::max(W, H) * (2 * k - 1));
    float spread = std::max(0.0f, v * e.major - u * u / 4); // variance left to the probes
    // n uniform probes at distance d have variance d^2 (n^2 - 1) / 12; d <= u. The tails of smooth weights need 1.53 times the
    // length.
    float length = std::sqrt(12 * spread) * (filter == Filter::Box ? 1.0f : 1.53f);
    const int n = std::clamp(int(std::ceil(std::sqrt(1 + (length / u) * (length / u)) - 0.25f)), 1, limits::kTextureTaps);
    const float *positions = allProbes().position[int(filter)][n - 1], *weights = allProbes().weight[int(filter)][n - 1];
    float deviation = std::sqrt(spread), dx = e.x * deviation / W, dy = e.y * deviation / H;
    const LevelBlend blend = blendOf(u, int(tex.levels.size()) - 1);
    for (int i = 0; i < n; ++i) sums.add(tex, blend, s + positions[i] * dx, t + positions[i] * dy, swrap, twrap, weights[i]);
}

void filteredLookup(const Texture& tex, int first, int count, float s, float t, const Footprint& fp, const LookupOptions& o,
                    Wrap swrap, Wrap twrap, float* out, float* slopes, float* curves) {
    for (int c = 0; c < count; ++c) out[c] = 0;
    if (slopes) std::fill_n(slopes, 2 * count, 0.0f);
    if (curves) std::fill_n(curves, 3 * count, 0.0f);
    int skip = first < -count ? count : first < 0 ? -first : 0; // a negative channel exists as little as one beyond the last
    int present = first < -count ? 0 : std::clamp(int(tex.channels.size()) - (first + skip), 0, count - skip);
    for (int c = 0; c < count; ++c)
        if (c < skip || c >= skip + present) out[c] = o.fill;
    if (!present) return;
    const auto run = [&](float* from, int number) { return from ? from + number * count + skip : nullptr; };
    const Sums sums{out + skip,     run(slopes, 0), run(slopes, 1), run(curves, 0), run(curves, 1),
                    run(curves, 2), first + skip,   present,        o.asLight};
    const Ellipse e = ellipseOf(fp, o, float(tex.width()), float(tex.height()));
    (hasShape(o.filter) ? shapedLookup : probedLookup)(tex, s, t, e, o.filter, swrap, twrap, sums);
    for (int i = 0; i < present; ++i) // between infinite texels there is no slope
        for (float* d : {sums.ds, sums.dt, sums.dss, sums.dst, sums.dtt})
            if (d) d[i] = finiteOr(d[i], 0);
}

void lookup(Handle h, int first, int count, float s, float t, const Footprint& fp, const LookupOptions& o, float* out,
            float* slopes, float* curves) {
    const Texture* tex = h;
    if (tex && tex->kind != Kind::Cube && !tex->tiles.empty()) {
        // Tiles are numbered in rows of ten; missing ones are empty.
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
    // The corners of a parallelogram are +-a/2 +-b/2: the sum of their outer products equals that of a and b.
    Footprint fp;
    for (int i = 0; i < 4; ++i) {
        float x = s[i] - ms, y = t[i] - mt;
        fp.ss += x * x;
        fp.st += x * y;
        fp.tt += y * y;
    }
    lookup(h, first, count, ms, mt, fp, o, out, slopes, curves);
}

// One for each file compiled from lanes/lookup.inc.
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
    squeeze = o.squeeze;
}

namespace {

/// Processes lanes with shaped filters one by one, and removes them from the mask.
void lookUpShaped(const Texture& tex, int first, int count, bool asLight, LookupLanes& l) {
    for (uint32_t left = l.mask; left; left &= left - 1) {
        const int i = std::countr_zero(left);
        if (!hasShape(l.filter[i])) continue;
        LookupOptions o;
        o.swidth = l.swidth[i], o.twidth = l.twidth[i], o.sblur = l.sblur[i], o.tblur = l.tblur[i];
        o.filter = l.filter[i], o.fill = l.fill[i], o.squeeze = l.squeeze, o.asLight = asLight;
        float found[4] = {};
        filteredLookup(tex, first, count, l.s[i], l.t[i], Footprint::sides(l.dsdx[i], l.dtdx[i], l.dsdy[i], l.dtdy[i]), o,
                       tex.swrap, tex.twrap, found);
        for (int c = 0; c < count; ++c) l.out[c][i] = found[c];
        l.mask &= ~(uint32_t(1) << i);
    }
}

/// The lanes of a mask in one map with levels.
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
    if (h && !h->levels.empty()) {
        const uint32_t all = l.mask;
        lookUpShaped(*h, first, count, asLight, l);
        if (l.mask) lookInOne(*h, first, count, asLight, l, look);
        l.mask = all;
        return;
    }
    if (h && h->kind != Kind::Cube && !h->tiles.empty()) { // tile by tile; each lane with its own coordinates
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
