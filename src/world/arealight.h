// Where on an emitter a light sample lies, and the density of a given hit (docs/design/light-transport.md).
#pragma once
#include "world/emitterfacets.h"
#include "world/trianglelamp.h"
#include <functional>
#include <span>
#include <unordered_map>

namespace alpenglow::transport {

/// The geometry of one area light: its shapes, chosen in proportion to area, of more than limits::kLightsSampled in proportion
/// to area over squared distance (LightChooser). Full spheres that are still spheres in camera space are sampled by the solid
/// angle they fill, and so are a few triangles near by; what is diced over the area of its facets; everything else over its area.
class Emitter {
public:
    /// visibility: kinds of rays (accel::Visibility) that can meet each shape; empty: all.
    explicit Emitter(std::vector<const geometry::Shape*> shapes, std::vector<uint32_t> visibility = {});
    /// When shapes are diced: from now on samples lie where rays meet them, and areas are those of what rays meet.
    /// seenThrough: whether a shape lets light through, so that what lies behind it on the same ray shines as well; null: none.
    void takeDiced(const std::function<bool(const geometry::Shape&)>& seenThrough = {});
    /// Says from which side light leaves: of the shapes with two sides, too.
    enum class Shines { Both, Front, Back };
    void shinesTo(Shines);
    /// The directions about which light leaves.
    Cone front() const;
    bool empty() const { return entries_.empty(); }
    double area() const { return area_; }
    geometry::Bounds bounds() const;
    /// The point of the first shape at (u, v) of its area; `shape` is set to it. Only when not empty.
    geometry::SurfacePoint point(Vec2 u, const geometry::Shape*& shape) const {
        shape = entries_[0].shape;
        return shape->sampleArea(u.x, u.y);
    }
    /// For lanes, if it is a few shapes of a few flat triangles each: all of them; else none.
    std::span<const FlatEmitter> flat() const { return flat_; }
    /// Of flat ones: the one that a number in [0, 1) chooses, and with which probability; Sample::visibility.
    size_t flatFrom(const Vec3& from, float choose, double& share) const {
        return size_t(&entryFrom(from, choose, share) - entries_.data());
    }
    uint32_t flatVisibility(size_t shape) const { return entries_[shape].visibility; }
    const geometry::Shape& flatShape(size_t shape) const { return *entries_[shape].shape; }
    /// Whether sample() needs its number `choose`.
    bool chooses() const { return entries_.size() > 1; }

    struct Sample {
        const geometry::Shape* shape = nullptr;
        float pdf = 0;  ///< per steradian as seen from the lit point; > 0
        Vec3 direction; ///< unit, from the lit point to the light
        float distance = 0;
        uint32_t visibility = ~0u; ///< kinds of rays that could have met this shape by chance
    };
    /// A point of the light for the lit point at `from`. False when the draw faces edge-on or coincides with `from`.
    /// needs: geometry::PointNeed of `point`.
    /// time: of the shutter, 0 to 1.
    bool sample(const Vec3& from, Vec2 u, float choose, float time, Sample& out, geometry::SurfacePoint& point,
                uint32_t needs = geometry::kNeedAll) const;
    /// A point of the surface for a mean over it: `pdf` is its density in units of the even one. Back sides count. False as
    /// above.
    bool sampleSurface(const Vec3& from, Vec2 u, float choose, float time, Sample& out, geometry::SurfacePoint& point,
                       uint32_t needs = geometry::kNeedAll) const;
    /// A point of the light that nobody looks at, and its shape; perArea: its density, per unit of area, 0 for a point that is
    /// cut away. toward: what turns to rays faces those that leave it along this. Only when not empty.
    const geometry::Shape* samplePoint(Vec2 u, float choose, float time, const Vec3& toward, geometry::SurfacePoint& point,
                                       float& perArea) const;
    /// Density per steradian with which sample() gives this hit as seen from `from`; 0 for shapes of other lights.
    float pdf(const geometry::Shape* shape, const geometry::SurfacePoint& hit, const Vec3& from) const;

private:
    struct Entry {
        const geometry::Shape* shape;
        double share, cumulative; ///< probability, and its sum up to and with this shape
        bool sphere = false;
        bool inner = false;   ///< of a sphere: the wall of a hole in a solid, of which the far side is seen
        bool through = false; ///< of a sphere: both its near and its far side are seen
        Vec3 centre;
        float radius = 0;
        uint32_t visibility = ~0u;
        int facets = -1;    ///< facets_; -1: rays meet the surface itself
        int triangles = -1; ///< triangles_; -1: never sampled by their solid angle
        Cone front;         ///< the directions about which light leaves
    };
    /// A whole sphere as it is seen from outside: 1 - cos of half the angle that it fills. False: from within.
    static bool outside(const Entry&, const Vec3& from, double& cap);
    bool sampleSphere(const Entry&, const Vec3& from, Vec2 u, double cap, double share, Sample&, geometry::SurfacePoint&,
                      uint32_t needs) const;
    void weigh();
    void makeChooser();
    /// A point for a lit one. False: it is cut away.
    bool place(const Entry&, const Vec3& from, Vec2 u, float time, geometry::SurfacePoint&, uint32_t needs) const;
    /// Density per area of place().
    double density(const Entry& e, const geometry::SurfacePoint& p) const {
        return e.facets < 0 ? e.shape->sampleDensity(p) : facets_[size_t(e.facets)].density(p);
    }
    /// The shape that a number in [0, 1) chooses, by their shares of the area. There is at least one.
    const Entry& entryAt(float choose) const;
    /// That which it chooses as seen from a point, and with which probability.
    const Entry& entryFrom(const Vec3& from, float choose, double& share) const;
    float areaPdf(const Entry&, double share, const geometry::SurfacePoint&, const Vec3& from) const;
    std::vector<Entry> entries_;
    std::vector<EmitterFacets> facets_;
    std::vector<TriangleLamp> triangles_;
    std::unordered_map<const geometry::Shape*, int> entryOf_;
    std::vector<FlatEmitter> flat_; ///< by entry; empty if some is not flat, or there are many
    double area_ = 0;
    LightChooser chooser_; ///< over entries_; empty where there are few
};

} // namespace alpenglow::transport
