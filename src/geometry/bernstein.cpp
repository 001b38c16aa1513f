#include "geometry/bernstein.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::geometry {

namespace {

struct Part {
    double c[kBernsteinMost + 1], from, wide;
};

double valueAt(const double* c, int degree, double x, double* slope) {
    double p[kBernsteinMost + 1];
    std::copy(c, c + degree + 1, p);
    for (int n = degree; n > 1; --n)
        for (int i = 0; i < n; ++i) p[i] += (p[i + 1] - p[i]) * x;
    *slope = degree * (p[1] - p[0]);
    return p[0] + (p[1] - p[0]) * x;
}

/// The only root in an interval where the values (times sign) are negative before it and positive after it.
double onlyRoot(const double* c, int degree, double sign) {
    double lo = 0, hi = 1, x = 0.5;
    if (c[0] * c[degree] < 0) x = c[0] / (c[0] - c[degree]);
    double last = 2;
    for (int i = 0; i < 100; ++i) {
        double slope;
        const double f = sign * valueAt(c, degree, x, &slope);
        slope *= sign;
        if (f == 0) return x;
        (f < 0 ? lo : hi) = x;
        double next = x - f / slope;
        if (!(next > lo && next < hi) || std::fabs(next - x) > 0.5 * last) next = 0.5 * (lo + hi);
        last = std::fabs(next - x);
        if (next == x || hi - lo < 1e-16) return next;
        if (last < 1e-15) return next;
        x = next;
    }
    return x;
}

} // namespace

int bernsteinRoots(const double* c, int degree, double out[8]) {
    int n = 0;
    double found[16];
    const auto add = [&](double x) {
        if (n < 16) found[n++] = x;
    };
    double most = 0;
    for (int i = 0; i <= degree; ++i) most = std::max(most, std::fabs(c[i]));
    if (!(most > 0) || !std::isfinite(most)) return 0;
    const double nothing = 1e-14 * most;
    if (std::fabs(c[0]) <= nothing) add(0);
    constexpr int kDeepest = 40;
    Part stack[kDeepest + 2];
    int size = 1;
    std::copy(c, c + degree + 1, stack[0].c);
    stack[0].from = 0;
    stack[0].wide = 1;
    while (size) {
        Part& p = stack[--size];
        double first = 0, last = 0;
        int changes = 0;
        for (int i = 0; i <= degree; ++i) {
            if (p.c[i] == 0) continue;
            changes += last * p.c[i] < 0 || (last != 0 && std::signbit(last) != std::signbit(p.c[i]));
            if (first == 0) first = p.c[i];
            last = p.c[i];
        }
        if (changes == 0) continue;
        if (changes == 1) {
            add(p.from + p.wide * onlyRoot(p.c, degree, first < 0 ? 1 : -1));
            continue;
        }
        if (p.wide < 0x1p-38) { // roots as close as double can distinguish
            if (std::signbit(first) != std::signbit(last)) add(p.from);
            continue;
        }
        Part left = p;
        double right[kBernsteinMost + 1];
        right[degree] = left.c[degree];
        for (int k = degree; k > 0; --k) {
            for (int i = degree; i > degree - k; --i) left.c[i] = 0.5 * (left.c[i - 1] + left.c[i]);
            right[k - 1] = left.c[degree];
        }
        const double half = 0.5 * p.wide, from = p.from;
        std::copy(right, right + degree + 1, p.c); // the right half waits below the left one
        p.from = from + half;
        p.wide = half;
        const bool between = left.c[degree] == 0;
        left.wide = half;
        ++size;
        stack[size++] = left;
        if (between) add(from + half);
    }
    if (std::fabs(c[degree]) <= nothing) add(1);
    std::sort(found, found + n);
    int roots = 0;
    for (int i = 0; i < n && roots < 8; ++i)
        if (roots == 0 || found[i] > out[roots - 1] + 1e-12) out[roots++] = found[i];
    return roots;
}

} // namespace alpenglow::geometry
