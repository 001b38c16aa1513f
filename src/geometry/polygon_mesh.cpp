#include "geometry/polygon_mesh.h"
#include "base/limits.h"
#include "geometry/dice.h"
#include "geometry/triangulate.h"
#include <algorithm>
#include <cmath>
#include <numeric>

namespace alpenglow::geometry {

using scene::Class;

ShapeRef makePolygonMesh(ShapeSource s, PolygonInput in, Diagnostics& diag) {
    const scene::Primitive& p = *s.primitive;
    const scene::Param* P = lastParam(p.params, "P");
    auto fail = [&](Rie code, const std::string& why) -> ShapeRef {
        diag.report(Severity::Error, code, p.place, p.kind + ": " + why + "; it is not drawn");
        return nullptr;
    };
    if (!P) return fail(Rie::MissingData, "\"P\" is missing");
    size_t points = P->numbers.size() / 3;
    if (points == 0) return fail(Rie::MissingData, "\"P\" is empty");
    if (points > 0xfffffff0u || in.vertex.size() > 0xfffffff0u) return fail(Rie::Limit, "too many points");
    for (float f : P->numbers)
        if (!std::isfinite(f)) return fail(Rie::Range, "\"P\" holds a number that is not finite");
    // A face with a vertex that does not exist loses its loops, and keeps its place: uniform values are counted by face.
    size_t loop = 0, corner = 0, bad = 0, thin = 0;
    for (int& n : in.loopsPerFace) {
        bool ok = true;
        size_t firstLoop = loop;
        for (int l = 0; l < n; ++l, ++loop) {
            if (l == 0 && in.cornersPerLoop[loop] < 3) ++thin;
            for (int c = 0; c < in.cornersPerLoop[loop]; ++c, ++corner)
                if (in.vertex[corner] < 0 || size_t(in.vertex[corner]) >= points) ok = false;
        }
        if (!ok) {
            ++bad;
            size_t c = corner;
            for (size_t l = loop; l-- > firstLoop;)
                for (int k = 0; k < in.cornersPerLoop[l]; ++k) in.vertex[--c] = -1;
        }
    }
    if (bad)
        diag.report(Severity::Error, Rie::Range, P->place,
                    p.kind + ": " + std::to_string(bad) + " faces use points beyond the " + std::to_string(points) +
                        " given; they are not drawn");
    if (thin)
        diag.report(Severity::Warning, Rie::Range, p.place,
                    p.kind + ": " + std::to_string(thin) + " faces have fewer than three corners; they are not drawn");
    auto mesh = std::make_shared<PolygonMesh>(std::move(s), in, P->numbers, diag);
    if (mesh->empty()) {
        if (!bad && !thin) diag.report(Severity::Warning, Rie::Range, p.place, p.kind + " has no area; it is not drawn");
        return nullptr;
    }
    return mesh;
}

PolygonMesh::PolygonMesh(ShapeSource s, const PolygonInput& in, const std::vector<float>& P, Diagnostics& diag)
    : Shape(std::move(s)) {
    objectP_ = P.data();
    faceCount_ = int(in.loopsPerFace.size());
    uint32_t points = uint32_t(P.size() / 3);
    cameraP_.resize(points);
    for (uint32_t i = 0; i < points; ++i) cameraP_[i] = Vec3(transformPoint(toCamera(), objectPoint(i)));
    cornerVertex_.resize(in.vertex.size());
    for (size_t i = 0; i < in.vertex.size(); ++i) {
        cornerVertex_[i] = in.vertex[i] < 0 ? 0 : uint32_t(in.vertex[i]);
        if (in.vertex[i] >= 0) vertexCount_ = std::max(vertexCount_, uint32_t(in.vertex[i]) + 1);
    }
    faceNormal_.resize(size_t(faceCount_));
    size_t loop = 0, corner = 0, forced = 0;
    std::vector<Vec3d> pts;
    std::vector<uint32_t> tris;
    for (int f = 0; f < faceCount_; ++f) {
        size_t loops = size_t(in.loopsPerFace[size_t(f)]), first = corner;
        pts.clear();
        tris.clear();
        bool ok = true;
        for (size_t l = loop; l < loop + loops; ++l)
            for (int c = 0; c < in.cornersPerLoop[l]; ++c, ++corner) {
                if (in.vertex[corner] < 0) ok = false;
                pts.push_back(objectPoint(cornerVertex_[corner]));
            }
        Vec3d n;
        if (ok && loops > 0) {
            auto r = triangulate(pts, std::span<const int>(&in.cornersPerLoop[loop], loops), tris, n);
            if (r == TriangulationResult::Forced) ++forced;
            for (uint32_t i : tris) corner_.push_back(uint32_t(first) + i);
            face_.insert(face_.end(), tris.size() / 3, uint32_t(f));
        }
        faceNormal_[size_t(f)] = Vec3(normalize(n));
        loop += loops;
    }
    if (forced)
        diag.report(Severity::Warning, Rie::Consistency, place(),
                    kind() + ": the loops of " + std::to_string(forced) +
                        " faces cross or lie outside each other; they are filled as well as possible");
    TriMesh m;
    m.P = cameraP_;
    m.index.reserve(corner_.size());
    double total = 0;
    for (size_t t = 0; t < face_.size(); ++t) {
        for (int k = 0; k < 3; ++k) m.index.push_back(vertexOf(uint32_t(t), k));
        Vec3d a = cameraCorner(uint32_t(t), 0), b = cameraCorner(uint32_t(t), 1), c = cameraCorner(uint32_t(t), 2);
        total += 0.5 * length(cross(b - a, c - a));
        cumulativeArea_.push_back(total);
    }
    m.finish();
    mesh_ = std::move(m);
    takePrimvars(diag);
    plain_ = varS_ < 0 && varT_ < 0 && varSt_ < 0 && !normal_.param;
    constexpr size_t kRemember = 256; // triangles; a plane takes 600 bytes
    if (face_.size() <= kRemember) {
        std::vector<Plane> planes;
        for (uint32_t t = 0; t < face_.size(); ++t) planes.push_back(makePlane(t));
        planes_ = std::move(planes);
    }
}

PolygonMesh::Frame PolygonMesh::frame(int face) const {
    Vec3d n(faceNormal_[size_t(face)]);
    if (std::fabs(n.z) >= 1e-4) return {{1, 0, 0}, {0, 1, 0}};
    Vec3d a = normalize(Vec3d(-n.y, n.x, 0));
    if (std::fabs(a.x) >= std::fabs(a.y) ? a.x < 0 : a.y < 0) a = -a;
    Vec3d b = normalize(cross(n, a));
    if (b.z < 0) b = -b;
    return {a, b};
}

PolygonMesh::Plane PolygonMesh::makePlane(uint32_t tri) const {
    Plane r;
    for (int k = 0; k < 3; ++k) r.p[k] = objectPoint(vertexOf(tri, k));
    Vec3d c = cross(r.p[1] - r.p[0], r.p[2] - r.p[0]), fn(faceNormal_[face_[tri]]);
    r.f = frame(int(face_[tri]));
    const Frame& f = r.f;
    double l = length(c);
    // A sliver's normal is noise, and a bent face may hold a triangle that stands edge-on in its frame: the face's then.
    double longest = std::max({length(r.p[1] - r.p[0]), length(r.p[2] - r.p[1]), length(r.p[0] - r.p[2])});
    r.n = l > 1e-12 * longest * longest ? c / l : fn;
    Vec3d ab = cross(f.a, f.b);
    if (std::fabs(dot(r.n, ab)) < 1e-5) r.n = fn;
    double d = dot(r.n, ab);
    r.Pu = cross(f.b, r.n) / d;
    r.Pv = cross(r.n, f.a) / d;
    Vec3d a = cameraCorner(tri, 0), b3 = cameraCorner(tri, 1), c3 = cameraCorner(tri, 2);
    r.a = a;
    r.e1 = b3 - a;
    r.e2 = c3 - a;
    SurfacePoint& p = r.point;
    p.face = int(face_[tri]);
    p.prim = tri;
    Vec3d Pu = transformVector(toCamera(), r.Pu), Pv = transformVector(toCamera(), r.Pv);
    p.dPdu = Vec3(Pu);
    p.dPdv = Vec3(Pv);
    // Ng = sign * dPdu ^ dPdv must lie where the winding points; the corners' cross product is the winding in camera space.
    Vec3d g = cross(Pu, Pv), wind = cross(r.e1, r.e2);
    double along = dot(g, wind);
    if (along == 0) along = dot(transformNormal(toCamera(), fn), g) * determinant3(toCamera());
    p.orientation = along < 0 ? -orientation_ : orientation_;
    p.Ng = Vec3(g * double(p.orientation));
    // Rays meet the rounded triangle: its own normal, unless it is too thin to have one.
    double lw = length(wind), longestSide = std::max({length(r.e1), length(c3 - b3), length(r.e2)});
    p.n = Vec3(lw > 1e-6 * longestSide * longestSide ? wind / lw * double(orientation_) : normalize(g) * double(p.orientation));
    p.N = p.n;
    return r;
}

void PolygonMesh::evaluateLocal(uint32_t tri, double b1, double b2, SurfacePoint& p) const {
    Plane room;
    const Plane& q = plane(tri, room);
    p = q.point;
    p.b1 = b1;
    p.b2 = b2;
    Vec3d P = q.a + q.e1 * b1 + q.e2 * b2, O = q.p[0] + (q.p[1] - q.p[0]) * b1 + (q.p[2] - q.p[0]) * b2;
    p.P = Vec3(P);
    p.u = float(dot(O, q.f.a));
    p.v = float(dot(O, q.f.b));
    p.pError = roundingError(p.P);
    if (plain_) { // what finishPoint does then; N is there
        p.s = p.u;
        p.t = p.v;
    } else finishPoint(p, false);
}

SurfacePoint PolygonMesh::evaluateLocal(uint32_t tri, double b1, double b2) const {
    SurfacePoint p;
    evaluateLocal(tri, b1, b2, p);
    return p;
}

SurfacePoint PolygonMesh::evaluate(int face, double u, double v) const {
    // The triangle of the face that holds (u, v), or the one that it misses least.
    auto range = std::equal_range(face_.begin(), face_.end(), uint32_t(std::max(0, face)));
    if (range.first == range.second) range = {face_.begin(), face_.begin() + 1};
    double best = INFINITY, b1 = 0, b2 = 0;
    uint32_t tri = uint32_t(range.first - face_.begin());
    for (auto it = range.first; it != range.second; ++it) {
        uint32_t t = uint32_t(it - face_.begin());
        Frame f = frame(int(*it));
        Vec3d p[3];
        for (int k = 0; k < 3; ++k) p[k] = objectPoint(vertexOf(t, k));
        double x1 = dot(p[1] - p[0], f.a), y1 = dot(p[1] - p[0], f.b), x2 = dot(p[2] - p[0], f.a), y2 = dot(p[2] - p[0], f.b);
        double x = u - dot(p[0], f.a), y = v - dot(p[0], f.b), d = x1 * y2 - x2 * y1;
        if (d == 0) continue;
        double s = (x * y2 - x2 * y) / d, r = (x1 * y - x * y1) / d;
        double out = std::max({-s, -r, s + r - 1, 0.0});
        if (out < best) best = out, tri = t, b1 = s, b2 = r;
        if (out == 0) break;
    }
    return evaluateLocal(tri, b1, b2);
}

void PolygonMesh::sampleArea(double xi1, double xi2, SurfacePoint& out) const {
    double target = xi1 * area();
    size_t t = size_t(std::upper_bound(cumulativeArea_.begin(), cumulativeArea_.end(), target) - cumulativeArea_.begin());
    t = std::min(t, cumulativeArea_.size() - 1);
    // What is left of the first number is uniform again within the triangle.
    double lo = t ? cumulativeArea_[t - 1] : 0, size = cumulativeArea_[t] - lo;
    double x = size > 0 ? std::clamp((target - lo) / size, 0.0, 1.0) : 0.5, root = std::sqrt(x);
    evaluateLocal(uint32_t(t), root * (1 - xi2), root * xi2, out);
}

SurfacePoint PolygonMesh::sampleArea(double xi1, double xi2) const {
    SurfacePoint p;
    sampleArea(xi1, xi2, p);
    return p;
}

double PolygonMesh::sampleDensity(const SurfacePoint&) const { return area() > 0 ? 1 / area() : 0; }

size_t PolygonMesh::classCount(Class c) const {
    switch (c) {
    case Class::Constant: return 1;
    case Class::Uniform: return size_t(faceCount_);
    case Class::FaceVarying:
    case Class::FaceVertex: return cornerVertex_.size();
    default: return vertexCount_;
    }
}

int PolygonMesh::weights(Class c, const SurfacePoint& p, Weight w[16]) const {
    if (c == Class::Constant || c == Class::Uniform) {
        w[0] = {c == Class::Uniform ? size_t(p.face) : 0, 1, 0, 0};
        return 1;
    }
    Plane room;
    const Plane& q = plane(p.prim, room);
    // Barycentric weights are linear in the plane: their gradients along Pu and Pv.
    Vec3d e1 = q.p[1] - q.p[0], e2 = q.p[2] - q.p[0], n = cross(e1, e2);
    double l = dot(n, n);
    auto slope = [&](const Vec3d& d, double& d1, double& d2) {
        d1 = l > 0 ? dot(cross(d, e2), n) / l : 0;
        d2 = l > 0 ? dot(cross(e1, d), n) / l : 0;
    };
    double u1, u2, v1, v2;
    slope(q.Pu, u1, u2);
    slope(q.Pv, v1, v2);
    bool byCorner = c == Class::FaceVarying || c == Class::FaceVertex;
    auto index = [&](int k) { return byCorner ? size_t(corner_[3 * size_t(p.prim) + size_t(k)]) : size_t(vertexOf(p.prim, k)); };
    w[0] = {index(0), 1 - p.b1 - p.b2, -u1 - u2, -v1 - v2};
    w[1] = {index(1), p.b1, u1, v1};
    w[2] = {index(2), p.b2, u2, v2};
    return 3;
}

void PolygonMesh::dice(const DiceOptions& opt, Diagnostics& diag) {
    if (!isDisplaced(*this, opt)) return;
    // Every triangle is cut alike, so that neighbours within the primitive meet without cracks.
    double edge = diceEdge(*source_.attributes), longest = 1;
    for (uint32_t t = 0; t < face_.size(); ++t)
        for (int k = 0; k < 3; ++k) {
            Vec3d a = cameraCorner(t, k), b = cameraCorner(t, (k + 1) % 3);
            longest = std::max(longest, opt.camera.pixels((a + b) * 0.5, b - a) / edge);
        }
    double cap = std::sqrt(2.0 * double(limits::kDiceQuads) / double(face_.size()));
    uint32_t n = uint32_t(std::clamp(std::ceil(longest), 1.0, std::clamp(std::floor(cap), 1.0, double(limits::kDiceEdge))));
    if (longest > n)
        diag.report(Severity::Info, Rie::Limit, place(),
                    kind() + " would need more than " + std::to_string(limits::kDiceQuads) +
                        " micropolygons; it is diced more coarsely");
    uint32_t perTri = (n + 1) * (n + 2) / 2;
    auto row = [&](uint32_t j) { return j * (n + 1) - j * (j - 1) / 2; }; // first vertex of row j, rows shrink by one
    TriMesh m;
    std::vector<Vec2> param;
    for (uint32_t t = 0; t < face_.size(); ++t) {
        uint32_t base = t * perTri;
        for (uint32_t j = 0; j <= n; ++j)
            for (uint32_t i = 0; i + j <= n; ++i) {
                param.push_back({float(double(i) / n), float(double(j) / n)});
                Vec3d a = cameraCorner(t, 0), b = cameraCorner(t, 1), c = cameraCorner(t, 2);
                m.P.push_back(Vec3((a * double(n - i - j) + b * double(i) + c * double(j)) / double(n)));
            }
        for (uint32_t j = 0; j < n; ++j)
            for (uint32_t i = 0; i + j < n; ++i) {
                uint32_t a = base + row(j) + i, c = base + row(j + 1) + i;
                m.index.insert(m.index.end(), {a, a + 1, c});
                if (i + j + 1 < n) m.index.insert(m.index.end(), {a + 1, c + 1, c});
            }
    }
    meshParam_ = std::move(param);
    trianglesPerPrim_ = n * n;
    displaced_ = true;
    float step = float(1.0 / n);
    displaceMesh(*this, opt, diag,
                 [&](uint32_t i) { return evaluateLocal(i / perTri, meshParam_[i].x, meshParam_[i].y); },
                 [&](uint32_t i) {
                     // A barycentric step turned to u and v: the extent of one micro-triangle.
                     uint32_t t = i / perTri;
                     Frame f = frame(int(face_[t]));
                     Vec3d a = objectPoint(vertexOf(t, 0)), e1 = objectPoint(vertexOf(t, 1)) - a,
                           e2 = objectPoint(vertexOf(t, 2)) - a;
                     auto extent = [&](const Vec3d& d) {
                         return float(std::max({std::fabs(dot(e1, d)), std::fabs(dot(e2, d)), 1e-12}));
                     };
                     return Vec2{extent(f.a) * step, extent(f.b) * step};
                 }, m);
    m.finish();
    mesh_ = std::move(m);
}

} // namespace alpenglow::geometry
