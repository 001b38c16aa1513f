// Emitting photons: where light of lights goes (EmissionPlan), what is wanted of it (PhotonJob), and what comes to rest.
#pragma once
#include "integrator/batchcontext.h"
#include "integrator/storedphoton.h"

namespace alpenglow::transport {

class LightKernels;
struct PhotonJob;

/// The numbers of one photon before it meets anything.
struct EmissionDraw {
    int light = -1;        ///< of EmissionPlan::lights(); -1: there is none
    float chance = 0;      ///< with which this light was drawn
    Vec2 place, way, cone; ///< each evenly in the square; `way` is guided
    float choose = 0, side = 0, time = 0;
    float density = 1;                                          ///< of `way`
    render::SampleNumbers numbers{render::Sampler(0, 0, 0), 0}; ///< all of the photon's, for random() of shaders
};

/// Which lights emit photons, and how many of all each gets: in proportion to power, or to what was found to arrive.
class EmissionPlan {
public:
    /// A light that emits. Camera space.
    struct Light {
        const BoundLight* light = nullptr;
        int number = -1;             ///< in WorldImpl::lights_
        double power = 0;            ///< luminance, about
        double share = 0, until = 0; ///< of the photons; sum up to and with this one
        Vec3 place;                  ///< LightKind::Point
        double pdf = 0;              ///< BoundLight::photons: mean of what generatePhoton() says
        float front = .5f;           ///< Area: of its photons, those that leave on the side of n
        std::vector<float> guide;    ///< kBins x kBins: densities of `way` by row; empty: even
        std::vector<float> rows;     ///< of the guide: share of each row of bins
    };
    static constexpr int kBins = 32;

    /// The lights that emit, as their attributes say: those with "emitphotons" 1, or where no light of the frame says anything,
    /// all but those that `all` leaves out. all: false: only lights that say so. sky: environments count, too.
    EmissionPlan(LightKernels&, bool all, bool sky);
    bool empty() const { return lights_.empty(); }
    const std::vector<Light>& lights() const { return lights_; }
    /// Whether anything moves that photons may meet or come from; and how far lights do while the shutter is open.
    bool moves() const;
    float travel() const;
    /// By light of the world, whether it emits.
    std::vector<uint8_t> emits() const;
    /// By shape, whether photons meet it. `both`: only what diffuse and specular rays meet.
    std::vector<uint8_t> met(bool both) const;

    /// The numbers of photon `number` of the emission with this key.
    EmissionDraw draw(const render::SampleNumbers&) const;
    /// Of an emission of `emitted` photons by this plan, those that came to rest: from now on more are sent where these went.
    void learn(std::span<const StoredPhoton>, const PhotonJob&, uint32_t emitted);

    /// A ball about all that photons can meet.
    Vec3 centre;
    float radius = 0;

private:
    void measure(LightKernels&, Light&);
    bool findPlace(LightKernels&, Light&);
    void share();
    const WorldImpl& world_;
    std::vector<Light> lights_;
};

/// One emission.
struct PhotonJob {
    const EmissionPlan* plan = nullptr;
    const uint8_t* met = nullptr; ///< by shape
    uint64_t seed = 0;
    uint32_t pass = 0;     ///< other passes have other photons
    bool caustics = false; ///< only photons that mirrors and glass sent are kept, and none goes on behind other lobes
    bool learns = false;   ///< PhotonUse::learns
    double scale = 1;      ///< of their power: one over how many are emitted
    bool models = true;    ///< Attribute "photon" "shadingmodel" counts
    float width = 0;       ///< caustics: lobes whose spread is below, in radians, count as mirrors
    render::SampleNumbers numbers(uint32_t photon) const {
        return {render::Sampler(render::SeedKey(seed ^ 0x70686f746f6e7331ull), int(pass >> 24), int(pass & 0xffffffu)), photon};
    }
};

/// Photons on their way.
struct PhotonTrace {
    const PhotonJob* job = nullptr;
    uint32_t first = 0;       ///< number of the photon of PathSample::path 0
    std::vector<Color> power; ///< by path: of a ray of weight 1, in units of job->scale
    struct From {
        int light = -1; ///< number in WorldImpl::lights_
        float kept = 1; ///< EmissionStart::kept
    };
    std::vector<From> from; ///< by path
    std::vector<StoredPhoton>* out = nullptr;
    RayKind diffuse, specular;
    float fastest = 0; ///< how far surfaces that photons have met move while the shutter is open
};

/// How many lobes of either kind those surfaces leave to a photon for caustics that have sent it on (Attribute "trace"
/// "maxdiffusedepth", "maxspeculardepth"). In PathRay::asked: nothing waits for photons.
struct PhotonDepths {
    static constexpr int kAll = 255; ///< as many as there are
    int diffuse = kAll, specular = kAll;
    static PhotonDepths of(const shading::PathRay& r) { return {r.asked >> 8, r.asked & 255}; }
    void to(shading::PathRay& r) const { r.asked = uint16_t(diffuse << 8 | specular); }
};

/// Of the angle between two unit vectors.
inline float sine(const Vec3& w, const Vec3& n) { return length(cross(w, n)); }

/// Radians between a photon's way and the normal below which the way is tilted (photonscatter.cpp).
inline constexpr float kLeastTilt = 1e-3f;

/// By how much a photon's power is more than the light that its lobe gives back, in radiance along the other way: the lobe at
/// `l`, for a photon that came from direction `from` and goes to `to`, both unit and away from the surface; n: its normal.
float photonFactor(const LobeColumns&, LobeColumns::Place, const LobeKind&, bool delta, const Vec3& from, const Vec3& to,
                   const Vec3& n, const Vec3& N);

/// The part that is left of it.
inline Color leftOfPhoton(const BatchContext& c, size_t point) {
    return c.haze.empty() || !c.haze[point].on ? Color(1) : c.haze[point].slope;
}

} // namespace alpenglow::transport
