// Curves type nvertices wrap: flat ribbons with "N", ribbons that face the eye or the ray without, or round (Attribute "dice"
// "roundcurve").
#include "geometry/curves.h"
#include "base/exact.h"
#include "geometry/capsule.h"
#include "geometry/curve_boxes.h"
#include "geometry/dice.h"
#include "geometry/factories.h"
#include "geometry/keyed.h"
#include "geometry/parametric.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::geometry {
namespace {

/// Hits on ribbons that face the ray encode the rotation of the ribbon: ExactHit::u is 2 * turn + u, with turn in these fractions
/// of a circle.
constexpr double kTurns = 1 << 24;

/// Hits on the end caps of a tube: ExactHit::v (b2 of points) is kFirst plus the fraction of the radius at the start, kLast minus
/// it at the end. Elsewhere it is the position in the segment, 0 to 1 with a margin.
constexpr double kFirst = -3, kLast = 4;
bool onDisc(double b2) { return b2 < kFirst + 1.5 || b2 > kLast - 1.5; }
/// The part of the radius.
double outOnDisc(double b2) { return b2 < 0 ? b2 - kFirst : kLast - b2; }

class Curves final : public KeyedShape, public InCapsules {
public:
    Curves(ShapeSource s, CurveSet set, Diagnostics&);

    uint32_t exactPrims() const override { return set_.segments() * parts_; }
    void exactBoundsOf(uint32_t first, std::span<Bounds> out) const override;
    void treeBoundsOf(uint32_t first, std::span<Bounds> out) const override;
    int exactHitsAt(uint32_t prim, const Vec3d& org, const Vec3d& dir, double lo, double hi, Wanted, float time,
                    ExactHit out[4]) const override;

    bool capsule(uint32_t prim, Capsule& c) const override {
        c.radius = 0;
        capsules(prim, {&c, 1});
        return !joined();
    }
    void capsules(uint32_t first, std::span<Capsule> out) const override;
    void fetch(uint32_t prim) const override { set_.fetch(prim / parts_); }

    int faces() const override { return int(source_.primitive->ints.size()); }
    SurfacePoint evaluate(int face, double u, double v) const override {
        double f;
        const uint32_t segment = set_.segmentAt(face, v, f);
        return pointOf(segment, u, f, Vec3d(0.0), 0);
    }
    double area() const override { return areas().empty() ? 0 : areas().back(); }
    SurfacePoint sampleFromAt(const Vec3& from, double xi1, double xi2, float time) const override;
    bool facesRays() const override { return fromRay_; }
    double sampleDensity(const SurfacePoint&) const override;
    Vec3 velocity(const SurfacePoint&) const override;
    void dice(const DiceOptions&, Diagnostics&) override;

protected:
    Bounds keyBounds(uint32_t prim) const override {
        Bounds b;
        boxes().bounds(prim, {&b, 1});
        return b;
    }
    bool fits(KeyedShape& later) const override {
        auto& c = static_cast<Curves&>(later);
        c.parts_ = parts_;
        return set_.alike(c.set_);
    }
    SurfacePoint pointAt(uint32_t prim, double b1, double b2, float time) const override;
    size_t classCount(scene::Class c) const override { return set_.classCount(c); }
    int weights(scene::Class c, const SurfacePoint& p, Weight w[16]) const override {
        return set_.weights(c, p.prim / parts_, std::clamp(p.b2, 0.0, 1.0), w);
    }

private:
    void load(uint32_t segment, float time, CurveSegment& out) const;
    void load(uint32_t segment, size_t key, double way, CurveSegment& out) const;
    /// Without CurveSegment::axis.
    void loadPoints(uint32_t segment, size_t key, double way, CurveSegment& out) const;
    /// The part of a segment that a primitive is.
    void part(uint32_t prim, double& from, double& to) const {
        from = double(prim % parts_) / parts_;
        to = double(prim % parts_ + 1) / parts_;
    }
    void chooseParts();
    CurveBoxes boxes() const { return {set_, toCamera(), parts_}; }
    Vec3d toObject(const Vec3d& p) const { return transformPoint(toObject_, p); }
    SurfacePoint pointOf(uint32_t segment, double u, double f, const Vec3d& from, float time) const;
    LocalPoint local(const CurveSegment&, const CurveFacing&, double u, double f) const;
    double turnOf(const CurveSegment&, double f, const Vec3d& across) const;
    const std::vector<double>& areas() const;
    bool tubes() const { return facing_.kind == CurveFacing::Round; }
    /// Whether a tube has a cap at the start, or the end, of a segment.
    bool closedAt(uint32_t segment, bool end) const {
        const CurveSet::Place p = set_.place(segment);
        return tubes() && !set_.periodic() && p.local == (end ? p.count - 1 : 0);
    }
    void intersectDiscs(const CurveSegment&, uint32_t prim, const CurveRay&, CurveHit* hits, int& n) const;
    double discArea(const SurfacePoint& onDisc) const;

