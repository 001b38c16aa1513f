#include "geometry/dice.h"
#include "base/exact.h"
#include "base/limits.h"
#include "geometry/placed.h"
#include <algorithm>
#include <cmath>
#include <tbb/parallel_for.h>
#include <unordered_set>

namespace alpenglow::geometry {

double DiceCamera::pixels(const Vec3d& p, const Vec3d& d) const {
    double l = length(d) * pixelsPerUnit;
    if (perspective) l /= std::max(length(p), 1e-30);
    return std::isfinite(l) ? l : 1e30;
}

DiceCamera DiceCamera::from(const scene::Options& o) {
    DiceCamera c;
    double aspect = o.frameAspect ? double(*o.frameAspect) : double(o.xres) * o.pixelAspect / std::max(1, o.yres);
    double left, right, bottom, top;
    if (o.screenWindow && o.screenWindow->size() == 4) {
        left = (*o.screenWindow)[0]; right = (*o.screenWindow)[1]; bottom = (*o.screenWindow)[2]; top = (*o.screenWindow)[3];
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

double diceEdge(const scene::Attributes& a) {
    double r = a.shadingRate;
    return std::isfinite(r) ? std::sqrt(std::clamp(r, 0.01, 1e4)) : 1;
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

// Lengths in "object" and "shader" space scale by the largest stretch of the object's transform; "world", "camera" and "current" are
// taken as they are, the camera being rigid.
double stretch(const Shape& s, const std::string& space) {
    if (space != "object" && space != "shader") return 1;
    double scale = 0;
    for (int i = 0; i < 3; ++i) {
        Vec3d axis(i == 0, i == 1, i == 2);
        scale = std::max(scale, length(transformVector(s.toCamera(), axis)));
    }
    return scale;
}

// Attribute "displacementbound" and what the shaders say: a length in camera space, or -1 when neither was given.
double displacementBound(const Shape& s, const DiceOptions& opt) {
    const scene::Param* sphere = s.attributes().value("displacementbound:sphere");
    const scene::Param* space = s.attributes().value("displacementbound:coordinatesystem");
    const DiceOptions::DeclaredBound declared = opt.declaredBound ? opt.declaredBound(s) : DiceOptions::DeclaredBound{};
    const bool given = sphere && !sphere->numbers.empty();
    if (!given && !(declared.radius > 0)) return -1;
    double bound = 0;
    if (given) bound += double(sphere->numbers[0]) * stretch(s, space && !space->strings.empty() ? space->strings[0] : "object");
    if (declared.radius > 0) bound += declared.radius * stretch(s, declared.space.empty() ? "object" : declared.space);
    return bound;
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

void displaceMesh(const Shape& shape, const DiceOptions& opt, Diagnostics& diag,
                  const std::function<SurfacePoint(uint32_t)>& pointOf, const std::function<Vec2(uint32_t)>& stepOf,
                  TriMesh& mesh) {
    constexpr uint32_t kRun = 4096; // keeps the full points of a run in the cache, and kernels in wide batches
    uint32_t n = uint32_t(mesh.P.size());
    double bound = displacementBound(shape, opt), farthest = 0;
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
            if (!std::isfinite(far)) { ++notFinite; continue; }
            if (far > limits::kDisplacementBound) { ++tooFar; continue; }
            farthest = std::max(farthest, far);
            // An unmoved vertex keeps its bits, and with them the closed seams of the mesh.
            if (!(p == g.points[i].P)) mesh.P[begin + i] = p;
        }
    }
    if (opt.stop && *opt.stop) return; // what kernels left early is void
    if (notFinite)
        diag.report(Severity::Error, Rie::Math, shape.place(),
                    "displacement of this " + shape.kind() + " is not finite at " + std::to_string(notFinite) +
                        " points; they stay where they were");
    if (tooFar)
        diag.report(Severity::Error, Rie::Limit, shape.place(),
                    "displacement of this " + shape.kind() + " moves " + std::to_string(tooFar) +
                        " points farther than the limit; they stay where they were");
    if (bound >= 0 && farthest > bound * 1.001)
        diag.report(Severity::Warning, Rie::Range, shape.place(),
                    "displacement of this " + shape.kind() + " reaches " + std::to_string(farthest) +
                        ", beyond its displacementbound of " + std::to_string(bound) + " (camera units); it is drawn whole",
                    bound > 0 ? "other renderers need the bound times " + factor(farthest / bound) : "other renderers need a bound that is not 0");
}

void diceShapes(const std::vector<ShapeRef>& all, const DiceOptions& opt, Diagnostics& diag) {
    // A geometry once for all its places.
    std::vector<ShapeRef> shapes;
    std::unordered_set<const Shape*> known;
    for (const ShapeRef& s : all) {
        const Placed* p = s->placed();
        if (!p) shapes.push_back(s);
        else if (known.insert(p->geometry().get()).second) shapes.push_back(p->geometry());
    }
    // Messages are kept by shape and passed on in order, so that they do not depend on threads.
    std::vector<std::vector<Diagnostic>> said(shapes.size());
    tbb::parallel_for(size_t(0), shapes.size(), [&](size_t i) {
        if (opt.stop && *opt.stop) return;
        Diagnostics own;
        shapes[i]->dice(opt, own);
        said[i] = own.all();
    });
    for (auto& list : said)
        for (auto& d : list) diag.report(std::move(d));
}

} // namespace alpenglow::geometry
