// Searches in scenes of few primitives over blocks of 16 rays, at 4, 8 and 16 lanes, selected once by processor. Every width
// gives the same bits. No standard header beyond <cstdint>: code for newer processors must not leave a copy of a library's inline
// function for others.
#pragma once
#include <cstdint>

namespace alpenglow::accel {

/// The scene: triangles in the layout of DirectTriangles, and bounding spheres of exact shapes.
struct DirectScene {
    static constexpr int kTriangles = 24, kBalls = 4; ///< capacity
    int triangles = 0, balls = 0;                     ///< number of each
    /// Unit normal and distance of the plane, the two barycentric weights as linear functions of the point, and their slopes.
    float n[3][kTriangles], d[kTriangles], u[3][kTriangles], u0[kTriangles], v[3][kTriangles], v0[kTriangles], slope[kTriangles];
    double planeN[3][kTriangles], planeD[kTriangles];
    float corner[kTriangles][9];               ///< a, b, c
    uint32_t visible[kTriangles];              ///< bits shared with Ray::mask
    float extent = 0;                          ///< largest 1-norm of a corner
    double centre[3][kBalls], radius2[kBalls]; ///< camera space; squared radii
};

/// New rays that hit all surfaces from both sides.
struct alignas(64) DirectRays {
    static constexpr int kSize = 16;                               ///< rays of a block
    float org[3][kSize], dir[3][kSize], tnear[kSize], tfar[kSize]; ///< as in Ray: camera space, t in lengths of dir
    uint32_t mask[kSize];                                          ///< as Ray::mask
};

/// Their hits.
struct alignas(64) DirectHits {
    double t[DirectRays::kSize], b1[DirectRays::kSize], b2[DirectRays::kSize]; ///< for the triangle
    int32_t triangle[DirectRays::kSize];                                       ///< -1: none
    uint32_t undecided = 0;                  ///< rays, as bits, that must be searched in double, one by one
    uint32_t ball[DirectScene::kBalls] = {}; ///< by sphere: rays that may hit it before the triangle
    uint32_t blocked = 0;                    ///< by any(): rays that certainly hit a triangle
};

/// The searches of one lane width; `rays`: those of the block to search, as bits. All widths give the same hits.
struct DirectSearch {
    /// Finds the nearest triangle, and the spheres that may be hit before it.
    void (*nearest)(const DirectScene&, const DirectRays&, uint32_t rays, DirectHits&);
    /// Finds whether some triangle is hit, and the spheres that may be.
    void (*any)(const DirectScene&, const DirectRays&, uint32_t rays, DirectHits&);
};

/// The searches at 4, 8 or 16 lanes; null if this processor cannot run that width.
const DirectSearch* directSearch(int lanes);
/// The widest that this processor can run.
const DirectSearch& directSearch();

} // namespace alpenglow::accel
