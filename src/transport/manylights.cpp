// Choosing among many lights. With few, each gets a sample at every vertex. With more than limits::kLightsSampled about that many get
// one, in proportion to power over squared distance, by systematic sampling: one random number, a comb over the running sum of the
// probabilities. A light is in the choice with exactly its probability, which divides what it gives: the mean stays the same.
#include "transport/engine.h"

namespace alpenglow::transport {

namespace {
// A tenth of the choice does not look at power, so that a light whose power was not seen (a spot between the probes) is found too.
constexpr double kBlind = 0.1;
} // namespace

void WorldImpl::lightChances(const std::vector<int>& lights, const Vec3& at, std::vector<float>& chance) const {
    size_t n = lights.size();
    chance.assign(n, 1.f);
    if (n <= size_t(limits::kLightsSampled)) return;
    double total = 0;
    for (size_t i = 0; i < n; ++i) {
        const BoundLight& l = lights_[size_t(lights[i])];
        float d2 = 1;
        if (l.kind != LightKind::Distant) {
            Vec3 to = l.centre - at;
            d2 = std::max({dot(to, to), l.radius * l.radius, 1e-12f});
        }
        chance[i] = std::isfinite(l.power / d2) ? l.power / d2 : 0;
        total += chance[i];
    }
    for (float& c : chance) {
        double share = total > 0 ? (1 - kBlind) * c / total + kBlind / double(n) : 1 / double(n);
        c = float(std::min(1.0, limits::kLightsSampled * share));
    }
}

void Engine::chooseLights(const std::vector<int>& lights, const Vec3& at, float random, std::vector<std::pair<int, float>>& chosen) {
    chosen.clear();
    world_->lightChances(lights, at, chances_);
    double sum = 0;
    double comb = std::ceil(-double(random));
    for (size_t i = 0; i < lights.size(); ++i) {
        sum += chances_[i];
        double next = std::ceil(sum - double(random));
        if (next > comb || chances_[i] >= 1) chosen.push_back({int(i), chances_[i]});
        comb = next;
    }
}

float Engine::chanceOf(int light, int binding, const Vec3& at) {
    const std::vector<int>& lights = world_->sampledLights_[size_t(world_->bindings_[size_t(binding)].lightList)];
    if (lights.size() <= size_t(limits::kLightsSampled)) return 1;
    auto i = std::find(lights.begin(), lights.end(), light);
    if (i == lights.end()) return 0;
    world_->lightChances(lights, at, chances_);
    return chances_[size_t(i - lights.begin())];
}

} // namespace alpenglow::transport
