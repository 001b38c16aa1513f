// The power of photons that lobes scatter.
//
// A photon continues along a lobe with the power that makes transport adjoint: light must be the same along a path in both
// directions. Let K be the radiance that the lobe scatters from one direction into the other; the photon's power is K times the
// cosine of the outgoing over that of the incoming direction, both with the geometric normal, over the sampling density (Veach,
// "Robust Monte Carlo Methods for Light Transport Simulation" (1997), 5.3). Refraction in shaders conserves radiance without the
// factor for the change of solid angle; the adjoint has its inverse.
#include "integrator/photonjob.h"

namespace alpenglow::integrator {

float photonFactor(const float* lobe, const LobeKind& kind, bool delta, const Vec3& from, const Vec3& to, const Vec3& n,
                   const Vec3& N) {
    const auto row = [&](int r) { return lobe[r * kLobeBlock]; };
    const float here = safeCosine(dot(from, n)), there = safeCosine(dot(to, n)), ways = there / here;
    const bool through = (dot(from, n) > 0) != (dot(to, n) > 0);
    if (delta) {
        if (!through) return ways;
        // Refraction about the shading normal, if it lies in one plane with the two directions.
        const Vec3 across = cross(from, to);
        const float si = sine(from, N), so = sine(to, N);
        if (!(si > 1e-5f) || std::fabs(dot(across, N)) > 1e-3f * length(across) + 1e-6f) return ways;
        const float index = so / si;
        return index * index * (safeCosine(dot(from, N)) / safeCosine(dot(to, N))) * ways;
    }
    const bool ofHorizon = kind.has(kCosineOfHorizon) && row(kRowHasHorizon) != 0;
    if (ofHorizon || kind.has(kCosineOfAxis)) {
        const int first = ofHorizon ? kRowHorizon : kRowAxis;
        const Vec3 axis(row(first), row(first + 1), row(first + 2));
        float index = 1;
        if (through && kind.has(kRefracts)) {
            const float eta = std::max(row(kRowEta), 1e-3f);
            index = dot(axis, from) < 0 ? eta : 1 / eta; // index on the side it came from over the other
        }
        return index * index * safeCosine(dot(from, axis)) / safeCosine(dot(to, axis)) * ways;
    }
    return ways;
}

} // namespace alpenglow::integrator
