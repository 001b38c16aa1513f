// Geometry that is shared or moves: a Placed shape puts a geometry, a shape in a space of its own, to a place that may move over
// the shutter; a Deforming geometry is one at several times. Both are shapes, so the rest of the renderer need not know; rays
// come into the space of the geometry (accel/).
//
// Times are parts of the shutter, 0 to 1. Between keys matrices and points are linear (RISpec 3.2, section 6); ri/ gives
// rotations keys so close that this is exact enough.
#pragma once
#include "geometry/affine.h"
#include "geometry/keyed.h"
#include "geometry/shape.h"
#include "scene/motion.h"
#include <mutex>

namespace alpenglow::geometry {

/// A primitive at several times: shapes whose diced meshes have the same triangles.
class Deforming final : public Shape {
public:
    /// keys: at least two, all of one kind; times: as many, from 0 to 1.
    Deforming(ShapeSource, std::vector<ShapeRef> keys, std::vector<float> times);
    /// As given to the constructor.
    const std::vector<ShapeRef>& keys() const { return keys_; }
    const std::vector<float>& times() const { return times_; }
    /// The key at or before a time, and the fraction of the way to the next one, 0 to 1.
    size_t keyAt(float time, double& way) const;
    /// A triangle at a time.
    void corners(uint32_t prim, float time, Vec3d out[3]) const;
    /// A corner between two keys.
    static Vec3d between(const Vec3& a, const Vec3& b, double way) { return Vec3d(a) * (1 - way) + Vec3d(b) * way; }

    Bounds bounds() const override;
    int faces() const override { return keys_[0]->faces(); }
    SurfacePoint evaluate(int face, double u, double v) const override { return keys_[0]->evaluate(face, u, v); }
    double area() const override { return keys_[0]->area(); }
    using Shape::sampleArea;
    SurfacePoint sampleArea(double xi1, double xi2) const override { return keys_[0]->sampleArea(xi1, xi2); }
    void sampleAreaAt(double xi1, double xi2, float time, SurfacePoint& out, uint32_t needs) const override;
    double sampleDensity(const SurfacePoint&) const override;
    void interpolate(int var, const SurfacePoint& at, float* out, float* du, float* dv) const override;
    const std::string& stringValue(int var, const SurfacePoint& at) const override { return keys_[0]->stringValue(var, at); }
    Vec3 velocity(const SurfacePoint&) const override;
    void dice(const DiceOptions&, Diagnostics&) override;

protected:
    size_t classCount(scene::Class) const override { return 0; }
    int weights(scene::Class, const SurfacePoint&, Weight*) const override { return 0; }
    SurfacePoint evaluateLocal(uint32_t prim, double b1, double b2) const override { return keys_[0]->evaluateHit(prim, b1, b2); }
    void localPoints(std::span<const HitRef>, uint32_t needs) const override;

private:
    SurfacePoint between(const SurfacePoint&, const SurfacePoint&, double way) const;
    void facet(SurfacePoint&, uint32_t prim, size_t key, double way, uint32_t needs) const;
    std::vector<ShapeRef> keys_;
    std::vector<float> times_;
};

/// Says that keys do not fit together.
void reportUnlike(const Shape&, Diagnostics&);

/// The bounds of a geometry for all its places, which would each look at all its points.
class SharedBounds {
public:
    /// Always for the same shape, whose points may change when it is diced.
    Bounds of(const Shape&);

private:
    std::mutex mutex_;
    bool known_ = false;
    const void* points_ = nullptr; ///< of the mesh that bounds_ are of
    uint32_t count_ = 0;
    Bounds bounds_;
};

/// An instance of a geometry.
class Placed final : public Shape {
public:
    /// toCamera of the source: at shutter open. place: from the geometry's space to camera space; affine, with constant
    /// handedness. bounds: of the geometry, shared by its instances; null: none.
    Placed(ShapeSource, ShapeRef geometry, const scene::Transform& place, std::shared_ptr<SharedBounds> bounds = nullptr);
    /// In its own space.
    const ShapeRef& geometry() const { return geometry_; }
    /// Null where the geometry is the same at all times.
    const Deforming* deforming() const { return deforming_; }
    /// Null unless primitives are intersected one by one at a time.
    const KeyedShape* keyed() const { return keyed_; }
    /// Whether place or geometry changes while the shutter is open; whether the place does.
    bool moves() const { return moving_ || deforming_ || (keyed_ && keyed_->joined()); }
    bool placeMoves() const { return moving_ != nullptr; }
    /// Where it is placed at times of the shutter, for one that is placeMoves().
    std::vector<std::pair<float, Affine>> placeKeys() const;
    /// Transformation from camera space at a time. Returns false if it is singular; the shape is then invisible.
    bool toGeometry(float time, Affine& out) const;
    /// Transformation to camera space at a time.
    Affine fromGeometry(float time) const;
    /// 1 or -1: the side of a normal of the geometry that is the placed one's.
    double side() const { return side_; }

    const Placed* placed() const override { return this; }
    Matrix toCameraAt(float time) const override;
    Vec3 velocity(const SurfacePoint&) const override;
    Bounds bounds() const override;
    int faces() const override { return geometry_->faces(); }
    SurfacePoint evaluate(int face, double u, double v) const override;
    double area() const override;
    using Shape::sampleArea;
    SurfacePoint sampleArea(double xi1, double xi2) const override;
    void sampleAreaAt(double xi1, double xi2, float time, SurfacePoint& out, uint32_t needs) const override;
    /// The same for a lit point: shapes that face rays are turned as seen from it.
    void sampleFromAt(const Vec3& from, double xi1, double xi2, float time, SurfacePoint& out, uint32_t needs) const;
    double sampleDensity(const SurfacePoint&) const override;
    double turnedDensity(const SurfacePoint&, const Vec3& from) const override;
    bool facesRays() const override { return geometry_->facesRays(); }
    void interpolate(int var, const SurfacePoint& at, float* out, float* du, float* dv) const override;
    const std::string& stringValue(int var, const SurfacePoint& at) const override { return geometry_->stringValue(var, at); }
    /// diceShapes() dices the geometry, once for all instances.
    void dice(const DiceOptions&, Diagnostics&) override {}

protected:
    size_t classCount(scene::Class) const override { return 0; }
    int weights(scene::Class, const SurfacePoint&, Weight*) const override { return 0; }
    SurfacePoint evaluateLocal(uint32_t prim, double b1, double b2) const override;
    void localPoints(std::span<const HitRef>, uint32_t needs) const override;

private:
    struct Moving {
        std::vector<float> times;
        std::vector<Affine> keys;
    };
    struct Pose {
        Affine out, in;
        double flip;
    };
    Pose poseAt(float time) const;
    void place(SurfacePoint&, const Pose&, float time) const;
    size_t keyAt(float time, double& way) const;

    ShapeRef geometry_;
    std::shared_ptr<SharedBounds> bounds_;
    const Deforming* deforming_ = nullptr;
    const KeyedShape* keyed_ = nullptr;
    std::unique_ptr<const Moving> moving_; ///< null: does not move
    Affine out_, in_;                      ///< at shutter open
    double side_ = 1;
};

} // namespace alpenglow::geometry
