#include "geometry/polygon_mesh.h"
#include "geometry/triangulate.h"
#include <algorithm>
#include <cmath>

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
    // A face with a missing vertex loses its loops but keeps its index, because uniform values are counted by face.
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
    auto mesh = std::make_shared<PolygonMesh>(std::move(s), std::move(in), P->numbers, diag);
    if (mesh->empty()) {
        if (!bad && !thin) diag.report(Severity::Warning, Rie::Range, p.place, p.kind + " has no area; it is not drawn");
        return nullptr;
    }
    return mesh;
}

PolygonMesh::PolygonMesh(ShapeSource s, PolygonInput&& in, const std::vector<float>& P, Diagnostics& diag) : Shape(std::move(s)) {
    objectP_ = P.data();
    faceCount_ = int(in.loopsPerFace.size());
    cornerCount_ = uint32_t(in.vertex.size());
    for (int& v : in.vertex)
        if (v >= 0) vertexCount_ = std::max(vertexCount_, uint32_t(v) + 1);
    const auto* like = dynamic_cast<const PolygonMesh*>(source_.like);
    source_.like = nullptr;
    if (like) cutAlike(*like, in);
    else if (!takeTriangles(in)) cutFaces(in, diag);
    in = {}; // frees memory for the following
    triangles_ = mesh_.triangles();
    const uint32_t points = uint32_t(P.size() / 3);
    mesh_.P.reserve(points + 1);
    for (uint32_t i = 0; i < points; ++i) mesh_.P.push_back(Vec3(transformPoint(toCamera(), objectPoint(i))));
    mesh_.finish();
    takePrimvars(diag);
    plain_ = varS_ < 0 && varT_ < 0 && varSt_ < 0 && !normal_.param;
    constexpr size_t kRemember = 256; // triangles of 700 bytes each
    if (triangles_ <= kRemember) remember();
}

/// The usual large mesh of valid triangles only: it needs no lists of corners and faces.
bool PolygonMesh::takeTriangles(const PolygonInput& in) {
    const size_t n = in.loopsPerFace.size();
    if (in.cornersPerLoop.size() != n || in.vertex.size() != 3 * n) return false;
    for (size_t f = 0; f < n; ++f) {
        if (in.loopsPerFace[f] != 1 || in.cornersPerLoop[f] != 3 || in.vertex[3 * f] < 0) return false;
        const Vec3d a = objectPoint(uint32_t(in.vertex[3 * f])), e1 = objectPoint(uint32_t(in.vertex[3 * f + 1])) - a,
                    e2 = objectPoint(uint32_t(in.vertex[3 * f + 2])) - a, c = cross(e1, e2);
        // Well within what triangulate() accepts.
        const double longest = std::max(dot(e1, e1), dot(e2, e2));
        if (!(dot(c, c) > 1e-12 * longest * longest)) return false;
    }
    // Corners of the request and of the triangles are the same, so large lists are stored once.
    if (in.kept.size() >= 3 * n) mesh_.index = {reinterpret_cast<const uint32_t*>(in.kept.data()), 3 * n};
    else mesh_.made.assign(in.vertex.begin(), in.vertex.end()), mesh_.index = mesh_.made;
    return true;
}

