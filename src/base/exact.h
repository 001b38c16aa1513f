// Elementary functions with the same bits on every machine: a library's differ from one version to the next and from one
// processor to the next, and would show in pictures. Plain additions, multiplications, divisions and roots, which IEEE 754 rounds
// exactly; no fused ones. Where these decide what a picture shows, use them; shadeops/elementary.h has the like over lanes.
// Errors: tests/base/exact_test.cpp, against a longer type. Not a number gives not a number.
#pragma once
#include <cmath>

namespace alpenglow::exact {

struct SinCos {
    double sin, cos;
};
/// Radians. Error below 1.5 ulp for |x| <= 1e3, 2.5 ulp for |x| <= 1e6; beyond, that of x reduced by 2 pi as it is rounded.
/// Infinity gives not a number.
SinCos sinCos(double x);
double sin(double x);
double cos(double x);
/// 3 ulp for |x| <= 1e3, 4 ulp for |x| <= 1e6.
double tan(double x);
/// 1.5 ulp, -pi..pi; the signs of zeros count, as in the C library. Not for infinities.
double atan2(double y, double x);
double atan(double x);
/// 3 ulp of the larger of result and 1; not a number outside [-1, 1].
double asin(double x);
double acos(double x);
/// 1.5 ulp; 0 below -745, infinity above 709.78.
double exp(double x);
/// 1.5 ulp; -infinity for 0, not a number below.
double log(double x);
/// x >= 0; (2 + |y log x|) ulp. 0 to the power of 0 is 1.
double pow(double x, double y);
/// For lengths that pictures have: squares must neither overflow nor vanish.
inline double hypot(double x, double y) { return std::sqrt(x * x + y * y); }

} // namespace alpenglow::exact
