// What the four polygon requests share: faces of one or more loops over common vertices, cut into triangles.
//
// u, v and the default s, t are the object-space x and y of the point (ri.md 7.1). A face that stands edge-on to z (its unit
// normal's z below 1e-4) uses an orthonormal frame of its plane instead: u along the horizontal direction in the plane, v up
// the plane towards +z. dPdu, dPdv are the exact partials in the plane of the triangle.
#pragma once
#include "geometry/shape.h"
#include <mutex>

namespace alpenglow::geometry {

/// Faces as index lists; all counts are trusted, makePolygonMesh checks them.
struct PolygonInput {
    std::vector<int> loopsPerFace;   ///< per face
    std::vector<int> cornersPerLoop; ///< per loop
    std::vector<int> vertex;         ///< per corner
};

/// Checks the input against "P", reports what is wrong, drops faulty faces; null when nothing is left.
ShapeRef makePolygonMesh(ShapeSource, PolygonInput, Diagnostics&);

class PolygonMesh final : public Shape {
public:
    PolygonMesh(ShapeSource, const PolygonInput&, const std::vector<float>& P, Diagnostics&);
    bool empty() const { return corner_.empty(); }
    int faces() const override { return faceCount_; }
    SurfacePoint evaluate(int face, double u, double v) const override;
    double area() const override { return cumulativeArea_.empty() ? 0 : cumulativeArea_.back(); }
    SurfacePoint sampleArea(double xi1, double xi2) const override;
    void sampleArea(double xi1, double xi2, SurfacePoint& out) const override;
    double sampleDensity(const SurfacePoint&) const override;
    void dice(const DiceOptions&, Diagnostics&) override;

protected:
    size_t classCount(scene::Class) const override;
    int weights(scene::Class, const SurfacePoint&, Weight w[16]) const override;
    SurfacePoint evaluateLocal(uint32_t prim, double b1, double b2) const override;
    void evaluateLocal(uint32_t prim, double b1, double b2, SurfacePoint& out) const override;

private:
    struct Frame { Vec3d a, b; };  ///< u = P.a, v = P.b (object space)
    /// What does not depend on the place in a triangle: object and camera space.
    struct Plane { Vec3d p[3]; Vec3d n; Vec3d Pu, Pv; Frame f; Vec3d a, e1, e2; SurfacePoint point; };
    Frame frame(int face) const;
    Plane makePlane(uint32_t prim) const;
    const Plane& plane(uint32_t prim, Plane& room) const { return planes_.empty() ? room = makePlane(prim) : planes_[prim]; }
    Vec3d objectPoint(uint32_t vertex) const {
        return {objectP_[3 * vertex], objectP_[3 * vertex + 1], objectP_[3 * vertex + 2]};
    }
    uint32_t vertexOf(uint32_t tri, int k) const { return cornerVertex_[corner_[3 * size_t(tri) + size_t(k)]]; }
    Vec3d cameraCorner(uint32_t tri, int k) const { return Vec3d(cameraP_[vertexOf(tri, k)]); }

    const float* objectP_ = nullptr;          ///< the request's own P
    uint32_t vertexCount_ = 0;
    int faceCount_ = 0;
    std::vector<uint32_t> cornerVertex_;      ///< per corner of the request: its vertex
    std::vector<uint32_t> corner_;            ///< three per triangle: corners of the request
    std::vector<uint32_t> face_;              ///< per triangle
    std::vector<Vec3> faceNormal_;            ///< per face, object space, unit, by winding
    std::vector<Vec3> cameraP_;               ///< per vertex
    bool plain_ = false;                      ///< no variable gives s, t or N
    std::vector<Plane> planes_;               ///< per triangle of small meshes, which are hit often; else empty
    std::vector<double> cumulativeArea_;      ///< per triangle, camera space
};

} // namespace alpenglow::geometry
