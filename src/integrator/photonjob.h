// Photon emission: the distribution over lights (EmissionPlan), parameters of one emission (PhotonJob), and the stored photons.
#pragma once
#include "integrator/batchcontext.h"
#include "integrator/photonprobe.h"
#include "world/storedphoton.h"
#include <algorithm>
#include <cmath>
#include <span>

namespace alpenglow::integrator {

class LightKernels;
struct PhotonJob;
struct PhotonUse;

/// Random numbers of one photon at emission.
struct EmissionDraw {
    int light = -1;                             ///< in EmissionPlan::lights(); -1: none
    float chance = 0;                           ///< probability of choosing this light
    Vec2 place, way, cone;                      ///< uniform in the unit square; `way` is warped by the guide
    float choose = 0, side = 0, time = 0;       ///< in [0, 1)
    float density = 1;                          ///< density of `way`
    SampleNumbers numbers{Sampler(0, 0, 0), 0}; ///< the photon's own generator, for random() in shaders
};

/// Which lights emit photons, and the share of each: in proportion to power, or to the power that was found to arrive.
class EmissionPlan {
public:
    /// A light that emits. Camera space.
    struct Light {
        const BoundLight* light = nullptr;
        int number = -1;             ///< in WorldImpl::lights()
        double power = 0;            ///< luminance, approximate
        double share = 0, until = 0; ///< fraction of the photons; cumulative sum including this light
        Vec3 place;                  ///< LightKind::Point
        double pdf = 0;              ///< BoundLight::photons: mean density from generatePhoton()
        float front = .5f;           ///< Area: fraction that leaves on the side of n
        bool bright = false;         ///< Environment: emits by its table, and only from its bright directions
        std::vector<float> guide;    ///< kBins x kBins: densities of `way` by row; empty: uniform
        std::vector<float> rows;     ///< probability of each row of the guide
    };
    static constexpr int kBins = 32;

    /// Lights that emit by their attributes: those with "emitphotons" 1; if no light of the frame sets it, all others except what
    /// PhotonUse::all excludes (false: only lights that set it).
    EmissionPlan(LightKernels&, const PhotonUse&);
    /// Whether no light emits; the lights that do.
    bool empty() const { return lights_.empty(); }
    const std::vector<Light>& lights() const { return lights_; }
    /// Whether anything moves that photons may hit or leave; distance that lights move while the shutter is open.
    bool moves() const;
    /// The longest distance that a light moves, camera space.
    float travel() const;
    /// By light of the world: whether it emits.
    std::vector<uint8_t> emits() const;
    /// By shape: whether photons hit it. `both`: only shapes that both diffuse and specular rays hit.
    std::vector<uint8_t> met(bool both) const;

    /// The random numbers of the photon with this generator.
    EmissionDraw draw(const SampleNumbers&) const;
    /// Adapts the plan to the stored photons of an emission of `emitted` photons: later emissions send more where these went.
    void learn(std::span<const StoredPhoton>, const PhotonJob&, uint32_t emitted);

    /// Bounding sphere of everything that photons can hit.
    Vec3 centre;
    float radius = 0;

private:
    void measure(LightKernels&, Light&);
    bool findPlace(LightKernels&, Light&);
    void share();
    const WorldImpl& world_;
    std::vector<Light> lights_;
};

/// Parameters of one emission.
struct PhotonJob {
    const EmissionPlan* plan = nullptr; ///< lights and their shares of the photons
    const uint8_t* met = nullptr;       ///< by shape
    uint64_t seed = 0;                  ///< of all random numbers
    uint32_t pass = 0;                  ///< each pass has other photons
    bool caustics = false;              ///< stores caustic photons only; photons continue along delta lobes only
    bool learns = false;                ///< PhotonUse::learns
    double scale = 1;                   ///< factor of photon power: one over the number of emitted photons
    bool models = true;                 ///< Attribute "photon" "shadingmodel" counts
    float width = 0;                    ///< caustics: lobes with a smaller spread, in radians, count as mirrors
    /// The numbers of a photon; photons are numbered over all threads.
    SampleNumbers numbers(uint32_t photon) const {
        return {Sampler(SeedKey(seed ^ 0x70686f746f6e7331ull), int(pass >> 24), int(pass & 0xffffffu)), photon};
    }
};

/// Photons in flight.
struct PhotonTrace {
    const PhotonJob* job = nullptr;      ///< what is emitted
    std::span<const PhotonProbe> probes; ///< by path; empty: photons are stored
    std::span<ProbeEnd> ends;            ///< by path, of the probes
    uint32_t first = 0;                  ///< photon number for PathSample::path 0
    std::vector<Color> power;            ///< by path: power for throughput 1, in units of job->scale
    /// Where a photon comes from.
    struct From {
        int light = -1; ///< index in WorldImpl::lights()
        float kept = 1; ///< EmissionStart::kept
    };
    std::vector<From> from;                   ///< by path
    std::vector<StoredPhoton>* out = nullptr; ///< receives the stored photons
    RayKind diffuse, specular;                ///< kinds of their rays
    float fastest = 0;                        ///< largest distance that surfaces hit by photons move while the shutter is open
};

/// Remaining diffuse and specular bounces of a caustic photon, by the surfaces that it hit (Attribute "trace" "maxdiffusedepth",
/// "maxspeculardepth"). Stored in PathRay::asked, which photons do not use otherwise.
struct PhotonDepths {
    static constexpr int kAll = 255; ///< no limit
    int diffuse = kAll, specular = kAll;
    /// As stored in the ray.
    static PhotonDepths of(const shading::PathRay& r) { return {r.asked >> 8, r.asked & 255}; }
    /// Stores both in the ray.
    void to(shading::PathRay& r) const { r.asked = uint16_t(diffuse << 8 | specular); }
};

/// Absolute value of a cosine, large enough to divide by it.
inline float safeCosine(float x) { return std::max(std::fabs(x), 1e-4f); }

/// Sine of the angle between two unit vectors.
inline float sine(const Vec3& w, const Vec3& n) { return length(cross(w, n)); }

/// Photons that arrive within this angle of the normal, in radians, are tilted (photonflight.cpp).
inline constexpr float kLeastTilt = 1e-3f;

/// Factor from the radiance that a lobe scatters along the reverse path to the power of the photon (adjoint correction). lobe:
/// its first row, the others kLobeBlock floats apart; `from`: direction to where the photon came from; `to`: where it goes; both
/// unit and away from the surface; n: its unit normal; N: shading normal.
float photonFactor(const float* lobe, const LobeKind&, bool delta, const Vec3& from, const Vec3& to, const Vec3& n,
                   const Vec3& N);

/// Transmittance of the volume before a photon's hit.
inline Color photonTransmittance(const BatchContext& c, size_t point) {
    return c.atmosphereEffects.empty() || !c.atmosphereEffects[point].on ? Color(1) : c.atmosphereEffects[point].slope;
}

} // namespace alpenglow::integrator
