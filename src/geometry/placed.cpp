#include "geometry/placed.h"
#include "base/exact.h"
#include <algorithm>

namespace alpenglow::geometry {

using scene::Type;

Bounds SharedBounds::of(const Shape& s) {
    const std::lock_guard lock(mutex_);
    const auto* deforming = dynamic_cast<const Deforming*>(&s);
    const TriMesh& mesh = deforming ? deforming->keys()[0]->mesh() : s.mesh();
    if (!known_ || points_ != mesh.P.data() || count_ != mesh.vertices) {
        bounds_ = s.bounds();
        points_ = mesh.P.data();
        count_ = mesh.vertices;
        known_ = true;
    }
    return bounds_;
}

Placed::Placed(ShapeSource s, ShapeRef geometry, const scene::Transform& place, std::shared_ptr<SharedBounds> bounds)
    : Shape(std::move(s)), geometry_(std::move(geometry)), bounds_(std::move(bounds)),
      deforming_(dynamic_cast<const Deforming*>(geometry_.get())), keyed_(dynamic_cast<const KeyedShape*>(geometry_.get())) {
    variables_ = &geometry_->primvars();
    out_ = Affine(place.first());
    if (!out_.inverse(in_)) in_ = Affine();
    // Effect of the orientation on the geometry's own normals, which use the inverse transpose (Shape::orientation()).
    side_ = double(orientation()) * double(geometry_->orientation()) * (out_.determinant() < 0 ? -1 : 1);
    if (!place.moves()) return;
    auto moving = std::make_unique<Moving>();
    moving->times = place.times;
    for (const Matrix& m : place.keys) moving->keys.emplace_back(m);
    moving_ = std::move(moving);
}

std::vector<std::pair<float, Affine>> Placed::placeKeys() const {
    std::vector<std::pair<float, Affine>> out;
    for (size_t i = 0; moving_ && i < moving_->keys.size(); ++i) out.emplace_back(moving_->times[i], moving_->keys[i]);
    return out;
}

size_t Placed::keyAt(float time, double& way) const { return keyBefore(moving_->times, time, way); }

Affine Placed::fromGeometry(float time) const {
    if (!moving_ || !(time > 0)) return out_;
    double way;
    const size_t k = keyAt(time, way);
    return Affine::between(moving_->keys[k], moving_->keys[k + 1], way);
}

bool Placed::toGeometry(float time, Affine& out) const {
    if (!moving_ || !(time > 0)) return out = in_, true;
    return fromGeometry(time).inverse(out);
}

Placed::Pose Placed::poseAt(float time) const {
    Pose p{fromGeometry(time), Affine(), 1};
    if (!toGeometry(time, p.in)) p.in = in_;
    p.flip = p.out.determinant() < 0 ? -side_ : side_;
    return p;
}

Matrix Placed::toCameraAt(float time) const {
    if (!moving_ || !(time > 0)) return toCamera();
    // The transformation from object to geometry is that at shutter open.
    const auto matrix = [](const Affine& a) {
        Matrix m;
        const Vec3d rows[4] = {a.x, a.y, a.z, a.o};
        for (int i = 0; i < 4; ++i)
            for (int k = 0; k < 3; ++k) m.m[i][k] = rows[i][k];
        return m;
    };
    return toCamera() * matrix(in_) * matrix(fromGeometry(time));
}

void Placed::place(SurfacePoint& p, const Pose& m, float time) const {
    const auto vector = [&](Vec3& v) { v = Vec3(m.out.vector(Vec3d(v))); };
    const auto normal = [&](const Vec3& n) { return m.in.across(Vec3d(n)); };
    const Vec3d from(p.displaced ? p.displacedP : p.P);
    // Error of the float point in the geometry's own space, which may be far from its origin; plus that of the rounded result.
    const double stretch = std::sqrt(3.0) * m.out.stretch();
    p.P = Vec3(m.out.point(Vec3d(p.P)));
    const Vec3d Ng = normal(p.Ng) * (m.out.determinant() * m.flip); // if no partials are known
    for (Vec3* v : {&p.dPdu, &p.dPdv, &p.Puu, &p.Puv, &p.Pvv}) vector(*v);
    const bool own = p.N == p.n;
    const Vec3d n = normal(p.n) * side_;
    p.n = Vec3(normalize(n));
    p.orientation = float(double(p.orientation) * m.flip);
    const Vec3d g = cross(Vec3d(p.dPdu), Vec3d(p.dPdv)) * double(p.orientation);
    p.Ng = dot(g, g) > 0 ? Vec3(g) : dot(Ng, Ng) > 0 ? Vec3(Ng) : p.n;
    const Vec3d N = normal(p.N) * (givesNormals() || geometry_->givesNormals() ? 1.0 : side_);
    const double l = length(N);
    if (l > 0) {
        const Vec3d unit = N / l;
        const double sign = geometry_->givesNormals() ? 1 : side_;
        const auto slope = [&](Vec3& v) {
            const Vec3d q = normal(v) * sign;
            v = Vec3((q - unit * dot(unit, q)) / l);
        };
        p.N = own && !geometry_->givesNormals() ? p.n : Vec3(unit);
        slope(p.dNdu);
        slope(p.dNdv);
    }
    if (p.facet != kNone) {
        p.displacedP = Vec3(m.out.point(Vec3d(p.displacedP)));
        p.displacedN = Vec3(normalize(normal(p.displacedN) * side_));
    }
    const Vec3& at = p.displaced ? p.displacedP : p.P;
    const double size = std::max({std::fabs(from.x), std::fabs(from.y), std::fabs(from.z)}) * m.out.stretch() +
                        std::max({std::fabs(m.out.o.x), std::fabs(m.out.o.y), std::fabs(m.out.o.z)});
    p.pError = float(double(p.pError) * stretch + roundingError(at) + 1e-14 * size);
    if (p.facet != kNone) p.facetError = float(double(p.facetError) * stretch + roundingError(p.displacedP) + 1e-14 * size);
    p.time = time;
}

SurfacePoint Placed::evaluateLocal(uint32_t prim, double b1, double b2) const {
    SurfacePoint p;
    const HitRef h{prim, b1, b2, &p, 0};
    localPoints({&h, 1}, kNeedAll);
    return p;
}

void Placed::localPoints(std::span<const HitRef> hits, uint32_t needs) const {
    geometry_->points(hits, needs);
    const Pose still = moving_ ? Pose{} : poseAt(0);
    for (const HitRef& h : hits) place(*h.out, moving_ ? poseAt(h.time) : still, h.time);
}

SurfacePoint Placed::evaluate(int face, double u, double v) const {
    SurfacePoint p = geometry_->evaluate(face, u, v);
    place(p, poseAt(0), 0);
    return p;
}

Bounds Placed::bounds() const {
    const Bounds in = bounds_ ? bounds_->of(*geometry_) : geometry_->bounds();
    Bounds b;
    if (in.empty()) return b;
    const auto add = [&](const Affine& m) {
        for (int i = 0; i < 8; ++i) {
            const Vec3d c = m.point(Vec3d(i & 1 ? in.hi.x : in.lo.x, i & 2 ? in.hi.y : in.lo.y, i & 4 ? in.hi.z : in.lo.z));
            // Rounded outwards, including the error of rays transformed to the geometry's space.
            const Vec3 p(c);
            const float room = 4 * roundingError(p);
            b.add(p - Vec3(room));
            b.add(p + Vec3(room));
        }
    };
    if (!moving_) add(out_);
    else
        for (const Affine& m : moving_->keys) add(m);
    return b;
}

double Placed::area() const {
    // Exact for similarity transforms; else the mean change of areas, which only affects selection probabilities.
    return geometry_->area() * exact::pow(std::fabs(out_.determinant()), 2. / 3);
}

SurfacePoint Placed::sampleArea(double xi1, double xi2) const {
    SurfacePoint p;
    sampleAreaAt(xi1, xi2, 0, p, kNeedAll);
    return p;
}

void Placed::sampleAreaAt(double xi1, double xi2, float time, SurfacePoint& out, uint32_t needs) const {
    geometry_->sampleAreaAt(xi1, xi2, time, out, needs | kNeedPartials);
    place(out, poseAt(time), time);
}

void Placed::sampleFromAt(const Vec3& from, double xi1, double xi2, float time, SurfacePoint& out, uint32_t needs) const {
    if (!keyed_) return sampleAreaAt(xi1, xi2, time, out, needs);
    const Pose m = poseAt(time);
    out = keyed_->sampleFromAt(Vec3(m.in.point(Vec3d(from))), xi1, xi2, time);
    place(out, m, time);
}

double Placed::sampleDensity(const SurfacePoint& p) const {
    const Pose m = poseAt(p.time);
    SurfacePoint q = p;
    q.dPdu = Vec3(m.in.vector(Vec3d(p.dPdu)));
    q.dPdv = Vec3(m.in.vector(Vec3d(p.dPdv)));
    q.P = Vec3(m.in.point(Vec3d(p.P)));
    const Vec3d n = normalize(m.out.across(Vec3d(p.n)));
    q.n = Vec3(n * side_);
    // An area across n grows by det times the length of its normal's image.
    const double grows = std::fabs(m.out.determinant()) * length(m.in.across(n));
    return grows > 0 ? geometry_->sampleDensity(q) / grows : 0;
}

double Placed::turnedDensity(const SurfacePoint& p, const Vec3& from) const {
    if (!keyed_) return 1;
    const Pose m = poseAt(p.time);
    SurfacePoint q = p;
    q.P = Vec3(m.in.point(Vec3d(p.P)));
    return keyed_->turnedDensity(q, Vec3(m.in.point(Vec3d(from))));
}

void Placed::interpolate(int var, const SurfacePoint& at, float* out, float* du, float* dv) const {
    geometry_->interpolate(var, at, out, du, dv);
    const PrimVar& v = primvars()[size_t(var)];
    const bool point = v.type == Type::Point || v.type == Type::HPoint, normal = v.type == Type::Normal;
    if (!point && !normal && v.type != Type::Vector) return;
    const Pose m = poseAt(at.time);
    const auto moved = [&](float* f, bool whole) {
        if (!f) return;
        for (int e = 0; e < v.elements(); ++e, f += 3) {
            const Vec3d x(f[0], f[1], f[2]), y = normal ? m.in.across(x) : whole ? m.out.point(x) : m.out.vector(x);
            for (int k = 0; k < 3; ++k) f[k] = float(y[k]);
        }
    };
    moved(out, point);
    moved(du, false);
    moved(dv, false);
}

Vec3 Placed::velocity(const SurfacePoint& p) const {
    const Pose m = poseAt(p.time);
    const Vec3d here = m.in.point(Vec3d(p.P));
    Vec3d v(0.0);
    if (moving_) {
        double way;
        const size_t k = keyAt(p.time, way);
        const double span = double(moving_->times[k + 1]) - moving_->times[k];
        v = (moving_->keys[k + 1].point(here) - moving_->keys[k].point(here)) / span;
    }
    if (deforming_ || keyed_) v += m.out.vector(Vec3d(geometry_->velocity(p)));
    return Vec3(v);
}

} // namespace alpenglow::geometry
