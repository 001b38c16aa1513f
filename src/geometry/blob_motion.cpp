#include "geometry/blob_motion.h"
#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace alpenglow::geometry {

namespace {

using Kind = BlobOp::Kind;

struct Matrix3 {
    double m[3][3] = {};
};
Vec3d rowTimes(const Vec3d& v, const Matrix3& a) {
    return {v.x * a.m[0][0] + v.y * a.m[1][0] + v.z * a.m[2][0], v.x * a.m[0][1] + v.y * a.m[1][1] + v.z * a.m[2][1],
            v.x * a.m[0][2] + v.y * a.m[1][2] + v.z * a.m[2][2]};
}
/// Bound on the norm of v -> v a.
double norm(const Matrix3& a) {
    double sum = 0;
    for (const auto& row : a.m)
        for (double x : row) sum += x * x;
    return std::sqrt(sum);
}

} // namespace

/// A leaf at the centre of a time span, and half of its change over the span; segments also have ends and a radius.
struct BlobMotion::Change {
    BlobLeaf middle;
    Matrix3 inverse, linear, by; ///< object to leaf, leaf to object, half the change of the latter
    Vec3d origin{0.0}, originBy{0.0};
    Vec3d end[2]{Vec3d(0.0), Vec3d(0.0)}, endBy[2]{Vec3d(0.0), Vec3d(0.0)};
    double radius = 1, radiusBy = 0;
    bool sound = true; ///< invertible at the centre
};

double BlobMotion::numberAt(size_t i, size_t key, double way) const {
    const double a = (*numbers_[key])[i];
    return key + 1 < numbers_.size() ? a * (1 - way) + (*numbers_[key + 1])[i] * way : a;
}

BlobMotion::Span BlobMotion::spanOf(float from, float to) const {
    // Spans do not cross keys: uses the key of the centre.
    double middle, a;
    Span s{keyBefore(times_, from + (to - from) * 0.5f, middle), 0, 1};
    const double length = double(times_[s.key + 1]) - times_[s.key];
    a = (double(from) - times_[s.key]) / length;
    s.w0 = std::clamp(a, 0.0, 1.0);
    s.w1 = std::clamp((double(to) - times_[s.key]) / length, 0.0, 1.0);
    return s;
}

BlobLeaf BlobMotion::leafAt(const BlobLeaf& plan, size_t key, double way) const {
    if (plan.kind == BlobLeaf::Kind::Ground) return plan;
    double numbers[23];
    const size_t n = plan.bySegment ? 23 : 16;
    for (size_t i = 0; i < n; ++i) numbers[i] = numberAt(plan.at + i, key, way);
    BlobLeaf l;
    l.number = plan.number;
    l.bySegment = plan.bySegment;
    l.at = plan.at;
    const bool sound = plan.bySegment ? shapeBlobLeaf(numbers + 7, numbers, l) : shapeBlobLeaf(numbers, nullptr, l);
    if (!sound) emptyBlobLeaf(l);
    return l;
}

void BlobMotion::at(const BlobTape& of, float time, BlobField& field, BlobTape& tape) const {
    double way;
    const size_t key = keyBefore(times_, time, way);
    std::vector<BlobLeaf> leaves;
    tape = of;
    for (BlobOp& o : tape) {
        if (o.kind == Kind::Constant && o.a > 0) o.c = numberAt(o.a - 1, key, way);
        if (o.kind != Kind::Leaf) continue;
        leaves.push_back(leafAt(plan_.leaves()[o.a], key, way));
        o.a = uint32_t(leaves.size() - 1);
    }
    field = BlobField(std::move(leaves));
}

BlobMotion::Change BlobMotion::changeOf(const BlobLeaf& plan, const Span& s) const {
    Change c;
    const double middle = 0.5 * (s.w0 + s.w1), half = 0.5 * (s.w1 - s.w0);
    c.middle = leafAt(plan, s.key, middle);
    const size_t matrix = plan.at + (plan.bySegment ? 7 : 0);
    const auto value = [&](size_t i) { return numberAt(i, s.key, middle); };
    const auto change = [&](size_t i) { return half * (numberAt(i, s.key, 1) - numberAt(i, s.key, 0)); };
    Matrix m;
    for (size_t i = 0; i < 4; ++i)
        for (size_t k = 0; k < 4; ++k) m.m[i][k] = value(matrix + 4 * i + k);
    for (size_t i = 0; i < 3; ++i)
        for (size_t k = 0; k < 3; ++k) c.linear.m[i][k] = m.m[i][k], c.by.m[i][k] = change(matrix + 4 * i + k);
    for (size_t k = 0; k < 3; ++k) c.origin[int(k)] = m.m[3][k], c.originBy[int(k)] = change(matrix + 12 + k);
    c.sound = determinant3(m) != 0;
    if (c.sound) m = inverse(m, nullptr);
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) {
            c.inverse.m[i][k] = m.m[i][k];
            c.sound = c.sound && std::isfinite(m.m[i][k]);
        }
    if (!plan.bySegment) return c;
    for (size_t e = 0; e < 2; ++e)
        for (size_t k = 0; k < 3; ++k)
            c.end[e][int(k)] = value(plan.at + 3 * e + k), c.endBy[e][int(k)] = change(plan.at + 3 * e + k);
    c.radius = std::fabs(value(plan.at + 6));
    c.radiusBy = std::fabs(change(plan.at + 6));
    return c;
}

