// trace()'s "hair": a fibre whose tip is axis. part: one lobe (R, TT, TRT, TRRT) alone. Directions are drawn evenly over the sphere: exact for
// every set of lobes, and noisy for narrow ones.
#include "transport/lobes/distribution.h"

namespace alpenglow::transport {
namespace {
constexpr int kLobes = 4, kNumbers = 4; // seed: up to 4 lobes of 4 numbers
const std::vector<float> kUnset = {1, 0, .3f, .3f, 1, 0, .3f, .3f, 1, 0, .3f, .3f};

Color colour(const LobeParams& p, Vec3 w) {
    const DistributionParams& m = *p.more;
    const std::vector<float>& lobes = m.lobes.empty() ? kUnset : m.lobes;
    const int count = std::min(kLobes, int(lobes.size()) / kNumbers);
    float largest = 1; // weights above 1 are scaled down together
    for (int i = 0; i < count; ++i) largest = std::max(largest, lobes[size_t(i * kNumbers)]);
    Color sum(0);
    for (int i = 0; i < count; ++i) {
        const float* of = &lobes[size_t(i * kNumbers)];
        if (of[0] == 0 || (m.part >= 0 && m.part != i)) continue;
        sum += (BsdfArguments() << w << p.axis << p.wo << m.udir << m.eta.x << m.absorption << float(i) << of[1] << of[2] << of[3]).value("al_bsdf_hair", 3) *
               (of[0] / largest);
    }
    return sum;
}
float value(const LobeParams& p, Vec3 w) { return maxComponent(colour(p, w)); }
float density(const LobeParams&, Vec3) { return 1 / (4 * float(kPi)); }
bool draw(const LobeParams& p, Vec2 u, Vec3& w) {
    w = Basis(p.axis).toWorld(sampleCone(2, u));
    return true;
}
} // namespace
extern const LobeKind kHairLobe;
const LobeKind kHairLobe = {"hair", "Light scattered by a fibre that points along axis.", notDelta, value, density, draw, about1,
                            [](const LobeParams&) { return 0.5f; }, colour, true};
} // namespace alpenglow::transport
