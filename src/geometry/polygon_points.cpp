// Surface points of hits on polygons: computes only what is needed, and prefetches memory.
#include "geometry/polygon_mesh.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::geometry {

using scene::Class;

void PolygonMesh::setPartials(uint32_t tri, const Plane& q, const Vec3d& wind, SurfacePoint& p) const {
    const Vec3d Pu = transformVector(toCamera(), q.Pu), Pv = transformVector(toCamera(), q.Pv);
    p.dPdu = Vec3(Pu);
    p.dPdv = Vec3(Pv);
    // Ng = sign * dPdu ^ dPdv must be on the side of the winding; the corners' cross product is the winding in camera space.
    const Vec3d g = cross(Pu, Pv);
    double along = dot(g, wind);
    if (along == 0) along = dot(transformNormal(toCamera(), faceNormal(tri)), g) * determinant3(toCamera());
    p.orientation = along < 0 ? -orientation_ : orientation_;
    p.Ng = Vec3(g * double(p.orientation));
}

void PolygonMesh::setVariables(SurfacePoint& p, const Plane* q, uint32_t needs) const {
    Weight w[3] = {{0, 1 - p.b1 - p.b2}, {0, p.b1}, {0, p.b2}};
    if (q) w[0].du = -q->u1 - q->u2, w[1].du = q->u1, w[2].du = q->u2, w[0].dv = -q->v1 - q->v2, w[1].dv = q->v1, w[2].dv = q->v2;
    // One component of a variable, and its derivatives if the triangle's plane is known.
    const auto mix = [&](const PrimVar& var, const uint32_t at[3], int width, int component, float& f, float* du, float* dv) {
        double x = 0, xu = 0, xv = 0;
        const float* data = var.data() + component;
        for (int k = 0; k < 3; ++k) {
            const double value = data[size_t(at[k]) * size_t(width)];
            x += w[k].w * value;
            if (q) xu += w[k].du * value, xv += w[k].dv * value;
        }
        f = float(x);
        if (q) *du = float(xu), *dv = float(xv);
    };
    uint32_t at[3];
    const auto places = [&](Class c) {
        for (int k = 0; k < 3; ++k)
            at[k] = c == Class::Constant                                ? 0
                    : c == Class::Uniform                               ? uint32_t(p.face)
                    : c == Class::FaceVarying || c == Class::FaceVertex ? cornerOf(p.prim, k)
                                                                        : vertexOf(p.prim, k);
    };
    if (needs & (kNeedST | kNeedSTSlopes)) {
        if (varSt_ >= 0) {
            const PrimVar& st = primvars_[size_t(varSt_)];
            places(st.cls);
            mix(st, at, 2, 0, p.s, &p.dsdu, &p.dsdv);
            mix(st, at, 2, 1, p.t, &p.dtdu, &p.dtdv);
        }
        if (varS_ >= 0) places(primvars_[size_t(varS_)].cls), mix(primvars_[size_t(varS_)], at, 1, 0, p.s, &p.dsdu, &p.dsdv);
        if (varT_ >= 0) places(primvars_[size_t(varT_)].cls), mix(primvars_[size_t(varT_)], at, 1, 0, p.t, &p.dtdu, &p.dtdv);
    }
    if (!normal_.param || !(needs & (kNeedN | kNeedNormalSlopes))) return;
    Vec3 n, nu, nv;
    places(normal_.cls);
    for (int k = 0; k < 3; ++k) mix(normal_, at, 3, k, n[k], &nu[k], &nv[k]);
    const float l = length(n);
    if (!(l > 0) || !std::isfinite(l)) return;
    p.N = n / l;
    if (!q) return;
    p.dNdu = (nu - p.N * dot(p.N, nu)) / l;
    p.dNdv = (nv - p.N * dot(p.N, nv)) / l;
}

void PolygonMesh::remember() {
    std::vector<Remembered> all(triangles_);
    for (uint32_t t = 0; t < triangles_; ++t) {
        Remembered& r = all[t];
        r.plane = planeOf(t);
        r.a = cameraCorner(t, 0);
        r.e1 = cameraCorner(t, 1) - r.a;
        r.e2 = cameraCorner(t, 2) - r.a;
        evaluateLocal(t, 0, 0, r.point, kNeedAll);
        r.point.N = r.point.n; // of the triangle; variables are evaluated for each point
        r.point.dNdu = r.point.dNdv = Vec3();
        r.point.dsdu = r.point.dtdv = 1;
        r.point.dsdv = r.point.dtdu = 0;
    }
    remembered_ = std::move(all);
}

