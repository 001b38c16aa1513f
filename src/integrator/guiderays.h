// Guide: at a point whose lobe spreads light, an extra ray toward the mirrors that light is known to come from there
// (world/causticguide.h). It goes on by single directions alone and counts only where it meets a light behind one.
// The lobe's own ray finds the same light by chance: both are weighed by the power heuristic (Veach and Guibas 1995), the own ray
// where it meets its first mirror, so that a ray that meets none pays nothing.
// Reads points, lobes and PathRay::trail; writes rays. Costs some 60 ns a point and a density at each mirror behind one.
#pragma once
#include "integrator/context.h"
#include "lobes/lobe.h"
#include "world/causticguide.h"

namespace alpenglow::transport {

class RayStore;
struct StageSet;

class GuideRays final : Stage {
public:
    explicit GuideRays(const StageSet&);
    /// Whether paths are guided here.
    bool on() const { return guide() != nullptr; }

    /// What the guide knows of a point. code 0: no ray is sent.
    struct Aim {
        const CausticGuide::Cell* cell = nullptr;
        int side = 0, code = 0;
        /// PathRay::trail of the rays that the lobe itself draws.
        uint8_t trail() const {
            return code ? uint8_t(shading::kTrailSpread | code * shading::kTrailGuide | side * shading::kTrailSide) : 0;
        }
    };
    /// P: the point; n: unit normal of its surface; in: unit direction in which it is seen; brings: luminance of what the eye
    /// gets of even light of radiance 1 by way of the lobe.
    Aim aimAt(const Vec3& P, const Vec3& n, const Vec3& in, float brings) const;

    /// A lobe that has a ray of its own with density `pdf`, drawn with the chance `chosen`.
    struct Lobe {
        const PathRay& from; ///< that came to the point
        TargetId target;     ///< gets what the ray brings
        Vec3 P;              ///< the point, camera space
        Color weight;        ///< of the request alone, without the throughput of `from`
        float indirect;      ///< LobeVertex::indirect and the energy rule, 0 to 1
        float chosen;        ///< probability that the lobe's own ray is drawn
        float spread;        ///< half angle of the lobe, radians
        const RayKind* kind;
        int32_t share;
        float importance;
        float maxDistance;
    };
    /// Whether chance sends a ray from where `from` came to, and then in which direction.
    bool draws(const PathRay& from, const Aim&, const Vec3& P, Vec3& w) const;
    /// Sends it. value: of the lobe toward w; origin, path, media: of the ray. A ray that brings nothing is not sent.
    void send(const Lobe&, const Aim&, const Vec3& w, const LobeValue& value, const Vec3& origin, uint16_t path,
              const shading::Media* media, Sched&);

    /// PathRay::lobePdf and trail of a ray that a mirror sends on which `from` came to.
    float pdfBehindMirror(const PathRay& from) const;
    static uint8_t trailBehindMirror(const PathRay& from) {
        if (!(from.trail & shading::kTrailSpread)) return 0;
        return uint8_t(shading::kTrailSpread | shading::kTrailMirrored |
                       (from.guided() ? shading::kGuided * shading::kTrailGuide : 0));
    }
    /// Whether the surfaces of a binding send nothing on that is guided: they are no mirrors. What comes through them is not
    /// guided either.
    bool ends(int binding) const { return ends_[size_t(binding)] != 0; }
    /// Whether a guided ray that has met a surface of the binding brings nothing.
    bool bringsNothing(const PathRay& r, int binding) const;
    /// Of a ray that goes on behind a surface of the binding. The guide's rays end at surfaces that are no mirrors, so what their
    /// lobes' own rays find behind these counts in full.
    void passThrough(PathRay& r, int binding) const {
        if (binding < 0 || !ends(binding)) return;
        if (r.guideCode()) r.trail &= shading::kTrailGuide - 1;
        if (r.lobePdf < 0) r.lobePdf = -1;
    }

private:
    const CausticGuide* guide() const {
        return rules_.pickOne && rules_.lightsAtRequests && world_.photons_ ? world_.photons_->guide.get() : nullptr;
    }
    std::vector<char> ends_; ///< by binding
    RayStore& store_;
};

} // namespace alpenglow::transport
