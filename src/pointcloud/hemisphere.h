// Visibility from a point in point clouds: rasterises them onto a cube of pixels around it. Distant clusters cover the solid
// angle that they subtend, near disks are drawn, nearest first. Approximate: errors do not vanish with more samples. Source:
// Christensen, Point-Based Approximate Color Bleeding, Pixar Technical Memo 08-01 (2008).
#pragma once
#include "pointcloud/octree.h"

namespace alpenglow::pointcloud {

/// Lengths and directions in the space of the cloud; angles in radians.
struct HemisphereQuery {
    Vec3 P, N;                         ///< N: unit
    float cone = 1.57079633f;          ///< half angle about N
    Vec3 axis;                         ///< only directions towards it; 0: all
    bool uniform = false;              ///< directions count alike, else by the cosine
    float maxDistance = 1e38f;         ///< ignores farther points
    float bias = 0;                    ///< ignores nearer points
    float maxSolidAngle = .1f;         ///< steradians: a cluster that looks larger is taken apart
    bool clamp = true;                 ///< multiple coverage of a pixel counts once
    bool sort = false;                 ///< nearer fragments hide farther ones
    DiskSides sides = DiskSides::Both; ///< which sides of disks emit and occlude
    bool colours = true;               ///< light is wanted
    /// Attenuation by distance: exp(-fall d), or (1 - d / maxDistance)^fall.
    float fall = 0;
    bool polynomial = false;
};

/// Use one for each thread: it reuses its memory.
class Hemisphere {
public:
    /// Starts a query: the cube is empty.
    void begin(const HemisphereQuery&);
    /// Draws a cloud; several may be added.
    void add(const PointOctree&);
    /// Sums the cube over the directions of the query.
    void finish();
    /// After finish(): means over the directions of the query. blocked(): covered fraction, 0 to 1 if clamped; then the arriving
    /// light.
    float blocked() const { return blocked_; }
    const Color& light() const { return light_; }
    /// f(direction, part of all directions that is open there), for each pixel in which something is; the parts add up to 1 -
    /// blocked().
    template <class F> void eachOpen(F&& f) const {
        for (const uint32_t i : used_)
            if (pixels_[i].open > 0) f(directions_[i], pixels_[i].open);
    }
    /// Half the width of a pixel, radians.
    float spread() const { return 1 / float(side_); }

private:
    struct Pixel {
        float weight, near, geometric, blocked, open;
        Color nearLight, light;
    };
    struct Fragment {
        uint32_t pixel;
        float distance, cover;
        Color light;
    };
    float fade(float distance) const;
    uint32_t pixelOf(const Vec3& direction) const;
    void cover(uint32_t pixel, float part, float distance, float kept, const Color& light);
    void splat(const Vec3& direction, float solidAngle, float distance, const Color& light);
    void cluster(const PointOctree::Node&, const Vec3& to, float distance);
    void point(const PointOctree::Point&);
    void draw(const PointOctree::Point&, const Vec3& to);
    void drawOnFace(const PointOctree::Point&, const Vec3& to, int face);
    void sortFragments();
    void thin();
    void compose();
    HemisphereQuery q_;
    int side_ = 0; ///< pixels along an edge of the cube
    std::vector<Vec3> directions_;
    std::vector<float> angles_; ///< steradians
    std::vector<Pixel> pixels_;
    std::vector<uint32_t> used_, stack_;
    std::vector<Fragment> fragments_;
    float blocked_ = 0;
    Color light_;
};

} // namespace alpenglow::pointcloud
