// Elementary functions with the same bits on every machine. Those of libraries differ between versions and processors, which
// would show in pictures. They use additions, multiplications, divisions and roots only, which IEEE 754 rounds exactly, without
// fused operations. Use them where the result affects pictures; shadeops/elementary.h has versions for lanes. Error bounds:
// tests/base/exact_test.cpp, against a longer type. NaN gives NaN.
#pragma once
#include <cmath>

namespace alpenglow::exact {

/// A sine and a cosine of one angle.
struct SinCos {
    double sin, cos; ///< of the same angle
};
/// Radians. Error below 1.5 ulp for |x| <= 1e3, 2.5 ulp for |x| <= 1e6; beyond, that of x reduced by the rounded 2 pi. Infinity
/// gives NaN.
SinCos sinCos(double x);
/// Radians; errors as of sinCos().
double sin(double x);
double cos(double x);
/// 3 ulp for |x| <= 1e3, 4 ulp for |x| <= 1e6.
double tan(double x);
/// 1.5 ulp, -pi..pi; signed zeros as in the C library. Arguments must be finite.
double atan2(double y, double x);
/// 1.5 ulp, -pi/2..pi/2.
double atan(double x);
/// 3 ulp of the larger of result and 1; NaN outside [-1, 1].
double asin(double x);
/// 3 ulp of the larger of result and 1, 0..pi; NaN outside [-1, 1].
double acos(double x);
/// 1.5 ulp; 0 below -745, infinity above 709.78.
double exp(double x);
/// 1.5 ulp; -infinity for 0, NaN for negative x.
double log(double x);
/// x >= 0; (2 + |y log x|) ulp. 0 to the power of 0 is 1.
double pow(double x, double y);
/// For lengths in pictures: squares must neither overflow nor underflow.
inline double hypot(double x, double y) { return std::sqrt(x * x + y * y); }

} // namespace alpenglow::exact
