// Moving shapes that are intersected exactly, one primitive at a time: their numbers are linear between keys. (A moving mesh is a
// Deforming, placed.h.)
#pragma once
#include "geometry/shape.h"
#include <algorithm>

namespace alpenglow::geometry {

/// The last of increasing times at or before `time` that has a successor, and the fraction of the way to it, 0 to 1.
inline size_t keyBefore(const std::vector<float>& times, float time, double& way) {
    const size_t n = times.size();
    way = 0;
    if (n < 2 || !(time > times.front())) return 0;
    if (time >= times.back()) return way = 1, n - 2;
    const size_t k = size_t(std::upper_bound(times.begin(), times.end(), time) - times.begin()) - 1;
    way = (double(time) - times[k]) / (double(times[k + 1]) - times[k]);
    return k;
}

/// Whether a shape is a key of a moving shape: pieces that are empty at one key may not be at another.
inline bool isKey(const ShapeSource& s) { return s.like || !s.primitive->motionKeys.empty(); }

/// A shape whose primitive has several keys: it is cut at each key alike, and interpolated between them.
class KeyedShape : public Shape {
public:
    using Shape::Shape;
    /// Makes this the first key; `later` are shapes of the same class from the primitive at later times. times: one more, from 0
    /// to 1. Returns false, without effect, if their pieces do not match.
    bool join(std::vector<ShapeRef> later, std::vector<float> times, Diagnostics&);
    /// Whether join() has made it the first of several keys.
    bool joined() const { return !later_.empty(); }

    using Shape::exactHits;
    int exactHits(uint32_t prim, const Vec3d& org, const Vec3d& dir, double lo, double hi, Wanted w,
                  ExactHit out[4]) const final {
        return exactHitsAt(prim, org, dir, lo, hi, w, 0, out);
    }
    /// exactHits() at a time of the shutter.
    virtual int exactHitsAt(uint32_t prim, const Vec3d& org, const Vec3d& dir, double lo, double hi, Wanted, float time,
                            ExactHit out[4]) const = 0;
    /// Boxes hold the shape at all times.
    Bounds exactBounds(uint32_t prim) const override;
    /// The same of primitives that follow one another.
    virtual void exactBoundsOf(uint32_t first, std::span<Bounds> out) const {
        for (Bounds& b : out) b = exactBounds(first++);
    }
    /// As exactBoundsOf(), for trees: may be a little larger, but within bounds().
    virtual void treeBoundsOf(uint32_t first, std::span<Bounds> out) const { exactBoundsOf(first, out); }
    Bounds bounds() const final { return bounds_; }

    using Shape::sampleArea;
    SurfacePoint sampleArea(double xi1, double xi2) const final { return sampleFromAt(Vec3(0.f), xi1, xi2, 0); }
    void sampleFrom(const Vec3& from, double xi1, double xi2, SurfacePoint& out, uint32_t) const final {
        out = sampleFromAt(from, xi1, xi2, 0);
    }
    void sampleAreaAt(double xi1, double xi2, float time, SurfacePoint& out, uint32_t) const final {
        out = sampleFromAt(Vec3(0.f), xi1, xi2, time);
    }
    /// sampleFrom() at a time of the shutter.
    virtual SurfacePoint sampleFromAt(const Vec3& from, double xi1, double xi2, float time) const = 0;

protected:
    /// A primitive's box at this key.
    virtual Bounds keyBounds(uint32_t prim) const = 0;
    /// evaluateLocal() at a time.
    virtual SurfacePoint pointAt(uint32_t prim, double b1, double b2, float time) const = 0;
    /// Whether that is the same primitive piece for piece, at another time. May make it so.
    virtual bool fits(KeyedShape& later) const = 0;
    /// Called when all keys match and are stored, before measure().
    virtual void joinKeys(const std::vector<float>& /*times*/, Diagnostics&) {}
    /// Call after primitives and keys are stored.
    void measure();
    size_t keyAt(float time, double& way) const { return keyBefore(times_, time, way); }
    const KeyedShape& key(size_t i) const { return i == 0 ? *this : static_cast<const KeyedShape&>(*later_[i - 1]); }
    /// Change of place(way) over the complete shutter at a position between a key and the next, by a central difference:
    /// rotations are not linear.
    template <class Place> Vec3 slopeOf(size_t key, double way, Place place) const {
        const double a = std::max(way - 1e-5, 0.0), b = std::min(way + 1e-5, 1.0);
        return Vec3((place(b) - place(a)) / ((b - a) * (double(times_[key + 1]) - times_[key])));
    }
    size_t keys() const { return 1 + later_.size(); }

    void interpolateVariable(const PrimVar&, const SurfacePoint& at, float* out, float* du, float* dv) const override;
    SurfacePoint evaluateLocal(uint32_t prim, double b1, double b2) const final { return pointAt(prim, b1, b2, 0); }
    void localPoints(std::span<const HitRef>, uint32_t needs) const final;

private:
    std::vector<ShapeRef> later_;
    std::vector<float> times_;
    Bounds bounds_;
};

} // namespace alpenglow::geometry
