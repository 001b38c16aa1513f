// A bounding volume hierarchy over triangles and exact primitives of a scene: eight children a node (BVH8), up to six triangles a
// leaf.
//
// Hits do not depend on the tree: boxes and the float test of triangles only exclude what cannot be hit (their bounds include
// float errors), and the remaining candidates are intersected in double by the caller's rule. So the result is the same on every
// processor and for every way to build the tree.
//
// Nodes store child boxes in 8 bits relative to their own box (after Ylitie, Karras and Laine, "Efficient Incoherent Ray
// Traversal on GPUs Through Compressed Wide BVHs", HPG 2017): a node takes two cache lines, and so does a leaf. Several rays are
// traversed in turn, so that one waits for memory while others compute.
#pragma once
#include "geometry/capsule.h"
#include "geometry/plane.h"
#include "geometry/shape.h"
#include <cmath>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace alpenglow::accel {

struct Box;

/// Quick: takes half the time for diced shapes, whose triangles come in rows of quads, at a few percent slower traversal; for up
/// to about ten rays per triangle. Hits are the same.
enum class Building { Best, Quick };

/// The tree. Immutable after build().
class Bvh {
public:
    static constexpr int kWidth = 8;                            ///< children of a node
    static constexpr int kLeafTriangles = 6, kLeafVertices = 8; ///< capacity of a leaf
    static constexpr int kDeepest = 80;                         ///< maximum depth
    /// Largest coordinate of a triangle. Farther boxes would overflow the distances in float, so that every ray visits every
    /// leaf.
    static constexpr float kFarthest = 1e30f;
    /// Whether a corner is beyond kFarthest, or NaN.
    static bool reaches(const Vec3& p) {
        return !(std::fabs(p.x) <= kFarthest && std::fabs(p.y) <= kFarthest && std::fabs(p.z) <= kFarthest);
    }

    /// A child: none, a node, a leaf of triangles, or one primitive of an exact shape.
    using Child = uint32_t;
    static constexpr Child kLeaf = 0x80000000u, kExact = 0x40000000u, kIndex = 0x3fffffffu, kNothing = 0xffffffffu;

    /// Eight children and their boxes, relative to the node's own.
    struct alignas(128) Node {
        float origin[4];         ///< boxes: origin + scale * q
        float scale[4];          ///< by axis; the fourth number is not used
        Child child[kWidth];     ///< kNothing where there are fewer
        uint8_t q[2][3][kWidth]; ///< by side (lower, upper) and axis
        uint8_t spare[16];       ///< fills two cache lines
    };
    /// Up to six triangles over eight vertices.
    struct alignas(128) Leaf {
        float p[3][kLeafVertices]; ///< by axis
        /// Three bits for the index of a vertex. Those of triangle k are the lowest bits of half k & 1 after a shift by 9 * (k >>
        /// 1), so that one shift of 64-bit lanes aligns all of them; from bit 59: number of triangles.
        uint64_t corners;
        uint32_t id[kLeafTriangles]; ///< triangles, numbered over all shapes
        /// Number of triangles.
        uint32_t size() const { return uint32_t(corners >> 59); }
        /// Where the three bits of a corner begin in `corners`.
        static int cornerAt(size_t triangle, int corner) { return int(32 * (triangle & 1) + 9 * (triangle >> 1)) + 3 * corner; }
        /// The index of a corner among the vertices of the leaf.
        uint32_t vertex(uint32_t triangle, int corner) const { return uint32_t(corners >> cornerAt(triangle, corner)) & 7; }
        /// A vertex, in the space of the tree.
        Vec3 point(uint32_t v) const { return {p[0][v], p[1][v], p[2][v]}; }
    };
    static_assert(sizeof(Node) == 128 && sizeof(Leaf) == 128);

    /// An exact child. For a part of a shape with its own tree: kPart and the number in Part, and the child in that tree.
    struct Exact {
        uint32_t shape, prim; ///< indices of the shape, and of the primitive in it
    };
    static constexpr uint32_t kPart = 0x80000000u;
    /// A part of a shape with its own tree, as it appears in this one.
    struct Part {
        geometry::Bounds bounds; ///< camera space
        uint32_t shape;
        Exact as;
    };
    /// Throws std::bad_alloc if memory is short, std::length_error for more than 2^30 leaves. keys, times: for a single shape,
    /// its states at several times from 0 to 1; points move linearly in between. parts: of shapes that are in the tree by their
    /// parts only, ordered by shape.
    void build(std::span<const geometry::ShapeRef>, std::span<const geometry::ShapeRef> keys = {},
               std::span<const float> times = {}, std::span<const Part> parts = {}, Building = Building::Best);

