#include "geometry/blob_field.h"
#include <algorithm>
#include <array>
#include <cmath>

namespace alpenglow::geometry {

namespace {

constexpr double kWhole = 35.0 / 32; ///< 1 over the integral of (1 - t^2)^3: an endless segment is 1 on its axis

double cube(double x) { return x * x * x; }

} // namespace

Vec3d BlobLeaf::inside(const Vec3d& p) const {
    return {m[0][0] * p.x + m[0][1] * p.y + m[0][2] * p.z + m[0][3], m[1][0] * p.x + m[1][1] * p.y + m[1][2] * p.z + m[1][3],
            m[2][0] * p.x + m[2][1] * p.y + m[2][2] * p.z + m[2][3]};
}

double blobLeafField(const BlobLeaf& l, const Vec3d& q, Vec3d* g, double* h) {
    if (g) *g = Vec3d(0.0);
    if (h) std::fill(h, h + 6, 0.0);
    if (l.kind == BlobLeaf::Kind::Ellipsoid) { // (1 - r^2)^3
        const double k = 1 - dot(q, q);
        if (k <= 0) return 0;
        if (g) *g = q * (-6 * k * k);
        if (h) {
            const double a = -6 * k * k, b = 24 * k;
            h[0] = a + b * q.x * q.x, h[1] = a + b * q.y * q.y, h[2] = a + b * q.z * q.z;
            h[3] = b * q.x * q.y, h[4] = b * q.x * q.z, h[5] = b * q.y * q.z;
        }
        return cube(k);
    }
    // The same bump, integrated along the segment: segments end to end add up to the longer one.
    const Vec3d e = q - l.from;
    const double s = dot(e, l.along);
    const Vec3d side = e - l.along * s;
    const double k = 1 - dot(side, side);
    if (k <= 0) return 0;
    const double reach = std::sqrt(k), lo = std::max(-s, -reach), hi = std::min(l.length - s, reach);
    if (lo >= hi) return 0;
    const auto between = [&](auto f) { return kWhole * (f(hi) - f(lo)); };
    const double value = between([&](double u) {
        const double v = u * u;
        return u * (k * k * k - v * (k * k - v * (0.6 * k - v / 7)));
    });
    if (!g) return value;
    const double byK = between([&](double u) {
        const double v = u * u;
        return u * (3 * k * k - v * (2 * k - 0.6 * v));
    });
    const double begin = std::max(0.0, k - s * s), end = std::max(0.0, k - (l.length - s) * (l.length - s));
    const double byS = kWhole * (cube(begin) - cube(end));
    *g = side * (-2 * byK) + l.along * byS;
    if (!h) return value;
    const double kk = between([&](double u) { return u * (6 * k - 2 * u * u); });
    const double ks = kWhole * 3 * (begin * begin - end * end);
    const double ss = kWhole * -6 * ((l.length - s) * end * end + s * begin * begin);
    const Vec3d gk = side * -2.0, &a = l.along;
    const auto term = [&](int i, int j) {
        return kk * gk[i] * gk[j] + ks * (gk[i] * a[j] + gk[j] * a[i]) + ss * a[i] * a[j] - 2 * byK * ((i == j) - a[i] * a[j]);
    };
    h[0] = term(0, 0), h[1] = term(1, 1), h[2] = term(2, 2), h[3] = term(0, 1), h[4] = term(0, 2), h[5] = term(1, 2);
    return value;
}

// ---- the ground
// -----------------------------------------------------------------------------------------------------------------

double BlobGround::above(const Vec3d& p) const {
    const auto& s = toScreen.m;
    const double w = p.x * s[0][3] + p.y * s[1][3] + p.z * s[2][3] + s[3][3];
    if (!(w > 0)) return INFINITY;
    const double x = (p.x * s[0][0] + p.y * s[1][0] + p.z * s[2][0] + s[3][0]) / w,
                 y = (p.x * s[0][1] + p.y * s[1][1] + p.z * s[2][1] + s[3][1]) / w;
    const double i = (0.5 + 0.5 * x) * width - 0.5, j = (0.5 - 0.5 * y) * height - 0.5;
    if (!(i >= -0.5 && i <= width - 0.5 && j >= -0.5 && j <= height - 0.5)) return INFINITY;
    const int i0 = std::clamp(int(std::floor(i)), 0, std::max(0, width - 2)),
              j0 = std::clamp(int(std::floor(j)), 0, std::max(0, height - 2));
    const int i1 = std::min(i0 + 1, width - 1), j1 = std::min(j0 + 1, height - 1);
    const double u = std::clamp(i - i0, 0.0, 1.0), v = std::clamp(j - j0, 0.0, 1.0);
    const auto at = [&](int x0, int y0) { return double(depth[size_t(y0) * size_t(width) + size_t(x0)]); };
    const double z = (1 - v) * ((1 - u) * at(i0, j0) + u * at(i1, j0)) + v * ((1 - u) * at(i0, j1) + u * at(i1, j1));
    return z - transformPoint(toCamera, p).z;
}

namespace {

/// As in the application note: a wall at height 0, a bulge around height c, zero from a on.
double repulsion(double z, const BlobGround& g) {
    if (!(z < g.a)) return 0;
    z = std::max(z, 1e-6);
    const double r = z / g.c, e = std::clamp(z / g.a, 0.0, 1.0);
    const double bump = r > 0 && r < 2 ? (((6 - r) * r - 12) * r + 8) * r * r * r : 0;
    return (g.d * bump - g.b / z) * (1 - e * e * (3 - 2 * e));
}

double groundField(const BlobGround& g, const Vec3d& p) { return repulsion(g.above(p), g); }

/// By differences with a step smaller than the map's detail: depth maps have no derivatives.
BlobJet groundJet(const BlobGround& g, const Vec3d& p) {
    BlobJet j;
    j.f = groundField(g, p);
    const double step = 1e-4 * std::max(g.a, 1e-9);
    for (int k = 0; k < 3; ++k) {
        Vec3d a = p, b = p;
        a[k] += step, b[k] -= step;
        const double fa = groundField(g, a), fb = groundField(g, b);
        j.g[k] = (fa - fb) / (2 * step);
        j.h[k] = (fa - 2 * j.f + fb) / (step * step);
    }
    return j;
}

Interval groundBounds(const BlobGround& g, const Vec3d& lo, const Vec3d& hi) {
    // Depths anywhere in the map: simple, and boxes get small.
    double near = INFINITY, far = -INFINITY;
    for (int k = 0; k < 8; ++k) {
        const double z = transformPoint(g.toCamera, Vec3d(k & 1 ? lo.x : hi.x, k & 2 ? lo.y : hi.y, k & 4 ? lo.z : hi.z)).z;
        near = std::min(near, z);
        far = std::max(far, z);
    }
    const double least = std::max(1e-6, g.least - far), most = std::max(1e-6, g.most - near);
    if (least >= g.a) return {0, 0};
    const double bulge = std::max(0.0, g.d), dent = std::min(0.0, g.d);
    return {dent - std::max(0.0, g.b) / least, bulge + std::max(0.0, -g.b) / std::min(least, most)};
}

} // namespace

// ---- values
// ---------------------------------------------------------------------------------------------------------------------

namespace {

using Kind = BlobOp::Kind;

BlobJet operator+(const BlobJet& a, const BlobJet& b) {
    BlobJet r{a.f + b.f, a.g + b.g, {}};
    for (int k = 0; k < 6; ++k) r.h[k] = a.h[k] + b.h[k];
    return r;
}
BlobJet operator*(const BlobJet& a, double s) {
    BlobJet r{a.f * s, a.g * s, {}};
    for (int k = 0; k < 6; ++k) r.h[k] = a.h[k] * s;
    return r;
}
constexpr int kFirst[6] = {0, 1, 2, 0, 0, 1}, kSecond[6] = {0, 1, 2, 1, 2, 2};
BlobJet product(const BlobJet& a, const BlobJet& b) {
    BlobJet r{a.f * b.f, a.g * b.f + b.g * a.f, {}};
    for (int k = 0; k < 6; ++k) {
        const int i = kFirst[k], j = kSecond[k];
        r.h[k] = a.h[k] * b.f + b.h[k] * a.f + a.g[i] * b.g[j] + a.g[j] * b.g[i];
    }
    return r;
}
BlobJet inverse(const BlobJet& a) {
    const double q = a.f != 0 ? 1 / a.f : 0;
    BlobJet r{q, a.g * (-q * q), {}};
    for (int k = 0; k < 6; ++k) r.h[k] = -a.h[k] * q * q + 2 * a.g[kFirst[k]] * a.g[kSecond[k]] * q * q * q;
    return r;
}

BlobJet leafJet(const BlobLeaf& l, const Vec3d& p) {
    if (l.kind == BlobLeaf::Kind::Ground) return groundJet(*l.ground, p);
    Vec3d g;
    double h[6];
    BlobJet r;
    r.f = blobLeafField(l, l.inside(p), &g, h);
    if (r.f == 0) return r;
    const double full[3][3] = {{h[0], h[3], h[4]}, {h[3], h[1], h[5]}, {h[4], h[5], h[2]}};
    for (int j = 0; j < 3; ++j) r.g[j] = g.x * l.m[0][j] + g.y * l.m[1][j] + g.z * l.m[2][j];
    for (int k = 0; k < 6; ++k)
        for (int a = 0; a < 3; ++a)
            for (int b = 0; b < 3; ++b) r.h[k] += l.m[a][kFirst[k]] * full[a][b] * l.m[b][kSecond[k]];
    return r;
}

/// Room for the results of a tape: nearly all are short.
template <class T> class Results {
public:
    explicit Results(size_t n) {
        if (n > few_.size()) many_.resize(n);
    }
    T& operator[](size_t i) { return many_.empty() ? few_[i] : many_[i]; }

private:
    std::array<T, 24> few_;
    std::vector<T> many_;
};

} // namespace

/// The value of every step of a tape; ofLeaf: the field of a leaf, by its number.
template <class OfLeaf> static void stepValues(const BlobTape& tape, Results<double>& v, OfLeaf ofLeaf) {
    for (size_t i = 0; i < tape.size(); ++i) {
        const BlobOp& o = tape[i];
        switch (o.kind) {
        case Kind::Constant:
            v[i] = o.c;
            break;
        case Kind::Leaf:
            v[i] = ofLeaf(o.a);
            break;
        case Kind::Add:
            v[i] = v[o.a] + v[o.b];
            break;
        case Kind::Multiply:
            v[i] = v[o.a] * v[o.b];
            break;
        case Kind::Maximum:
            v[i] = std::max(v[o.a], v[o.b]);
            break;
        case Kind::Minimum:
            v[i] = std::min(v[o.a], v[o.b]);
            break;
        case Kind::Subtract:
            v[i] = v[o.a] - v[o.b];
            break;
        case Kind::Divide:
            v[i] = v[o.b] != 0 ? v[o.a] / v[o.b] : 0;
            break;
        case Kind::Negate:
            v[i] = -v[o.a];
            break;
        }
    }
}

double BlobField::value(const BlobTape& tape, const Vec3d& p) const {
    Results<double> v(tape.size());
    stepValues(tape, v, [&](uint32_t leaf) {
        const BlobLeaf& l = leaves_[leaf];
        return l.kind == BlobLeaf::Kind::Ground ? groundField(*l.ground, p) : blobLeafField(l, l.inside(p), nullptr, nullptr);
    });
    return v[tape.size() - 1];
}

BlobJet BlobField::jet(const BlobTape& tape, const Vec3d& p) const {
    Results<BlobJet> v(tape.size());
    for (size_t i = 0; i < tape.size(); ++i) {
        const BlobOp& o = tape[i];
        switch (o.kind) {
        case Kind::Constant:
            v[i] = {o.c, Vec3d(0.0), {}};
            break;
        case Kind::Leaf:
            v[i] = leafJet(leaves_[o.a], p);
            break;
        case Kind::Add:
            v[i] = v[o.a] + v[o.b];
            break;
        case Kind::Multiply:
            v[i] = product(v[o.a], v[o.b]);
            break;
        case Kind::Maximum:
            v[i] = v[o.a].f >= v[o.b].f ? v[o.a] : v[o.b];
            break;
        case Kind::Minimum:
            v[i] = v[o.a].f <= v[o.b].f ? v[o.a] : v[o.b];
            break;
        case Kind::Subtract:
            v[i] = v[o.a] + v[o.b] * -1.0;
            break;
        case Kind::Divide:
            v[i] = product(v[o.a], inverse(v[o.b]));
            break;
        case Kind::Negate:
            v[i] = v[o.a] * -1.0;
            break;
        }
    }
    return v[tape.size() - 1];
}

void BlobField::shares(const BlobTape& tape, const Vec3d& p, std::vector<Share>& out) const {
    out.clear();
    // A maximum has the colour of its larger side, a difference or quotient of its first: subtracted blobs have none.
    Results<double> v(tape.size());
    std::vector<bool> shown(tape.size());
    stepValues(tape, v, [&](uint32_t leaf) { return leafJet(leaves_[leaf], p).f; });
    shown[tape.size() - 1] = true;
    double sum = 0;
    Vec3d slope(0.0);
    for (size_t i = tape.size(); i-- > 0;) {
        if (!shown[i]) continue;
        const BlobOp& o = tape[i];
        switch (o.kind) {
        case Kind::Constant:
            break;
        case Kind::Leaf:
            if (leaves_[o.a].kind == BlobLeaf::Kind::Ground) break;
            if (const BlobJet j = leafJet(leaves_[o.a], p); j.f > 0) {
                out.push_back({leaves_[o.a].number, j.f, j.g});
                sum += j.f;
                slope = slope + j.g;
            }
            break;
        case Kind::Maximum:
            shown[v[o.a] >= v[o.b] ? o.a : o.b] = true;
            break;
        case Kind::Minimum:
            shown[v[o.a] <= v[o.b] ? o.a : o.b] = true;
            break;
        case Kind::Subtract:
        case Kind::Divide:
        case Kind::Negate:
            shown[o.a] = true;
            break;
        default:
            shown[o.a] = shown[o.b] = true;
        }
    }
    for (Share& s : out) {
        s.g = (s.g - slope * (s.w / sum)) / sum;
        s.w /= sum;
    }
    std::sort(out.begin(), out.end(), [](const Share& a, const Share& b) { return a.number < b.number; });
}

// ---- bounds over a box
// ----------------------------------------------------------------------------------------------------------

namespace {

Interval multiply(const Interval& a, const Interval& b) {
    const double x[4] = {a.lo * b.lo, a.lo * b.hi, a.hi * b.lo, a.hi * b.hi};
    Interval r{INFINITY, -INFINITY};
    for (double v : x) {
        if (std::isnan(v)) v = 0; // 0 times infinity, for an unbounded value
        r.lo = std::min(r.lo, v);
        r.hi = std::max(r.hi, v);
    }
    return r;
}
Interval divide(const Interval& a, const Interval& b) {
    if (b.lo == 0 && b.hi == 0) return {0, 0};
    if (b.lo <= 0 && b.hi >= 0) return {-INFINITY, INFINITY};
    return multiply(a, {1 / b.hi, 1 / b.lo});
}

} // namespace

Interval combinedBounds(const BlobOp& o, const Interval& a, const Interval& b) {
    switch (o.kind) {
    case Kind::Add:
        return {a.lo + b.lo, a.hi + b.hi};
    case Kind::Multiply:
        return multiply(a, b);
    case Kind::Maximum:
        return {std::max(a.lo, b.lo), std::max(a.hi, b.hi)};
    case Kind::Minimum:
        return {std::min(a.lo, b.lo), std::min(a.hi, b.hi)};
    case Kind::Subtract:
        return {a.lo - b.hi, a.hi - b.lo};
    case Kind::Divide:
        return divide(a, b);
    case Kind::Negate:
        return {-a.hi, -a.lo};
    default:
        return {o.c, o.c};
    }
}

namespace {

constexpr double kSegmentBend = 13.2; ///< bound on second derivatives of a segment's field

} // namespace

Interval BlobField::leafBounds(const BlobLeaf& l, const Vec3d& lo, const Vec3d& hi) const {
    if (l.kind == BlobLeaf::Kind::Ground) return groundBounds(*l.ground, lo, hi);
    if (lo.x > l.hi.x || hi.x < l.lo.x || lo.y > l.hi.y || hi.y < l.lo.y || lo.z > l.hi.z || hi.z < l.lo.z) return {0, 0};
    const Vec3d q = l.inside((lo + hi) * 0.5), half = (hi - lo) * 0.5;
    double near = 0, far = 0, reach = 0;
    for (int i = 0; i < 3; ++i) {
        const double e = std::fabs(l.m[i][0]) * half.x + std::fabs(l.m[i][1]) * half.y + std::fabs(l.m[i][2]) * half.z +
                         1e-14 * (1 + std::fabs(q[i]));
        const double a = std::fabs(q[i]), b = std::max(0.0, a - e);
        near += b * b;
        far += (a + e) * (a + e);
        reach += e * e;
    }
    if (l.kind == BlobLeaf::Kind::Ellipsoid) return {cube(std::max(0.0, 1 - far)), cube(std::max(0.0, 1 - near))};
    reach = std::sqrt(reach);
    const Vec3d e = q - l.from;
    const double distance = length(e - l.along * std::clamp(dot(e, l.along), 0.0, l.length));
    if (distance - reach >= 1) return {0, 0};
    const double f = blobLeafField(l, q, nullptr, nullptr);
    return {std::max(0.0, f - kBlobSegmentSlope * reach), std::min(1.0, f + kBlobSegmentSlope * reach)};
}

Interval BlobField::bounds(const BlobTape& tape, const Vec3d& lo, const Vec3d& hi, std::vector<Interval>& v) const {
    v.resize(tape.size());
    for (size_t i = 0; i < tape.size(); ++i) {
        const BlobOp& o = tape[i];
        if (o.kind == Kind::Leaf) v[i] = leafBounds(leaves_[o.a], lo, hi);
        else if (o.kind == Kind::Constant) v[i] = {o.c, o.c};
        else v[i] = combinedBounds(o, v[o.a], v[o.b]);
    }
    return v.back();
}

BlobTape BlobField::simplified(const BlobTape& tape, const std::vector<Interval>& v) {
    const size_t n = tape.size();
    std::vector<uint32_t> same(n); // the operation that has its value here
    std::vector<bool> needed(n);
    const auto fixed = [&](size_t i) { return v[i].lo == v[i].hi; };
    for (size_t i = 0; i < n; ++i) {
        const BlobOp& o = tape[i];
        same[i] = uint32_t(i);
        if (fixed(i)) continue;
        if (o.kind == Kind::Maximum) {
            if (v[o.a].lo >= v[o.b].hi) same[i] = same[o.a];
            else if (v[o.b].lo >= v[o.a].hi) same[i] = same[o.b];
        } else if (o.kind == Kind::Minimum) {
            if (v[o.a].hi <= v[o.b].lo) same[i] = same[o.a];
            else if (v[o.b].hi <= v[o.a].lo) same[i] = same[o.b];
        } else if (o.kind == Kind::Add) {
            if (fixed(o.a) && v[o.a].lo == 0) same[i] = same[o.b];
            else if (fixed(o.b) && v[o.b].lo == 0) same[i] = same[o.a];
        } else if (o.kind == Kind::Subtract && fixed(o.b) && v[o.b].lo == 0) same[i] = same[o.a];
    }
    needed[same[n - 1]] = true;
    for (size_t i = n; i-- > 0;) {
        const BlobOp& o = tape[i];
        if (!needed[i] || fixed(i) || o.kind == Kind::Leaf || o.kind == Kind::Constant) continue;
        needed[same[o.a]] = true;
        if (o.kind != Kind::Negate) needed[same[o.b]] = true;
    }
    BlobTape out;
    std::vector<uint32_t> at(n);
    for (size_t i = 0; i < n; ++i) {
        if (!needed[i]) continue;
        BlobOp o = tape[i];
        if (fixed(i)) o = {Kind::Constant, 0, 0, v[i].lo};
        else if (o.kind != Kind::Leaf && o.kind != Kind::Constant)
            o.a = at[same[o.a]], o.b = o.kind == Kind::Negate ? 0 : at[same[o.b]];
        at[i] = uint32_t(out.size());
        out.push_back(o);
    }
    return out;
}

// ---- along a ray
// ----------------------------------------------------------------------------------------------------------------

namespace {

/// Bounds of a value and of its derivative by t.
struct Course {
    Interval f, d;
};

struct RayLeaf {
    Vec3d o, d;                 ///< in the leaf's space
    double a = 0, b = 0, c = 0; ///< ellipsoid: r^2 = a t^2 + 2 b t + c
};

Course ellipsoidCourse(const RayLeaf& r, double t0, double t1) {
    const double e0 = (r.a * t0 + 2 * r.b) * t0 + r.c, e1 = (r.a * t1 + 2 * r.b) * t1 + r.c;
    double lo = std::min(e0, e1), hi = std::max(e0, e1);
    if (const double bottom = r.a > 0 ? -r.b / r.a : t0; bottom > t0 && bottom < t1) lo = std::min(lo, r.c - r.b * r.b / r.a);
    const double slack = 1e-13 * (1 + std::fabs(r.c));
    const double most = std::max(0.0, 1 - lo + slack), least = std::max(0.0, 1 - hi - slack);
    const Interval slope{2 * (r.a * t0 + r.b), 2 * (r.a * t1 + r.b)}, squared{-3 * most * most, -3 * least * least};
    return {{cube(least), cube(most)}, multiply(slope, squared)};
}

Course segmentCourse(const BlobLeaf& l, const RayLeaf& r, double t0, double t1) {
    const double middle = 0.5 * (t0 + t1), speed = length(r.d), half = 0.5 * (t1 - t0) * speed;
    Vec3d g;
    const double f = blobLeafField(l, r.o + r.d * middle, &g, nullptr), d = dot(g, r.d), bend = kSegmentBend * half * speed;
    const Vec3d e = r.o + r.d * middle - l.from;
    if (length(e - l.along * std::clamp(dot(e, l.along), 0.0, l.length)) - half >= 1) return {{0, 0}, {0, 0}};
    const double by = std::min(kBlobSegmentSlope * half, (std::fabs(d) + bend) * 0.5 * (t1 - t0));
    return {{std::max(0.0, f - by), std::min(1.0, f + by)},
            {std::max(d - bend, -kBlobSegmentSlope * speed), std::min(d + bend, kBlobSegmentSlope * speed)}};
}

Course combinedCourse(const BlobOp& o, const Course& a, const Course& b) {
    Course r;
    r.f = combinedBounds(o, a.f, b.f);
    switch (o.kind) {
    case Kind::Add:
        r.d = {a.d.lo + b.d.lo, a.d.hi + b.d.hi};
        break;
    case Kind::Subtract:
        r.d = {a.d.lo - b.d.hi, a.d.hi - b.d.lo};
        break;
    case Kind::Negate:
        r.d = {-a.d.hi, -a.d.lo};
        break;
    case Kind::Multiply: {
        const Interval x = multiply(a.d, b.f), y = multiply(a.f, b.d);
        r.d = {x.lo + y.lo, x.hi + y.hi};
        break;
    }
    case Kind::Divide: {
        const Interval x = multiply(a.d, b.f), y = multiply(a.f, b.d);
        r.d = divide({x.lo - y.hi, x.hi - y.lo}, multiply(b.f, b.f));
        if (b.f.has(0)) r.d = {-INFINITY, INFINITY};
        break;
    }
    case Kind::Maximum:
        r.d = a.f.lo >= b.f.hi ? a.d : b.f.lo >= a.f.hi ? b.d : Interval{std::min(a.d.lo, b.d.lo), std::max(a.d.hi, b.d.hi)};
        break;
    case Kind::Minimum:
        r.d = a.f.hi <= b.f.lo ? a.d : b.f.hi <= a.f.lo ? b.d : Interval{std::min(a.d.lo, b.d.lo), std::max(a.d.hi, b.d.hi)};
        break;
    default:
        r.d = {0, 0};
    }
    return r;
}

} // namespace

namespace {

/// Looks for roots of the field less the threshold, part by part.
class Search {
public:
    Search(const BlobField& f, const BlobTape& tape, const Vec3d& org, const Vec3d& dir, int most, double* out)
        : field_(f), tape_(tape), org_(org), dir_(dir), most_(most), out_(out), rays_(tape.size()), courses_(tape.size()) {
        for (size_t i = 0; i < tape.size(); ++i) {
            if (tape[i].kind != Kind::Leaf) continue;
            const BlobLeaf& l = f.leaves()[tape[i].a];
            if (l.kind == BlobLeaf::Kind::Ground) continue;
            RayLeaf& r = rays_[i];
            r.o = l.inside(org);
            r.d = l.inside(org + dir) - r.o;
            r.d = Vec3d(l.m[0][0] * dir.x + l.m[0][1] * dir.y + l.m[0][2] * dir.z,
                        l.m[1][0] * dir.x + l.m[1][1] * dir.y + l.m[1][2] * dir.z,
                        l.m[2][0] * dir.x + l.m[2][1] * dir.y + l.m[2][2] * dir.z);
            r.a = dot(r.d, r.d), r.b = dot(r.o, r.d), r.c = dot(r.o, r.o);
        }
    }
    int found = 0;
    double at(double t) const { return field_.value(tape_, org_ + dir_ * t) - kBlobThreshold; }

