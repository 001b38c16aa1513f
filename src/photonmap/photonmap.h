// A photon map: photons of one emission, and density estimates. A k-d tree without pointers, as in Jensen, "Realistic Image
// Synthesis Using Photon Mapping" (2001). The same photons give the same tree and the same sums, bit by bit.
#pragma once
#include "photonmap/photon.h"
#include <memory>
#include <span>
#include <vector>

namespace alpenglow::photonmap {

/// The photons of one pass or file in a tree, for searches of the nearest. Immutable after it was built.
class PhotonMap {
public:
    PhotonMap() = default;
    /// The photons in order of emission.
    explicit PhotonMap(std::vector<Photon> photons);
    /// Number of photons.
    size_t size() const { return photons_.size(); }
    std::span<const Photon> photons() const { return photons_; } ///< in the order of the tree
    /// Total power.
    Color power() const;

    /// How nearest photons are searched.
    struct Lookup {
        Vec3 P, N;                   ///< N: unit; only light on its side counts
        int estimator = 50;          ///< number of photons in the estimate, 1 to kMostAsked
        int minBounces = 0;          ///< photons with fewer are ignored
        uint64_t* visited = nullptr; ///< counts visited photons
    };
    static constexpr int kMostAsked = 4096; ///< most photons of one search
    /// Irradiance, in radiance times steradians: power of the nearest `estimator` photons over the area of the disk to the next
    /// one, which is unbiased for uniform photons. With fewer photons the farthest one bounds the disk. Biased where light varies
    /// within the disk.
    Color irradiance(const Lookup&) const;
    /// Diffusely reflected radiance: photons weighted by the reflectance where they are stored.
    Color radiance(const Lookup&) const;

private:
    struct Found {
        float distance2;
        uint32_t at;
        bool operator<(const Found& b) const { return distance2 < b.distance2 || (distance2 == b.distance2 && at < b.at); }
    };
    class Nearest;
    struct Estimate {
        Color power, given;
        float area = 0;
    };
    /// Bounds of a node's photons: positions, and normals in steps of 1/127.
    struct Bounds {
        Vec3 lo, hi;
        int8_t normalLo[3], normalHi[3];
    };
    Estimate estimate(const Lookup&) const;
    Bounds bound(size_t begin, size_t end);
    bool mayCount(const Lookup&, size_t begin, size_t end, float within2) const;
    void build(std::vector<Photon>& from, std::vector<uint32_t>& order, size_t begin, size_t end);
    void nearest(const Lookup&, std::vector<Found>& found) const;
    void scan(const Lookup&, size_t begin, size_t end, Nearest&) const;
    bool counts(const Lookup&, size_t at) const;
    std::vector<Photon> photons_;
    /// Data that lookups read first: positions, and unit vectors in steps of 1/127.
    std::vector<float> place_[3];
    struct Directions {
        int8_t normal[3], from[3];
    };
    std::vector<Directions> directions_;
    std::vector<uint8_t> axis_; ///< by photon: split axis of its node
    /// Bounds of nodes with at least kBounded photons, by median index / kBoundStep: medians of two such nodes are at least that
    /// far apart.
    std::vector<Bounds> bounds_;
    static constexpr size_t kBounded = 16, kBoundStep = 8;
    static constexpr size_t kScanned = 32; ///< smaller nodes are searched linearly
};

/// Distance to the n-th nearest other photon: median over `asked` photons at uniform indices, i.e. the density where most photons
/// are. 0 if there are too few.
float typicalDistance(const PhotonMap&, int n, int asked);

} // namespace alpenglow::photonmap
