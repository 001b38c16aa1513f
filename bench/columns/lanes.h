// W lanes of floats, integers and doubles: what the columns of this folder are worked on with. -DW=4, 8 or 16.
#pragma once
#include <cstdint>
#include <immintrin.h>

#ifndef W
#define W 8
#endif

namespace alpenglow::bench::columns {

typedef float F __attribute__((ext_vector_type(W)));
typedef int32_t I __attribute__((ext_vector_type(W)));
typedef uint32_t U __attribute__((ext_vector_type(W)));
typedef double D __attribute__((ext_vector_type(W)));
typedef int64_t L __attribute__((ext_vector_type(W)));
#define INL [[gnu::always_inline]] static inline
INL F ld(const float* p) {
    F v;
    __builtin_memcpy(&v, p, sizeof v);
    return v;
}
INL I ldi(const float* p) {
    I v;
    __builtin_memcpy(&v, p, sizeof v);
    return v;
}
INL U ldu(const float* p) {
    U v;
    __builtin_memcpy(&v, p, sizeof v);
    return v;
}
template <class T> INL void st(float* p, T v) { __builtin_memcpy(p, &v, sizeof v); }
INL F all(float f) { return F(f); }
INL F fma(F a, F b, F c) { return __builtin_elementwise_fma(a, b, c); }
INL D fma(D a, D b, D c) { return __builtin_elementwise_fma(a, b, c); }
INL F sq(F a) { return __builtin_elementwise_sqrt(a); }
INL F mn(F a, F b) { return a < b ? a : b; }
INL F mx(F a, F b) { return a > b ? a : b; }
INL F ab(F a) { return __builtin_bit_cast(F, __builtin_bit_cast(I, a) & 0x7fffffff); }
INL unsigned mask(I m) {
#if W == 8
    return unsigned(_mm256_movemask_ps(__builtin_bit_cast(__m256, m)));
#elif W == 4
    return unsigned(_mm_movemask_ps(__builtin_bit_cast(__m128, m)));
#else
    typedef int32_t I8 __attribute__((ext_vector_type(8)));
    return unsigned(_mm256_movemask_ps(__builtin_bit_cast(__m256, I8(m.lo)))) |
           unsigned(_mm256_movemask_ps(__builtin_bit_cast(__m256, I8(m.hi)))) << 8;
#endif
}
struct Lut {
    alignas(32) int32_t at[256][8];
    Lut() {
        for (int m = 0; m < 256; ++m) {
            int n = 0;
            for (int k = 0; k < 8; ++k) at[m][k] = 0;
            for (int k = 0; k < 8; ++k)
                if (m >> k & 1) at[m][n++] = k;
        }
    }
};
static const Lut lut;
/// Stores the lanes of the mask next to each other; room for W behind p.
template <class T> INL void put(float* p, T v, unsigned m) {
#if W == 8
    _mm256_storeu_ps(p, _mm256_permutevar8x32_ps(__builtin_bit_cast(__m256, v), *(const __m256i*)lut.at[m]));
#elif W == 4
    _mm_storeu_ps(p, _mm_permutevar_ps(__builtin_bit_cast(__m128, v), *(const __m128i*)lut.at[m]));
#else
    typedef float F8 __attribute__((ext_vector_type(8)));
    F f = __builtin_bit_cast(F, v);
    _mm256_storeu_ps(p, _mm256_permutevar8x32_ps(__builtin_bit_cast(__m256, F8(f.lo)), *(const __m256i*)lut.at[m & 255]));
    _mm256_storeu_ps(p + __builtin_popcount(m & 255),
                     _mm256_permutevar8x32_ps(__builtin_bit_cast(__m256, F8(f.hi)), *(const __m256i*)lut.at[m >> 8]));
#endif
}
INL F gather(const float* p, I i) {
#if W == 8
    return __builtin_bit_cast(F, _mm256_i32gather_ps(p, __builtin_bit_cast(__m256i, i), 4));
#else
    F r;
    for (int k = 0; k < W; ++k) r[k] = p[i[k]];
    return r;
#endif
}
INL I iota() {
    I r;
    for (int k = 0; k < W; ++k) r[k] = k;
    return r;
}
INL F unitF(U v) { return __builtin_convertvector(__builtin_bit_cast(I, v >> 8), F) * 0x1p-24f; }

} // namespace alpenglow::bench::columns