    // ---- for a shape with keys
    /// The nodes with their boxes at time 1; those of nodes() are then for time 0, and boxes in between are interpolated.
    /// Otherwise null.
    const Node* lastNodes() const { return last_.empty() ? nullptr : last_.data(); }
    struct Vertices {
        /// By axis, in the order of Leaf::p.
        alignas(32) float p[3][kLeafVertices];
        /// Vertex v of the leaf.
        Vec3 point(uint32_t v) const { return {p[0][v], p[1][v], p[2][v]}; }
    };
    /// The vertices of a leaf at a key.
    const Vertices& vertices(uint32_t leaf, size_t key) const { return moved_[leaf * keys_ + key]; }
    /// Vertices of this leaf coincide at first and separate later: vertices() does not hold all of them.
    bool loose(uint32_t leaf) const { return loose_[leaf] != 0; }
    /// Largest coordinate at any time.
    float extent() const { return extent_; }

    /// Number of triangles left out because a corner is beyond kFarthest; and a shape that has some.
    size_t beyond() const { return beyond_; }
    uint32_t beyondOf() const { return beyondOf_; }
    /// The tree: the first node is the root; leaves by the index in Child.
    const Node* nodes() const { return nodes_.data(); }
    const Leaf* leaves() const { return leaves_.data(); }
    /// There is nothing in it.
    bool empty() const { return nodes_.empty(); }
    /// Up to `most` subtrees that together contain the complete tree, with their boxes; the largest are divided first. Only the
    /// root for a tree with keys.
    std::vector<std::pair<Child, geometry::Bounds>> opened(size_t most) const;
    /// Of all contents; empty if there are none.
    const geometry::Bounds& bounds() const { return bounds_; }
    bool reachesInto(std::span<const geometry::Plane>) const; ///< Accel::reachesInto(): by the boxes of its leaves
    /// Memory in bytes.
    size_t bytes() const {
        return nodes_.size() * sizeof(Node) + leaves_.size() * sizeof(Leaf) + exact_.size() * sizeof(Exact) +
               capsules_.size() * sizeof(geometry::Capsule);
    }
    /// What a child of kind kExact means.
    const Exact& exact(uint32_t index) const { return exact_[index]; }
    /// All exact children, by the same index.
    const Exact* exacts() const { return exact_.data(); }
    /// Capsules around exact primitives, by the same index; null: none. Infinite radius: unknown.
    const geometry::Capsule* capsules() const { return capsules_.empty() ? nullptr : capsules_.data(); }
    /// Prefetches the data for intersecting an exact primitive with a capsule.
    void fetch(const Exact& e) const {
        if (const geometry::InCapsules* s = inCapsules_[e.shape]) s->fetch(e.prim);
    }
    /// Shape of a triangle, and its index there.
    void find(uint32_t id, uint32_t& shape, uint32_t& prim) const {
        uint32_t k = first_[id >> kCoarse];
        while (k + 1 < meshes_.size() && meshes_[k + 1].first <= id) ++k;
        shape = meshes_[k].shape;
        prim = id - meshes_[k].first;
    }

private:
    struct Builder;
    void orderChildren(); ///< of nodes: the child that most likely stops a ray becomes the last, where shadow rays start
    void followKeys(std::span<const geometry::ShapeRef> keys, std::span<const float> times);
    void followLeaf(size_t leaf, std::span<const geometry::ShapeRef> keys, std::span<const float> times, Box& first, Box& last);
    struct Mesh {
        uint32_t first, shape;
    }; ///< index of its first triangle
    static constexpr int kCoarse = 4;
    std::vector<Node> nodes_; ///< the root is the first
    std::vector<Leaf> leaves_;
    std::vector<Mesh> meshes_;
    std::vector<uint32_t> first_; ///< by sixteen triangles: index in meshes_
    std::vector<Exact> exact_;    ///< in order of the leaves
    std::vector<geometry::Capsule> capsules_;
    std::vector<const geometry::InCapsules*> inCapsules_; ///< by shape; null: none. Empty without capsules
    geometry::Bounds bounds_;
    std::vector<Node> last_;
    std::vector<Vertices> moved_;
    std::vector<uint8_t> loose_;
    size_t keys_ = 0;
    float extent_ = 0;
    size_t beyond_ = 0;
    uint32_t beyondOf_ = 0;
};

} // namespace alpenglow::accel
