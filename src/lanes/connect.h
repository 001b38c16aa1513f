// Stages aim and contribute.
#pragma once
#include "lanes/rows.h"

namespace alpenglow::lanes::AL_NAMESPACE {

/// Stages::placeFar.
static Lanes placeFarLights(const float* L, int stride, bool endless, LightBlock& to) {
    Lanes odd = 0;
    for (int at = 0; at < kBlock; at += kW) {
        const V3 l = load3(L + at, stride);
        vm usual;
        store3(to.w, at, directionOr(-l, {vf(0), vf(0), vf(1)}, usual));
        odd |= bitsFrom(~usual, at);
        const vf far = endless ? vf(1e38f) : length(l);
        store(to.far + at, select(far < vf(1e30f), far * vf(1 - 1e-5f), far));
        store(to.density + at, vf(1));
    }
    return odd;
}

/// Stages::aim.
static void aimShadowRays(const VertexBlock& v, const LightBlock& l, ShadowBlock& to) {
    for (int at = 0; at < kBlock; at += kW) {
        const V3 w = load3(l.w, at), from = leave(v, at, w);
        store3(to.origin, at, from);
        if (!l.emitter) {
            store3(to.direction, at, w);
            store(to.length + at, load(l.far + at));
            continue;
        }
        // The light's own surface must not occlude: the ray ends before it.
        const V3 way = load3(l.end, at) - from;
        store3(to.direction, at, normalizeOr(way, w));
        store(to.length + at, length(way) * vf(1 - 1e-6f));
    }
}

/// Stages::contribute.
static Lanes contributeLight(const VertexBlock& v, const LobeBlock& lobe, const LightBlock& l, const float* kept, Lanes met,
                             bool ahead, const float* value, ShadowBlock& to, Lanes* failed) {
    Lanes some = 0;
    *failed = 0;
    const Lanes asked = lobe.lights & l.asked;
    for (int at = 0; at < kBlock; at += kW) {
        const vf fcos = load(value + kRowFcos * kBlock + at), pdf = load(value + kRowPdf * kBlock + at);
        const vf part = load(kept + at), density = load(l.density + at);
        vm mask = maskFrom(asked, at);
        *failed |= bitsFrom(mask & (fcos != fcos), at);
        if (ahead && l.emitter) mask &= dot(load3(l.end, at) - load3(to.origin, at), load3(l.w, at)) > 0;
        V3 c = load3(lobe.weight, at) * load3(v.weight, at) * load3(l.Cl, at);
        c = c * (load3(value + kRowColour * kBlock + at, kBlock) / (l.draws ? fcos * load(l.draws + at) : fcos));
        if (l.hasPart) c = c * load(l.part + at);
        if (l.met) { // `other`: density of this direction by the lobe's own sampling
            const vf chosen = load(lobe.chosen + at);
            const vf other = select(maskFrom(met, at) & (chosen > 0), pdf * chosen, vf(0));
            c = c * (part * fcos / density * misWeight(density, other));
        } else {
            c = c * (part * vf(float(3.14159265358979323846)) * fcos / density);
        }
        store3(to.light, at, c);
        some |= bitsFrom(mask & (fcos > 0), at);
    }
    return some;
}

} // namespace alpenglow::lanes::AL_NAMESPACE
