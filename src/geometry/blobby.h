// Blobby nleaf code floats strings: the surface where the field of its blobs is 0.421875 (blob_field.h). Not for other folders.
//
// Rays meet the surface itself. Space is cut into boxes until each is small against the blobs in it, boxes that the surface
// provably misses are dropped, and each that is left is an exact primitive with the part of the field that matters there.
// Polygons would need to be as small as the thinnest part of the thinnest blob; boxes may be larger, because roots along a ray
// are isolated by bounds and none is lost. Where the numbers of the blobs move, boxes are cut in time as well.
//
// A point has u and v like a polygon's: the two coordinates of object space across the axis that its normal is nearest to. What
// an exact hit gives (two numbers) are those coordinates within its box, with the third, coarse, in their last bits, and the time
// where it moves: from there Newton finds the surface again.
#pragma once
#include "geometry/blob_motion.h"
#include "geometry/keyed.h"
#include <mutex>

namespace alpenglow::geometry {

/// The shape of the request.
class Blobby final : public KeyedShape {
public:
    /// leaves: of the request. Cuts the surface into boxes.
    Blobby(ShapeSource s, BlobField field, int leaves, Diagnostics& diag);
    /// There is no surface.
    bool empty() const { return boxes_.empty(); }

    uint32_t exactPrims() const override { return uint32_t(boxes_.size()); }
    Bounds exactBounds(uint32_t prim) const override { return keyBounds(prim); }
    int exactHitsAt(uint32_t prim, const Vec3d& org, const Vec3d& dir, double lo, double hi, Wanted, float time,
                    ExactHit out[4]) const override;
    SurfacePoint evaluate(int face, double u, double v) const override;
    double area() const override { return areas().sum; }
    SurfacePoint sampleFromAt(const Vec3& from, double xi1, double xi2, float time) const override;
    double sampleDensity(const SurfacePoint&) const override;
    Vec3 velocity(const SurfacePoint&) const override;
    void dice(const DiceOptions& opt, Diagnostics& diag) override;

protected:
    using Class = scene::Class;
    size_t classCount(Class c) const override { return c == Class::Constant || c == Class::Uniform ? 1 : size_t(leaves_); }
    int weights(Class, const SurfacePoint&, Weight w[16]) const override;
    void interpolateVariable(const PrimVar&, const SurfacePoint& at, float* out, float* du, float* dv) const override;
    SurfacePoint pointAt(uint32_t prim, double b1, double b2, float time) const override;
    Bounds keyBounds(uint32_t prim) const override { return boundsOf(boxes_[prim].lo, boxes_[prim].hi); }
    bool fits(KeyedShape& later) const override;
    void joinKeys(const std::vector<float>& times, Diagnostics&) override;

private:
    struct Box {
        Vec3d lo, hi;
        uint32_t tape = 0;
        float from = 0, to = 1; ///< when it holds surface; the end does not belong to it, unless it is 1
        bool at(float time) const { return time >= from && (time < to || to >= 1); }
    };
    /// The field about a box at a time.
    class Now {
    public:
        Now(const Blobby&, const BlobTape&, float time);
        const BlobField& field() const { return still_ ? *still_ : own_; }
        const BlobTape& tape() const { return still_ ? *stillTape_ : ownTape_; }
        BlobJet jet(const Vec3d& p) const { return field().jet(tape(), p); }
        Now(const Now&) = delete;

    private:
        const BlobField* still_ = nullptr;
        const BlobTape* stillTape_ = nullptr;
        BlobField own_;
        BlobTape ownTape_;
    };
    /// Chances of boxes for points of the surface, of those of a part of the shutter.
    struct Areas {
        double sum = 0; ///< mean over the shutter
        struct Part {
            std::vector<uint32_t> boxes;
            std::vector<double> cumulative; ///< to 1
            double chance(uint32_t box) const;
        };
        std::vector<Part> parts; ///< equal ones
        std::once_flag made;
        const Part& at(float time) const;
    };
    const Areas& areas() const;
    /// A vertex variable of type mpoint: maps object space of each blob to the variable's position in camera space.
    struct PlacedPoints {
        size_t var;               ///< among primvars_, where it is a point (or an array of them)
        std::vector<Matrix> maps; ///< elements() for each blob
    };
    void takePlacedPoints();
    void placePoint(const PlacedPoints&, const SurfacePoint& at, float* out, float* du, float* dv) const;
    double boxArea(uint32_t box, int lines) const;
    void cut(Diagnostics&);
    std::vector<Box> roots();
    Interval fieldBounds(const Box& of, const Vec3d& lo, const Vec3d& hi, float from, float to, std::vector<Interval>&) const;
    int longest(const Box&, double& size, double& thin) const;
    Bounds boundsOf(const Vec3d& lo, const Vec3d& hi) const;
    const BlobTape& tapeOf(const Box& b) const { return tapes_[b.tape]; }
    struct Found {
        Vec3d p;
        float time;           ///< its time
        const BlobTape* tape; ///< of the field about it
    };
    Found decoded(uint32_t prim, double b1, double b2, float time) const;
    float metAt(const Box&, double b2, float time) const;
    Vec3d onSurface(const Now&, Vec3d p, const Vec3d& size, bool& found) const;
    void encode(uint32_t prim, const Vec3d& p, const Vec3d& gradient, float time, double& b1, double& b2) const;
    int alongAxis(const Box&, const Now&, int axis, const Vec3d& through, double* out) const;
    double densityObject(uint32_t prim, const Now&, float time, const Vec3d& p, const Vec3d& normal) const;
    double stretch(const Vec3d& normal) const;
    const Blobby& owner() const { return owner_ ? *owner_ : *this; }

    BlobField field_;
    int leaves_;
    std::vector<Box> boxes_;
    std::vector<BlobTape> tapes_;
    Matrix toObject_;
    std::unique_ptr<const BlobMotion> motion_; ///< null: numbers do not move
    const Blobby* owner_ = nullptr;            ///< of a later key: that which has its boxes
    mutable Areas areas_;
    std::vector<PlacedPoints> placed_;
};

} // namespace alpenglow::geometry