void PolygonMesh::evaluateRemembered(uint32_t tri, double b1, double b2, SurfacePoint& p, uint32_t needs) const {
    const Remembered& q = remembered_[tri];
    p = q.point;
    p.b1 = b1;
    p.b2 = b2;
    p.P = Vec3(q.a + q.e1 * b1 + q.e2 * b2);
    p.pError = roundingError(p.P);
    if (plain_ && !(needs & (kNeedUV | kNeedST))) return;
    const Vec3d O = q.plane.o + q.plane.e1 * b1 + q.plane.e2 * b2;
    p.u = p.s = float(dot(O, q.plane.f.a));
    p.v = p.t = float(dot(O, q.plane.f.b));
    if (!plain_) setVariables(p, &q.plane, kNeedAll);
}

void PolygonMesh::evaluateLocal(uint32_t tri, double b1, double b2, SurfacePoint& p, uint32_t needs) const {
    if (!remembered_.empty()) return evaluateRemembered(tri, b1, b2, p, needs);
    static const SurfacePoint kBlank;
    p = kBlank; // unneeded members are the same in every run
    p.face = int(faceOf(tri));
    p.prim = tri;
    p.b1 = b1;
    p.b2 = b2;
    const uint32_t* v = &base().index[3 * size_t(tri)];
    const Vec3* corners = base().P.data();
    const Vec3d a(corners[v[0]]), e1 = Vec3d(corners[v[1]]) - a, e2 = Vec3d(corners[v[2]]) - a;
    p.P = Vec3(a + e1 * b1 + e2 * b2);
    p.pError = roundingError(p.P);
    // Rays hit the rounded triangle: uses its own normal, unless it is degenerate.
    const Vec3d wind = cross(e1, e2), e3 = e2 - e1;
    const double area = dot(wind, wind), longest = std::max({dot(e1, e1), dot(e2, e2), dot(e3, e3)});
    const bool thin = !(area > 1e-12 * longest * longest);
    if (!thin) p.n = Vec3(wind * (double(orientation_) / std::sqrt(area)));
    uint32_t inPlane = kNeedPartials | kNeedNg | kNeedUV;
    if (varSt_ < 0 && (varS_ < 0 || varT_ < 0)) inPlane |= kNeedST;
    if (!plain_) inPlane |= kNeedSTSlopes | (normal_.param ? kNeedNormalSlopes : 0);
    if (thin) needs |= kNeedPartials;
    if (needs & inPlane) {
        const Plane q = planeOf(tri);
        const Vec3d O = q.o + q.e1 * b1 + q.e2 * b2;
        p.u = p.s = float(dot(O, q.f.a));
        p.v = p.t = float(dot(O, q.f.b));
        if (needs & (kNeedPartials | kNeedNg)) setPartials(tri, q, wind, p);
        if (thin)
            p.n = Vec3(normalize(cross(transformVector(toCamera(), q.Pu), transformVector(toCamera(), q.Pv))) *
                       double(p.orientation));
        p.N = p.n;
        if (!plain_) setVariables(p, &q, needs);
        return;
    }
    p.N = p.n;
    if (!plain_) setVariables(p, nullptr, needs);
}

void PolygonMesh::cornerParameters(uint32_t tri, SurfacePoint out[3]) const {
    const Plane q = remembered_.empty() ? planeOf(tri) : remembered_[tri].plane;
    for (int k = 0; k < 3; ++k) {
        SurfacePoint& p = out[k];
        p.face = int(faceOf(tri));
        p.prim = tri;
        p.b1 = k == 1;
        p.b2 = k == 2;
        const Vec3d O = q.o + q.e1 * p.b1 + q.e2 * p.b2;
        p.u = p.s = float(dot(O, q.f.a));
        p.v = p.t = float(dot(O, q.f.b));
        if (!plain_) setVariables(p, &q, kNeedST);
    }
}

void PolygonMesh::localPoints(std::span<const HitRef> hits, uint32_t needs) const {
    // Prefetch distances that cover memory latency: first the indices of a triangle, then its vertices.
    constexpr size_t kIndices = 12, kCorners = 6;
    const bool large = remembered_.empty(), object = (needs & (kNeedPartials | kNeedNg | kNeedUV)) != 0;
    const TriMesh& m = base();
    for (size_t i = 0; i < hits.size(); ++i) {
        if (large && i + kIndices < hits.size()) __builtin_prefetch(&m.index[3 * size_t(hits[i + kIndices].prim)]);
        if (large && i + kCorners < hits.size())
            for (int k = 0; k < 3; ++k) {
                const uint32_t v = m.index[3 * size_t(hits[i + kCorners].prim) + size_t(k)];
                __builtin_prefetch(&m.P[v]);
                if (object) __builtin_prefetch(&objectP_[3 * size_t(v)]);
            }
        evaluateLocal(hits[i].prim, hits[i].b1, hits[i].b2, *hits[i].out, needs);
    }
}

SurfacePoint PolygonMesh::evaluateLocal(uint32_t tri, double b1, double b2) const {
    SurfacePoint p;
    evaluateLocal(tri, b1, b2, p, kNeedAll);
    return p;
}

} // namespace alpenglow::geometry
