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
#include "geometry/blob_leaf.h"
#include "geometry/interval.h"
#include "scene/primitive.h"
#include <cstdint>
#include <string>
#include <vector>

namespace alpenglow::geometry {

/// Threshold of the surface: 0.75 cubed, so that a single unit ellipsoid has radius 1/2.
inline constexpr double kBlobThreshold = 0.421875;

/// One operation of a tape.
struct BlobOp {
    /// What it computes from a, b and c.
    enum class Kind : uint8_t { Constant, Leaf, Add, Multiply, Maximum, Minimum, Subtract, Divide, Negate } kind = Kind::Constant;
    uint32_t a = 0, b = 0; ///< earlier operations; Leaf: a is the leaf; Constant that moves: one more than the index of its float
    double c = 0;          ///< the constant
};
using BlobTape = std::vector<BlobOp>;

/// The leaves of a request and the tape that joins them. Object space.
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
    /// The tape of the request, and its leaves by number.
    const BlobTape& whole() const { return tape_; }
    const std::vector<BlobLeaf>& leaves() const { return leaves_; }

    /// The field at a point; the surface is where it is kBlobThreshold.
    double value(const BlobTape&, const Vec3d&) const;
    /// The field with its derivatives.
    BlobJet jet(const BlobTape&, const Vec3d&) const;
    /// Bounds over a box. values: of every operation.
    Interval bounds(const BlobTape&, const Vec3d& lo, const Vec3d& hi, std::vector<Interval>& values) const;
    /// The tape without operations that these bounds decide.
    static BlobTape simplified(const BlobTape&, const std::vector<Interval>& values);
    /// Leaves that colour a point, with their weights (which sum to 1) and the gradients of these.
    struct Share {
        uint32_t number; ///< BlobLeaf::number
        double w;        ///< share of the leaf
        Vec3d g;         ///< object space
    };
    /// Replaces the contents of `out`; no leaf where the field is constant.
    void shares(const BlobTape&, const Vec3d&, std::vector<Share>& out) const;

    /// Crossings of the threshold between t0 and t1, by increasing t. Stops after `most`.
    int crossings(const BlobTape&, const Vec3d& org, const Vec3d& dir, double t0, double t1, int most, double* out) const;

private:
    struct Reader;
    BlobTape tape_;
    std::vector<BlobLeaf> leaves_;
};

/// Bounds of an operation from those of its operands.
Interval combinedBounds(const BlobOp&, const Interval& a, const Interval& b);

} // namespace alpenglow::geometry
