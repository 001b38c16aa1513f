// Searches of scenes of few primitives over blocks of 16 rays, at 4, 8 and 16 lanes; the processor chooses once. Every width
// gives the same bits. No standard header beyond <cstdint>: what compiles for newer processors must not leave a copy of a
// library's inline function behind for others.
#pragma once
#include <cstdint>

namespace alpenglow::accel {

/// What rays are tried against: triangles, as DirectTriangles holds them, and balls around exact shapes.
struct DirectScene {
    static constexpr int kTriangles = 24, kBalls = 4;
    int triangles = 0, balls = 0;
    /// Unit normal and distance of the plane, the two barycentric weights as linear functions of the point, and their slopes.
    float n[3][kTriangles], d[kTriangles], u[3][kTriangles], u0[kTriangles], v[3][kTriangles], v0[kTriangles], slope[kTriangles];
    double planeN[3][kTriangles], planeD[kTriangles];
    float corner[kTriangles][9];  ///< a, b, c
    uint32_t visible[kTriangles]; ///< Ray::mask that it shares a bit with
    float extent = 0;             ///< largest 1-norm of a corner
    double centre[3][kBalls], radius2[kBalls];
};

/// Rays that begin, which meet all surfaces from both sides.
struct alignas(64) DirectRays {
    static constexpr int kSize = 16;
    float org[3][kSize], dir[3][kSize], tnear[kSize], tfar[kSize];
    uint32_t mask[kSize];
};

/// What they meet.
struct alignas(64) DirectHits {
    double t[DirectRays::kSize], b1[DirectRays::kSize], b2[DirectRays::kSize]; ///< of the triangle
    int32_t triangle[DirectRays::kSize];                                       ///< -1: none
    uint32_t undecided = 0;                  ///< rays, as bits, whose search must be made in double, one by one
    uint32_t ball[DirectScene::kBalls] = {}; ///< by ball: rays that may meet it before the triangle
    uint32_t blocked = 0;                    ///< of any(): rays that surely meet a triangle
};

struct DirectSearch {
    /// The nearest triangle, and the balls that may lie before it.
    void (*nearest)(const DirectScene&, const DirectRays&, uint32_t rays, DirectHits&);
    /// Whether some triangle is met, and the balls that may be.
    void (*any)(const DirectScene&, const DirectRays&, uint32_t rays, DirectHits&);
};

/// The searches at 4, 8 or 16 lanes; null where this processor cannot run that.
const DirectSearch* directSearch(int lanes);
/// The widest that this processor runs.
const DirectSearch& directSearch();

} // namespace alpenglow::accel
