// The leaves of a Blobby (RISpec 5.6): the fields of ellipsoids, segments and repelling ground.
#pragma once
#include "base/matrix.h"
#include "base/vec.h"
#include "geometry/interval.h"
#include <cstdint>
#include <memory>
#include <vector>

namespace alpenglow::geometry {

/// A value with its gradient and second derivatives, xx yy zz xy xz yz.
struct BlobJet {
    double f = 0;     ///< value
    Vec3d g{0.0};     ///< by x, y, z
    double h[6] = {}; ///< second derivatives
};
/// Where these derivatives stand in the matrix of all.
inline constexpr int kBlobJetRow[6] = {0, 1, 2, 0, 0, 1}, kBlobJetColumn[6] = {0, 1, 2, 1, 2, 2};

/// A depth map under a repelling plane.
struct BlobGround {
    int width = 0, height = 0; ///< texels
    std::vector<float> depth;
    Matrix toCamera, toScreen; ///< from object space; screen is -1 to 1
    /// Least and largest depth of some texels.
    struct Range {
        float least, most; ///< depths
    };
    /// Of depths: level k has the texels of the one before two by two, level 0 those of the map.
    std::vector<std::vector<Range>> levels;
    double a = 0, b = 0, c = 0, d = 0; ///< height where it ends, sharpness, height and strength of the bulge
    /// Height of a point above the ground, along its depth; INFINITY outside of the map.
    double above(const Vec3d& p) const;
    /// Depth at a place of the map, in texels, whose centres are whole numbers from 0.
    double depthAt(double i, double j) const;
    /// Computes levels of `depth`.
    void sumUp();
    /// Of the texels from x0, y0 to x1, y1, both included.
    Range range(int x0, int y0, int x1, int y1) const;
};

/// One blob: where it is, and the floats that shape it.
struct BlobLeaf {
    /// A ball of any affine shape, a rod with round ends, or a repelling ground.
    enum class Kind { Ellipsoid, Segment, Ground } kind = Kind::Ellipsoid;
    double m[3][4] = {};                      ///< from object space to that of the unit sphere, or of the segment over its radius
    Vec3d from, along;                        ///< segment: its start and direction in leaf space
    double length = 0;                        ///< of the segment, object space
    uint32_t number = 0;                      ///< among all leaves of the request: of its vertex values
    uint32_t at = 0;                          ///< start of its floats in those of the request
    bool bySegment = false;                   ///< the floats are two ends and a radius, then the matrix; else the matrix only
    double thin = 0;                          ///< its smallest half axis, object space
    Vec3d lo, hi;                             ///< it is 0 outside, object space
    std::shared_ptr<const BlobGround> ground; ///< null: no ground
    /// A point of object space in the space of the leaf.
    Vec3d inside(const Vec3d& p) const;
};

/// Computes the shape of a leaf from its floats; `at` and number are unchanged. segment: two ends and a radius, or null. Returns
/// false if the matrix has no inverse, or the radius is 0.
bool shapeBlobLeaf(const double matrix[16], const double segment[7], BlobLeaf&);
/// The shape of a leaf that is 0 everywhere.
void emptyBlobLeaf(BlobLeaf&);

/// How fast a segment's field changes, per radius: across its axis at most 1.812, along it 35/32. So for either of its ends.
inline constexpr double kBlobSegmentSlope = 2.12;

/// Bound on the second derivatives of a segment's field.
inline constexpr double kBlobSegmentBend = 13.2;

/// The third power.
inline double cube(double x) { return x * x * x; }

/// The leaf's field in its own space, optionally with gradient and second derivatives.
double blobLeafField(const BlobLeaf&, const Vec3d& q, Vec3d* gradient, double* hessian);
/// A leaf's field at a point, object space.
double blobLeafValue(const BlobLeaf&, const Vec3d&);
/// The same with its derivatives.
BlobJet blobLeafJet(const BlobLeaf&, const Vec3d&);
/// Bounds of a leaf's field over a box, object space.
Interval blobLeafBounds(const BlobLeaf&, const Vec3d& lo, const Vec3d& hi);

/// The field of the ground at a point, object space.
double blobGroundField(const BlobGround&, const Vec3d&);
/// The same with its derivatives.
BlobJet blobGroundJet(const BlobGround&, const Vec3d&);
/// Bounds of the field of the ground over a box, object space.
Interval blobGroundBounds(const BlobGround&, const Vec3d& lo, const Vec3d& hi);

} // namespace alpenglow::geometry
