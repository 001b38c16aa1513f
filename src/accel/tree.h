// A tree of boxes over all triangles and primitives of exact shapes of a scene, eight children a node, up to six triangles a
// leaf.
//
// What a ray meets does not depend on the tree: boxes and the float test of triangles only leave out what cannot be met (their
// bounds hold whatever float arithmetic does), and what they let pass is met in double by the caller's rule. So the result is the
// same on every processor and for every way to build the tree.
//
// Nodes keep the boxes of their children in eighths of bits of their own box (after Ylitie, Karras and Laine, "Efficient
// Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs", HPG 2017): a node is two cache lines, and so is a leaf. Several
// rays are followed in turns, so that one waits for memory while the others work.
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

/// Quick: half the time for what is diced, whose triangles come as rows of quads, for rays that take a few parts in a hundred
/// longer: where there are no more than some ten a triangle. What rays meet is the same.
enum class Building { Best, Quick };

class Tree {
public:
    static constexpr int kWide = 8; ///< children of a node
    static constexpr int kLeafTriangles = 6, kLeafVertices = 8;
    static constexpr int kDeepest = 80; ///< nodes above each other
    /// No triangle reaches farther along an axis: distances to boxes beyond, over the parts of a direction, have no floats, and
    /// then every ray would have to look at every leaf.
    static constexpr float kFarthest = 1e30f;
    static bool reaches(const Vec3& p) {
        return !(std::fabs(p.x) <= kFarthest && std::fabs(p.y) <= kFarthest && std::fabs(p.z) <= kFarthest);
    }

    /// A child: nothing, a node, a leaf of triangles, or one primitive of an exact shape.
    using Child = uint32_t;
    static constexpr Child kLeaf = 0x80000000u, kExact = 0x40000000u, kIndex = 0x3fffffffu, kNothing = 0xffffffffu;

    struct alignas(128) Node {
        float origin[4]; ///< boxes: origin + scale * q
        float scale[4];
        Child child[kWide];
        uint8_t q[2][3][kWide]; ///< by side (lower, upper) and axis
        uint8_t spare[16];
    };
    struct alignas(128) Leaf {
        float p[3][kLeafVertices]; ///< by axis
        /// Three bits a number of a vertex. Those of triangle k are the lowest of the half k & 1 after 9 * (k >> 1) bits, so that
        /// one shift by lanes of 64 bits brings all of them down; from bit 59: how many triangles.
        uint64_t corners;
        uint32_t id[kLeafTriangles]; ///< triangles, counted through all shapes
        uint32_t size() const { return uint32_t(corners >> 59); }
        static int cornerAt(size_t triangle, int corner) { return int(32 * (triangle & 1) + 9 * (triangle >> 1)) + 3 * corner; }
        uint32_t vertex(uint32_t triangle, int corner) const { return uint32_t(corners >> cornerAt(triangle, corner)) & 7; }
        Vec3 point(uint32_t v) const { return {p[0][v], p[1][v], p[2][v]}; }
    };
    static_assert(sizeof(Node) == 128 && sizeof(Leaf) == 128);

    /// A child that is exact. Of a part of a shape that has a tree of its own: kPart and the number that Part gives, and the
    /// child of that tree.
    struct Exact {
        uint32_t shape, prim;
    };
    static constexpr uint32_t kPart = 0x80000000u;
    struct Part {
        geometry::Bounds bounds;
        uint32_t shape;
        Exact as;
    };
    /// Throws std::bad_alloc when memory is short, std::length_error for more than 2^30 leaves. keys, times: of the only shape,
    /// what it is at several times from 0 to 1; its points go linearly between them. parts: of shapes that are in the tree by
    /// them alone, ordered by shape.
    void build(std::span<const geometry::ShapeRef>, std::span<const geometry::ShapeRef> keys = {},
               std::span<const float> times = {}, std::span<const Part> parts = {}, Building = Building::Best);

    // ---- of a shape with keys
    /// The nodes with their boxes at time 1; those of nodes() are then the ones at time 0, and boxes between lie between. Else
    /// null.
    const Node* lastNodes() const { return last_.empty() ? nullptr : last_.data(); }
    struct Vertices {
        alignas(32) float p[3][kLeafVertices];
        Vec3 point(uint32_t v) const { return {p[0][v], p[1][v], p[2][v]}; }
    };
    /// Those of a leaf at a key.
    const Vertices& vertices(uint32_t leaf, size_t key) const { return moved_[leaf * keys_ + key]; }
    /// Vertices of this leaf lie at one place at first, and then do not: vertices() does not hold all of them.
    bool loose(uint32_t leaf) const { return loose_[leaf] != 0; }
    /// The largest coordinate at any time.
    float extent() const { return extent_; }

    /// Triangles that are left out, for a corner of theirs lies beyond kFarthest; and a shape that has some.
    size_t beyond() const { return beyond_; }
    uint32_t beyondOf() const { return beyondOf_; }
    const Node* nodes() const { return nodes_.data(); }
    const Leaf* leaves() const { return leaves_.data(); }
    bool empty() const { return nodes_.empty(); }
    /// Up to `most` children, the largest divided first, that hold all of the tree between them, and their boxes; the root alone
    /// for a tree with keys.
    std::vector<std::pair<Child, geometry::Bounds>> opened(size_t most) const;
    const geometry::Bounds& bounds() const { return bounds_; }
    bool reachesInto(std::span<const geometry::Plane>) const; ///< Accel::reachesInto(): by the boxes of its leaves
    size_t bytes() const {
        return nodes_.size() * sizeof(Node) + leaves_.size() * sizeof(Leaf) + exact_.size() * sizeof(Exact) +
               capsules_.size() * sizeof(geometry::Capsule);
    }
    const Exact& exact(uint32_t index) const { return exact_[index]; }
    const Exact* exacts() const { return exact_.data(); }
    /// Around each of them, by the same index; null: nothing is known of any. A radius of infinity: nothing is known.
    const geometry::Capsule* capsules() const { return capsules_.empty() ? nullptr : capsules_.data(); }
    /// Asks memory for what is needed to meet an exact primitive that has a capsule.
    void fetch(const Exact& e) const {
        if (const geometry::InCapsules* s = inCapsules_[e.shape]) s->fetch(e.prim);
    }
    /// Shape of a triangle, and its number there.
    void find(uint32_t id, uint32_t& shape, uint32_t& prim) const {
        uint32_t k = first_[id >> kCoarse];
        while (k + 1 < meshes_.size() && meshes_[k + 1].first <= id) ++k;
        shape = meshes_[k].shape;
        prim = id - meshes_[k].first;
    }

private:
    struct Builder;
    void orderChildren(); ///< of nodes: what likely stops a ray that comes to it is the last, where shadow rays begin
    void followKeys(std::span<const geometry::ShapeRef> keys, std::span<const float> times);
    void followLeaf(size_t leaf, std::span<const geometry::ShapeRef> keys, std::span<const float> times, Box& first, Box& last);
    struct Mesh {
        uint32_t first, shape;
    }; ///< number of its first triangle
    static constexpr int kCoarse = 4;
    std::vector<Node> nodes_; ///< the root is the first
    std::vector<Leaf> leaves_;
    std::vector<Mesh> meshes_;
    std::vector<uint32_t> first_; ///< by sixteen triangles: into meshes_
    std::vector<Exact> exact_;    ///< in the order of the leaves
    std::vector<geometry::Capsule> capsules_;
    std::vector<const geometry::InCapsules*> inCapsules_; ///< by shape; null: none are known. Empty without capsules
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
