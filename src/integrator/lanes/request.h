// Stages request and select.
#pragma once
#include "integrator/lanes/rows.h"

namespace alpenglow::transport::AL_NAMESPACE {

/// Directions toward the viewer.
AL_INLINE V3 toViewer(const VertexBlock& v, int at) { return normalizeOr(-load3(v.I, at), load3(v.n, at)); }

/// Rows of the directions that a call gives; `usual`: as directionOr().
AL_INLINE void giveDirections(const VertexBlock& v, const LobeArguments& a, const float* rows, int stride, int at, LobeBlock& to,
                              vm& usual) {
    const V3 n = load3(v.n, at);
    const auto direction = [&](int row, const V3& otherwise) __attribute__((always_inline)) {
        vm good;
        const V3 d = directionOr(load3(rows + row * stride + at, stride), otherwise, good);
        usual &= good;
        return d;
    };
    store3(to.lobe + kRowAxis, at, direction(a.axis, n));
    if (a.needsWo) {
        V3 viewer = toViewer(v, at);
        if (a.wo >= 0) viewer = direction(a.wo, viewer);
        else if (a.traces) viewer = normalizeOr(viewer, viewer);
        store3(to.lobe + kRowWo, at, viewer);
    }
    if (a.horizon >= 0) store3(to.lobe + kRowHorizon, at, direction(a.horizon, n));
    store(to.lobe[kRowHasHorizon] + at, vf(a.horizon >= 0 ? 1.f : 0.f));
}

/// Rows of a distribution's parameters.
AL_INLINE void giveSurface(const LobeArguments& a, const float* rows, int stride, int at, LobeBlock& to) {
    for (int r = 0; r < kRowAlbedo - kRowRoughness; ++r)
        store(to.lobe[kRowRoughness + r] + at, a.rows[r] < 0 ? vf(a.numbers[r]) : load(rows + a.rows[r] * stride + at));
}

/// Rays of trace() that start elsewhere than at the point.
AL_INLINE vm startsElsewhere(const VertexBlock& v, const float* rows, int stride, int at) {
    const V3 P = load3(v.P, at), size = absolute(P);
    const vf near = vf(1.1920929e-7f) * (size.x + size.y + size.z) + vf(1e-37f);
    return ~(length(load3(rows + at, stride) - P) <= near + vf(4) * load(v.error + at));
}

static Lanes requestLobes(const VertexBlock& v, const LobeArguments& a, const float* weight, int stride, Lanes asked,
                          LobeBlock& to) {
    const float* rows = weight + 3 * stride;
    Lanes odd = 0, some = 0;
    for (int at = 0; at < kBlock; at += kW) {
        const vm mask = maskFrom(asked, at);
        const V3 w = load3(weight + at, stride);
        vm usual = finite(w), wanted = mask & ~isZero(w);
        if (a.traces) wanted &= ~isZero(load3(rows + a.axis * stride + at, stride));
        store3(to.weight, at, w);
        giveDirections(v, a, rows, stride, at, to, usual);
        if (a.from >= 0) usual &= ~startsElsewhere(v, rows + a.from * stride, stride, at);
        if (a.samples >= 0) usual &= load(rows + a.samples * stride + at) <= vf(kMostSamples);
        if (a.surface) giveSurface(a, rows, stride, at, to);
        vf x(a.otherwise);
        if (a.a >= 0) {
            x = load(rows + a.a * stride + at);
            if (a.perRow > 0) x = vf(a.perRow) / select(x < vf(1e-6f), vf(1e-6f), x);
        }
        store(to.lobe[kRowA] + at, x);
        some |= bitsFrom(wanted, at);
        odd |= bitsFrom(wanted & ~usual, at) | bitsFrom(mask & ~finite(w), at);
    }
    to.asked |= some;
    return odd;
}

/// What lobes give back of even light, and the factor that leaves at most what arrives.
AL_INLINE vf energyScaleOf(const V3& reflected, const SelectRules& rules) {
    vf scale(1);
    if (rules.unbiased) return scale;
    const vf channels[] = {reflected.x, reflected.y, reflected.z};
    for (const vf r : channels) {
        const vf least = vf(1) / r;
        scale = select((r > 1) & (least < scale), least, scale);
    }
    return scale;
}

static Lanes selectLobes(VertexBlock& v, LobeBlock* const* sites, int count, uint32_t lighting, const SelectRules& rules,
                         Lanes* scaled) {
    Lanes bad = 0;
    *scaled = 0;
    for (int at = 0; at < kBlock; at += kW) {
        V3 sum{vf(0), vf(0), vf(0)};
        vd total(0);
        for (int s = 0; s < count; ++s) {
            LobeBlock& l = *sites[s];
            const vm mask = maskFrom(l.asked, at);
            const V3 weight = absolute(load3(l.weight, at));
            const vf albedo = load(l.lobe[kRowAlbedo] + at), worth = luminance(weight) * albedo;
            if (lighting >> s & 1) {
                const V3 given = weight * albedo;
                sum = choose(mask, sum + given, sum);
            }
            const vf chosen = select(mask & ~(worth < 0), worth, vf(0));
            bad |= bitsFrom(mask & ~finite(worth), at);
            total += __builtin_convertvector(chosen, vd);
            store(l.chosen + at, chosen);
        }
        for (int s = 0; s < count; ++s) {
            LobeBlock& l = *sites[s];
            const vf chosen = load(l.chosen + at);
            if (count == 1) {
                store(l.chosen + at, select(chosen > 0, vf(1), vf(0)));
                continue;
            }
            const vd c = __builtin_convertvector(chosen, vd);
            const vf share = __builtin_convertvector(c / total, vf);
            const vm alone = __builtin_convertvector(total == c, vi), none = __builtin_convertvector(~(total > 0), vi);
            store(l.chosen + at, select(none, vf(0), select(alone, vf(1), share)));
        }
        const vf scale = energyScaleOf(sum, rules);
        store(v.energyScale + at, scale);
        *scaled |= bitsFrom(scale < vf(.999f), at) & v.points;
    }
    return bad;
}

} // namespace alpenglow::transport::AL_NAMESPACE
