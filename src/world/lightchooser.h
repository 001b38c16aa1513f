// Sampling of many lights: chooses about limits::kLightsSampled of a list for a vertex, in time logarithmic in their number.
#pragma once
#include "base/vec.h"
#include "lanes/lighttree.h"
#include "world/names.h"
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace alpenglow::world {

/// Directions within an angle of an axis.
struct Cone {
    Vec3 axis;
    float cosine = -1; ///< cosine of the angle; -1: all directions
    /// Every direction is in it.
    bool all() const { return !(cosine > -1); }
    /// The opposite cone.
    Cone opposite() const { return {-axis, cosine}; }
};
/// A cone that contains both.
Cone around(const Cone&, const Cone&);

/// A light for the chooser. power: luminance at distance 1, or anywhere for lights without a position (Distant). Lengths in
/// current space.
struct LightBound {
    Vec3 centre;      ///< centre of a ball around it
    float radius = 0; ///< of the ball
    float power = 0;
    bool everywhere = false; ///< no falloff with distance
    Cone front = {};         ///< light leaves at less than a right angle to one of these directions
};

/// A tree over the lights of a list. The probability of a light is about `wanted` times its share of power over squared distance,
/// times the largest cosine at which its light can leave toward the point, so lights that face away get none. A fraction kBlind
/// is equal for all lights, so that lights whose power was missed (a spot between the probes) are also found.
///
/// Far nodes act as one light; near ones are opened first (the cut), with shares relative to the whole cut. Below the
/// cut a node's probability is divided between its children by the same measure. One random number makes the choice by systematic
/// sampling: a comb of unit spacing over the cumulative probabilities of the leaves includes each light with exactly its
/// probability, by which its contribution is divided. After Conty Estevez and Kulla, Importance Sampling of Many Lights with
/// Adaptive Tree Splitting (2018); the comb makes the number of lights equal at all points.
class LightChooser {
public:
    /// Fraction of the choice that ignores power.
    static constexpr double kBlind = 0.1;
    /// Maximum of `wanted`.
    static constexpr int kMost = LightTree::kMost;

    LightChooser() = default;
    /// Lights are numbered in this order. `wanted`: approximate number of lights in a choice, 1 to kMost.
    LightChooser(std::span<const LightBound> lights, int wanted);
    bool empty() const { return leafOf_.empty(); }

    using Chosen = std::vector<std::pair<int, float>>; ///< indices of lights, and the probability of each
    /// Chooses lights for a point, each at most once, with their probabilities in (0, 1], in any order. `u`: random number in [0,
    /// 1).
    void choose(const Vec3& at, float u, Chosen& chosen) const;
    /// For wanted = 1: chooses one light; p: its probability, equal to pmf(). Uses up u. The chooser must not be empty.
    int pick(const Vec3& at, float u, float& p) const;
    /// Probability that choose() or pick() includes this light.
    float pmf(int light, const Vec3& at) const;
    /// For stages over blocks (lanes/stages.h); valid as long as this object.
    LightTree tree() const;

private:
    using Node = LightNode;
    /// A node of the cut, and its importance relative to the whole.
    struct Part {
        int node;
        double importance;
    };
    static constexpr int kCut = LightTree::kCut;
    struct Cut {
        Part part[kCut];
        int size = 0;
        double total = 0;
    };

    void build(int node, std::span<int> order, std::span<const LightBound> lights);
    size_t split(std::span<int> order, std::span<const LightBound> lights) const;
    double importance(const Node&, const Vec3& at) const;
    /// Largest cosine at which light of a node can leave toward a point, 0 to 1.
    double towards(const Node&, const Vec3& at) const;
    Cut cutAt(const Vec3& at) const;
    double probability(double share, const Node&) const;
    /// Fractions of the children in their parent's share.
    std::pair<double, double> divide(const Node&, const Vec3& at) const;

    std::vector<Node> nodes_;
    std::vector<LightFront> fronts_; ///< by node
    std::vector<int> leafOf_;        ///< by light
    std::vector<int> roots_;         ///< of lights with a position, and of the others
    int wanted_ = 1;
};

} // namespace alpenglow::world
