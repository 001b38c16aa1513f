// diffuse(N), diffusely: Lambert. axis = N. f = 1/pi.
#include "transport/lobe.h"
#include "transport/sampling.h"

namespace alpenglow::transport {
namespace {
float value(const LobeParams& p, Vec3 w) { return std::max(0.f, dot(p.axis, w)) / float(kPi); }
bool draw(const LobeParams& p, Vec2 u, Vec3& w) {
    w = Basis(p.axis).toWorld(sampleCosine(u));
    return dot(p.axis, w) > 0;
}
} // namespace
extern const LobeKind kDiffuseLobe;
const LobeKind kDiffuseLobe = {"diffuse", "Lambert about axis: f = 1/pi. Radiance 1 from everywhere gives 1.",
                               [](const LobeParams&) { return false; }, value, value, draw,
                               [](const LobeParams&) { return 1.f; }, [](const LobeParams&) { return 0.7f; }};
} // namespace alpenglow::transport
