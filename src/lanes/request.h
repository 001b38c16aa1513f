// Stages request and select.
#pragma once
#include "lanes/rows.h"

namespace alpenglow::lanes::AL_NAMESPACE {

/// Directions toward the viewer.
AL_INLINE V3 toViewer(const VertexBlock& v, int at) { return normalizeOr(-load3(v.I, at), load3(v.n, at)); }

/// Rows of the directions that a call gives; `usual`: as for directionOr().
AL_INLINE void giveDirections(const VertexBlock& v, const LobeArguments& a, const float* rows, int stride, int at, LobeBlock& to,
                              vm& usual) {
    const V3 n = load3(v.n, at);
    const auto direction = [&](int row, const V3& otherwise) __attribute__((always_inline)) {
        vm good;
        const V3 d = directionOr(load3(rows + row * stride + at, stride), otherwise, good);
        usual &= good;
        return d;
    };
    store3(to.lobe + kRowAxis, at, a.axis >= 0 ? direction(a.axis, n) : n);
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

/// trace() rays that do not start at the point.
AL_INLINE vm hasOwnOrigin(const VertexBlock& v, const float* rows, int stride, int at) {
    const V3 P = load3(v.P, at), size = absolute(P);
    const vf near = vf(1.1920929e-7f) * (size.x + size.y + size.z) + vf(1e-37f);
    return ~(length(load3(rows + at, stride) - P) <= near + vf(4) * load(v.error + at));
}

/// Stages::request.
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
        if (a.lights >= 0) usual &= load(rows + a.lights * stride + at) != 0;
        if (a.samples >= 0) usual &= load(rows + a.samples * stride + at) <= vf(kMostSamples);
        if (a.surface) giveSurface(a, rows, stride, at, to);
        vf x(a.otherwise);
        if (a.a >= 0) {
            x = load(rows + a.a * stride + at);
            if (a.perRow > 0) x = vf(a.perRow) / select(x < vf(1e-6f), vf(1e-6f), x);
        }
        store(to.lobe[kRowA] + at, x);
        some |= bitsFrom(wanted, at);
        if (a.from >= 0) to.ownOrigin |= bitsFrom(wanted & hasOwnOrigin(v, rows + a.from * stride, stride, at), at);
        odd |= bitsFrom(wanted & ~usual, at) | bitsFrom(mask & ~finite(w), at);
    }
    to.asked |= some;
    return odd;
}

/// Energy rule: factor so that reflected plus transmitted light is at most the incident light.
AL_INLINE vf energyScaleOf(const V3& reflected, const V3& clear, const SelectRules& rules) {
    vf scale(1);
    if (rules.unbiased) return scale;
    const vf given[] = {reflected.x, reflected.y, reflected.z}, through[] = {clear.x, clear.y, clear.z};
    for (int k = 0; k < 3; ++k) {
        const vf least = (vf(1) - through[k]) / given[k];
        scale = select((given[k] + through[k] > 1) & (given[k] > 0) & (least < scale), least, scale);
    }
    return scale;
}

/// Indirect light of a lobe may be scaled to 0, but its ray still carries emission: it keeps at least this fraction of its
/// probability.
inline constexpr float kLeastScale = 1 / 32.f;

/// Weight of a part of the throughput: if rays behind the surface compete, weighted by the path's throughput in each channel.
AL_INLINE vf worthOf(const V3& share, const V3& left, vm competes) {
    return select(competes, dot(share, left) / vf(3), luminance(share));
}

/// Points where a depth limit ends the rays of a site.
AL_INLINE Lanes deepOf(const VertexBlock& v, const LobeBlock& l, const SelectRules& rules, int site) {
    return rules.sites[site].endless ? 0 : v.deep[rules.sites[site].diffuse] & (v.last | ~l.boundless);
}

