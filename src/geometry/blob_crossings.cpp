// Where a ray crosses the surface of a Blobby: the roots of its field less the threshold.
#include "geometry/blob_field.h"
#include "geometry/tape_results.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::geometry {

namespace {

using Kind = BlobOp::Kind;

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
    const double f = blobLeafField(l, r.o + r.d * middle, &g, nullptr), d = dot(g, r.d), bend = kBlobSegmentBend * half * speed;
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

/// Looks for roots of the field less the threshold, part by part.
class Search {
public:
    Search(const BlobField& f, const BlobTape& tape, const Vec3d& org, const Vec3d& dir, int most, double* out)
        : field_(f), tape_(tape), org_(org), dir_(dir), most_(most), out_(out), rays_(tape.size()), courses_(tape.size()) {
        for (size_t i = 0; i < tape.size(); ++i) {
            if (tape[i].kind != Kind::Leaf) continue;
            const BlobLeaf& l = f.leaves()[tape[i].a];
            if (l.kind == BlobLeaf::Kind::Ground) {
                deepest_ = kGroundDeepest;
                continue;
            }
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
        constexpr int kCoarse = 6, kPieces = 1 << 16;
        constexpr double kTouch = 1e-10;
        const bool along = depth >= kCoarse && std::fabs(f0) < kTouch && std::fabs(f1) < kTouch;
        const double middle = 0.5 * (t0 + t1);
        if (depth >= deepest_ || along || ++pieces_ > kPieces ||
            !(middle > t0 && middle < t1)) { // it touches, or there is no slope to trust: a change of sign counts
            if (crosses) out_[found++] = deepest_ == kGroundDeepest ? refined(t0, f0, t1, f1) : middle;
            return;
        }
        const double fm = at(middle);
        between(t0, f0, middle, fm, depth + 1);
        between(middle, fm, t1, f1, depth + 1);
    }

private:
    /// Halvings of a ray. Depth maps have no slopes that are known, only bounds.
    static constexpr int kDeepest = 46, kGroundDeepest = 20;
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
                    c.f = blobGroundBounds(*l.ground, {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)},
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
    int pieces_ = 0, deepest_ = kDeepest;
    TapeResults<RayLeaf> rays_;
    TapeResults<Course> courses_;
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
