// A photon map: photons of one emission, and the light that they are found to be at a point. A tree of k dimensions without
// pointers, as in Jensen, "Realistic Image Synthesis Using Photon Mapping" (2001). The same photons give the same tree and the
// same sums, bit by bit.
#pragma once
#include "photons/photon.h"
#include <memory>
#include <span>
#include <vector>

namespace alpenglow::photons {

class PhotonMap {
public:
    PhotonMap() = default;
    /// The photons in the order in which they were emitted.
    explicit PhotonMap(std::vector<Photon> photons);
    size_t size() const { return photons_.size(); }
    std::span<const Photon> photons() const { return photons_; } ///< in the tree's order
    /// Sum of what all carry.
    Color power() const;

    struct Lookup {
        Vec3 P, N;                   ///< N: unit; light counts that arrives on its side
        int estimator = 50;          ///< photons that are asked for, 1 to kMostAsked
        int minBounces = 0;          ///< photons with fewer are passed over
        uint64_t* visited = nullptr; ///< counts the photons that are looked at
    };
    static constexpr int kMostAsked = 4096;
    /// Power of the nearest photons over the area of the disc that they fill: irradiance, in radiance times steradians. The
    /// nearest `estimator` of them count, and the disc reaches to the one after: so the estimate is right in the mean where
    /// photons lie evenly. Of fewer the farthest bounds the disc. Biased where light changes within the disc.
    Color irradiance(const Lookup&) const;
    /// What the surface gives back of it as diffuse light: the reflection that the photons there have met.
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
    /// What bounds the photons of a node: their places, and their normals in steps of 1/127.
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
    /// What look-ups read of photons first: places, and unit vectors in steps of 1/127.
    std::vector<float> place_[3];
    struct Directions {
        int8_t normal[3], from[3];
    };
    std::vector<Directions> directions_;
    std::vector<uint8_t> axis_; ///< by photon: along which its node divides
    /// Of nodes of kBounded photons or more, by their middle / kBoundStep: the middles of two such nodes are that far apart.
    std::vector<Bounds> bounds_;
    static constexpr size_t kBounded = 16, kBoundStep = 8;
    static constexpr size_t kScanned = 32; ///< nodes of fewer photons are looked through from end to end
};

/// The distance to the n-th nearest other photon, of a photon in the middle of `asked` that are picked evenly: how dense photons
/// are where they are dense. 0 where there are too few.
float typicalDistance(const PhotonMap&, int n, int asked);

} // namespace alpenglow::photons
