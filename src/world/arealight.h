// Where on an emitter a light sample lies, and with which density a given hit would have been chosen (design decision 4).
#pragma once
#include "geometry/shape.h"
#include <unordered_map>

namespace alpenglow::transport {

/// The geometry of one area light: its shapes, chosen in proportion to area. Full spheres that are still spheres in camera space
/// are sampled by the solid angle they fill; everything else over its area.
class Emitter {
public:
    /// visibility: kinds of rays (accel::Visibility) that can meet each shape; empty: all.
    explicit Emitter(std::vector<const geometry::Shape*> shapes, std::vector<uint32_t> visibility = {});
    bool empty() const { return entries_.empty(); }
    double area() const { return area_; }
    geometry::Bounds bounds() const;
    /// The point of the first shape at (u, v) of its area; `shape` is set to it. Only when not empty.
    geometry::SurfacePoint point(Vec2 u, const geometry::Shape*& shape) const {
        shape = entries_[0].shape;
        return shape->sampleArea(u.x, u.y);
    }
    /// Whether sample() needs its number `choose`.
    bool chooses() const { return entries_.size() > 1; }

    struct Sample {
        const geometry::Shape* shape = nullptr;
        float pdf = 0; ///< per steradian as seen from the lit point; > 0
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
    /// A point of the light that nobody looks at, and its shape; perArea: its density, per unit of area. Only when not empty.
    const geometry::Shape* samplePoint(Vec2 u, float choose, float time, geometry::SurfacePoint& point, float& perArea) const;
    /// Density per steradian with which sample() gives this hit as seen from `from`; 0 for shapes of other lights.
    float pdf(const geometry::Shape* shape, const geometry::SurfacePoint& hit, const Vec3& from) const;

private:
    struct Entry {
        const geometry::Shape* shape;
        double share, cumulative; ///< probability, and its sum up to and with this shape
        bool sphere = false;
        Vec3 centre;
        float radius = 0;
        uint32_t visibility = ~0u;
    };
    /// The shape that a number in [0, 1) chooses, by their shares. There is at least one.
    const Entry& entryAt(float choose) const;
    float areaPdf(const Entry&, const geometry::SurfacePoint&, const Vec3& from) const;
    std::vector<Entry> entries_;
    std::unordered_map<const geometry::Shape*, int> entryOf_;
    double area_ = 0;
};

} // namespace alpenglow::transport
