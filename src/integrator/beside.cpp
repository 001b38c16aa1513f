// Rays that leave surfaces in a medium and pass a light there: what they find is about 1 / sine of the angle that they are off
// its direction, so that draws by a lobe alone bring it with a variance without bound. A part of the draws is even in that angle.
#include "integrator/lobeselection.h"
#include "integrator/mediastacks.h"
#include "integrator/medium.h"
#include "integrator/photonstage.h"
#include "integrator/requests.h"
#include "lobes/sampling.h"

namespace alpenglow::transport {

namespace {
constexpr float kMostBeside = 0.3f; ///< of a lobe's draws
constexpr float kThin = 0.2f;       ///< optical length to a light where it is half of that
} // namespace

/// Finds the lights, and how many draws are for them: the fewer the less the lobe gives back from there, and the less is
/// scattered on the way there.
void LobeSelection::besideLights() {
    if (!world_.scatters_ || !rules_.pickOne || !rules_.lightsAtRequests || c_->between || photons_.photonTrace() ||
        world_.settings_.mediumSampling == MediumSampling::Distance)
        return;
    aimed_.clear();
    for (size_t point = 0; point < c_->points.size(); ++point)
        if (begin_[point] != begin_[point + 1]) besideLight(point);
    if (aimed_.empty()) return;
    for (int i : aimed_) requests_.rows.ask(requests_.lobes[size_t(i)].place, requests_.lobes[size_t(i)].beside);
    requests_.rows.evaluate();
    for (int i : aimed_) {
        LobeVertex& l = requests_.lobes[size_t(i)];
        const LobeValue v = requests_.rows.value(l.place);
        l.besideShare *= v.fcos > 0 && v.pdf > 0 ? std::min(1.f, v.pdf * float(kPi)) : 0;
    }
}

/// Of a point: the light on the side that it is seen from, else on the other one.
void LobeSelection::besideLight(size_t point) {
    const PathRay& ray = c_->rays[point];
    const ShadePoint& p = c_->points[point];
    const Vec3 n = dot(p.surface.n, ray.dir) > 0 ? -p.surface.n : p.surface.n;
    for (const Vec3& side : {n, -n}) {
        const int medium = MediaStacks::mediumOf(media_.towards(*c_, int(point), side));
        if (medium < 0) continue;
        const Medium& m = world_.media_[size_t(medium)];
        if (!m.homogeneous || !(maxComponent(m.homogeneous->scattering) > 0)) continue;
        float away = 0;
        const Vec3 to = mediumFlights_.besideLight(m, ray, p.P, &away);
        if (!(dot(to, side) > 0)) continue;
        const float thick = away * mean(m.homogeneous->scattering);
        for (int i : lobesOf(point)) {
            LobeVertex& l = requests_.lobes[size_t(i)];
            // What a kernel is told of its rays is by their lobe alone.
            if (l.delta || !l.followed || !(l.chosen > 0) || l.ownsTarget || l.elsewhere || l.below >= 0 ||
                (l.trace && l.trace->onlyLights))
                continue;
            l.beside = to;
            l.besideShare = kMostBeside * thick / (thick + kThin);
            aimed_.push_back(i);
        }
        return;
    }
}

/// The density of a lobe's draws toward w, those beside its light among them.
float LobeSelection::densityBeside(const LobeVertex& l, const Vec3& w, float ofLobe) {
    if (!(l.besideShare > 0)) return ofLobe;
    const float sine = std::max(length(cross(w, l.beside)), 1e-6f);
    return (1 - l.besideShare) * ofLobe + l.besideShare * float(0.5 / (kPi * kPi)) / sine;
}

/// A direction beside the light by u, or nothing: then u is for the lobe.
std::optional<Vec3> LobeSelection::drawBeside(const LobeVertex& l, Vec2& u) {
    if (!(l.besideShare > 0)) return {};
    if (u.x >= l.besideShare) {
        u.x = std::min((u.x - l.besideShare) / (1 - l.besideShare), 1 - 0x1p-24f);
        return {};
    }
    const Vec2 off = unitCircle(0.5f * u.x / l.besideShare), about = unitCircle(u.y);
    return Basis(l.beside).toWorld({off.y * about.x, off.y * about.y, off.x});
}

} // namespace alpenglow::transport
