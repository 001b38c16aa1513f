// A tree of lights as the stage that chooses among them reads it (world/lightchooser.h says what it means). No standard header
// beyond <cstdint>, as in blocks.h.
#pragma once
#include <cstdint>

namespace alpenglow::transport {

/// A node: of a cache line's size, so that lanes load whole ones and turn them to rows.
struct alignas(64) LightNode {
    float centre[3] = {0, 0, 0}; ///< current space
    int32_t next = -1;           ///< the first of its two children, which lie side by side; < 0: a leaf, ~next its light
    double power = 0;
    double radius2 = 0; ///< squared, and not zero
    double blind = 0;   ///< the part of the choice that is the same for all lights, times its part of these
    double wide2 = 0;   ///< squared distance within which it is opened; 0: never
    int32_t count = 1;  ///< lights below it
    uint32_t flags = 0;
    int32_t parent = -1;
    static constexpr uint32_t kEverywhere = 1; ///< its light does not fall off; so in all of its tree
    static constexpr uint32_t kFaces = 2;      ///< its front is not all directions
    bool leaf() const { return next < 0; }
    bool everywhere() const { return flags & kEverywhere; }
    bool faces() const { return flags & kFaces; }
};
static_assert(sizeof(LightNode) == 64);

/// The directions that a node's light leaves to: Cone of world/lightchooser.h; and what of the node belongs to that.
struct alignas(64) LightFront {
    float axis[3] = {0, 0, 0}, centre[3] = {0, 0, 0};
    double radius2 = 0, cosine = -1, sine = 0; ///< cosine and sine of the cone's angle
};
static_assert(sizeof(LightFront) == 64);

/// All of it.
struct LightTree {
    static constexpr int kMost = 64; ///< the most that may be wanted
    static constexpr int kCut = 32;  ///< nodes of the cut at most
    /// Of a choice at a point.
    static constexpr int kMostChosen = kMost + kCut + 4;
    const LightNode* nodes = nullptr;
    const LightFront* fronts = nullptr; ///< by node
    int32_t roots[2] = {0, 0}, rootCount = 0;
    double wanted = 1, seeing = 1; ///< seeing: the part of the choice that is not blind
    double lights = 1;             ///< how many
};

/// A light that a point of a block has chosen, and with which probability.
struct ChosenLight {
    int32_t light, lane;
    float chance;
};

} // namespace alpenglow::transport