    CurveSet set_;
    CurveFacing facing_;
    bool fromRay_ = false;
    uint32_t parts_ = 1; ///< primitives of a segment
    Matrix toObject_;
    double side_ = 1; ///< +1, -1: of Ng along dPdu ^ dPdv of object space
    mutable std::once_flag made_;
    /// Cumulative areas by segment, each including the curve and its caps; for moving curves the mean of the keys.
    mutable std::vector<double> areas_;
};

Curves::Curves(ShapeSource s, CurveSet set, Diagnostics& diag) : KeyedShape(std::move(s)), set_(std::move(set)) {
    toObject_ = inverse(toCamera());
    const bool mirrored = determinant3(toCamera()) < 0;
    side_ = (mirrored ? -1 : 1) * double(orientation_);
    const scene::Param* round = attributes().value("dice:roundcurve");
    if (set_.hasNormals()) facing_.kind = CurveFacing::Given;
    else {
        // These face the viewer regardless of orientation: with sides 1 they would vanish.
        facing_.side = side_;
        if (round && !round->numbers.empty() && round->numbers[0] != 0) facing_.kind = CurveFacing::Round;
        else if (source_.facing == Facing::Eye) facing_.kind = CurveFacing::Point, facing_.at = toObject(Vec3d(0.0));
        else if (source_.facing == Facing::Picture) facing_.at = transformVector(toObject_, Vec3d(0, 0, -1));
        else fromRay_ = true;
    }
    takePrimvars(diag);
    source_.like = nullptr;
    chooseParts();
    measure();
}

void Curves::chooseParts() {
    // Boxes around long thin pieces hold mostly air: short pieces have smaller ones. Beyond some millions memory counts more. A
    // cubic segment is as long as several straight ones, and a ray costs more there.
    constexpr uint32_t kProbes = 512;
    constexpr size_t kMost = 6'000'000, kMostCubic = 500'000;
    const uint32_t n = set_.segments(), step = std::max(1u, n / kProbes);
    double longs = 0, wides = 0;
    for (uint32_t i = 0; i < n; i += step) {
        CurveSegment g;
        set_.load(i, g);
        longs += length(g.linear ? g.p[2] - g.p[1] : g.p[3] - g.p[0]);
        wides += 2 * g.widest();
    }
    const auto mayHalve = [&](uint32_t parts, size_t most) {
        return parts_ < parts && longs > 4 * parts_ * wides && 2 * size_t(n) * parts_ <= most;
    };
    if (facing_.kind != CurveFacing::Round || !set_.linear())
        while (mayHalve(8, kMost) || (!set_.linear() && mayHalve(32, kMostCubic))) parts_ *= 2;
}

/// A segment at a time: positions, widths and normals are linear between keys.
void Curves::load(uint32_t segment, float time, CurveSegment& g) const {
    double way;
    const size_t k = keyAt(time, way);
    load(segment, k, way, g);
}
void Curves::load(uint32_t segment, size_t k, double way, CurveSegment& g) const {
    loadPoints(segment, k, way, g);
    g.axis = set_.axis(segment); // of the first key: otherwise the frame could flip at a key
}
void Curves::loadPoints(uint32_t segment, size_t k, double way, CurveSegment& g) const {
    static_cast<const Curves&>(key(k)).set_.load(segment, g);
    CurveSegment to;
    if (way != 0 && k + 1 < keys()) {
        static_cast<const Curves&>(key(k + 1)).set_.load(segment, to);
        for (int i = 0; i < 4; ++i) {
            g.p[i] = g.p[i] * (1 - way) + to.p[i] * way;
            g.h[i] = g.h[i] * (1 - way) + to.h[i] * way;
            g.n[i] = g.n[i] * (1 - way) + to.n[i] * way;
        }
    }
}

void Curves::exactBoundsOf(uint32_t first, std::span<Bounds> out) const {
    boxes().bounds(first, out);
    std::vector<Bounds> more(joined() ? out.size() : 0);
    for (size_t k = 1; k < keys(); ++k) {
        static_cast<const Curves&>(key(k)).boxes().bounds(first, more);
        for (size_t i = 0; i < out.size(); ++i) out[i].add(more[i]);
    }
}

void Curves::treeBoundsOf(uint32_t first, std::span<Bounds> out) const {
    if (joined() || !boxes().quick()) exactBoundsOf(first, out);
    else boxes().quickBounds(first, out, bounds());
}

void Curves::capsules(uint32_t first, std::span<Capsule> out) const {
    if (!joined()) return boxes().capsules(first, out);
    for (Capsule& c : out) c.radius = INFINITY;
}

double Curves::turnOf(const CurveSegment& g, double f, const Vec3d& across) const {
    Vec3d a, b;
    acrossFrame(curveAt(g, f).d, a, b);
    double turn = exact::atan2(dot(across, b), dot(across, a)) / (2 * kPi);
    if (turn < 0) turn += 1;
    return std::min(std::floor(turn * kTurns), kTurns - 1);
}

int Curves::exactHitsAt(uint32_t prim, const Vec3d& org, const Vec3d& dir, double lo, double hi, Wanted wanted, float time,
                        ExactHit out[4]) const {
    CurveSegment g;
    double way;
    const size_t k = keyAt(time, way);
    loadPoints(prim / parts_, k, way, g);
    const Vec3d o = toObject(org), d = transformVector(toObject_, dir);
    const double dd = dot(d, d);
    if (!(dd > 0) || !std::isfinite(dd)) return 0;
    double from, to;
    part(prim, from, to);
    const CurveRay ray(o, d, (g.p[1] + g.p[2]) * 0.5, lo, hi);
    CurveFacing facing = facing_;
    if (fromRay_) facing.at = -d;
    CurveHit hits[6];
    const bool round = tubes();
    int n = round ? intersectTube(g, from, to, ray, hits, wanted != Wanted::All)
                  : intersectRibbon(g, from, to, facing, fromRay_, ray, hits);
    if (round) intersectDiscs(g, prim, ray, hits, n);
    std::sort(hits, hits + n, [](const CurveHit& a, const CurveHit& b) { return a.t < b.t; });
    n = std::min(n, wanted != Wanted::All ? 1 : 4);
    for (int i = 0; i < n; ++i) {
        const CurveHit& h = hits[i];
        out[i] = {h.t, 0.5 + 0.5 * h.s, h.f};
        if (wanted == Wanted::Any) break;
        if (fromRay_) out[i].u += 2 * turnOf(g, h.f, h.across);
        if (!round) continue;
        g.axis = set_.axis(prim / parts_);
        out[i].u = tubeAngle(g, onDisc(h.f) ? double(h.f > 0) : h.f, o + d * h.t);
    }
    return n;
}

/// Adds the hits of a ray on the caps of a primitive.
void Curves::intersectDiscs(const CurveSegment& g, uint32_t prim, const CurveRay& ray, CurveHit* hits, int& n) const {
    for (const bool end : {false, true}) {
        if (prim % parts_ != (end ? parts_ - 1 : 0) || !closedAt(prim / parts_, end)) continue;
        Vec3d centre, axis;
        double radius;
        tubeEnd(g, end, centre, axis, radius);
        const Vec3d c = centre - ray.org;
        const double along = dot(ray.e3, axis);
        if (!(radius > 0) || !(std::fabs(along) > 0)) continue;
        const double z = dot(c, axis) / along, t = ray.t(z);
        const Vec3d w = ray.e3 * z - c;
        const double out = std::sqrt(dot(w, w)) / radius;
        // Up to the tube, including its rounding error.
        if (!(t > ray.lo && t <= ray.hi) || !(out <= 1 + 1e-9)) continue;
        hits[n++] = {t, 0, end ? kLast - std::min(out, 1.0) : kFirst + std::min(out, 1.0), {}};
    }
}

LocalPoint Curves::local(const CurveSegment& g, const CurveFacing& facing, double u, double f) const {
    LocalPoint p;
    const bool disc = facing.kind == CurveFacing::Round && onDisc(f);
    const double part = disc ? outOnDisc(f) : 1, outward = f < 0 ? 1 : -1; // along f
    if (disc) f = f > 0;
    const Jet c = curveAt(g, f);
    if (disc) {
        Jet a, b;
        ScalarJet r;
        tubeFrame(g, f, a, b, r);
        const auto [s, k] = exact::sinCos(2 * kPi * u);
        const Vec3d out = (a.f * k + b.f * s) * r.f, round = (b.f * k - a.f * s) * (2 * kPi * r.f);
        p = {c.f + out * part,
             round * part,
             out * outward,
             out * (-4 * kPi * kPi * part),
             round * outward,
             Vec3d(0.0),
             {},
             {},
             {}};
        p.n = cross(a.f, b.f) * -outward;
    } else if (facing.kind == CurveFacing::Round) {
        Jet a, b;
        ScalarJet r;
        tubeFrame(g, f, a, b, r);
        // Outward, and counterclockwise seen from the direction of the curve.
        const auto [s, k] = exact::sinCos(2 * kPi * u);
        const Jet out = r * (ScalarJet{k} * a + ScalarJet{s} * b),
                  round = r * (ScalarJet{-2 * kPi * s} * a + ScalarJet{2 * kPi * k} * b);
        p = {c.f + out.f, round.f, c.d + out.d, out.f * (-4 * kPi * kPi), round.d, c.dd + out.dd};
        p.n = a.f * k + b.f * s;
    } else {
        const double s = 2 * u - 1;
        const Jet w = sideAt(g, facing, f);
        p = {c.f + w.f * s, w.f * 2.0, c.d + w.d * s, Vec3d(0.0), w.d * 2.0, c.dd + w.dd * s};
        p.n = facing.kind == CurveFacing::Point ? facing.at - c.f : facing.at; // where the product vanishes
        // If a bend is narrower than the ribbon, its inner side is folded; it still faces the ray.
        if (facing.kind != CurveFacing::Given && dot(cross(p.Pu, p.Pv), p.n) * facing.side <= 0)
            p.Pv = c.d, p.Puv = p.Pvv = Vec3d(0.0);
    }
    return p;
}

SurfacePoint Curves::pointAt(uint32_t prim, double b1, double b2, float time) const {
    const uint32_t segment = prim / parts_;
    CurveSegment g;
    load(segment, time, g);
    const CurveSet::Place place = set_.place(segment);
    CurveFacing facing = facing_;
    double u = b1, n = place.count;
    if (fromRay_) {
        const double turn = std::floor(0.5 * b1);
        u = b1 - 2 * turn;
        Vec3d a, b;
        const Vec3d along = curveAt(g, b2).d;
        acrossFrame(along, a, b);
        const auto [s, c] = exact::sinCos(2 * kPi * (turn + 0.5) / kTurns);
        facing.at = cross(a * c + b * s, along) * facing.side;
    }
    LocalPoint o = local(g, facing, u, b2);
    LocalPoint c;
    const Matrix& m = toCamera();
    c.P = transformPoint(m, o.P);
    c.Pu = transformVector(m, o.Pu);
    c.Pv = transformVector(m, o.Pv * n);
    c.Puu = transformVector(m, o.Puu);
    c.Puv = transformVector(m, o.Puv * n);
    c.Pvv = transformVector(m, o.Pvv * (n * n));
    const Vec3d across = cross(c.Pu, c.Pv) * double(orientation_);
    const double l = length(across);
    c.n = l > 0 ? across / l : normalize(transformNormal(m, o.n) * (facing_.kind == CurveFacing::Round ? side_ : 1));
    normalDerivatives(c);
    SurfacePoint p;
    p.P = Vec3(c.P);
    p.dPdu = Vec3(c.Pu), p.dPdv = Vec3(c.Pv);
    p.Puu = Vec3(c.Puu), p.Puv = Vec3(c.Puv), p.Pvv = Vec3(c.Pvv);
    p.n = Vec3(c.n);
    p.dNdu = Vec3(c.nu), p.dNdv = Vec3(c.nv);
    p.Ng = l > 0 ? Vec3(across) : p.n;
    p.u = float(u);
    p.v = float((place.local + std::clamp(b2, 0.0, 1.0)) / n);
    p.orientation = orientation_;
    p.face = int(place.face);
    p.prim = segment * parts_; // the same for all of its parts
    p.b1 = u;
    p.b2 = b2;
    p.time = time;
    // A ray that leaves a ribbon facing the previous ray must not hit the ribbon in its new orientation: it starts half a width
    // away.
    p.pError = 2 * roundingError(p.P) + (fromRay_ ? 0.26f * length(p.dPdu) : 0);
    finishPoint(p, true);
    return p;
}

/// A point of a segment as seen from `from` (camera space).
SurfacePoint Curves::pointOf(uint32_t segment, double u, double f, const Vec3d& from, float time) const {
    double b1 = u;
    if (fromRay_) {
        CurveSegment g;
        load(segment, time, g);
        CurveFacing facing = facing_;
        const Vec3d eye = toObject(from), middle = curveAt(g, f).f;
        facing.at = eye - middle;
        for (int k = 0; k < kTurnsToRay; ++k) facing.at = eye - (middle + sideAt(g, facing, f).f * (2 * u - 1));
        b1 += 2 * turnOf(g, f, sideAt(g, facing, f).f);
    }
    return pointAt(segment * parts_, b1, f, time);
}

const std::vector<double>& Curves::areas() const {
    std::call_once(made_, [&] {
        // Gauss, four points a segment, eight around a tube.
        static constexpr double x[4] = {0.0694318442029737, 0.3300094782075719, 0.6699905217924281, 0.9305681557970263};
        static constexpr double w[4] = {0.1739274225687269, 0.3260725774312731, 0.3260725774312731, 0.1739274225687269};
        const int around = tubes() ? 8 : 1;
        double sum = 0;
        areas_.reserve(3 * size_t(set_.segments()));
        for (uint32_t i = 0; i < set_.segments(); ++i) {
            const double n = set_.place(i).count * double(keys());
            for (size_t j = 0; j < keys(); ++j)
                for (int k = 0; k < 4; ++k)
                    for (int a = 0; a < around; ++a) {
                        const SurfacePoint p =
                            static_cast<const Curves&>(key(j)).pointOf(i, (a + 0.5) / around, x[k], Vec3d(0.0), 0);
                        sum += w[k] * length(cross(Vec3d(p.dPdu), Vec3d(p.dPdv))) / (n * around);
                    }
            areas_.push_back(sum);
            for (const bool end : {false, true}) {
                for (size_t j = 0; j < keys() && closedAt(i, end); ++j) {
                    const auto& at = static_cast<const Curves&>(key(j));
                    sum += at.discArea(at.pointOf(i, 0, end ? kLast - 1 : kFirst + 1, Vec3d(0.0), 0)) / double(keys());
                }
                areas_.push_back(sum);
            }
        }
    });
    return areas_;
}

SurfacePoint Curves::sampleFromAt(const Vec3& from, double xi1, double xi2, float time) const {
    const std::vector<double>& sums = areas();
    const double target = xi1 * sums.back();
    const size_t i = std::min(size_t(std::upper_bound(sums.begin(), sums.end(), target) - sums.begin()), sums.size() - 1);
    // The remainder of the first number is uniform within the segment.
    const double lo = i ? sums[i - 1] : 0, size = sums[i] - lo;
    const double left = size > 0 ? std::clamp((target - lo) / size, 0.0, 1.0) : 0.5, out = std::sqrt(left);
    const double f = i % 3 == 0 ? left : i % 3 == 1 ? kFirst + out : kLast - out;
    return pointOf(uint32_t(i / 3), xi2, f, Vec3d(from), time);
}

/// Area of the cap that contains a point, at its time.
double Curves::discArea(const SurfacePoint& p) const {
    const double out = outOnDisc(p.b2), l = length(cross(Vec3d(p.dPdu), Vec3d(p.dPdv)));
    return out > 0 ? l / (2 * out * set_.place(p.prim / parts_).count) : 0;
}

/// For ribbons that face the ray, the velocity of the centre line, as the orientation depends on the viewer.
Vec3 Curves::velocity(const SurfacePoint& at) const {
    double way;
    const size_t k = keyAt(at.time, way);
    if (k + 1 >= keys()) return Vec3(0.f);
    return slopeOf(k, way, [&](double w) {
        CurveSegment g;
        load(at.prim / parts_, k, w, g);
        return transformPoint(toCamera(), fromRay_ ? curveAt(g, at.b2).f : local(g, facing_, at.b1, at.b2).P);
    });
}

double Curves::sampleDensity(const SurfacePoint& p) const {
    const std::vector<double>& sums = areas();
    const uint32_t segment = p.prim / parts_;
    const bool disc = tubes() && onDisc(p.b2);
    const size_t i = 3 * size_t(segment) + (!disc ? 0 : p.b2 < 0 ? 1 : 2);
    const double share = (sums[i] - (i ? sums[i - 1] : 0)) / sums.back();
    const double l = disc ? discArea(p) : length(cross(Vec3d(p.dPdu), Vec3d(p.dPdv))) / set_.place(segment).count;
    return l > 0 ? share / l : 0;
}

void Curves::dice(const DiceOptions& o, Diagnostics& diag) { reportNotDisplaced(*this, o, diag); }

} // namespace

ShapeRef makeCurves(ShapeSource s, Diagnostics& diag) {
    CurveSet set;
    if (!set.take(s, diag)) return nullptr;
    return std::make_shared<Curves>(std::move(s), std::move(set), diag);
}

} // namespace alpenglow::geometry
