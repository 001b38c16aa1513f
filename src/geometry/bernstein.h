// Polynomials in Bernstein form over 0..1, in double, for intersecting curves. Source: Farin, "Curves and Surfaces for CAGD", 5.
#pragma once
#include "base/vec.h"
#include <array>

namespace alpenglow::geometry {

inline constexpr int kBernsteinMost = 8; ///< largest degree below

/// n over k, for 0 <= k <= n <= kBernsteinMost.
inline double binomial(int n, int k) {
    static constexpr double kTable[kBernsteinMost + 1][kBernsteinMost + 1] = {
        {1},
        {1, 1},
        {1, 2, 1},
        {1, 3, 3, 1},
        {1, 4, 6, 4, 1},
        {1, 5, 10, 10, 5, 1},
        {1, 6, 15, 20, 15, 6, 1},
        {1, 7, 21, 35, 35, 21, 7, 1},
        {1, 8, 28, 56, 70, 56, 28, 8, 1},
    };
    return kTable[n][k];
}

/// Value at x by de Casteljau; also for x a little outside of 0..1. T: a number or a vector.
template <int Degree, class T> T bernsteinAt(const T* c, double x) {
    T p[Degree + 1];
    for (int i = 0; i <= Degree; ++i) p[i] = c[i];
    for (int n = Degree; n > 0; --n)
        for (int i = 0; i < n; ++i) p[i] = p[i] * (1 - x) + p[i + 1] * x;
    return p[0];
}

/// out: Degree coefficients of the derivative, of one degree less.
template <int Degree, class T> void bernsteinSlope(const T* c, T* out) {
    for (int i = 0; i < Degree; ++i) out[i] = (c[i + 1] - c[i]) * double(Degree);
}

/// c becomes the part over 0..x and `right` that over x..1, both over 0..1 again.
template <int Degree, class T> void bernsteinSplit(T* c, double x, T* right) {
    right[Degree] = c[Degree];
    for (int n = Degree; n > 0; --n) {
        for (int i = Degree; i > Degree - n; --i) c[i] = c[i - 1] * (1 - x) + c[i] * x;
        // c[Degree] holds the last of this round; those of the left are settled from the front.
        right[n - 1] = c[Degree];
    }
}

/// The part over a..b, over 0..1 again.
template <int Degree, class T> void bernsteinPart(T* c, double a, double b) {
    T right[Degree + 1];
    if (b < 1) bernsteinSplit<Degree>(c, b, right);
    if (a > 0) {
        bernsteinSplit<Degree>(c, a / b, right);
        for (int i = 0; i <= Degree; ++i) c[i] = right[i];
    }
}

/// sum += sign * a * b.
template <int A, int B> void bernsteinAddProduct(double* sum, const double* a, const double* b, double sign = 1) {
    for (int i = 0; i <= A; ++i)
        for (int k = 0; k <= B; ++k) sum[i + k] += sign * binomial(A, i) * binomial(B, k) / binomial(A + B, i + k) * a[i] * b[k];
}

/// Sign changes of the polynomial in 0..1, by increasing parameter, at most 8; ends where it nearly vanishes count too, so that
/// of two adjacent polynomials at least one has a root at the joint. Excludes roots of even multiplicity. Bisects until the
/// coefficients change sign once (Descartes), then iterates by bracketed Newton steps to the last bits.
int bernsteinRoots(const double* c, int degree, double out[8]);

} // namespace alpenglow::geometry
