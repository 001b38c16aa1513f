#include "geometry/dice.h"
#include "base/exact.h"
#include "base/limits.h"
#include "base/parallel.h"
#include "geometry/dicecost.h"
#include "geometry/edge_corners.h"
#include "geometry/parametric.h"
#include "geometry/placed.h"
#include "geometry/polygon_mesh.h"
#include "geometry/seams.h"
#include "scene/deferred.h"
#include "scene/scene.h"
#include "scene/shadingrate.h"
#include <algorithm>
#include <cmath>
#include <unordered_set>

namespace alpenglow::geometry {

double DiceCamera::pixels(const Vec3d& p, const Vec3d& d) const {
    const double away = length(p);
    double whole = length(d);
    if (narrowest < 1) {
        const double along = perspective ? dot(d, p) / std::max(away, 1e-30) : d.z;
        whole = std::max(std::sqrt(std::max(0.0, whole * whole - along * along)), narrowest * whole);
    }
    double l = whole * pixelsPerUnit;
    if (perspective) l /= std::max(away, 1e-30);
    if (away > limits::kDiceDistance) l *= limits::kDiceDistance / away;
    return std::isfinite(l) ? l : 1e30;
}

DiceCamera DiceCamera::from(const scene::Options& o) {
    DiceCamera c;
    double aspect = o.frameAspect ? double(*o.frameAspect) : double(o.xres) * o.pixelAspect / std::max(1, o.yres);
    double left, right, bottom, top;
    if (o.screenWindow && o.screenWindow->size() == 4) {
        left = (*o.screenWindow)[0];
        right = (*o.screenWindow)[1];
        bottom = (*o.screenWindow)[2];
        top = (*o.screenWindow)[3];
    } else {
        right = aspect >= 1 ? aspect : 1;
        top = aspect >= 1 ? 1 : 1 / aspect;
        left = -right;
        bottom = -top;
    }
    double x = std::fabs(o.xres / (right - left)), y = std::fabs(o.yres / (top - bottom));
    c.pixelsPerUnit = std::max(std::isfinite(x) ? x : 1, std::isfinite(y) ? y : 1);
    c.perspective = o.projection == "perspective";
    if (c.perspective) c.pixelsPerUnit /= std::max(1e-6, exact::tan(std::clamp(double(o.fov), 1e-3, 179.9) * kPi / 360));
    return c;
}

DiceCamera diceCamera(const DiceOptions& o, const scene::Attributes& a, bool displaced) {
    constexpr double kNarrowest = 0.25;
    DiceCamera c = o.camera;
    const scene::Param* orient = a.value("dice:rasterorient");
    const bool asSeen = !orient || orient->numbers.empty() || orient->numbers[0] != 0;
    if (displaced && o.picture && asSeen) c.narrowest = kNarrowest;
    return c;
}

double diceEdge(const scene::Attributes& a) {
    double r = scene::shadedArea(a);
    return std::isfinite(r) ? std::sqrt(std::clamp(r, 0.01, 1e4)) : 1;
}

double diceFlatness(const scene::Attributes& a) {
    const scene::Param* f = a.value("GeometricApproximation:flatness");
    return f && !f->numbers.empty() && f->numbers[0] > 0 ? std::clamp(double(f->numbers[0]), 1e-3, 1e3) : 0;
}

bool isDisplaced(const Shape& s, const DiceOptions& o) {
    return o.displace && (o.displaces ? o.displaces(s) : s.attributes().displacement != nullptr);
}

void reportNotDisplaced(const Shape& s, const DiceOptions& o, Diagnostics& diag) {
    if (!isDisplaced(s, o)) return;
    Diagnostic d;
    d.severity = Severity::Warning;
    d.code = Rie::Incapable;
    d.place = s.place();
    d.message = s.kind() + (s.kind() == "Blobby" ? " is" : " are") + " not displaced: the displacement shader moves normals only";
    diag.reportOnce("geometry:displaced " + s.kind(), d);
}

namespace {

/// Limit of displacement, in its own space; Attribute "displacementbound" and declarations of shaders add up.
struct Bound {
    double radius = -1; ///< not declared
    std::string space;
    Matrix fromCamera;
    double reach(const Vec3d& moved) const { return length(transformVector(fromCamera, moved)); }
};

/// Object space is the shape's own; without names for others they count as camera space.
Matrix toCamera(const Shape& s, const DiceOptions& opt, const std::string& space) {
    Matrix m;
    if (opt.spaceOf && opt.spaceOf(s, space, m) && determinant3(m) != 0) return m;
    return space == "object" || space == "shader" ? s.toCamera() : Matrix();
}

/// The largest stretch of the linear part: its largest singular value, by powers of the matrix times its transpose.
double stretch(const Matrix& m) {
    Vec3d rows[3];
    for (int i = 0; i < 3; ++i) rows[i] = Vec3d(m.m[i][0], m.m[i][1], m.m[i][2]);
    Vec3d v(1, 0.7, 0.4);
    double l = 0;
    for (int k = 0; k < 100; ++k) {
        const Vec3d w(dot(rows[0], v), dot(rows[1], v), dot(rows[2], v));
        v = rows[0] * w.x + rows[1] * w.y + rows[2] * w.z;
        l = length(v);
        if (!(l > 0) || !std::isfinite(l)) return 0;
        v = v / l;
    }
    return std::sqrt(l);
}

Bound displacementBound(const Shape& s, const DiceOptions& opt) {
    const scene::Param* sphere = s.attributes().value("displacementbound:sphere");
    const scene::Param* space = s.attributes().value("displacementbound:coordinatesystem");
    const DiceOptions::DeclaredBound declared = opt.declaredBound ? opt.declaredBound(s) : DiceOptions::DeclaredBound{};
    const bool given = sphere && !sphere->numbers.empty();
    Bound b;
    if (!given && !(declared.radius > 0)) return b;
    const std::string one = space && !space->strings.empty() ? space->strings[0] : "object",
                      other = declared.space.empty() ? "object" : declared.space;
    const double own = given ? double(sphere->numbers[0]) : 0, more = declared.radius > 0 ? declared.radius : 0;
    b.space = given ? one : other;
    const Matrix there = toCamera(s, opt, b.space);
    b.fromCamera = inverse(there);
    // Of two spaces, each as far as it reaches in its longest direction.
    if (given && more > 0 && one != other) {
        b.space = "camera";
        b.fromCamera = Matrix();
        b.radius = own * stretch(there) + more * stretch(toCamera(s, opt, other));
    } else {
        b.radius = own + more;
    }
    return b;
}

/// Rounded up to two digits behind the point, so that the product is enough.
std::string factor(double f) {
    const double hundredths = std::ceil(f * 100);
    if (!(hundredths < 1e15)) return std::to_string(f);
    const std::string s = std::to_string(int64_t(hundredths));
    const std::string padded = s.size() < 3 ? std::string(3 - s.size(), '0') + s : s;
    return padded.substr(0, padded.size() - 2) + "." + padded.substr(padded.size() - 2);
}

} // namespace

double displacementReach(const Shape& s, const DiceOptions& opt) {
    const Bound b = displacementBound(s, opt);
    return b.radius < 0 ? -1 : b.radius * (b.space == "camera" ? 1 : stretch(toCamera(s, opt, b.space)));
}

bool displaceMesh(const Shape& shape, const DiceOptions& opt, Diagnostics& diag,
                  const std::function<SurfacePoint(uint32_t)>& pointOf, const std::function<Vec2(uint32_t)>& stepOf,
                  TriMesh& mesh) {
    constexpr uint32_t kRun = 4096; // the points of a run fit into the cache, and kernels have wide batches
    uint32_t n = uint32_t(mesh.P.size());
    const Bound bound = displacementBound(shape, opt);
    double farthest = 0;
    size_t notFinite = 0, tooFar = 0;
    for (uint32_t begin = 0; begin < n && !(opt.stop && *opt.stop); begin += kRun) {
        uint32_t count = std::min(kRun, n - begin);
        DiceGrid g;
        for (uint32_t i = 0; i < count; ++i) {
            g.points.push_back(pointOf(begin + i));
            Vec2 step = stepOf(begin + i);
            g.du.push_back(step.x);
            g.dv.push_back(step.y);
            g.P.push_back(g.points.back().P);
        }
        opt.displace(shape, g);
        for (uint32_t i = 0; i < count && i < g.P.size(); ++i) {
            Vec3 p = g.P[i];
            double far = length(Vec3d(p) - Vec3d(g.points[i].P));
            if (!std::isfinite(far)) {
                ++notFinite;
                continue;
            }
            if (far > limits::kDisplacementBound) {
                ++tooFar;
                continue;
            }
            if (bound.radius >= 0) farthest = std::max(farthest, bound.reach(Vec3d(p) - Vec3d(g.points[i].P)));
            // An unmoved vertex keeps its bits, so seams of the mesh stay closed.
            if (!(p == g.points[i].P)) mesh.P[begin + i] = p;
        }
    }
    if (opt.stop && *opt.stop) return true; // early exits of kernels are void
    if (notFinite)
        diag.report(Severity::Error, Rie::Math, shape.place(),
                    "displacement of this " + shape.kind() + " is not finite at " + std::to_string(notFinite) +
                        " points; these are not displaced");
    if (tooFar)
        diag.report(Severity::Error, Rie::Limit, shape.place(),
                    "displacement of this " + shape.kind() + " moves " + std::to_string(tooFar) +
                        " points farther than the limit; these are not displaced");
    if (bound.radius < 0 || farthest <= bound.radius * 1.001) return true;
    diag.report(Severity::Warning, Rie::Range, shape.place(),
                "displacement of this " + shape.kind() + " reaches " + std::to_string(farthest) +
                    ", beyond its displacementbound of " + std::to_string(bound.radius) + " in \"" + bound.space +
                    "\" space; it is drawn completely",
                bound.radius > 0 ? "other renderers need the bound times " + factor(farthest / bound.radius)
                                 : "other renderers need a bound that is not 0");
    return false;
}

void closeSeams(const DiceOptions& opt, TriMesh& mesh, std::vector<uint32_t> vertex, std::vector<Vec3> flat) {
    if (vertex.empty()) return;
    Seams own;
    (opt.seams ? *opt.seams : own).add(mesh, std::move(vertex), std::move(flat), opt.seamOrder, opt.seamWith);
    own.close();
}

namespace {

/// Motion that two shapes must share for their borders to coincide during the shutter: none for static shapes. Compared to about
/// 1e-6, as equal motions may result from different matrix products.
std::vector<double> motionOf(const Placed* p) {
    std::vector<double> out;
    if (!p || !p->placeMoves()) return out;
    for (const auto& [time, m] : p->placeKeys()) {
        out.push_back(double(time));
        for (const Vec3d* v : {&m.x, &m.y, &m.z, &m.o})
            for (int i = 0; i < 3; ++i) out.push_back(std::round((*v)[i] * 0x1p20));
    }
    return out;
}

bool stitched(const Shape& s) {
    const scene::Param* p = s.attributes().value("stitch:enable");
    return !p || p->numbers.empty() || p->numbers[0] != 0;
}

} // namespace

void diceShapes(const std::vector<ShapeRef>& all, const DiceOptions& opt, Diagnostics& diag) {
    // Each geometry once, for all instances.
    std::vector<ShapeRef> shapes;
    std::vector<const Placed*> places;
    std::unordered_set<const Shape*> known;
    for (const ShapeRef& s : all) {
        const Placed* p = s->placed();
        if (!p) shapes.push_back(s), places.push_back(nullptr);
        else if (known.insert(p->geometry().get()).second) shapes.push_back(p->geometry()), places.push_back(p);
    }
    Seams seams;
    std::vector<std::vector<double>> with(shapes.size()); // groups of shapes whose borders are closed together
    EdgeCorners corners;
    for (size_t i = 0; i < shapes.size(); ++i) {
        with[i] = motionOf(places[i]);
        // Deferred procedurals expand in any order: their borders are closed among themselves.
        for (const char c : scene::partOf(shapes[i]->attributes())) with[i].push_back(double(c));
        if (places[i] || !stitched(*shapes[i]) || !isDisplaced(*shapes[i], opt)) continue;
        std::vector<Vec3> own;
        if (const auto* mesh = dynamic_cast<const PolygonMesh*>(shapes[i].get())) mesh->borderCorners(own);
        else if (const auto* patch = dynamic_cast<const Parametric*>(shapes[i].get())) patch->borderCorners(own);
        corners.add(with[i], own);
    }
    corners.finish();
    // Messages are collected by shape and reported in order, so that they do not depend on threads.
    std::vector<std::vector<Diagnostic>> reported(shapes.size());
    std::vector<DiceCost> costs(shapes.size());
    parallelFor(size_t(0), shapes.size(), [&](size_t i) {
        if (opt.stop && *opt.stop) return;
        Diagnostics own;
        DiceOptions mine = opt;
        mine.seamOrder = uint32_t(i);
        if (stitched(*shapes[i])) mine.seams = &seams, mine.seamWith = with[i];
        if (stitched(*shapes[i]) && !places[i]) mine.corners = &corners;
        if (places[i]) mine.picture = nullptr; // it moves, or is seen in several places
        const double before = threadSeconds();
        shapes[i]->dice(mine, own);
        costs[i] = costOf(*shapes[i], threadSeconds() - before);
        reported[i] = own.all();
    });
    if (!(opt.stop && *opt.stop)) seams.close();
    for (auto& list : reported)
        for (auto& d : list) diag.report(std::move(d));
    noteCosts(shapes, costs, opt, diag);
}

} // namespace alpenglow::geometry
