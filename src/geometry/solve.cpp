#include "geometry/solve.h"
#include <cmath>
#include <utility>

namespace alpenglow::geometry {

int solveQuadratic(double a, double h, double c, double t[2]) {
    double d = h * h - a * c;
    if (!(d >= 0) || !std::isfinite(d)) return 0;
    double q = -(h + std::copysign(std::sqrt(d), h));
    int n = 0;
    if (q == 0) { // h = 0 and a c = 0
        if (a != 0) t[n++] = 0, t[n++] = 0;
        return n;
    }
    double t0 = c / q, t1 = q / a;
    t[n++] = t0;
    if (a != 0 && std::isfinite(t1)) t[n++] = t1;
    if (n == 2 && t[0] > t[1]) std::swap(t[0], t[1]);
    return n;
}

namespace {

double value(const double* c, int degree, double t) {
    double f = c[degree];
    for (int i = degree - 1; i >= 0; --i) f = f * t + c[i];
    return f;
}

// The root in [a, b] with a sign change: Newton steps safeguarded by bisection.
double refine(const double* c, const double* dc, int degree, double a, double b, double fa) {
    double t = 0.5 * (a + b);
    for (int i = 0; i < 100; ++i) {
        double f = value(c, degree, t);
        if (f == 0) return t;
        if ((f < 0) == (fa < 0)) a = t;
        else b = t;
        double d = value(dc, degree - 1, t), next = t - f / d;
        if (!(next > a && next < b)) next = 0.5 * (a + b);
        if (next == t || std::fabs(b - a) <= 1e-16 * (std::fabs(a) + std::fabs(b))) return next;
        if (std::fabs(next - t) <= 1e-8 * std::fabs(next)) return next; // steps of Newton's: the next would be the square of this
        t = next;
    }
    return t;
}

} // namespace

int polynomialRoots(const double* c, int degree, double lo, double hi, double t[4]) {
    while (degree > 0 && c[degree] == 0) --degree;
    if (degree == 0 || !(lo <= hi)) return 0;
    if (degree == 1) {
        double r = -c[0] / c[1];
        if (!(r >= lo && r <= hi)) return 0;
        t[0] = r;
        return 1;
    }
    if (degree == 2) {
        double both[2];
        if (solveQuadratic(c[2], c[1] / 2, c[0], both) != 2 || both[0] == both[1]) return 0;
        int n = 0;
        for (const double r : both)
            if (r >= lo && r <= hi) t[n++] = r;
        return n;
    }
    double dc[4], edge[6];
    for (int i = 1; i <= degree; ++i) dc[i - 1] = i * c[i];
    double crit[4];
    int m = polynomialRoots(dc, degree - 1, lo, hi, crit), e = 0, n = 0;
    edge[e++] = lo;
    for (int i = 0; i < m; ++i) edge[e++] = crit[i];
    edge[e++] = hi;
    double fa = value(c, degree, edge[0]);
    if (fa == 0) t[n++] = edge[0];
    for (int i = 0; i + 1 < e && n < degree; ++i) {
        double fb = value(c, degree, edge[i + 1]);
        if (fb == 0) {
            if (n == 0 || t[n - 1] != edge[i + 1]) t[n++] = edge[i + 1];
        } else if (fa != 0 && (fa < 0) != (fb < 0)) {
            t[n++] = refine(c, dc, degree, edge[i], edge[i + 1], fa);
        }
        fa = fb;
    }
    return n;
}

} // namespace alpenglow::geometry
