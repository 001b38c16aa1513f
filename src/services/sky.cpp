// __skysample() and __skydensity(): directions in proportion to the radiance of an environment map, for generateSamplesEnv() and
// evaluateSamplesEnv(), which are written in RSL.
#include "services/services.h"

namespace alpenglow::services {

/// Arguments: the map, then two numbers in [0, 1), or a direction in the map's space. Results: density per steradian; for
/// __skysample() the direction; radiance there.
void answerSky(Services& answers, const ServiceCall& call) {
    const bool draws = call.d.op == "__skysample";
    const size_t numbers = draws ? 2 : 1;
    if (call.s.rows.size() < numbers) return;
    const int first = call.s.rows[call.s.rows.size() - numbers], second = call.s.rows.back();
    call.each([&](int lane, const ShadePoint&) {
        const texture::SkyDirections& sky = answers.skyOf(answers.mapOfName(call.nameId(lane), [&] { return call.place(); }));
        const auto part = [&](int row) {
            const float x = call.at(row, lane);
            return std::isfinite(x) ? x : 0.f;
        };
        texture::SkyDirections::Direction d;
        if (draws) {
            d = sky.at({std::clamp(part(first), 0.f, 1.f), std::clamp(part(second), 0.f, 1.f)});
        } else {
            const Vec3 w(part(first), part(first + 1), part(first + 2));
            const float l = length(w);
            d = sky.of(l > 0 && std::isfinite(l) ? w / l : Vec3(0, 0, 1));
        }
        int row = 0;
        call.put(row++, lane, d.density);
        for (int k = 0; draws && k < 3; ++k) call.put(row++, lane, d.w[k]);
        for (int k = 0; k < 3; ++k) call.put(row++, lane, d.light[k]);
    });
}

} // namespace alpenglow::services
