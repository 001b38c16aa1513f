// The field of a Blobby (RISpec 3.2, 5.6; Pixar's application note 31): leaves, joined by operators.
//
// A field is a tape: a list of operations, each on results of earlier ones, the last being the field. Over a box or along a part
// of a ray it is bounded by intervals, and what the bounds decide (a leaf that is 0 there, the smaller side of a maximum) is left
// out of the tape of that box. So a thousand blobs cost a ray what the few near it cost, and no root is overlooked, however thin
// the part.
#pragma once
#include "base/diagnostics.h"
#include "base/matrix.h"
#include "base/vec.h"
#include "scene/primitive.h"
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace alpenglow::geometry {

/// Threshold of the surface: 0.75 cubed, so that a single unit ellipsoid has radius 1/2.
inline constexpr double kBlobThreshold = 0.421875;

struct Interval {
    double lo = 0, hi = 0;
    bool has(double x) const { return lo <= x && x <= hi; }
};

/// A value with its gradient and second derivatives, xx yy zz xy xz yz.
struct BlobJet {
    double f = 0;
    Vec3d g{0.0};
    double h[6] = {};
};

/// A depth map under a repelling plane.
struct BlobGround {
    int width = 0, height = 0;
    std::vector<float> depth;
    Matrix toCamera, toScreen; ///< from object space; screen is -1 to 1
    float least = 0, most = 0;
    double a = 0, b = 0, c = 0, d = 0; ///< height where it ends, sharpness, height and strength of the bulge
    /// Height of a point above the ground, along its depth; INFINITY outside of the map.
    double above(const Vec3d& p) const;
};

struct BlobLeaf {
    enum class Kind { Ellipsoid, Segment, Ground } kind = Kind::Ellipsoid;
    double m[3][4] = {}; ///< from object space to that of the unit sphere, or of the segment over its radius
    Vec3d from, along;   ///< segment: its start and direction in leaf space
    double length = 0;
    uint32_t number = 0;    ///< among all leaves of the request: of its vertex values
    uint32_t at = 0;        ///< start of its floats in those of the request
    bool bySegment = false; ///< the floats are two ends and a radius, then the matrix; else the matrix only
    double thin = 0;        ///< its smallest half axis, object space
    Vec3d lo, hi;           ///< it is 0 outside, object space
    std::shared_ptr<const BlobGround> ground;
    Vec3d inside(const Vec3d& p) const;
};

/// Computes the shape of a leaf from its floats; `at` and number are unchanged. segment: two ends and a radius, or null. Returns
/// false if the matrix has no inverse, or the radius is 0.
bool shapeBlobLeaf(const double matrix[16], const double segment[7], BlobLeaf&);
/// The shape of a leaf that is 0 everywhere.
void emptyBlobLeaf(BlobLeaf&);

struct BlobOp {
    enum class Kind : uint8_t { Constant, Leaf, Add, Multiply, Maximum, Minimum, Subtract, Divide, Negate } kind = Kind::Constant;
    uint32_t a = 0, b = 0; ///< earlier operations; Leaf: a is the leaf; Constant that moves: one more than the index of its float
    double c = 0;
};
using BlobTape = std::vector<BlobOp>;

/// A ray in the spaces of the leaves of a tape.
struct BlobRay;

class BlobField {
public:
    BlobField() = default;
    /// For tapes over these leaves.
    explicit BlobField(std::vector<BlobLeaf> leaves) : leaves_(std::move(leaves)) {}
    /// code, numbers, strings: as in the request. objectToWorld: depth maps are in world space. Returns false after an error.
    /// moves: numbers vary over time, so no operation is dropped because of their values.
    bool read(int leaves, const std::vector<int>& code, const std::vector<float>& numbers,
              const std::vector<std::string>& strings, const Matrix& objectToWorld, const SourcePlace&, Diagnostics&,
              bool moves = false);
    const BlobTape& whole() const { return tape_; }
    const std::vector<BlobLeaf>& leaves() const { return leaves_; }

    double value(const BlobTape&, const Vec3d&) const;
    BlobJet jet(const BlobTape&, const Vec3d&) const;
    /// Bounds over a box. values: of every operation.
    Interval bounds(const BlobTape&, const Vec3d& lo, const Vec3d& hi, std::vector<Interval>& values) const;
    /// The tape without operations that these bounds decide.
    static BlobTape simplified(const BlobTape&, const std::vector<Interval>& values);
    /// Leaves that colour a point, with their weights (which sum to 1) and the gradients of these.
    struct Share {
        uint32_t number;
        double w;
        Vec3d g;
    };
    void shares(const BlobTape&, const Vec3d&, std::vector<Share>& out) const;

    /// Crossings of the threshold between t0 and t1, by increasing t. Stops after `most`.
    int crossings(const BlobTape&, const Vec3d& org, const Vec3d& dir, double t0, double t1, int most, double* out) const;

    Interval leafBounds(const BlobLeaf&, const Vec3d& lo, const Vec3d& hi) const;

private:
    struct Reader;
    BlobTape tape_;
    std::vector<BlobLeaf> leaves_;
};

/// Bounds of an operation from those of its operands.
Interval combinedBounds(const BlobOp&, const Interval& a, const Interval& b);
/// How fast a segment's field changes, per radius: across its axis at most 1.812, along it 35/32. So for either of its ends.
inline constexpr double kBlobSegmentSlope = 2.12;

/// The leaf's field in its own space, optionally with gradient and second derivatives.
double blobLeafField(const BlobLeaf&, const Vec3d& q, Vec3d* gradient, double* hessian);

} // namespace alpenglow::geometry
