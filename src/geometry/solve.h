// Real roots of polynomials in double, for ray-surface intersection.
#pragma once

namespace alpenglow::geometry {

/// Real roots of a t^2 + 2 h t + c by increasing t (h is HALF the linear coefficient). Without cancellation; a may be 0.
/// Returns 0, 1 or 2; a double root counts twice; none when all coefficients vanish or one is not finite.
int solveQuadratic(double a, double h, double c, double t[2]);

/// Roots of c[0] + c[1] t + ... + c[degree] t^degree in [lo, hi] by increasing t, degree at most 4. Brackets are the critical
/// points, found the same way one degree lower, so every sign change is found and no iteration diverges. A root of even
/// multiplicity is found only if rounding makes it a sign change.
int polynomialRoots(const double* c, int degree, double lo, double hi, double t[4]);

} // namespace alpenglow::geometry