/// select() for the lanes from `at` on.
AL_INLINE void selectLanes(VertexBlock& v, LobeBlock* const* sites, int count, const SelectRules& rules, int at,
                           Selected& found) {
    V3 sum{vf(0), vf(0), vf(0)}, clear = sum, beyond = sum;
    vm competes(0);
    const V3 left = absolute(load3(v.weight, at));
    if (v.through) {
        clear = load3(v.clear, at);
        beyond = load3(v.beyond, at);
        competes = (loadInt(v.bounces + at) > 0) & (maxComponent(beyond) > 0);
    }
    vi lobes(0);
    for (int s = 0; s < count; ++s) {
        LobeBlock& l = *sites[s];
        const Lanes deep = deepOf(v, l, rules, s);
        const vm mask = maskFrom(l.asked, at);
        const V3 weight = absolute(load3(l.weight, at));
        const vf albedo = load(l.lobe[kRowAlbedo] + at), worth = worthOf(weight, left, competes) * albedo;
        if (rules.sites[s].lighting) sum = choose(mask, sum + weight * albedo, sum);
        l.failed |= bitsFrom(mask & ~finite(worth), at);
        found.failed |= l.failed;
        const vm guided = maskFrom(v.guided, at) & (load(l.lobe[kRowDelta] + at) == 0);
        const vm follows = mask & finite(worth) & ~(worth < 0);
        found.cut |= bitsFrom(follows & (worth > 0), at) & v.last;
        l.ended |= bitsFrom(follows & (worth > 0) & ~guided, at) & deep & ~l.stays;
        store(l.chosen + at, select(follows & ~maskFrom(deep | l.stays, at) & ~guided, worth, vf(0)));
        lobes -= mask;
    }
    const vf scale = energyScaleOf(sum, clear, rules);
    store(v.energyScale + at, scale);
    const vm more = maxComponent(sum) > 1;
    found.bright |= bitsFrom((scale < vf(.999f)) & more, at) & v.points;
    found.brightWithClear |= bitsFrom((scale < vf(.999f)) & ~more, at) & v.points;
    const vf behind = v.through ? select(competes, worthOf(beyond, left, competes), vf(0)) : vf(0);
    vd total = __builtin_convertvector(behind, vd);
    for (int s = 0; s < count; ++s) {
        LobeBlock& l = *sites[s];
        vf chosen = load(l.chosen + at);
        if (v.through && rules.sites[s].lighting) {
            const vf least = select(scale < vf(kLeastScale), vf(kLeastScale), scale);
            chosen = select(behind > 0, chosen * least, chosen);
            store(l.chosen + at, chosen);
        }
        total += __builtin_convertvector(chosen, vd);
    }
    for (int s = 0; s < count; ++s) {
        LobeBlock& l = *sites[s];
        const vf chosen = load(l.chosen + at);
        const vm alone = (lobes == 1) & (behind == 0);
        vf share = select(chosen > 0, vf(1), vf(0));
        if (count > 1 || v.through) {
            const vd c = __builtin_convertvector(chosen, vd);
            const vm whole = __builtin_convertvector(total == c, vi), none = __builtin_convertvector(~(total > 0), vi);
            share = select(alone, share, select(none, vf(0), select(whole, vf(1), __builtin_convertvector(c / total, vf))));
        }
        if (rules.all) share = select(chosen > 0, vf(1), vf(0));
        if (v.waits) share = select(maskFrom(l.asked & ~(deepOf(v, l, rules, s) | l.stays | v.guided), at), vf(1), vf(0));
        store(l.chosen + at, share);
    }
    const vd passes = __builtin_convertvector(behind, vd) / total;
    const vm some = (behind > 0) & __builtin_convertvector(total > __builtin_convertvector(behind, vd), vi);
    store(v.passes + at, v.through ? select(some, __builtin_convertvector(passes, vf), vf(1)) : vf(1));
}

/// Stages::select.
static Selected selectLobes(VertexBlock& v, LobeBlock* const* sites, int count, const SelectRules& rules) {
    Selected found;
    for (int s = 0; s < count; ++s) sites[s]->ended = sites[s]->failed = 0;
    for (int at = 0; at < kBlock; at += kW) selectLanes(v, sites, count, rules, at, found);
    return found;
}

} // namespace alpenglow::lanes::AL_NAMESPACE
