#include "geometry/dice.h"
#include "geometry/placed.h"
#include "geometry/polygon_mesh.h"
#include "geometry/seams.h"
#include <algorithm>

namespace alpenglow::geometry {

namespace {
Vec3 mix(const Vec3& a, const Vec3& b, double w) { return Vec3(Vec3d(a) * (1 - w) + Vec3d(b) * w); }
float mix(float a, float b, double w) { return float(a * (1 - w) + b * w); }
} // namespace

Deforming::Deforming(ShapeSource s, std::vector<ShapeRef> keys, std::vector<float> times)
    : Shape(std::move(s)), keys_(std::move(keys)), times_(std::move(times)) {
    variables_ = &keys_[0]->primvars();
    normal_.param = keys_[0]->givesNormals() ? source_.primitive->params.data() : nullptr; // whether; the values are the keys'
}

size_t Deforming::keyAt(float time, double& way) const { return keyBefore(times_, time, way); }

void Deforming::corners(uint32_t prim, float time, Vec3d out[3]) const {
    double way;
    const size_t k = keyAt(time, way);
    const TriMesh &a = keys_[k]->mesh(), &b = keys_[std::min(k + 1, keys_.size() - 1)]->mesh();
    for (size_t c = 0; c < 3; ++c) {
        const uint32_t i = a.index[3 * size_t(prim) + c];
        out[c] = between(a.P[i], b.P[i], way);
    }
}

Bounds Deforming::bounds() const {
    Bounds b;
    for (const ShapeRef& k : keys_) b.add(k->bounds());
    return b;
}

/// Interpolates the same surface point between two keys. Partials by u and v interpolate like points, because u and v are
/// constant.
SurfacePoint Deforming::between(const SurfacePoint& a, const SurfacePoint& b, double w) const {
    SurfacePoint p = a;
    for (auto v : {&SurfacePoint::P, &SurfacePoint::dPdu, &SurfacePoint::dPdv, &SurfacePoint::Puu, &SurfacePoint::Puv,
                   &SurfacePoint::Pvv, &SurfacePoint::dNdu, &SurfacePoint::dNdv, &SurfacePoint::displacedP})
        p.*v = mix(a.*v, b.*v, w);
    for (auto f : {&SurfacePoint::u, &SurfacePoint::v, &SurfacePoint::s, &SurfacePoint::t, &SurfacePoint::dsdu,
                   &SurfacePoint::dsdv, &SurfacePoint::dtdu, &SurfacePoint::dtdv})
        p.*f = mix(a.*f, b.*f, w);
    const bool own = a.N == a.n && b.N == b.n;
    const Vec3d g = cross(Vec3d(p.dPdu), Vec3d(p.dPdv)) * double(a.orientation), blend = Vec3d(mix(a.n, b.n, w));
    p.n = Vec3(normalize(dot(g, g) > 0 ? g : dot(blend, blend) > 0 ? blend : Vec3d(a.n)));
    p.Ng = dot(g, g) > 0 ? Vec3(g) : p.n;
    const Vec3d N = Vec3d(mix(a.N, b.N, w));
    p.N = own || !(dot(N, N) > 0) ? p.n : Vec3(normalize(N));
    p.pError = std::max(a.pError, b.pError) + roundingError(p.P);
    p.facetError = std::max(a.facetError, b.facetError) + roundingError(p.displacedP);
    return p;
}

/// The parts of a facet that depend on its shape at the time, for a mesh that is its own surface: normal, and derivatives by u
/// and v, which for polygons are object x and y and change with it. They follow from the data of the facet's corners; if u and v
/// are constant over it, derivatives are unchanged.
void Deforming::facet(SurfacePoint& p, uint32_t prim, size_t key, double way, uint32_t needs) const {
    const ShapeRef &first = keys_[key], &last = keys_[std::min(key + 1, keys_.size() - 1)];
    Vec3d P[3];
    const TriMesh &from = first->mesh(), &to = last->mesh();
    for (size_t i = 0; i < 3; ++i) {
        const uint32_t v = from.index[3 * size_t(prim) + i];
        P[i] = between(from.P[v], to.P[v], way);
    }
    const Vec3d e1 = P[1] - P[0], e2 = P[2] - P[0], wind = cross(e1, e2) * double(keys_[0]->orientation());
    if (dot(wind, wind) > 0) {
        const bool own = p.N == p.n;
        p.n = Vec3(normalize(wind));
        if (own) p.N = p.n;
    }
    if (!(needs & (kNeedPartials | kNeedNg | kNeedSTSlopes))) return;
    SurfacePoint c[3], x[3], y[3];
    static_cast<const PolygonMesh&>(*first).cornerParameters(prim, x);
    static_cast<const PolygonMesh&>(*last).cornerParameters(prim, y);
    for (int i = 0; i < 3; ++i)
        for (auto f : {&SurfacePoint::u, &SurfacePoint::v, &SurfacePoint::s, &SurfacePoint::t})
            c[i].*f = mix(x[i].*f, y[i].*f, way);
    const auto step = [&](float SurfacePoint::* f, int i) { return double(c[i].*f) - double(c[0].*f); };
    const double u1 = step(&SurfacePoint::u, 1), u2 = step(&SurfacePoint::u, 2), v1 = step(&SurfacePoint::v, 1),
                 v2 = step(&SurfacePoint::v, 2), det = u1 * v2 - u2 * v1;
    if (!(std::fabs(det) > 1e-12 * (std::fabs(u1) + std::fabs(u2)) * (std::fabs(v1) + std::fabs(v2)))) return;
    p.dPdu = Vec3((e1 * v2 - e2 * v1) / det);
    p.dPdv = Vec3((e2 * u1 - e1 * u2) / det);
    const auto slopes = [&](float SurfacePoint::* f, float& du, float& dv) {
        du = float((step(f, 1) * v2 - step(f, 2) * v1) / det);
        dv = float((step(f, 2) * u1 - step(f, 1) * u2) / det);
    };
    slopes(&SurfacePoint::s, p.dsdu, p.dsdv);
    slopes(&SurfacePoint::t, p.dtdu, p.dtdv);
    const Vec3d g = cross(Vec3d(p.dPdu), Vec3d(p.dPdv));
    p.orientation = dot(g, Vec3d(p.n)) < 0 ? -1.f : 1.f;
    p.Ng = dot(g, g) > 0 ? Vec3(g * double(p.orientation)) : p.n;
}

void Deforming::localPoints(std::span<const HitRef> hits, uint32_t needs) const {
    for (const HitRef& h : hits) {
        double way;
        const size_t k = keyAt(h.time, way);
        // As at a still key: the very same point.
        if (way == 0 || way == 1) {
            keys_[way == 0 ? k : k + 1]->evaluateHit(h.prim, h.b1, h.b2, *h.out, needs);
        } else {
            SurfacePoint a, b;
            const bool facets = !keys_[0]->diced(); // of a PolygonMesh, whose normal is not a product of partials
            const auto read = [&](uint32_t wanted) {
                keys_[k]->evaluateHit(h.prim, h.b1, h.b2, a, wanted);
                keys_[k + 1]->evaluateHit(h.prim, h.b1, h.b2, b, wanted);
                *h.out = between(a, b, way);
            };
            constexpr uint32_t kOfFacet = kNeedPartials | kNeedNg | kNeedSTSlopes; // facet() finds them
            read(facets ? needs & ~kOfFacet : needs | kNeedPartials);
            if (!facets) {
                Vec3d c[3];
                corners(h.prim, h.time, c);
                const Vec3d n = cross(c[1] - c[0], c[2] - c[0]) * double(keys_[0]->orientation());
                if (dot(n, n) > 0) h.out->displacedN = Vec3(normalize(n));
            }
            if (facets) facet(*h.out, h.prim, k, way, needs);
            if (facets && (needs & kOfFacet) && h.out->dPdu == Vec3(0.f) && h.out->dPdv == Vec3(0.f)) {
                read(needs);
                facet(*h.out, h.prim, k, way, 0);
            }
        }
        h.out->time = h.time;
    }
}

void Deforming::sampleAreaAt(double xi1, double xi2, float time, SurfacePoint& out, uint32_t needs) const {
    SurfacePoint chosen;
    keys_[0]->sampleArea(xi1, xi2, chosen, kNeedPartials);
    if (!keys_[0]->diced()) {
        const HitRef h{chosen.prim, chosen.b1, chosen.b2, &out, time};
        return localPoints({&h, 1}, needs);
    }
    double way;
    const size_t k = keyAt(time, way);
    out = between(keys_[k]->evaluate(0, chosen.b1, chosen.b2),
                  keys_[std::min(k + 1, keys_.size() - 1)]->evaluate(0, chosen.b1, chosen.b2), way);
    out.time = time;
}

double Deforming::sampleDensity(const SurfacePoint& p) const {
    if (keys_[0]->diced()) return keys_[0]->sampleDensity(p); // of its partials
    Vec3d then[3], now[3];
    corners(p.prim, 0, then);
    corners(p.prim, p.time, now);
    const double a = length(cross(then[1] - then[0], then[2] - then[0])), b = length(cross(now[1] - now[0], now[2] - now[0]));
    return b > 0 ? keys_[0]->sampleDensity(p) * a / b : 0;
}

void Deforming::interpolate(int var, const SurfacePoint& at, float* out, float* du, float* dv) const {
    double way;
    const size_t k = keyAt(at.time, way);
    keys_[k]->interpolate(var, at, out, du, dv);
    if (way == 0 || k + 1 >= keys_.size()) return;
    const size_t n = size_t(primvars()[size_t(var)].outWidth());
    std::vector<float> other(3 * n);
    keys_[k + 1]->interpolate(var, at, &other[0], du ? &other[n] : nullptr, dv ? &other[2 * n] : nullptr);
    float* const to[3] = {out, du, dv};
    for (size_t j = 0; j < 3; ++j)
        for (size_t i = 0; to[j] && i < n; ++i) to[j][i] = mix(to[j][i], other[j * n + i], way);
}

Vec3 Deforming::velocity(const SurfacePoint& at) const {
    double way;
    const size_t k = keyAt(at.time, way);
    if (k + 1 >= keys_.size()) return Vec3(0.f);
    const double length = double(times_[k + 1]) - times_[k];
    if (!keys_[0]->diced()) { // the facet itself
        const TriMesh &from = keys_[k]->mesh(), &to = keys_[k + 1]->mesh();
        const double share[3] = {1 - at.b1 - at.b2, at.b1, at.b2};
        Vec3d moved(0.0);
        for (size_t i = 0; i < 3; ++i) {
            const uint32_t v = from.index[3 * size_t(at.prim) + i];
            moved = moved + (Vec3d(to.P[v]) - Vec3d(from.P[v])) * share[i];
        }
        return Vec3(moved / length);
    }
    const auto point = [&](const ShapeRef& s) { // of the undiced surface
        if (at.prim == 0) return Vec3d(s->evaluate(at.face, at.b1, at.b2).P);
        return Vec3d(s->evaluateHit(at.prim, at.b1, at.b2).P);
    };
    return Vec3((point(keys_[k + 1]) - point(keys_[k])) / length);
}

void reportUnlike(const Shape& s, Diagnostics& diag) {
    diag.report(Severity::Warning, Rie::Incapable, s.place(),
                "the keys of this moving " + s.kind() + " do not match: it is drawn at its first position");
}

void Deforming::dice(const DiceOptions& options, Diagnostics& diag) {
    DiceOptions alike = options;
    alike.keys = keys_;
    for (size_t k = 0; k < keys_.size(); ++k) { // joined points are joined at every key
        alike.seamWith = options.seamWith;
        alike.seamWith.push_back(double(k));
        for (float t : times_) alike.seamWith.push_back(double(t));
        keys_[k]->dice(alike, diag);
    }
    const TriMesh& first = keys_[0]->mesh();
    for (const ShapeRef& k : keys_)
        if (k->exact() || k->mesh().vertices != first.vertices ||
            !std::equal(first.index.begin(), first.index.end(), k->mesh().index.begin(), k->mesh().index.end())) {
            reportUnlike(*this, diag);
            for (const ShapeRef& other : keys_)
                if (options.seams && other != keys_[0]) options.seams->drop(other->mesh());
            keys_.resize(1);
            times_.resize(1);
            return;
        }
}

} // namespace alpenglow::geometry