/// Each coordinate of an end is a product of two functions linear in time: it deviates from the interval between its ends by at
/// most a quarter of the product of their changes. The extent around it is at most that of the larger radius and axes.
void BlobMotion::leafBox(const BlobLeaf& plan, const Span& s, Vec3d& lo, Vec3d& hi) const {
    lo = Vec3d(INFINITY), hi = Vec3d(-INFINITY);
    const Change c = changeOf(plan, s);
    const double radius = c.radius + c.radiusBy;
    for (int side = -1; side <= 1; side += 2)
        for (int e = 0; e < 2; ++e) {
            Matrix3 m;
            for (int i = 0; i < 3; ++i)
                for (int k = 0; k < 3; ++k) m.m[i][k] = c.linear.m[i][k] + side * c.by.m[i][k];
            const Vec3d p = rowTimes(c.end[e] + c.endBy[e] * side, m) + c.origin + c.originBy * side;
            for (int k = 0; k < 3; ++k) {
                double reach = 0, bend = 0;
                for (int i = 0; i < 3; ++i) {
                    const double axis = std::fabs(c.linear.m[i][k]) + std::fabs(c.by.m[i][k]);
                    reach += axis * axis;
                    bend += std::fabs(c.endBy[e][i] * c.by.m[i][k]);
                }
                const double room = radius * std::sqrt(reach) + bend + 1e-12 * (std::fabs(p[k]) + 1);
                lo[k] = std::min(lo[k], p[k] - room);
                hi[k] = std::max(hi[k], p[k] + room);
            }
        }
}

/// With A the leaf's matrix at the centre, sD its change and so' that of its origin, the leaf's coordinates q of a point become
/// (q - s e) (1 + s E)^-1, where E = D A^-1 and e = o' A^-1: they change by at most |e + q E| / (1 - |E|).
Interval BlobMotion::leafBounds(const BlobLeaf& plan, const Vec3d& lo, const Vec3d& hi, const Span& s) const {
    if (plan.kind == BlobLeaf::Kind::Ground) return blobLeafBounds(plan, lo, hi);
    Vec3d from, to;
    leafBox(plan, s, from, to);
    if (lo.x > to.x || hi.x < from.x || lo.y > to.y || hi.y < from.y || lo.z > to.z || hi.z < from.z) return {0, 0};
    const Change c = changeOf(plan, s);
    const Interval all{0, 1};
    Matrix3 E;
    for (int i = 0; i < 3; ++i) {
        const Vec3d row = rowTimes({c.by.m[i][0], c.by.m[i][1], c.by.m[i][2]}, c.inverse);
        for (int k = 0; k < 3; ++k) E.m[i][k] = row[k];
    }
    const double turn = norm(E);
    if (!c.sound || !(turn < 0.9)) return all;
    const Vec3d half = (hi - lo) * 0.5, q = rowTimes((lo + hi) * 0.5 - c.origin, c.inverse);
    double reach = 0; // of the box around its centre, in the leaf's space
    for (int k = 0; k < 3; ++k) {
        double e = 1e-14 * (1 + std::fabs(q[k]));
        for (int i = 0; i < 3; ++i) e += std::fabs(c.inverse.m[i][k]) * half[i];
        reach += e * e;
    }
    reach = std::sqrt(reach);
    const double moved = (length(rowTimes(c.originBy, c.inverse) + rowTimes(q, E)) + turn * reach) / (1 - turn) * (1 + 1e-12);
    const auto bump = [](double r) { return r < 1 ? (1 - r * r) * (1 - r * r) * (1 - r * r) : 0.0; };
    if (!plan.bySegment) return {bump(length(q) + reach + moved), bump(std::max(0.0, length(q) - reach - moved))};
    const double least = c.radius - c.radiusBy;
    if (!(least > 0) || c.middle.kind != BlobLeaf::Kind::Segment) return all;
    // Motion relative to the radius. A change of either end counts at most as much as one of the point.
    const double grows = c.radiusBy / (least * c.radius), ends = length(c.endBy[0]) + length(c.endBy[1]);
    const double away = length(q - c.end[0]) + length(q - c.end[1]) + 2 * reach;
    const double by = (moved + ends) / least + grows * away + reach / c.radius;
    if (c.middle.length - by <= 1e-6) return all; // may be a ball at some time
    const Vec3d at = q / c.radius, e = at - c.middle.from;
    if (length(e - c.middle.along * std::clamp(dot(e, c.middle.along), 0.0, c.middle.length)) - by >= 1) return {0, 0};
    const double f = blobLeafField(c.middle, at, nullptr, nullptr);
    return {std::max(0.0, f - kBlobSegmentSlope * by), std::min(1.0, f + kBlobSegmentSlope * by)};
}

