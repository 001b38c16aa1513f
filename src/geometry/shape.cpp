#include "geometry/shape.h"
#include "scene/solids.h"
#include <cmath>

namespace alpenglow::geometry {

using scene::Class;

float orientationSign(const scene::Attributes& a, const Matrix& toCamera) {
    if (a.absoluteHandedness) return a.rightHanded ? -1.f : 1.f;
    bool flip = (determinant3(toCamera) < 0) != a.inside;
    if (scene::solidTakenAway(a)) flip = !flip; // the surface of a hole looks into it
    return flip ? -1.f : 1.f;
}

Shape::Shape(ShapeSource s) : source_(std::move(s)) { orientation_ = orientationSign(*source_.attributes, source_.toCamera); }

Bounds Shape::bounds() const {
    Bounds b;
    for (uint32_t i = 0; i < mesh_.vertices; ++i) b.add(mesh_.P[i]);
    return b;
}

void Shape::leaveOut(const Bounds& b) {
    mesh_ = TriMesh();
    mesh_.P = {b.lo, b.hi};
    mesh_.finish();
    meshParam_.assign(2, Vec2{});
}

int Shape::findPrimvar(std::string_view name) const {
    const std::vector<PrimVar>& all = *variables_;
    for (size_t i = 0; i < all.size(); ++i)
        if (all[i].name == name) return int(i);
    return -1;
}

void Shape::takePrimvars(Diagnostics& diag) {
    normal_.param = nullptr;
    for (const scene::Param& p : source_.primitive->params) {
        if (p.name == "P" || p.name == "Pw" || p.name == "Pz" || p.name == "uknot" || p.name == "vknot") continue;
        if (p.name == "intargs" || p.name == "floatargs" || p.name == "stringargs") continue; // of tags
        bool isNormal = (p.name == "N" || p.name == "Np") && scene::componentCount(p.type) == 3 && p.arrayLength == 0;
        PrimVar var;
        if (isNormal) {
            // Whatever type an old file declared (point, vector), these are normals.
            scene::Param typed = p;
            typed.type = scene::Type::Normal;
            if (p.name == "Np" && normal_.param) continue;
            if (!makePrimVar(typed, classCount(p.cls), source_.toCamera, kind(), diag, var)) continue;
            var.param = &p;
            normal_ = std::move(var);
            continue;
        }
        if (!makePrimVar(p, classCount(p.cls), source_.toCamera, kind(), diag, var)) continue;
        int old = findPrimvar(p.name);
        if (old >= 0) primvars_[size_t(old)] = std::move(var); // given twice: the last one counts
        else primvars_.push_back(std::move(var));
    }
    auto floatVar = [&](const char* name, int width) {
        int i = findPrimvar(name);
        return i >= 0 && primvars_[size_t(i)].type == scene::Type::Float && primvars_[size_t(i)].width() == width ? i : -1;
    };
    varS_ = floatVar("s", 1);
    varT_ = floatVar("t", 1);
    varSt_ = floatVar("st", 2);
}

namespace {
/// Room for the weights of one value: nearly always on the stack.
class Weights {
public:
    explicit Weights(int most) {
        if (most > 16) many_.resize(size_t(most));
    }
    operator Weight*() { return many_.empty() ? few_ : many_.data(); }
    Weight& operator[](int i) { return many_.empty() ? few_[i] : many_[size_t(i)]; }

private:
    Weight few_[16];
    std::vector<Weight> many_;
};
} // namespace

void Shape::interpolate(int var, const SurfacePoint& at, float* out, float* du, float* dv) const {
    interpolateVariable(primvars_[size_t(var)], at, out, du, dv);
}

void Shape::interpolateVariable(const PrimVar& p, const SurfacePoint& at, float* out, float* du, float* dv) const {
    Weights w(mostWeights_);
    int n = weights(p.cls, at, w);
    interpolatePrimVar(p, w, n, out, du, dv);
}

const std::string& Shape::stringValue(int var, const SurfacePoint& at) const {
    Weights w(mostWeights_);
    const PrimVar& p = primvars_[size_t(var)];
    weights(p.cls, at, w);
    return p.param->strings[w[0].index * size_t(p.elements())];
}

void Shape::finishPoint(SurfacePoint& p, bool parametric) const {
    if (parametric) {
        // Bilinear map of TextureCoordinates, corners (0,0) (1,0) (0,1) (1,1).
        const float* c = source_.attributes->textureCoordinates;
        auto map = [&](int k, float& f, float& fu, float& fv) {
            float a = c[k], b = c[2 + k], d = c[4 + k], e = c[6 + k];
            float lo = a + (b - a) * p.u, hi = d + (e - d) * p.u;
            f = lo + (hi - lo) * p.v;
            fu = (b - a) * (1 - p.v) + (e - d) * p.v;
            fv = hi - lo;
        };
        map(0, p.s, p.dsdu, p.dsdv);
        map(1, p.t, p.dtdu, p.dtdv);
    } else {
        p.s = p.u;
        p.t = p.v;
        p.dsdu = 1;
        p.dsdv = 0;
        p.dtdu = 0;
        p.dtdv = 1;
    }
    if (varSt_ >= 0) {
        float v[2], du[2], dv[2];
        interpolate(varSt_, p, v, du, dv);
        p.s = v[0];
        p.dsdu = du[0];
        p.dsdv = dv[0];
        p.t = v[1];
        p.dtdu = du[1];
        p.dtdv = dv[1];
    }
    if (varS_ >= 0) interpolate(varS_, p, &p.s, &p.dsdu, &p.dsdv);
    if (varT_ >= 0) interpolate(varT_, p, &p.t, &p.dtdu, &p.dtdv);
    p.N = p.n;
    if (normal_.param) {
        float v[3], du[3], dv[3];
        interpolateVariable(normal_, p, v, du, dv);
        Vec3 q(v[0], v[1], v[2]);
        float l = length(q);
        if (l > 0 && std::isfinite(l)) {
            Vec3 qu(du[0], du[1], du[2]), qv(dv[0], dv[1], dv[2]);
            p.N = q / l;
            p.dNdu = (qu - p.N * dot(p.N, qu)) / l;
            p.dNdv = (qv - p.N * dot(p.N, qv)) / l;
        }
    }
}

Vec3d Shape::localNormal(uint32_t prim, double b1, double b2) const { return Vec3d(evaluateLocal(prim, b1, b2).n); }

namespace {
struct Facet {
    Vec3d P, n;
};
Facet facetAt(const TriMesh& m, uint32_t prim, double b1, double b2) {
    Vec3d a(m.P[m.index[3 * prim]]), b(m.P[m.index[3 * prim + 1]]), c(m.P[m.index[3 * prim + 2]]);
    return {a + (b - a) * b1 + (c - a) * b2, cross(b - a, c - a)};
}
} // namespace

SurfacePoint Shape::evaluateHit(uint32_t prim, double b1, double b2) const {
    SurfacePoint p;
    evaluateHit(prim, b1, b2, p, kNeedAll);
    return p;
}

void Shape::evaluateHit(uint32_t prim, double b1, double b2, SurfacePoint& p, uint32_t needs) const {
    if (meshParam_.empty()) return evaluateLocal(prim, b1, b2, p, needs);
    const uint32_t* i = &mesh_.index[3 * size_t(prim)];
    Vec2 p0 = meshParam_[i[0]], p1 = meshParam_[i[1]], p2 = meshParam_[i[2]];
    double b0 = 1 - b1 - b2;
    const uint32_t local = !meshPrim_.empty() ? meshPrim_[i[0]] : trianglesPerPrim_ ? prim / trianglesPerPrim_ : 0;
    evaluateLocal(local, b0 * p0.x + b1 * p1.x + b2 * p2.x, b0 * p0.y + b1 * p1.y + b2 * p2.y, p, needs);
    Facet f = facetAt(mesh_, prim, b1, b2);
    Vec3d fn = normalize(f.n) * double(orientation_);
    p.displaced = displaced_;
    p.facet = prim;
    p.displacedP = Vec3(f.P);
    p.displacedN = Vec3(fn);
    p.facetError = roundingError(p.displacedP);
    if (displaced_) p.pError = p.facetError;
    else p.pError += float(1.01 * length(Vec3d(p.P) - f.P));
}

void Shape::points(std::span<const HitRef> hits, uint32_t needs) const {
    if (meshParam_.empty()) return localPoints(hits, needs);
    for (const HitRef& h : hits) evaluateHit(h.prim, h.b1, h.b2, *h.out, needs);
}

void Shape::localPoints(std::span<const HitRef> hits, uint32_t needs) const {
    for (const HitRef& h : hits) evaluateLocal(h.prim, h.b1, h.b2, *h.out, needs);
}

Vec3d Shape::hitNormal(uint32_t prim, double b1, double b2) const {
    // Triangles wind as the polygon, or as (u, v): in both cases orientation() turns their normal to Ng's side.
    if (!exact()) return facetAt(mesh_, prim, b1, b2).n * double(orientation_);
    return localNormal(prim, b1, b2);
}

} // namespace alpenglow::geometry
