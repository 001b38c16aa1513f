// Stands in for shadeops/lanes.h in the hand-written patterns: the same polynomials and the same noise, over plain floats
// (HAND_LANES 1) or over vector types, for whatever processor the file is compiled for. HAND_LIST names the list to define.
#pragma once
#define HAND_JOIN2(a, b) a##b
#define HAND_JOIN(a, b) HAND_JOIN2(a, b)
#define AL_NAMESPACE HAND_JOIN(hand, HAND_LIST)
#define AL_INLINE static inline __attribute__((always_inline))
#define AL_MEMBER __attribute__((always_inline)) inline

namespace alpenglow::shadeops::AL_NAMESPACE {

#if HAND_LANES == 1
typedef float vf;
typedef int vi;
typedef unsigned vu;
typedef bool vm;
AL_INLINE vm maskOf(bool m) { return m; }
AL_INLINE vu bitsForFlip(vm m) { return m ? ~0u : 0u; }
AL_INLINE vi toInt(vf x) { return int(x); }
AL_INLINE vf toReal(vi x) { return float(x); }
#else
typedef float vf __attribute__((ext_vector_type(HAND_LANES)));
typedef int vi __attribute__((ext_vector_type(HAND_LANES)));
typedef unsigned vu __attribute__((ext_vector_type(HAND_LANES)));
typedef vi vm;
AL_INLINE vm maskOf(vi m) { return m; }
AL_INLINE vu bitsForFlip(vm m) { return __builtin_bit_cast(vu, m); }
AL_INLINE vi toInt(vf x) { return __builtin_convertvector(x, vi); }
AL_INLINE vf toReal(vi x) { return __builtin_convertvector(x, vf); }
#endif
AL_INLINE vu bitsOf(vf x) { return __builtin_bit_cast(vu, x); }
AL_INLINE vf fromBits(vu x) { return __builtin_bit_cast(vf, x); }
AL_INLINE vf select(vm m, vf a, vf b) { return m ? a : b; }
AL_INLINE vu select(vm m, vu a, vu b) { return m ? a : b; }
AL_INLINE vf mad(vf a, vf b, vf c) { return __builtin_elementwise_fma(a, b, c); }
AL_INLINE vf floorLanes(vf x) { return __builtin_elementwise_floor(x); }
AL_INLINE vf ceilLanes(vf x) { return __builtin_elementwise_ceil(x); }
AL_INLINE vf truncLanes(vf x) { return __builtin_elementwise_trunc(x); }
AL_INLINE vf absLanes(vf x) { return fromBits(bitsOf(x) & 0x7fffffffu); }
AL_INLINE vf minLanes(vf a, vf b) { return a < b ? a : b; }
AL_INLINE vf maxLanes(vf a, vf b) { return a > b ? a : b; }
AL_INLINE vf rootLanes(vf x) { return __builtin_elementwise_sqrt(x); }
AL_INLINE vf flipSign(vf x, vu bits) { return fromBits(bitsOf(x) ^ (bits & 0x80000000u)); }
AL_INLINE vf copySign(vf x, vf sign) { return fromBits((bitsOf(x) & 0x7fffffffu) | (bitsOf(sign) & 0x80000000u)); }
AL_INLINE vf unitReal(vu h) { return toReal(__builtin_bit_cast(vi, h >> 8)) * 0x1p-24f; }
AL_INLINE vf signedSlope(vu h) { return fromBits((h & 0x807fffffu) | 0x3f000000u); }
AL_INLINE vu payload(vf x) { return bitsOf(x); }

} // namespace alpenglow::shadeops::AL_NAMESPACE

#include "shadeops/elementary.h"
