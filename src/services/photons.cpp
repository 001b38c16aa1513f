// photonmap() and caustic(): photon map lookups.
#include "base/direction.h"
#include "services/services.h"

namespace alpenglow::services {

void answerPhotons(Services& answers, const ServiceCall& call) {
    const PhotonSite& s = *call.s.photons;
    const WorldImpl& world = answers.world();
    if (s.point < 0 || answers.building()) return;
    static const int32_t kRadiance = rsl::internString("radiance");
    const auto triple = [&](int row, int lane) {
        return Vec3(call.at(row, lane), call.at(row + 1, lane), call.at(row + 2, lane));
    };
    const auto count = [&](int row, int lane, int none) {
        if (row < 0) return none;
        const float n = call.at(row, lane);
        return n >= 0 ? int(std::min(n, 1e6f)) : 0; // not a number: 0
    };
    call.each([&](int lane, const ShadePoint&) {
        const SurfaceBinding* b = s.caustic ? call.binding(world, lane) : nullptr;
        const photonmap::PhotonMap* map = nullptr;
        int estimator = 50;
        if (!s.caustic) map = answers.photonsOf(s.computed ? std::bit_cast<int32_t>(call.at(0, lane)) : call.s.nameId, call);
        else if (b && !b->photons.causticMap.empty()) {
            map = answers.photonsOf(rsl::internString(b->photons.causticMap), call);
            estimator = b->photons.estimator;
        }
        if (!map) return;
        photonmap::PhotonMap::Lookup l{triple(s.point, lane), directionOr(triple(s.normal, lane), {}),
                                       std::clamp(count(s.estimator, lane, estimator), 1, photonmap::PhotonMap::kMostAsked),
                                       count(s.minBounces, lane, 0)};
        const bool radiance = s.lookup < 0 ? s.radiance : std::bit_cast<int32_t>(call.at(s.lookup, lane)) == kRadiance;
        const Color c = radiance ? map->radiance(l) : map->irradiance(l) / float(kPi);
        if (call.s.resultRowCount < 3) return call.put(0, lane, luminance(c));
        for (int k = 0; k < 3; ++k) call.put(k, lane, c[k]);
    });
}

} // namespace alpenglow::services
