// Light samples on emitters, and the density of a given hit (docs/design/light-transport.md).
#pragma once
#include "world/emitterfacets.h"
#include "world/facetgroups.h"
#include "world/halfturn.h"
#include "world/trianglelamp.h"
#include <functional>
#include <span>
#include <unordered_map>

namespace alpenglow::world {

/// The geometry of one area light. A shape is chosen in proportion to area; among more than limits::kLightsSampled shapes in
/// proportion to area over squared distance (LightChooser). Complete spheres that are spheres in camera space, and a few near
/// triangles, are sampled by solid angle; diced shapes by the area of their facets; other complete quadrics by area on the half
/// that faces the lit point (HalfTurn); all others by area.
class Emitter {
public:
    /// visibility: kinds of rays (accel::Visibility) that can hit each shape; empty: all.
    explicit Emitter(std::vector<const geometry::Shape*> shapes, std::vector<uint32_t> visibility = {});
    /// Call after dicing: samples then lie on the facets that rays hit, and areas are those of the facets. seenThrough: whether a
    /// shape is transparent, so that rays also reach emission behind it; null: none is.
    void takeDiced(const std::function<bool(const geometry::Shape&)>& seenThrough = {});
    /// Sets the side from which light leaves, also for shapes with two sides.
    /// The sides of its shapes from which light leaves.
    enum class Shines { Both, Front, Back };
    void shinesTo(Shines);
    /// Bound of the directions in which light leaves.
    Cone front() const;
    bool empty() const { return entries_.empty(); }
    double area() const { return area_; }
    /// Around all of its shapes.
    geometry::Bounds bounds() const;
    /// The point at (u, v) on the first shape, by area; `shape` is set to that shape. The emitter must not be empty.
    geometry::SurfacePoint point(Vec2 u, const geometry::Shape*& shape) const {
        shape = entries_[0].shape;
        return shape->sampleArea(u.x, u.y);
    }
    /// For lanes: all shapes, if they are few and have a few flat triangles each; else empty.
    std::span<const FlatEmitter> flat() const { return flat_; }
    /// For flat emitters: the shape that a number in [0, 1) chooses, with its probability; Sample::visibility.
    size_t flatFrom(const Vec3& from, float choose, double& share) const {
        return size_t(&entryFrom(from, choose, share) - entries_.data());
    }
    uint32_t flatVisibility(size_t shape) const { return entries_[shape].visibility; }
    const geometry::Shape& flatShape(size_t shape) const { return *entries_[shape].shape; }
    /// Whether sample() needs its number `choose`.
    bool chooses() const { return entries_.size() > 1; }

    /// A light sample.
    struct Sample {
        const geometry::Shape* shape = nullptr; ///< null: no sample
        float pdf = 0;                          ///< per steradian as seen from the lit point; > 0
        Vec3 direction;                         ///< unit, from the lit point to the light
        float distance = 0;                     ///< from the lit point
        uint32_t visibility = ~0u;              ///< kinds of rays that could also have hit this shape
    };
    /// Samples a point on the light for the lit point `from`. Returns false if the sample is edge-on or coincides with `from`.
    /// needs: geometry::PointNeed of `point`; time: of the shutter, 0 to 1.
    bool sample(const Vec3& from, Vec2 u, float choose, float time, Sample& out, geometry::SurfacePoint& point,
                uint32_t needs = geometry::kNeedAll) const;
    /// Samples a point of the surface for a mean over it: `pdf` is the density relative to the uniform one. Back sides count.
    /// Returns false as sample() does.
    bool sampleSurface(const Vec3& from, Vec2 u, float choose, float time, Sample& out, geometry::SurfacePoint& point,
                       uint32_t needs = geometry::kNeedAll) const;
    /// Samples a point on the light independently of a lit point; returns its shape. perArea: density per unit of area, 0 if the
    /// point is cut away. toward: shapes that turn to rays face those that leave along this direction. The emitter must not be
    /// empty.
    const geometry::Shape* samplePoint(Vec2 u, float choose, float time, const Vec3& toward, geometry::SurfacePoint& point,
                                       float& perArea) const;
    /// Whether light samples may follow directions (sampleToward): one shape, a flat polygon, which a ray meets once.
    bool followsDirections() const;
    /// As sample(), but at the point in direction w, with the `pdf` of sample() there. Returns false if there is none.
    bool sampleToward(const Vec3& from, const Vec3& w, Sample& out, geometry::SurfacePoint& point,
                      uint32_t needs = geometry::kNeedAll) const;
    /// Density per steradian with which sample() returns this hit, seen from `from`; 0 for shapes of other lights.
    float pdf(const geometry::Shape* shape, const geometry::SurfacePoint& hit, const Vec3& from) const;

private:
    struct Entry {
        const geometry::Shape* shape;
        double share, cumulative; ///< probability; its cumulative sum including this shape
        bool sphere = false;
        bool inner = false;   ///< sphere: wall of a hole in a CSG solid, visible on its far side
        bool through = false; ///< sphere: both the near and the far side are visible
        Vec3 centre;
        float radius = 0;
        uint32_t visibility = ~0u;
        int facets = -1;    ///< index in facets_; -1: rays hit the surface itself
        int triangles = -1; ///< index in triangles_; -1: not sampled by solid angle
        int groups = -1;    ///< index in groups_; -1: facets are not chosen by what the lit point sees of them
        int turn = -1;      ///< index in turns_; -1: samples are not turned toward the lit point
        Cone front;         ///< bound of the directions in which light leaves
    };
    /// A complete sphere seen from outside: 1 - cos of its angular radius. Returns false from inside.
    static bool outside(const Entry&, const Vec3& from, double& cap);
    bool sampleSphere(const Entry&, const Vec3& from, Vec2 u, double cap, double share, Sample&, geometry::SurfacePoint&,
                      uint32_t needs) const;
    void weigh();
    void makeChooser();
    /// Chooses a point for a lit one. Returns false if it is cut away.
    bool place(const Entry&, const Vec3& from, Vec2 u, float time, geometry::SurfacePoint&, uint32_t needs) const;
    /// Density per area of place().
    double density(const Entry& e, const geometry::SurfacePoint& p) const {
        return e.facets < 0 ? e.shape->sampleDensity(p) : facets_[size_t(e.facets)].density(p);
    }
    /// The shape that a number in [0, 1) chooses, by area. There is at least one.
    const Entry& entryAt(float choose) const;
    /// The shape chosen as seen from a point, and its probability.
    const Entry& entryFrom(const Vec3& from, float choose, double& share) const;
    float areaPdf(const Entry&, double share, const geometry::SurfacePoint&, const Vec3& from) const;
    /// Per steradian, from a density per area.
    static float asSeen(const Entry&, double perArea, const geometry::SurfacePoint&, const Vec3& from);
    std::vector<Entry> entries_;
    std::vector<EmitterFacets> facets_;
    std::vector<TriangleLamp> triangles_;
    std::vector<FacetGroups> groups_;
    std::vector<HalfTurn> turns_;
    std::unordered_map<const geometry::Shape*, int> entryOf_;
    std::vector<FlatEmitter> flat_; ///< by entry; empty if some shape is not flat, or there are many
    double area_ = 0;
    LightChooser chooser_; ///< over entries_; empty if there are few
};

} // namespace alpenglow::world
