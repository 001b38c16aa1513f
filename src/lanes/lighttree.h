// The light tree in the layout of its stage (meaning: world/lightchooser.h). No standard header beyond <cstdint>, as in blocks.h.
#pragma once

#include "lanes/names.h"
#include <cstdint>

namespace alpenglow::lanes {

/// A node of one cache line, so that lanes load complete nodes and transpose them to rows.
struct alignas(64) LightNode {
    float centre[3] = {0, 0, 0};               ///< current space
    int32_t next = -1;                         ///< first of its two adjacent children; < 0: a leaf, ~next is its light
    double power = 0;                          ///< of the lights below it
    double radius2 = 0;                        ///< squared, > 0
    double blind = 0;                          ///< uniform part of the choice for these lights
    double wide2 = 0;                          ///< squared distance within which it is opened; 0: never
    int32_t count = 1;                         ///< number of lights below it
    uint32_t flags = 0;                        ///< kEverywhere and kFaces
    int32_t parent = -1;                       ///< index; -1: a root
    static constexpr uint32_t kEverywhere = 1; ///< no falloff, for all lights below it
    static constexpr uint32_t kFaces = 2;      ///< its front does not include all directions
    /// Next is a light.
    bool leaf() const { return next < 0; }
    /// Lights without a position.
    bool everywhere() const { return flags & kEverywhere; }
    /// Its front counts.
    bool faces() const { return flags & kFaces; }
};
static_assert(sizeof(LightNode) == 64);

/// Emission directions of a node: Cone of world/lightchooser.h; and related values.
struct alignas(64) LightFront {
    float axis[3] = {0, 0, 0}, centre[3] = {0, 0, 0}; ///< unit; current space
    double radius2 = 0, cosine = -1, sine = 0;        ///< of the cone's angle
};
static_assert(sizeof(LightFront) == 64);

/// The complete tree.
struct LightTree {
    static constexpr int kMost = 64; ///< maximum of `wanted`
    static constexpr int kCut = 32;  ///< maximum number of nodes in a cut
    /// Limit for one point.
    static constexpr int kMostChosen = kMost + kCut + 4;
    const LightNode* nodes = nullptr;
    const LightFront* fronts = nullptr;       ///< by node
    int32_t roots[2] = {0, 0}, rootCount = 0; ///< indices: one for lights with a position, one for the others
    double wanted = 1, seeing = 1;            ///< seeing: fraction of the choice that uses power
    double lights = 1;                        ///< number of lights
};

/// A light chosen for a point of a block, with its probability.
struct ChosenLight {
    int32_t light, lane; ///< index of the light; point of the block
    float chance;        ///< probability, 0 to 1
};

} // namespace alpenglow::lanes
