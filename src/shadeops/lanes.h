// Numbers over lanes, and the few primitives that shadeops are written in. Compiled four ways: into the program at 4 lanes, into
// its stages at 1 to 16 (src/lanes), to bitcode at 4..64 lanes, and in a test with another type in place of float
// (ALPENGLOW_REFERENCE names the header that replaces this one). Lane-wise operations only, in a fixed order, with fused
// multiply-add where the source says mad(): so every width gives the same bits.
#pragma once
#ifdef ALPENGLOW_REFERENCE
#include ALPENGLOW_REFERENCE
#else

#ifndef ALPENGLOW_LANES
#define ALPENGLOW_LANES 4
#endif
#define AL_JOIN2(a, b) a##b
#define AL_JOIN(a, b) AL_JOIN2(a, b)
#ifndef AL_NAMESPACE
#define AL_NAMESPACE AL_JOIN(lanes, ALPENGLOW_LANES)
#endif
#define AL_INLINE static inline __attribute__((always_inline))
#define AL_MEMBER __attribute__((always_inline)) inline

namespace alpenglow::shadeops::AL_NAMESPACE {

/// One float, integer, unsigned integer for each lane.
typedef float vf __attribute__((ext_vector_type(ALPENGLOW_LANES)));
typedef int vi __attribute__((ext_vector_type(ALPENGLOW_LANES)));
typedef unsigned vu __attribute__((ext_vector_type(ALPENGLOW_LANES)));
typedef vi vm; ///< mask: -1 or 0

/// The same bits as another type.
AL_INLINE vu bitsOf(vf x) { return __builtin_bit_cast(vu, x); }
AL_INLINE vf fromBits(vu x) { return __builtin_bit_cast(vf, x); }
/// By lane: a where m is set, else b.
AL_INLINE vf select(vm m, vf a, vf b) { return m ? a : b; }
AL_INLINE vu select(vm m, vu a, vu b) { return m ? a : b; }

/// a * b + c, rounded once.
#if defined(ALPENGLOW_BITCODE) || defined(__FMA__)
/// A b + c, rounded once.
AL_INLINE vf mad(vf a, vf b, vf c) { return __builtin_elementwise_fma(a, b, c); }
#else
// The program itself is built for machines without the instruction: a call keeps the code small there.
static __attribute__((noinline, unused)) vf mad(vf a, vf b, vf c) { return __builtin_elementwise_fma(a, b, c); }
#endif

/// Rounds down, up, toward zero.
AL_INLINE vf floorLanes(vf x) { return __builtin_elementwise_floor(x); }
AL_INLINE vf ceilLanes(vf x) { return __builtin_elementwise_ceil(x); }
AL_INLINE vf truncLanes(vf x) { return __builtin_elementwise_trunc(x); }
/// The absolute value, also of NaN.
AL_INLINE vf absLanes(vf x) { return fromBits(bitsOf(x) & 0x7fffffffu); }
/// b where a is not a number: compare and select, one instruction on x86.
AL_INLINE vf minLanes(vf a, vf b) { return a < b ? a : b; }
AL_INLINE vf maxLanes(vf a, vf b) { return a > b ? a : b; }
/// Square root of x >= 0, correctly rounded.
AL_INLINE vf rootLanes(vf x) { return __builtin_elementwise_sqrt(x); }
/// x with its sign changed where the top bit of `bits` is set.
AL_INLINE vf flipSign(vf x, vu bits) { return fromBits(bitsOf(x) ^ (bits & 0x80000000u)); }
AL_INLINE vf copySign(vf x, vf sign) { return fromBits((bitsOf(x) & 0x7fffffffu) | (bitsOf(sign) & 0x80000000u)); }
/// A comparison of integers as a mask for select.
AL_INLINE vm maskOf(vi m) { return m; }
/// Bits that make flipSign change the sign where the mask is set.
AL_INLINE vu bitsForFlip(vm m) { return __builtin_bit_cast(vu, m); }
/// Whole numbers |x| <= 2^30.
AL_INLINE vi toInt(vf x) { return __builtin_convertvector(x, vi); }
AL_INLINE vf toReal(vi x) { return __builtin_convertvector(x, vf); }
/// Hash bits to [0,1), 24 bits.
AL_INLINE vf unitReal(vu h) { return __builtin_convertvector(__builtin_bit_cast(vi, h >> 8), vf) * 0x1p-24f; }
/// Hash bits to +-[0.5, 1): sign from the top bit.
AL_INLINE vf signedSlope(vu h) { return fromBits((h & 0x807fffffu) | 0x3f000000u); }
/// A hash that travels as a float's bits (strings, random()).
AL_INLINE vu payload(vf x) { return bitsOf(x); }

} // namespace alpenglow::shadeops::AL_NAMESPACE

#include "shadeops/elementary.h"
#endif
