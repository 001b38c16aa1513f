// Choosing among many lights: about limits::kLightsSampled of a list get a sample at a vertex, in time that grows with the
// logarithm of their number.
#pragma once
#include "base/vec.h"
#include "lanes/lighttree.h"
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace alpenglow::transport {

/// Directions within an angle about an axis.
struct Cone {
    Vec3 axis;
    float cosine = -1; ///< of the angle; -1: all directions
    bool all() const { return !(cosine > -1); }
    /// The same turned about.
    Cone opposite() const { return {-axis, cosine}; }
};
/// One that holds both.
Cone around(const Cone&, const Cone&);

/// What the choice knows of a light. Power: luminance that it brings to a point at distance 1; of lights without a place
/// (Distant), anywhere. Lengths in current space.
struct LightBound {
    Vec3 centre;
    float radius = 0;
    float power = 0;
    bool everywhere = false; ///< its light does not fall off
    Cone front = {};         ///< its light leaves at less than a right angle from one of these directions
};

/// A tree over the lights of one list. The probability of a light is about `wanted` times its share of power over squared
/// distance, times the greatest cosine at which its light can leave towards the point: one that faces away takes nothing. A part
/// of it, kBlind, is the same for all lights, so that one whose power was not seen (a spot between the probes) is found too.
///
/// A point far from a node sees it as one light; near ones are opened first (the cut), and their shares are of all nodes of the
/// cut. Below the cut a node's probability is split between its two children by the same measure. One random number chooses: a
/// comb with teeth one apart over the running sum of the probabilities of the leaves (systematic sampling), so that a light is in
/// the choice with exactly its probability, which divides what it gives. After Conty Estevez and Kulla, Importance Sampling of
/// Many Lights with Adaptive Tree Splitting (2018); the comb makes the number of lights the same at all points.
class LightChooser {
public:
    /// A tenth of the choice does not look at power.
    static constexpr double kBlind = 0.1;
    /// The most that may be `wanted`.
    static constexpr int kMost = LightTree::kMost;

    LightChooser() = default;
    /// Lights are numbered as they come here. `wanted`: how many of them a choice has, about; 1 to kMost.
    LightChooser(std::span<const LightBound> lights, int wanted);
    bool empty() const { return leafOf_.empty(); }

    using Chosen = std::vector<std::pair<int, float>>;
    /// Lights for a point, with their probabilities (0 to 1], each once, in any order. `u`: a random number, 0 <= u < 1.
    void choose(const Vec3& at, float u, Chosen& chosen) const;
    /// Of a chooser that wants one: a single light, and its probability, which is pmf(). Not where it is empty. A number that
    /// lies evenly
    /// in the range that chose the light is lost.
    int pick(const Vec3& at, float u, float& p) const;
    /// The probability that choose(), or pick(), takes this light.
    float pmf(int light, const Vec3& at) const;
    /// For stages over blocks (lanes/stages.h); good as long as this is.
    LightTree tree() const;

private:
    using Node = LightNode;
    /// A node of the cut, and its share of importance in the whole.
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
    /// The greatest cosine at which light of a node can leave towards a point, 0 to 1.
    double towards(const Node&, const Vec3& at) const;
    Cut cutAt(const Vec3& at) const;
    double probability(double share, const Node&) const;
    /// Shares of the children in that of their parent.
    std::pair<double, double> divide(const Node&, const Vec3& at) const;

    std::vector<Node> nodes_;
    std::vector<LightFront> fronts_; ///< by node
    std::vector<int> leafOf_;        ///< by light
    std::vector<int> roots_;         ///< of lights with a place, and of the others
    int wanted_ = 1;
};

} // namespace alpenglow::transport
