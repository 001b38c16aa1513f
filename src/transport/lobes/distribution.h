// What trace()'s distributions share with each other: values from the code that bsdf() runs (shadeops/bsdf/), frames, half vectors.
#pragma once
#include "shadeops/descriptor.h"
#include "transport/lobe.h"
#include "transport/sampling.h"

namespace alpenglow::transport {

/// Arguments of one of the symbols al_bsdf_*, in order.
struct BsdfArguments {
    float number[32];
    int count = 0;
    BsdfArguments& operator<<(float x) { number[count++] = x; return *this; }
    BsdfArguments& operator<<(const Vec3& v) { return *this << v.x << v.y << v.z; }
    /// One to three numbers.
    Color value(std::string_view symbol, int width) const {
        float out[3] = {};
        rsl::evaluateRuntime(symbol, number, count, out, width);
        return width == 1 ? Color(out[0]) : Color(out[0], out[1], out[2]);
    }
};

/// Smaller roughness counts as this, as in bsdf().
inline float sane(float roughness) { return std::max(roughness, 0.01f); }
inline float exponentOf(float roughness) { return std::max(std::pow(sane(roughness), -3.5f) - 1, 0.f); }
/// The plane of "horizon" lets through what lies on the same side of it as of the surface.
inline bool aboveHorizon(const LobeParams& p, const Vec3& w) { return !p.hasHorizon || dot(p.horizon, w) * dot(p.axis, w) > 0; }

/// u as far along udir as a tangent of n can lie; any tangent where udir says nothing.
struct TangentFrame {
    Vec3 u, v, n;
    TangentFrame(const Vec3& normal, const Vec3& udir) : n(normal) {
        Vec3 wanted = udir - n * dot(n, udir);
        if (!(dot(wanted, wanted) > 1e-12f * dot(udir, udir))) {
            const Vec3 any = std::fabs(n.x) < 0.9f ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
            wanted = any - n * dot(n, any);
        }
        u = wanted / length(wanted);
        v = cross(n, u);
    }
    Vec3 toWorld(const Vec3& a) const { return u * a.x + v * a.y + n * a.z; }
    Vec3 toLocal(const Vec3& a) const { return {dot(a, u), dot(a, v), dot(a, n)}; }
};

inline bool notDelta(const LobeParams&) { return false; }
inline float about1(const LobeParams&) { return 1; }
inline float spreadOf(const LobeParams& p) { return std::min(0.7f, sane(std::min(p.more->roughness, p.more->roughnessv))); }

} // namespace alpenglow::transport
