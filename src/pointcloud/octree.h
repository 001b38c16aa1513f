// A point cloud for distant receivers: an octree whose nodes store projected area and emitted light by direction. Source:
// Christensen, Point-Based Approximate Color Bleeding, Pixar Technical Memo 08-01 (2008).
#pragma once
#include "base/diagnostics.h"
#include "pointcloud/pointcloud.h"
#include <array>
#include <memory>

namespace alpenglow::pointcloud {

/// Which sides of disks block and send. Balls (no normal) do on all.
enum class DiskSides : uint8_t { Both, Front, Back };

/// The tree of one cloud. Immutable.
class PointOctree {
public:
    /// A disk or a ball of the cloud.
    struct Point {
        Vec3 P, N;      ///< N: unit, or 0: a ball
        float area = 0; ///< > 0
        Color light;    ///< radiance of the surface; for subsurface() entering irradiance over PI
        /// Radius of a disk with the area of the point, without gaps; a sphere of this projected area.
        float radius() const;
    };
    /// A function of the direction from which the node is seen, by real spherical harmonics of bands 0 to 2.
    using Harmonics = std::array<float, 9>;
    /// A cluster of points, and what it looks like from afar.
    struct Node {
        Vec3 centre;                      ///< mean by area
        float reach = 0;                  ///< largest distance of its disks from the centre
        float area = 0;                   ///< of all
        Color power;                      ///< area times light, of all
        Harmonics seen;                   ///< of disks: projected area of their front sides
        std::array<Harmonics, 3> sent;    ///< the same times light
        float ball = 0;                   ///< area of balls
        Color ballPower;                  ///< sum over balls of area times radiosity
        uint32_t begin = 0, end = 0;      ///< points
        uint32_t first = 0, children = 0; ///< nodes; none: a leaf
    };
    /// `lightChannel`: a color or float; "": none. Excludes points without area, and those with absurdly large area.
    PointOctree(const PointCloud&, const std::string& lightChannel);
    const std::vector<Node>& nodes() const { return nodes_; } ///< the root first; none: no points
    /// In the order of the leaves.
    const std::vector<Point>& points() const { return points_; }
    size_t leftOut() const { return leftOut_; } ///< points
    bool lit() const { return lit_; }           ///< the channel exists
    /// Memory.
    size_t bytes() const { return points_.size() * sizeof(Point) + nodes_.size() * sizeof(Node); }
    /// Projected area of a node in direction `towards` (unit), and the light that it sends there.
    static float seenFrom(const Node&, const Vec3& towards, DiskSides, Color* sent);

    /// Calls f(distance, point or node area times light, radius or 0) for all points as seen from P; nodes above the solid angle
    /// limit are opened.
    template <class F> void each(const Vec3& P, float maxSolidAngle, F&& f) const;

private:
    void build(uint32_t at, uint32_t begin, uint32_t end, int shift, std::span<const uint64_t> codes);
    void sum(Node&) const;
    std::vector<Point> points_;
    std::vector<Node> nodes_;
    size_t leftOut_ = 0;
    bool lit_ = false;
};

/// Solid angle, in steradians, of a square around everything within `reach` at a distance.
inline float solidAngleOf(float reach, float distance2) { return 3.14159265f * reach * reach / distance2; }

template <class F> void PointOctree::each(const Vec3& P, float maxSolidAngle, F&& f) const {
    if (nodes_.empty()) return;
    std::vector<uint32_t> stack = {0};
    while (!stack.empty()) {
        const Node& n = nodes_[stack.back()];
        stack.pop_back();
        const Vec3 d = n.centre - P;
        const float d2 = dot(d, d);
        if (d2 > n.reach * n.reach && solidAngleOf(n.reach, d2) < maxSolidAngle) {
            f(double(std::sqrt(d2)), n.power, 0.0);
        } else if (n.children) {
            for (uint32_t k = n.children; k-- > 0;) stack.push_back(n.first + k);
        } else {
            for (uint32_t i = n.begin; i < n.end; ++i) {
                const Point& p = points_[i];
                f(double(length(p.P - P)), p.light * p.area, std::sqrt(double(p.area) / 3.14159265358979));
            }
        }
    }
}

} // namespace alpenglow::pointcloud
