// Rows in registers: the vectors of shadeops/lanes.h over the blocks of lanes/blocks.h. Sums and products are in the order of
// base/vec.h, each rounded once, so a stage gives the bits of a function over Vec3.
#pragma once
#include "lanes/stages.h"
#include "shadeops/lanes.h"

namespace alpenglow::lanes::AL_NAMESPACE {
using namespace shadeops::AL_NAMESPACE;

inline constexpr int kW = ALPENGLOW_LANES; ///< lanes of a vector
/// Double and 64-bit integer for each lane.
typedef double vd __attribute__((ext_vector_type(ALPENGLOW_LANES)));
typedef uint64_t vq __attribute__((ext_vector_type(ALPENGLOW_LANES)));

/// As many numbers of a row as there are lanes, from p on.
AL_INLINE vf load(const float* p) {
    vf v;
    __builtin_memcpy(&v, p, sizeof v);
    return v;
}
AL_INLINE vi loadInt(const int32_t* p) {
    vi v;
    __builtin_memcpy(&v, p, sizeof v);
    return v;
}
AL_INLINE vu loadBits(const uint32_t* p) {
    vu v;
    __builtin_memcpy(&v, p, sizeof v);
    return v;
}
/// Writes a vector to p, unaligned.
template <class V> AL_INLINE void store(void* p, V v) { __builtin_memcpy(p, &v, sizeof v); }

/// Masks from and to the bits of a set of points, from point `at` on.
AL_INLINE vm maskFrom(Lanes bits, int at) {
    vi bit;
    for (int k = 0; k < kW; ++k) bit[k] = 1 << k;
    return (vi(int32_t(bits >> at)) & bit) != 0;
}
AL_INLINE Lanes bitsFrom(vm m, int at) {
    typedef bool vb __attribute__((ext_vector_type(ALPENGLOW_LANES)));
    const vb b = __builtin_convertvector(m, vb);
    Lanes bits = 0;
    __builtin_memcpy(&bits, &b, sizeof b);
    return (bits & ((1u << kW) - 1)) << at;
}
/// True where x is neither infinite nor NaN.
AL_INLINE vm finite(vf x) { return (bitsOf(x) & 0x7f800000u) != 0x7f800000u; }

/// Three rows in registers.
struct V3 {
    vf x, y, z; ///< by lane
};
/// Three rows from a block, or rows `stride` floats apart; operators and functions as of Vec3, by lane.
AL_INLINE V3 load3(const Row* r, int at) { return {load(r[0] + at), load(r[1] + at), load(r[2] + at)}; }
AL_INLINE V3 load3(const float* rows, int stride) { return {load(rows), load(rows + stride), load(rows + 2 * stride)}; }
AL_INLINE void store3(Row* r, int at, const V3& v) {
    store(r[0] + at, v.x);
    store(r[1] + at, v.y);
    store(r[2] + at, v.z);
}
AL_INLINE V3 operator+(const V3& a, const V3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
AL_INLINE V3 operator-(const V3& a, const V3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
AL_INLINE V3 operator-(const V3& a) { return {-a.x, -a.y, -a.z}; }
AL_INLINE V3 operator*(const V3& a, const V3& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
AL_INLINE V3 operator*(const V3& a, vf s) { return {a.x * s, a.y * s, a.z * s}; }
AL_INLINE V3 operator/(const V3& a, vf s) { return {a.x / s, a.y / s, a.z / s}; }
AL_INLINE vf dot(const V3& a, const V3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
AL_INLINE vf length(const V3& a) { return rootLanes(dot(a, a)); }
AL_INLINE V3 choose(vm m, const V3& a, const V3& b) { return {select(m, a.x, b.x), select(m, a.y, b.y), select(m, a.z, b.z)}; }
AL_INLINE V3 absolute(const V3& a) { return {absLanes(a.x), absLanes(a.y), absLanes(a.z)}; }
AL_INLINE vm finite(const V3& a) { return finite(a.x) & finite(a.y) & finite(a.z); }
AL_INLINE vm isZero(const V3& a) { return (a.x == 0) & (a.y == 0) & (a.z == 0); }
AL_INLINE vf maxComponent(const V3& a) {
    const vf m = select(a.x > a.y, a.x, a.y);
    return select(m > a.z, m, a.z);
}
AL_INLINE vf luminance(const V3& c) { return vf(float(0.2126)) * c.x + vf(float(0.7152)) * c.y + vf(float(0.0722)) * c.z; }
/// normalizeOr() of base/vec.h.
AL_INLINE V3 normalizeOr(const V3& a, const V3& otherwise) {
    const vf l = length(a);
    return choose((l > 0) & finite(l), a / l, otherwise);
}
/// directionOr() of base/direction.h where `usual` is set; the other lanes need double.
AL_INLINE V3 directionOr(const V3& a, const V3& otherwise, vm& usual) {
    const V3 size = absolute(a);
    const vf most = maxLanes(maxLanes(size.x, size.y), size.z);
    usual = finite(a) & (most > vf(1e-15f)) & (most < vf(1e15f));
    return normalizeOr(a, otherwise);
}

/// Origin of a ray that leaves a surface: geometry::offsetOrigin().
AL_INLINE vf stepAway(vf x, vf by) {
    const vi bits = __builtin_bit_cast(vi, x), direction = __builtin_bit_cast(vi, by);
    vi moved = bits + (((bits ^ direction) >> 31) | 1);
    moved = x == 0 ? ((direction & vi(INT32_MIN)) | 1) : moved;
    const vm goes = (by != 0) & (by == by) & (absLanes(x) < vf(__builtin_inff()));
    return __builtin_bit_cast(vf, goes ? moved : bits);
}
/// Of a point of a block.
AL_INLINE V3 offsetOrigin(const V3& P, const V3& n, vf error, const V3& w) {
    const vf d = vf(2) * error;
    const V3 off = n * select(dot(w, n) >= 0, d, -d), o = P + off;
    return {stepAway(o.x, off.x), stepAway(o.y, off.y), stepAway(o.z, off.z)};
}
/// Origin of a ray along w from a vertex.
AL_INLINE V3 leave(const VertexBlock& v, int at, const V3& w) {
    const V3 P = load3(v.P, at);
    const vf bias = load(v.bias + at);
    return choose(bias > 0, P + w * bias, offsetOrigin(P, load3(v.n, at), load(v.error + at), w));
}

/// MIS weight of technique a against b: misWeight() of bsdf/sampling.h.
AL_INLINE vf misWeight(vf a, vf b) {
    const vf r = b / a;
    return select(a > 0, vf(1) / (vf(1) + r * r), vf(0));
}

} // namespace alpenglow::lanes::AL_NAMESPACE
