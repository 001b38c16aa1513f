// What the four polygon requests share: faces of one or more loops over common vertices, cut into triangles.
//
// u, v and the default s, t are the object-space x and y of the point (RISpec 3.2, 5.1). A face that is edge-on to z (its unit
// normal's z below 1e-4) uses an orthonormal frame of its plane instead: u along the horizontal direction in the plane, v up
// the plane towards +z. dPdu, dPdv are the exact partials in the plane of the triangle.
#pragma once
#include "geometry/faceplace.h"
#include <mutex>
#include <span>

namespace alpenglow::geometry {

/// Faces as index lists; all counts are trusted, makePolygonMesh checks them.
struct PolygonInput {
    std::vector<int> loopsPerFace;   ///< per face
    std::vector<int> cornersPerLoop; ///< per loop
    std::vector<int> vertex;         ///< per corner
    std::span<const int> kept;       ///< empty, or the list that `vertex` was copied from, which lives as long as the primitive
};

/// Checks the input against "P", reports errors, drops invalid faces; returns null if none are left.
ShapeRef makePolygonMesh(ShapeSource, PolygonInput, Diagnostics&);

/// The shape of the four requests.
class PolygonMesh final : public Shape {
public:
    /// Moves the lists of the input, to free their memory early.
    PolygonMesh(ShapeSource, PolygonInput&&, const std::vector<float>& P, Diagnostics&);
    /// There is no triangle.
    bool empty() const { return triangles_ == 0; }
    /// No variable supplies s, t or N: normals are those of the triangles.
    bool plain() const { return plain_; }
    int faces() const override { return faceCount_; }
    SurfacePoint evaluate(int face, double u, double v) const override;
    double area() const override { return areas().sum; }
    SurfacePoint sampleArea(double xi1, double xi2) const override;
    void sampleArea(double xi1, double xi2, SurfacePoint& out, uint32_t needs) const override;
    double sampleDensity(const SurfacePoint&) const override;
    void dice(const DiceOptions&, Diagnostics&) override;
    /// u, v, s and t at the corners of a triangle, before dicing: as evaluateHit() there.
    void cornerParameters(uint32_t tri, SurfacePoint out[3]) const;
    /// facePlace() of a point of a triangle of the undiced mesh. Returns false if its face has more than four corners. Defined in
    /// faceplace.cpp.
    bool placeOnFace(uint32_t tri, double b1, double b2, FacePlace&) const;
    /// Corners on sides that no other triangle of the mesh has, camera space. Before it is diced.
    void borderCorners(std::vector<Vec3>& out) const;

protected:
    size_t classCount(scene::Class) const override;
    int weights(scene::Class, const SurfacePoint&, Weight w[16]) const override;
    SurfacePoint evaluateLocal(uint32_t prim, double b1, double b2) const override;
    void evaluateLocal(uint32_t prim, double b1, double b2, SurfacePoint& out, uint32_t needs) const override;
    void localPoints(std::span<const HitRef>, uint32_t needs) const override;

private:
    struct Frame {
        Vec3d a, b;
    }; ///< u = P.a, v = P.b (object space)
    /// A triangle in object space: its corners, the partials of the point in its plane, and the normal of its face. Slopes of the
    /// weights of the 2nd and 3rd corner by u and v.
    struct Plane {
        Vec3d o, e1, e2, Pu, Pv, fn;
        Frame f;
        double u1, u2, v1, v2;
    };
    /// Data that is constant in a triangle, for small meshes.
    struct Remembered {
        Plane plane;
        Vec3d a, e1, e2;
        SurfacePoint point;
    };
    /// Triangles by area, for emitters; made at first use.
    struct Areas {
        std::once_flag made;
        double sum = 0, perSum = 0;     ///< of the areas, and 1 over it; 0 where there is none
        std::vector<double> cumulative; ///< per triangle, camera space
        std::vector<uint32_t> first;    ///< by equal parts of the sum: index of the first triangle
    };
    bool takeTriangles(const PolygonInput&);
    void cutFaces(const PolygonInput&, Diagnostics&);
    /// Cuts faces as in another mesh with the same faces and other points.
    void cutAlike(const PolygonMesh&, const PolygonInput&);
    Frame frame(const Vec3d& faceNormal) const;
    Plane planeOf(uint32_t tri) const;
    void setPartials(uint32_t tri, const Plane&, const Vec3d& wind, SurfacePoint&) const;
    void remember();
    void evaluateRemembered(uint32_t tri, double b1, double b2, SurfacePoint&, uint32_t needs) const;
    void setVariables(SurfacePoint&, const Plane*, uint32_t needs) const;
    const Areas& areas() const;
    Vec3d faceNormal(uint32_t tri) const;
    struct Dicing; ///< polygon_dice.cpp
    bool displaceSeen(Dicing&, std::vector<Vec3>& flat, Diagnostics&);
    Vec3d objectPoint(uint32_t vertex) const {
        return {objectP_[3 * vertex], objectP_[3 * vertex + 1], objectP_[3 * vertex + 2]};
    }
    /// The mesh before it was displaced.
    const TriMesh& base() const { return undiced_.vertices ? undiced_ : mesh_; }
    uint32_t vertexOf(uint32_t tri, int k) const { return base().index[3 * size_t(tri) + size_t(k)]; }
    uint32_t cornerOf(uint32_t tri, int k) const {
        return corner_.empty() ? 3 * tri + uint32_t(k) : corner_[3 * size_t(tri) + size_t(k)];
    }
    uint32_t faceOf(uint32_t tri) const { return face_.empty() ? tri : face_[tri]; }
    Vec3d cameraCorner(uint32_t tri, int k) const { return Vec3d(base().P[vertexOf(tri, k)]); }

    const float* objectP_ = nullptr; ///< the request's own P
    uint32_t vertexCount_ = 0, cornerCount_ = 0, triangles_ = 0;
    int faceCount_ = 0;
    std::vector<uint32_t> corner_;       ///< three per triangle: corners of the request. Empty: they are counted through
    std::vector<uint32_t> face_;         ///< per triangle. Empty: every face is one triangle
    std::vector<Vec3> faceNormal_;       ///< per face, object space, unit, by winding. Empty: the triangle's
    TriMesh undiced_;                    ///< base() after displacement
    bool plain_ = false;                 ///< no variable supplies s, t or N
    std::vector<Remembered> remembered_; ///< per triangle of small meshes, which are hit often; else empty
    mutable Areas areas_;
};

} // namespace alpenglow::geometry