    /// f0, f1: at the ends.
    void between(double t0, double f0, double t1, double f1, int depth) {
        if (found >= most_) return;
        const Course c = course(t0, t1);
        constexpr double kRounding = 1e-12;
        if (c.f.lo > kBlobThreshold + kRounding || c.f.hi < kBlobThreshold - kRounding) return;
        const bool crosses = (f0 < 0) != (f1 < 0);
        if (c.d.lo > 0 || c.d.hi < 0) {
            if (crosses) out_[found++] = refined(t0, f0, t1, f1);
            return;
        }
        // A line in the surface (along a tube, or through a point of it) is at the threshold everywhere, so that no interval is
        // decided: the result is where it leaves. In other slow cases a ray is limited to kPieces intervals.
        constexpr int kDeepest = 46, kCoarse = 6, kPieces = 1 << 16;
        constexpr double kTouch = 1e-10;
        const bool along = depth >= kCoarse && std::fabs(f0) < kTouch && std::fabs(f1) < kTouch;
        const double middle = 0.5 * (t0 + t1);
        if (depth >= kDeepest || along || ++pieces_ > kPieces ||
            !(middle > t0 && middle < t1)) { // it touches, or there is no slope to trust: a change of sign counts
            if (crosses) out_[found++] = middle;
            return;
        }
        const double fm = at(middle);
        between(t0, f0, middle, fm, depth + 1);
        between(middle, fm, t1, f1, depth + 1);
    }

private:
    Course course(double t0, double t1) {
        for (size_t i = 0; i < tape_.size(); ++i) {
            const BlobOp& o = tape_[i];
            Course& c = courses_[i];
            if (o.kind == Kind::Constant) c = {{o.c, o.c}, {0, 0}};
            else if (o.kind != Kind::Leaf) c = combinedCourse(o, courses_[o.a], courses_[o.b]);
            else {
                const BlobLeaf& l = field_.leaves()[o.a];
                if (l.kind == BlobLeaf::Kind::Ellipsoid) c = ellipsoidCourse(rays_[i], t0, t1);
                else if (l.kind == BlobLeaf::Kind::Segment) c = segmentCourse(l, rays_[i], t0, t1);
                else {
                    const Vec3d a = org_ + dir_ * t0, b = org_ + dir_ * t1;
                    c.f = groundBounds(*l.ground, {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)},
                                       {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)});
                    c.d = c.f.lo == c.f.hi ? Interval{0, 0} : Interval{-INFINITY, INFINITY};
                }
            }
        }
        return courses_[tape_.size() - 1];
    }
    /// The root between ends of different signs: regula falsi (Illinois), safeguarded by bisection.
    double refined(double lo, double flo, double hi, double fhi) const {
        double t = lo;
        int side = 0;
        for (int i = 0; i < 80; ++i) {
            t = i % 4 == 3 ? 0.5 * (lo + hi) : lo + (hi - lo) * flo / (flo - fhi);
            if (!(t > lo && t < hi)) t = 0.5 * (lo + hi);
            if (!(t > lo && t < hi)) break;
            const double f = at(t);
            if (f == 0) break;
            if ((f < 0) == (flo < 0)) {
                lo = t, flo = f;
                if (side == 1) fhi *= 0.5;
                side = 1;
            } else {
                hi = t, fhi = f;
                if (side == 2) flo *= 0.5;
                side = 2;
            }
            if (hi - lo <= 4e-16 * (std::fabs(lo) + std::fabs(hi))) break;
        }
        return t;
    }

    const BlobField& field_;
    const BlobTape& tape_;
    Vec3d org_, dir_;
    int most_;
    double* out_;
    int pieces_ = 0;
    Results<RayLeaf> rays_;
    Results<Course> courses_;
};

} // namespace

int BlobField::crossings(const BlobTape& tape, const Vec3d& org, const Vec3d& dir, double t0, double t1, int most,
                         double* out) const {
    if (!(t0 < t1)) return 0;
    Search s(*this, tape, org, dir, most, out);
    s.between(t0, s.at(t0), t1, s.at(t1), 0);
    return s.found;
}

} // namespace alpenglow::geometry
