// The field of a Blobby with moving numbers: linear between keys, so that at each time it is the field with the numbers of that
// time. Bounds over a box are valid for a time span as well.
#pragma once
#include "geometry/blob_field.h"
#include "geometry/keyed.h"

namespace alpenglow::geometry {

/// The field of a Blobby over the shutter, 0 to 1.
class BlobMotion {
public:
    /// plan: read with `moves`; numbers: of the request at each key, as many; times: one more than none, from 0 to 1.
    BlobMotion(const BlobField& plan, std::vector<const std::vector<float>*> numbers, std::vector<float> times)
        : plan_(plan), numbers_(std::move(numbers)), times_(std::move(times)) {}
    /// As given to the constructor.
    const std::vector<float>& times() const { return times_; }
    const BlobField& plan() const { return plan_; }

    /// The field of a tape at a time, with the leaves of this tape only, and the tape for it.
    void at(const BlobTape&, float time, BlobField& field, BlobTape& tape) const;
    /// Bounds over a box and from one time to another, between the same two keys.
    Interval bounds(const BlobTape&, const Vec3d& lo, const Vec3d& hi, float from, float to, std::vector<Interval>& values) const;
    /// Extent of a tape's leaves, for sizes of boxes and time spans.
    struct Extent {
        double way = 0;                    ///< longest displacement of a leaf between two times, object space
        double thin = INFINITY;            ///< smallest half axis
        Vec3d lo{INFINITY}, hi{-INFINITY}; ///< all are 0 outside
    };
    /// Between two times of the shutter, 0 to 1.
    Extent extent(const BlobTape&, float from, float to) const;
    /// A point of the surface at one time, carried along by the leaves that make it to another. Object space.
    Vec3d carried(const BlobTape&, const Vec3d& p, float from, float to) const;

private:
    struct Span {
        size_t key;
        double w0, w1;
    };
    Span spanOf(float from, float to) const;
    double numberAt(size_t i, size_t key, double way) const;
    BlobLeaf leafAt(const BlobLeaf& plan, size_t key, double way) const;
    Interval leafBounds(const BlobLeaf& plan, const Vec3d& lo, const Vec3d& hi, const Span&) const;
    void leafBox(const BlobLeaf& plan, const Span&, Vec3d& lo, Vec3d& hi) const;
    struct Change;
    Change changeOf(const BlobLeaf& plan, const Span&) const;

    const BlobField& plan_;
    std::vector<const std::vector<float>*> numbers_;
    std::vector<float> times_;
};

} // namespace alpenglow::geometry
