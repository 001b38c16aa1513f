// trace()'s "oren-nayar": axis = normal. Drawn by the cosine.
#include "transport/lobes/distribution.h"

namespace alpenglow::transport {
namespace {
float value(const LobeParams& p, Vec3 w) {
    if (!aboveHorizon(p, w)) return 0;
    return (BsdfArguments() << w << p.axis << p.wo << p.more->roughness).value("al_bsdf_orennayar", 1).x;
}
float density(const LobeParams& p, Vec3 w) { return std::max(0.f, dot(p.axis, w)) / float(kPi); }
bool draw(const LobeParams& p, Vec2 u, Vec3& w) {
    w = Basis(p.axis).toWorld(sampleCosine(u));
    return dot(p.axis, w) > 0 && aboveHorizon(p, w);
}
} // namespace
extern const LobeKind kOrenNayarLobe;
const LobeKind kOrenNayarLobe = {"oren-nayar", "Rough diffuse surface with normal axis, seen from wo.", notDelta, value, density, draw, about1,
                                 [](const LobeParams&) { return 0.5f; }, nullptr, true};
} // namespace alpenglow::transport
