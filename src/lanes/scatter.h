// Stages pick, take, name and extend.
#pragma once
#include "lanes/rows.h"

namespace alpenglow::lanes::AL_NAMESPACE {

/// Stages::pick.
static void pickLobe(VertexBlock& v, const LobeBlock* const* sites, int count, const float* number, ScatterBlock& to) {
    to.goes = to.single = 0;
    for (int at = 0; at < kBlock; at += kW) {
        vi last(-1), site(-1), lobes(0);
        for (int s = 0; s < count; ++s) {
            const vm mask = maskFrom(sites[s]->asked & v.points, at);
            last = mask ? vi(s) : last;
            lobes -= mask;
        }
        const vf passes = load(v.passes + at), u = count > 1 || v.through ? load(number + at) : vf(0);
        const vm mayPass = passes < 1; // lobes have the remaining probability
        vf sum(0), scale(1);
        vm taken(0);
        for (int s = 0; s < count; ++s) {
            const vf chosen = load(sites[s]->chosen + at);
            const vm mask = maskFrom(sites[s]->asked & v.points, at) & (chosen > 0);
            sum = select(mask, sum + chosen, sum);
            const vm takes = mask & ~taken & (~(u >= sum) | (~mayPass & ((last == s) | (lobes == 1))));
            taken |= takes;
            site = takes ? vi(s) : site;
            scale = select(takes, vf(1) / chosen, scale);
        }
        store(to.site + at, site);
        store(to.scale + at, scale);
        store(v.passes + at, select(mayPass & taken, vf(0), passes));
    }
}

/// Stages::takeDirections.
static void takeDirections(const LobeBlock& lobe, int site, bool lighting, const float* drawn, ScatterBlock& to) {
    for (int at = 0; at < kBlock; at += kW) {
        const vm mine = loadInt(to.site + at) == site;
        const vm goes = mine & (load(drawn + kRowDrawn * kBlock + at) != 0), single = load(lobe.lobe[kRowDelta] + at) != 0;
        store3(to.direction, at, choose(mine, load3(drawn + at, kBlock), load3(to.direction, at)));
        store3(to.request, at, choose(mine, load3(lobe.weight, at), load3(to.request, at)));
        store(to.spread + at, select(mine, load(lobe.lobe[kRowSpread] + at), load(to.spread + at)));
        store(to.indirect + at, select(mine, vf(lighting ? 1.f : 0.f), load(to.indirect + at)));
        const V3 albedo{load(lobe.lobe[kRowAlbedo] + at), load(lobe.lobe[kRowAlbedo] + at), load(lobe.lobe[kRowAlbedo] + at)};
        store3(to.colour, at, choose(mine, albedo, load3(to.colour, at)));
        store(to.pdf + at, select(mine, vf(0), load(to.pdf + at)));
        to.goes |= bitsFrom(goes, at);
        to.single |= bitsFrom(mine & single, at);
    }
}

/// Stages::takeValues.
static void takeValues(const LobeBlock&, int site, const float* value, ScatterBlock& to) {
    for (int at = 0; at < kBlock; at += kW) {
        const vm mine = (loadInt(to.site + at) == site) & maskFrom(to.goes & ~to.single, at);
        store3(to.colour, at, choose(mine, load3(value + kRowColour * kBlock + at, kBlock), load3(to.colour, at)));
        store(to.pdf + at, select(mine, load(value + kRowPdf * kBlock + at), load(to.pdf + at)));
    }
}

/// mix64() of base/hash.h, by lane.
AL_INLINE vq mixed(vq v) {
    v = (v ^ (v >> 30)) * vq(0xbf58476d1ce4e5b9ull);
    v = (v ^ (v >> 27)) * vq(0x94d049bb133111ebull);
    return v ^ (v >> 31);
}

/// Stages::name.
static void nameVertices(const VertexBlock& v, const uint32_t* key, ScatterBlock& to) {
    const vq first = mixed(vq(0x9e3779b97f4a7c15ull)); // childVertex() of occurrence 0
    for (int at = 0; at < kBlock; at += kW) {
        vu site;
        for (int k = 0; k < kW; ++k) site[k] = key[to.site[at + k] < 0 ? 0 : to.site[at + k]];
        const vq way = __builtin_convertvector(loadBits(v.vertex + at), vq) << 32 | __builtin_convertvector(site, vq);
        const vu name = __builtin_convertvector(mixed(way ^ first) >> 32, vu);
        store(to.vertex + at, name == 0 ? vu(1) : name);
    }
}

/// Survival probability by rouletteOfPath() or rouletteLocal() (bsdf/sampling.h) after the third bounce; 0: the path ends.
AL_INLINE vf chanceToGoOn(Roulette rule, const V3& weight, const V3& request, const vf& dice) {
    const vf likely = rule == Roulette::Local ? maxComponent(request) : vf(1.5f) * rootLanes(maxComponent(absolute(weight)));
    const vf most = select(likely < 1, likely, vf(1));
    return select(most >= 1, vf(1), select((most > 0) & (dice < most), most, vf(0)));
}

/// Stages::extend.
static Lanes extendPaths(const VertexBlock& v, Roulette rule, ScatterBlock& to) {
    Lanes bad = 0, goes = 0;
    for (int at = 0; at < kBlock; at += kW) {
        const vm mask = maskFrom(to.goes, at), single = maskFrom(to.single, at);
        const vf pdf = load(to.pdf + at);
        const V3 colour = load3(to.colour, at), zero{vf(0), vf(0), vf(0)};
        const V3 f = choose(single, colour, choose(pdf > 0, colour / pdf, zero));
        const V3 through = load3(to.request, at) * (f * load(to.scale + at));
        V3 weight = load3(v.weight, at) * through;
        const vm good = finite(weight);
        bad |= bitsFrom(mask & ~good, at);
        vf q(1);
        if (rule != Roulette::None)
            q = select(loadInt(v.bounces + at) + 1 > 3, chanceToGoOn(rule, weight, load3(to.request, at), load(to.dice + at)),
                       vf(1));
        const vm brings = v.waits ? vm(-1) : ~isZero(weight);
        goes |= bitsFrom(mask & good & brings & (q > 0), at);
        store3(to.weight, at, weight / q);
        store3(to.origin, at, leave(v, at, load3(to.direction, at)));
    }
    to.goes = goes;
    return bad;
}

} // namespace alpenglow::lanes::AL_NAMESPACE
