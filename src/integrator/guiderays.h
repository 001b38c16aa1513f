// Caustic guide: at a point with a non-delta lobe, an extra ray toward the mirrors that send caustics there
// (world/causticguide.h). It continues along delta lobes only and counts only light behind a mirror. The lobe's own ray finds the
// same light by chance; the power heuristic weights both (Veach and Guibas 1995). The own ray is weighted at its first mirror, so
// rays without mirrors cost nothing.
// Reads points, lobes and PathRay::trail; writes rays. Sixteen points ask at once; costs about 40 ns a point, and a density at
// each mirror behind one.
#pragma once
#include "bsdf/lobe.h"
#include "integrator/context.h"
#include "world/causticguide.h"

namespace alpenglow::integrator {

class RayStore;
struct StageSet;

/// Sends and weights the rays of the caustic guide.
class GuideRays final : Stage {
public:
    explicit GuideRays(const StageSet&);
    /// Whether the caustic guide is active.
    bool on() const { return guide() != nullptr; }

    /// The guide's entry for a point. code 0: no ray is sent.
    struct Aim {
        const CausticGuide::Cell* cell = nullptr; ///< null: no cell
        int side = 0, code = 0;                   ///< SurfaceTree::sideOf(); CausticGuide::chanceOf()
        /// PathRay::trail for the rays of the lobe itself.
        uint8_t trail() const {
            return code ? uint8_t(shading::kTrailSpread | code * shading::kTrailGuide | side * shading::kTrailSide) : 0;
        }
    };
    struct Query {
        Vec3 P, n, in; ///< the point; unit surface normal; unit direction of the incoming ray
        float brings;  ///< luminance that the eye receives through the lobe under uniform light of radiance 1
    };
    /// At most SurfaceTree::kTogether queries.
    void aim(std::span<const Query>, Aim*) const;

    /// A lobe with a ray of its own of density `pdf`, followed with probability `chosen`.
    struct Lobe {
        const PathRay& from;  ///< the ray that hit the point
        AccumulatorId target; ///< receives the light of the ray
        Vec3 P;               ///< the point, camera space
        Color weight;         ///< of the request alone, without the throughput of `from`
        float indirect;       ///< LobeVertex::indirect times the energy rule, 0 to 1
        float chosen;         ///< probability that the lobe's own ray is drawn
        float spread;         ///< half angle of the lobe, radians
        const RayKind* kind;  ///< of the ray
        int32_t share;        ///< RayExtra::share
        float importance;     ///< PathRay::importance
        float maxDistance;    ///< of the ray
    };
    /// Decides at random whether to send a ray, and samples its direction w.
    bool draws(const PathRay& from, const Aim&, const Vec3& P, Vec3& w) const;
    /// Sends the ray. value: of the lobe toward w; origin, path, media: of the ray. Rays without contribution are not sent.
    void send(const Lobe&, const Aim&, const Vec3& w, const LobeValue& value, const Vec3& origin, uint16_t path,
              const shading::Media* media, Sched&);

    /// PathRay::lobePdf and trail of the ray that a mirror reflects when hit by `from`.
    float pdfBehindMirror(const PathRay& from) const;
    /// Trail of the ray behind a mirror that `from` has hit.
    static uint8_t trailBehindMirror(const PathRay& from) {
        if (!(from.trail & shading::kTrailSpread)) return 0;
        return uint8_t(shading::kTrailSpread | shading::kTrailMirrored |
                       (from.guided() ? shading::kGuided * shading::kTrailGuide : 0));
    }
    /// Whether surfaces of this binding end guided rays because they are no mirrors. Transmission is not guided there either.
    bool ends(int binding) const { return ends_[size_t(binding)] != 0; }
    /// Whether a guided ray contributes nothing after hitting a surface of this binding.
    bool bringsNothing(const PathRay& r, int binding) const;
    /// Updates a ray that continues behind a surface of this binding. Guide rays end at surfaces that are no mirrors, so light
    /// that the lobe's own ray finds behind such a surface counts in full.
    void continueBehind(PathRay& r, int binding) const {
        if (binding < 0 || !ends(binding)) return;
        if (r.guideCode()) r.trail &= shading::kTrailGuide - 1;
        if (r.lobePdf < 0) r.lobePdf = -1;
    }

private:
    const CausticGuide* guide() const {
        return rules_.pickOne && rules_.lightsAtRequests && world_.photons() ? world_.photons()->guide.get() : nullptr;
    }
    std::vector<char> ends_; ///< by binding
    RayStore& store_;
};

} // namespace alpenglow::integrator
