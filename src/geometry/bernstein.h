// Polynomials in Bernstein form over 0..1, in double: what curves are met with. Source: Farin, "Curves and Surfaces for CAGD", 5.
#pragma once
#include "base/vec.h"
#include <array>

namespace alpenglow::geometry {

inline constexpr int kBernsteinMost = 8; ///< largest degree below

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

/// Where the polynomial changes its sign within 0..1, by increasing parameter, at most 8; ends where it is as good as nought
/// count too, so that of two polynomials that continue each other at least one has the root between them. A root of even
/// multiplicity is none. Cut in halves until the coefficients change their sign once (Descartes), then a bracketed Newton
/// iteration to the last bits.
int bernsteinRoots(const double* c, int degree, double out[8]);

} // namespace alpenglow::geometry