Interval BlobMotion::bounds(const BlobTape& tape, const Vec3d& lo, const Vec3d& hi, float from, float to,
                            std::vector<Interval>& v) const {
    const Span s = spanOf(from, to);
    v.resize(tape.size());
    for (size_t i = 0; i < tape.size(); ++i) {
        const BlobOp& o = tape[i];
        if (o.kind == Kind::Leaf) v[i] = leafBounds(plan_.leaves()[o.a], lo, hi, s);
        else if (o.kind != Kind::Constant) v[i] = combinedBounds(o, v[o.a], v[o.b]);
        else if (o.a == 0) v[i] = {o.c, o.c};
        else {
            const double a = numberAt(o.a - 1, s.key, s.w0), b = numberAt(o.a - 1, s.key, s.w1);
            v[i] = {std::min(a, b), std::max(a, b)};
        }
    }
    return v.back();
}

BlobMotion::Extent BlobMotion::extent(const BlobTape& tape, float from, float to) const {
    const Span s = spanOf(from, to);
    Extent out;
    for (const BlobOp& o : tape) {
        if (o.kind != Kind::Leaf) continue;
        const BlobLeaf& plan = plan_.leaves()[o.a];
        if (plan.kind == BlobLeaf::Kind::Ground) {
            out.thin = std::min(out.thin, plan.thin);
            continue;
        }
        Vec3d lo, hi;
        leafBox(plan, s, lo, hi);
        for (int k = 0; k < 3; ++k) out.lo[k] = std::min(out.lo[k], lo[k]), out.hi[k] = std::max(out.hi[k], hi[k]);
        const Change c = changeOf(plan, s);
        const double far = std::max(length(c.end[0]), length(c.end[1])) + c.radius;
        out.way = std::max(out.way, 2 * (length(c.originBy) + norm(c.by) * (plan.bySegment ? far : 1) +
                                         norm(c.linear) * (length(c.endBy[0]) + length(c.endBy[1]) + c.radiusBy)));
        double thin = 0; // a leaf growing from 0 has its final size
        for (double w : {s.w0, 0.5 * (s.w0 + s.w1), s.w1})
            if (const double t = leafAt(plan, s.key, w).thin; std::isfinite(t)) thin = std::max(thin, t);
        if (thin > 0) out.thin = std::min(out.thin, thin);
    }
    return out;
}

Vec3d BlobMotion::carried(const BlobTape& tape, const Vec3d& p, float from, float to) const {
    BlobField then;
    BlobTape steps;
    at(tape, from, then, steps);
    std::vector<BlobField::Share> shares;
    then.shares(steps, p, shares);
    double way0, way1;
    const size_t k0 = keyBefore(times_, from, way0), k1 = keyBefore(times_, to, way1);
    Vec3d sum(0.0);
    double weight = 0;
    for (const BlobOp& o : tape) {
        if (o.kind != Kind::Leaf) continue;
        const BlobLeaf& plan = plan_.leaves()[o.a];
        const auto share = std::find_if(shares.begin(), shares.end(), [&](const auto& s) { return s.number == plan.number; });
        if (plan.kind == BlobLeaf::Kind::Ground || share == shares.end()) continue;
        const size_t matrix = plan.at + (plan.bySegment ? 7 : 0);
        Matrix a, b;
        for (size_t i = 0; i < 16; ++i) {
            a.m[i / 4][i % 4] = numberAt(matrix + i, k0, way0);
            b.m[i / 4][i % 4] = numberAt(matrix + i, k1, way1);
        }
        if (determinant3(a) == 0) continue;
        const Vec3d q = transformPoint(inverse(a), p);
        // Along a segment: the same fraction of its length as before; across it: the same fraction of the radius.
        Vec3d there = q;
        if (plan.bySegment) {
            const auto number = [&](size_t i, size_t k, double w) { return numberAt(plan.at + i, k, w); };
            const auto end = [&](size_t e, size_t k, double w) {
                return Vec3d(number(3 * e, k, w), number(3 * e + 1, k, w), number(3 * e + 2, k, w));
            };
            const Vec3d u = end(0, k0, way0), v = end(1, k0, way0);
            const double l2 = dot(v - u, v - u), x = l2 > 0 ? std::clamp(dot(q - u, v - u) / l2, 0.0, 1.0) : 0;
            const double r0 = std::fabs(number(6, k0, way0)), r1 = std::fabs(number(6, k1, way1));
            const Vec3d core = u + (v - u) * x, u1 = end(0, k1, way1), v1 = end(1, k1, way1);
            there = u1 + (v1 - u1) * x + (q - core) * (r0 > 0 ? r1 / r0 : 1);
        }
        sum = sum + transformPoint(b, there) * share->w;
        weight += share->w;
    }
    return weight > 0 ? sum / weight : p;
}

} // namespace alpenglow::geometry
