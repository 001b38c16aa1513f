// SubdivisionMesh and HierarchicalSubdivisionMesh: rays hit a fine tessellation, shading evaluates the limit surface
// (limit_surface.h has the parameters of a face and the accuracy).
#pragma once
#include "geometry/parametric.h"
#include "geometry/subdivision_cage.h"
#include <mutex>

namespace alpenglow::geometry {

/// Position of a refined face in its original face: (u, v) is origin + u along + v across.
struct FaceDomain {
    Vec2 origin{0, 0}, along{1, 0}, across{0, 1};
};

/// The shape of the two requests.
class Subdivision final : public Shape {
public:
    /// domains: per face of the cage; empty where the cage is the request's own.
    Subdivision(ShapeSource, CageInput&&, std::vector<FaceDomain> domains, Diagnostics&);
    /// Nothing of it is drawn.
    bool empty() const { return drawn_ == 0; }
    int faces() const override { return int(input_.requestFaces); }
    /// Faces that are cut into pieces have u from k to k + 1 in the piece of corner k.
    SurfacePoint evaluate(int face, double u, double v) const override;
    double area() const override { return areas().sum; }
    SurfacePoint sampleArea(double xi1, double xi2) const override;
    double sampleDensity(const SurfacePoint&) const override;
    void dice(const DiceOptions&, Diagnostics&) override;

protected:
    size_t classCount(scene::Class) const override;
    /// Of values that are not smooth; of smooth ones that of the nearest vertex, for strings.
    int weights(scene::Class, const SurfacePoint&, Weight w[16]) const override;
    void interpolateVariable(const PrimVar&, const SurfacePoint&, float* out, float* du, float* dv) const override;
    /// prim: piece; b1, b2: its u and v.
    SurfacePoint evaluateLocal(uint32_t prim, double u, double v) const override;
    void evaluateLocal(uint32_t prim, double u, double v, SurfacePoint& out, uint32_t needs) const override;

private:
    /// Pieces by area, for emitters; made at first use.
    struct Areas {
        std::once_flag made;
        double sum = 0;
        std::vector<double> cumulative;
    };
    struct Dicing; ///< subdivision_dice.cpp
    bool diceSeen(const DiceOptions&, const class Unseen&, Diagnostics&);
    void takeMesh(const Dicing&, const TriMesh& shared, const std::vector<Vec3>& flat,
                  const std::vector<const struct PieceGrid*>& gridOf, const std::vector<uint32_t>& insideOf);
    const Areas& areas() const;
    LocalPoint cameraPoint(uint32_t piece, double u, double v, int derivatives) const;
    Vec3d cameraPosition(uint32_t piece, double u, double v) const { return cameraPoint(piece, u, v, 0).P; }
    Vec3d controlPoint(int vertex) const {
        const float* p = objectP_ + 3 * size_t(vertex);
        return transformPoint(toCamera(), Vec3d(p[0], p[1], p[2]));
    }
    void setNormal(uint32_t piece, double u, double v, LocalPoint&) const;
    int channelOf(const PrimVar&) const;
    int corners(uint32_t face) const { return input_.cage.corners[face]; }
    size_t firstCorner(uint32_t face) const {
        return firstCorner_.empty() ? size_t(face) * size_t(evenCorners_) : firstCorner_[face];
    }
    int vertexAt(size_t corner) const { return input_.cage.vertex[corner]; }
    size_t requestCorner(size_t corner) const { return input_.cornerOf.empty() ? corner : input_.cornerOf[corner]; }
    /// Weights of the corners of a face, for values that are linear. Returns how many: all corners of the face.
    int cornerWeights(uint32_t piece, double u, double v, std::vector<Weight>& w) const;
    void makeChannels(std::vector<LimitSurface::Channel>&);

    CageInput input_;
    std::unique_ptr<LimitSurface> limit_;
    std::vector<FaceDomain> domains_;
    std::vector<size_t> firstCorner_; ///< per face; empty: all have evenCorners_
    int evenCorners_ = 0;
    const float* objectP_ = nullptr;          ///< the request's own
    std::vector<const scene::Param*> smooth_; ///< face-varying variables by channel
    uint32_t drawn_ = 0;                      ///< pieces that have a surface
    double pointScale_ = 0;                   ///< bound on |P| in camera space
    mutable Areas areas_;
};

} // namespace alpenglow::geometry