void PolygonMesh::cutFaces(const PolygonInput& in, Diagnostics& diag) {
    faceNormal_.resize(size_t(faceCount_));
    size_t loop = 0, corner = 0, forced = 0;
    std::vector<Vec3d> pts;
    std::vector<uint32_t> tris;
    const auto vertex = [&](size_t c) { return uint32_t(std::max(0, in.vertex[c])); };
    for (int f = 0; f < faceCount_; ++f) {
        size_t loops = size_t(in.loopsPerFace[size_t(f)]), first = corner;
        pts.clear();
        tris.clear();
        bool ok = true;
        for (size_t l = loop; l < loop + loops; ++l)
            for (int c = 0; c < in.cornersPerLoop[l]; ++c, ++corner) {
                if (in.vertex[corner] < 0) ok = false;
                pts.push_back(objectPoint(vertex(corner)));
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
                        " faces have loops that cross or are outside each other; they are filled approximately");
    mesh_.made.reserve(corner_.size());
    for (uint32_t c : corner_) mesh_.made.push_back(vertex(c));
    mesh_.index = mesh_.made;
}

void PolygonMesh::cutAlike(const PolygonMesh& like, const PolygonInput& in) {
    mesh_.made.assign(like.base().index.begin(), like.base().index.end());
    mesh_.index = mesh_.made;
    corner_ = like.corner_;
    face_ = like.face_;
    if (like.faceNormal_.empty()) return;
    faceNormal_.resize(size_t(faceCount_));
    size_t loop = 0, corner = 0;
    for (int f = 0; f < faceCount_; ++f) {
        // Twice the area of the outer loop, as a vector (Newell).
        Vec3d n;
        const size_t first = corner;
        for (int l = 0; l < in.loopsPerFace[size_t(f)]; ++l, ++loop) corner += size_t(in.cornersPerLoop[loop]);
        const size_t outer =
            in.loopsPerFace[size_t(f)] > 0 ? size_t(in.cornersPerLoop[loop - size_t(in.loopsPerFace[size_t(f)])]) : 0;
        const auto at = [&](size_t c) { return objectPoint(uint32_t(std::max(0, in.vertex[first + c % outer]))); };
        for (size_t c = 0; c < outer; ++c) n += cross(at(c) - at(0), at(c + 1) - at(0));
        faceNormal_[size_t(f)] = dot(n, n) > 0 ? Vec3(normalize(n)) : like.faceNormal_[size_t(f)];
    }
}

/// Whether a face with this normal, of any length, has u and v along x and y.
static bool looksAlongZ(const Vec3d& n) { return n.z * n.z >= 1e-8 * dot(n, n); }

Vec3d PolygonMesh::faceNormal(uint32_t tri) const {
    if (!faceNormal_.empty()) return Vec3d(faceNormal_[faceOf(tri)]);
    const Vec3d o = objectPoint(vertexOf(tri, 0));
    return normalize(cross(objectPoint(vertexOf(tri, 1)) - o, objectPoint(vertexOf(tri, 2)) - o));
}

PolygonMesh::Frame PolygonMesh::frame(const Vec3d& n) const {
    if (looksAlongZ(n)) return {{1, 0, 0}, {0, 1, 0}};
    Vec3d a = normalize(Vec3d(-n.y, n.x, 0));
    if (std::fabs(a.x) >= std::fabs(a.y) ? a.x < 0 : a.y < 0) a = -a;
    Vec3d b = normalize(cross(n, a));
    if (b.z < 0) b = -b;
    return {a, b};
}

PolygonMesh::Plane PolygonMesh::planeOf(uint32_t tri) const {
    Plane r;
    r.o = objectPoint(vertexOf(tri, 0));
    r.e1 = objectPoint(vertexOf(tri, 1)) - r.o;
    r.e2 = objectPoint(vertexOf(tri, 2)) - r.o;
    const Vec3d c = cross(r.e1, r.e2), e3 = r.e2 - r.e1;
    const double area = dot(c, c), longest = std::max({dot(r.e1, r.e1), dot(r.e2, r.e2), dot(e3, e3)});
    // The normal of a sliver is noise, and a bent face may contain a triangle perpendicular to its frame: uses the face's normal.
    const bool sliver = !(area > 1e-24 * longest * longest);
    const Vec3d face = faceNormal_.empty() ? c : Vec3d(faceNormal_[faceOf(tri)]);
    if (!sliver && looksAlongZ(face) && c.z * c.z >= 1e-10 * area) { // the usual case: u and v are x and y
        const double inverse = 1 / c.z;
        r.f = {{1, 0, 0}, {0, 1, 0}};
        r.Pu = {1, 0, -c.x * inverse};
        r.Pv = {0, 1, -c.y * inverse};
        r.u1 = r.e2.y * inverse;
        r.u2 = -r.e1.y * inverse;
        r.v1 = -r.e2.x * inverse;
        r.v2 = r.e1.x * inverse;
        return r;
    }
    const Vec3d fn = faceNormal(tri);
    r.f = frame(fn);
    const Vec3d ab = cross(r.f.a, r.f.b);
    Vec3d n = sliver ? fn : c / std::sqrt(area);
    if (std::fabs(dot(n, ab)) < 1e-5) n = fn;
    const double d = dot(n, ab);
    r.Pu = cross(r.f.b, n) / d;
    r.Pv = cross(n, r.f.a) / d;
    // Barycentric weights are linear in the plane: their gradients along Pu and Pv.
    const auto slope = [&](const Vec3d& along, double& d1, double& d2) {
        d1 = area > 0 ? dot(cross(along, r.e2), c) / area : 0;
        d2 = area > 0 ? dot(cross(r.e1, along), c) / area : 0;
    };
    slope(r.Pu, r.u1, r.u2);
    slope(r.Pv, r.v1, r.v2);
    return r;
}

SurfacePoint PolygonMesh::evaluate(int face, double u, double v) const {
    // The triangle of the face that contains (u, v), or the nearest one.
    uint32_t first = uint32_t(std::clamp(face, 0, int(triangles_) - 1)), last = first + 1;
    if (!face_.empty()) {
        auto range = std::equal_range(face_.begin(), face_.end(), uint32_t(std::max(0, face)));
        if (range.first == range.second) range = {face_.begin(), face_.begin() + 1};
        first = uint32_t(range.first - face_.begin());
        last = uint32_t(range.second - face_.begin());
    }
    double best = INFINITY, b1 = 0, b2 = 0;
    uint32_t tri = first;
    for (uint32_t t = first; t < last; ++t) {
        Frame f = frame(faceNormal(t));
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

const PolygonMesh::Areas& PolygonMesh::areas() const {
    std::call_once(areas_.made, [&] {
        areas_.cumulative.reserve(triangles_);
        for (uint32_t t = 0; t < triangles_; ++t) {
            const Vec3d a = cameraCorner(t, 0), b = cameraCorner(t, 1), c = cameraCorner(t, 2);
            areas_.cumulative.push_back(areas_.sum += 0.5 * length(cross(b - a, c - a)));
        }
        areas_.perSum = areas_.sum > 0 ? 1 / areas_.sum : 0;
        areas_.first.reserve(triangles_);
        for (uint32_t k = 0, t = 0; k < triangles_; ++k) {
            while (t + 1 < triangles_ && areas_.cumulative[t] <= areas_.sum * k / triangles_) ++t;
            areas_.first.push_back(t);
        }
    });
    return areas_;
}

void PolygonMesh::sampleArea(double xi1, double xi2, SurfacePoint& out, uint32_t needs) const {
    const Areas& all = areas();
    const double target = xi1 * all.sum;
    // The first triangle whose cumulative area exceeds the target.
    size_t t = 0;
    if (constexpr uint32_t kFew = 4; triangles_ <= kFew) { // unpredictable: avoids a branch
        for (uint32_t k = 0; k + 1 < triangles_; ++k) t += all.cumulative[k] <= target;
    } else { // starts near the right entry
        t = all.first[std::min(size_t(xi1 * double(triangles_)), size_t(triangles_) - 1)];
        while (t > 0 && all.cumulative[t - 1] > target) --t;
        while (t + 1 < triangles_ && all.cumulative[t] <= target) ++t;
    }
    // The remainder of the first number is uniform within the triangle.
    double lo = t ? all.cumulative[t - 1] : 0, size = all.cumulative[t] - lo;
    double x = size > 0 ? std::clamp((target - lo) / size, 0.0, 1.0) : 0.5, root = std::sqrt(x);
    evaluateLocal(uint32_t(t), root * (1 - xi2), root * xi2, out, needs);
}

SurfacePoint PolygonMesh::sampleArea(double xi1, double xi2) const {
    SurfacePoint p;
    sampleArea(xi1, xi2, p, kNeedAll);
    return p;
}

double PolygonMesh::sampleDensity(const SurfacePoint&) const { return areas().perSum; }

size_t PolygonMesh::classCount(Class c) const {
    switch (c) {
    case Class::Constant:
        return 1;
    case Class::Uniform:
        return size_t(faceCount_);
    case Class::FaceVarying:
    case Class::FaceVertex:
        return cornerCount_;
    default:
        return vertexCount_;
    }
}

int PolygonMesh::weights(Class c, const SurfacePoint& p, Weight w[16]) const {
    if (c == Class::Constant || c == Class::Uniform) {
        w[0] = {c == Class::Uniform ? size_t(p.face) : 0, 1, 0, 0};
        return 1;
    }
    const Plane q = remembered_.empty() ? planeOf(p.prim) : remembered_[p.prim].plane;
    bool byCorner = c == Class::FaceVarying || c == Class::FaceVertex;
    auto index = [&](int k) { return size_t(byCorner ? cornerOf(p.prim, k) : vertexOf(p.prim, k)); };
    w[0] = {index(0), 1 - p.b1 - p.b2, -q.u1 - q.u2, -q.v1 - q.v2};
    w[1] = {index(1), p.b1, q.u1, q.v1};
    w[2] = {index(2), p.b2, q.u2, q.v2};
    return 3;
}

} // namespace alpenglow::geometry
