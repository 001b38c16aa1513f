// Shared by the files of this folder: rows of a block as vectors, and the functions of LobeLanes generated from a kind.
//
// A kind is a struct with `name`, `doc`, `distribution`, and
//     needs                                                     LobeNeed of the rows that it reads
//     traits, eta                                               LobeTrait and LobeLanes::eta, if not 0
//     static void prepare(Rows)                                 fills kRowAlbedo, kRowSpread, kRowDelta and its own rows
//     static Value evaluate(const Given&, const Direction& w)   f cos by channel, and the density of sample() per solid angle
//     static vm sample(const Given&, const Pair<vf>& u, Direction& w)
// f cos is the value of docs/light.md: the shadeop's result is the integral of L f cos over directions, so diffuse() of
// radiance 1 from everywhere is 1, and a light's Cl (irradiance / pi) is scored pi f cos Cl.
#pragma once
#include "bsdf/lanes/directions.h"
#include "bsdf/lobelanes.h"

namespace alpenglow::bsdf::AL_NAMESPACE {

/// Floats from one row of a block to the next.
inline constexpr int kStride = ALPENGLOW_LANES == 1 ? 1 : kLobeBlock;

/// As many floats as there are lanes; no alignment is required.
AL_INLINE vf loadLanes(const float* from) {
    vf x;
    __builtin_memcpy(&x, from, sizeof x);
    return x;
}
/// Writes as many floats as there are lanes; no alignment is required.
AL_INLINE void storeLanes(float* to, vf x) { __builtin_memcpy(to, &x, sizeof x); }

/// Lanes of a block.
struct Given {
    const float* at; ///< row 0 of the lanes
    /// A row (LobeRow), by lane.
    AL_MEMBER vf number(int row) const { return loadLanes(at + row * kStride); }
    /// Three rows from this one on.
    AL_MEMBER Direction triple(int row) const { return {number(row), number(row + 1), number(row + 2)}; }
    /// The axis, and the direction toward the viewer; unit.
    AL_MEMBER Direction axis() const { return triple(kRowAxis); }
    AL_MEMBER Direction wo() const { return triple(kRowWo); }
    /// A row that the kind's prepare() has set.
    AL_MEMBER vf own(int k) const { return number(kRowOwn + k); }
    /// Three of these rows.
    AL_MEMBER Direction ownTriple(int k) const { return triple(kRowOwn + k); }
};
/// Lanes of a block that prepare() may write.
struct Rows : Given {
    float* to; ///< row 0 of the lanes
    /// p: row 0 of the lanes, in a block.
    AL_MEMBER explicit Rows(float* p) : Given{p}, to(p) {}
    /// Write one row, or three from this one on, for all lanes; own(): rows of the kind.
    AL_MEMBER void set(int row, vf x) const { storeLanes(to + row * kStride, x); }
    AL_MEMBER void set(int row, const Direction& v) const { set(row, v.x), set(row + 1, v.y), set(row + 2, v.z); }
    AL_MEMBER void own(int k, vf x) const { set(kRowOwn + k, x); }
    AL_MEMBER void own(int k, const Direction& v) const { set(kRowOwn + k, v); }
    AL_MEMBER vf own(int k) const { return Given::own(k); }
    /// Sets what every kind must: Bsdf::albedo(), spread() and delta().
    AL_MEMBER void common(vf albedo, vf spread, vf delta) const {
        set(kRowAlbedo, albedo), set(kRowSpread, spread), set(kRowDelta, delta);
    }
};
/// f cos by channel, and the density of sample() per solid angle.
struct Value {
    Direction colour; ///< f cos, by channel
    vf pdf;           ///< per solid angle
};
/// The same f cos in all channels.
AL_INLINE Value grey(vf f, vf pdf) { return {{f, f, f}, pdf}; }
/// For a lobe that is sampled by its own value.
AL_INLINE vf where(vm m, vf x) { return select(m, x, vf(0)); }

/// Whether w is above the plane of "horizon"; true without one.
AL_INLINE vm aboveHorizon(const Given& p, const Direction& w) {
    return (p.number(kRowHasHorizon) == 0) | (dot(p.triple(kRowHorizon), w) * dot(p.axis(), w) > 0);
}

/// LobeLanes::prepare of a kind; lanes without a lobe are skipped in groups.
template <class Kind> static void prepareBlock(float* block, uint32_t lanes) {
    for (int at = 0; at < kStride; at += ALPENGLOW_LANES)
        if (lanes >> at & ((1u << ALPENGLOW_LANES) - 1)) Kind::prepare(Rows(block + at));
}
/// LobeLanes::evaluate of a kind.
template <class Kind> static void evaluateBlock(const float* block, uint32_t lanes, const float* w, float* value) {
    for (int at = 0; at < kStride; at += ALPENGLOW_LANES) {
        if (!(lanes >> at & ((1u << ALPENGLOW_LANES) - 1))) continue;
        const Value v = Kind::evaluate(Given{block + at}, Given{w + at}.triple(0));
        const Rows out(value + at);
        out.set(kRowColour, v.colour);
        out.set(kRowFcos, maxLanes(maxLanes(v.colour.x, v.colour.y), v.colour.z));
        out.set(kRowPdf, v.pdf);
    }
}
/// LobeLanes::sample of a kind.
template <class Kind> static void sampleBlock(const float* block, uint32_t lanes, const float* u, float* drawn) {
    for (int at = 0; at < kStride; at += ALPENGLOW_LANES) {
        if (!(lanes >> at & ((1u << ALPENGLOW_LANES) - 1))) continue;
        const Given numbers{u + at};
        Direction w;
        const vm good = Kind::sample(Given{block + at}, {numbers.number(0), numbers.number(1)}, w);
        const Rows out(drawn + at);
        out.set(kRowDirection, w);
        out.set(kRowDrawn, select(good, vf(1), vf(0)));
    }
}
/// The optional members of a kind; 0 where it has none.
template <class Kind> constexpr int traitsOf() {
    if constexpr (requires { Kind::traits; }) return Kind::traits;
    else return 0;
}
template <class Kind> constexpr float etaOf() {
    if constexpr (requires { Kind::eta; }) return Kind::eta;
    else return 0;
}
/// The entry of a kind in the list of lobes.
template <class Kind> constexpr LobeLanes lanesOf() {
    return {Kind::name,    Kind::doc,          Kind::distribution,  Kind::needs,      traitsOf<Kind>(),
            etaOf<Kind>(), prepareBlock<Kind>, evaluateBlock<Kind>, sampleBlock<Kind>};
}

} // namespace alpenglow::bsdf::AL_NAMESPACE
