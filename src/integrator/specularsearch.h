// Searches for paths from lights with a single place or direction through mirrors and glass to given points: light that no ray
// meets and no light sample reaches. A search begins at a photon that came near the point (world/causticseeds.h), sends probes
// in directions next to it, and moves its start by Newton's method until it arrives. The same differences give the density of
// light there. How often other beginnings lead to the same path is found by repeating the search: that number of trials is an
// unbiased estimate of one over the probability of the path (Zeltner, Georgiev and Jakob, "Specular Manifold Sampling", 2020;
// Hanika, Droske and Fascione, "Manifold Next Event Estimation", 2015, for the idea of solving). Probes run the shaders of what
// they meet, so bumps, displacement and any shader of delta lobes count as they are.
#pragma once
#include "integrator/emission.h"
#include "integrator/pipeline.h"
#include "world/causticseeds.h"
#include <memory>
#include <span>
#include <vector>

namespace alpenglow::integrator {

/// Searches paths from points to lights by mirrors and glass.
class SpecularSearch {
public:
    /// seeds: must outlive the search.
    SpecularSearch(const std::shared_ptr<const WorldImpl>&, const CausticSeeds& seeds, Diagnostics&);
    ~SpecularSearch();
    /// A point to which light is sought. Camera space.
    struct Query {
        Vec3 P;                                   ///< camera space
        const CausticSeeds::Cell* cell = nullptr; ///< of CausticSeeds::find()
        int bounces = 0;                          ///< most mirrors of its path
        float time = 0;                           ///< as a fraction of the open shutter
        uint32_t vertex = 0;                      ///< with `numbers`: key of the random numbers of this search
        /// Of the point's sample.
        SampleNumbers numbers{Sampler(0, 0, 0), 0};
    };
    /// Light that comes to a point by one path, over the probability of having found it.
    struct Found {
        int light = -1; ///< in WorldImpl::lights(); -1: no path was found
        Vec3 from;      ///< the point of the last mirror
        Color Cl{0};    ///< as of a light without area at `from`: irradiance over pi on a surface that faces it
        float keptDiffuse = 1, keptSpecular = 1; ///< LightValue::kept()
    };
    /// Results depend on no other query. False if `stop` was set; `found` is then undefined.
    bool run(std::span<const Query>, std::span<Found> found, const StopFlag* stop);
    /// Counts since the search was made.
    struct Counts {
        uint64_t searches = 0, found = 0, probes = 0; ///< searches; those that found a path; probes sent
        uint64_t mirrors = 0;                         ///< that these probes were to meet
        uint64_t lost = 0; ///< paths that kMostTrials others did not find again; their light is too low
    };
    const Counts& counts() const { return counts_; }

private:
    struct Trial;
    Trial begin(const Query&, size_t query, uint32_t number);
    bool walk(std::span<Trial>, std::span<const Query>, const StopFlag*);
    bool send(const StopFlag*);
    bool light(std::span<const Trial>, std::span<const Query>, std::span<Found>, const StopFlag*);
    Found lightOf(const Trial&, const Vec3& P, const ProbeEnd*) const;
    void roulette(std::span<const Query>, std::span<Found>) const;
    bool repeat(std::span<const Trial>, std::span<const Query>, std::span<Found>, const StopFlag*);
    PhotonProbe probeAt(const Trial&, const Query&, const Vec3& start) const;
    const EmissionPlan::Light* planned(int light) const;
    Vec3 directionOf(const EmissionPlan::Light&, const Query&);

    const CausticSeeds& seeds_;
    Pipeline pipeline_;
    EmissionPlan plan_;
    std::vector<uint8_t> met_;
    bool moves_; ///< anything in the world
    PhotonJob job_;
    Counts counts_;
    std::vector<PhotonProbe> probes_; ///< of a round
    std::vector<ProbeEnd> ends_;
};

} // namespace alpenglow::integrator
