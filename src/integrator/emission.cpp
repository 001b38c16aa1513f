// The distribution of photons over lights, and their random numbers.
#include "integrator/emission.h"
#include "integrator/integrator.h"
#include "integrator/lightkernels.h"
#include "world/photonattributes.h"
#include <algorithm>

namespace alpenglow::integrator {

namespace {
/// Keys of a photon's random numbers; its first ray has vertex 0, as a camera ray has.
enum Use : uint32_t { kUseLight = 1u << 24, kUsePlace, kUseWay, kUseCone, kUseChoose, kUseSide, kUsePhotonTime };
constexpr int kProbes = 64;       ///< samples for measuring the power of a light
constexpr double kUnlearned = .1; ///< fraction of photons for bins where nothing was found, so that learning stays complete

/// Whether rays find light of `l`, and photons of it can therefore guide them. Uniform skies need no guide.
bool guides(const BoundLight& l) {
    return l.kernel && (l.kind == LightKind::Area ? !l.mean : l.kind == LightKind::Environment && l.sky);
}

/// Whether no ray meets light of `l`, and mirrors and glass bring it by single paths: a light with one place or one direction.
bool isUnmet(const BoundLight& l) {
    return l.kernel && !l.photons && !l.instance->moving && (l.kind == LightKind::Point || l.kind == LightKind::Distant);
}

bool mayEmit(const BoundLight& l, bool sky) {
    if (l.kernel && l.photons) return true;
    if (!l.kernel || l.kind == LightKind::Ambient || (l.kind == LightKind::Environment && !sky)) return false;
    return l.kind != LightKind::Area || (l.emitter && !l.emitter->empty());
}
} // namespace

EmissionPlan::EmissionPlan(LightKernels& lights, const PhotonUse& use) : world_(lights.world()) {
    if (!world_.canTrace()) return;
    const geometry::Bounds box = world_.bounds();
    centre = (box.lo + box.hi) * 0.5f;
    radius = length(box.hi - box.lo) * 0.5f * 1.0001f;
    if (!std::isfinite(radius) || !(radius > 0)) return;
    const auto says = [](const BoundLight& l) { return emitsPhotons(l).value_or(false); };
    const bool some = std::any_of(world_.lights().begin(), world_.lights().end(), says);
    for (size_t i = 0; i < world_.lights().size(); ++i) {
        const BoundLight& l = world_.lights()[i];
        if (!mayEmit(l, use.sky || says(l)) || !emitsPhotons(l).value_or(use.all && !some)) continue;
        if (use.learns && !(use.unmet ? isUnmet(l) : guides(l))) continue;
        Light light;
        light.bright = use.learns && l.kind == LightKind::Environment;
        light.light = &l;
        light.number = int(i);
        if (l.kind == LightKind::Point && !l.photons && !findPlace(lights, light)) continue;
        measure(lights, light);
        lights_.push_back(std::move(light));
    }
    share();
}

std::vector<uint8_t> EmissionPlan::emits() const {
    std::vector<uint8_t> by(world_.lights().size(), 0);
    for (const Light& l : lights_) by[size_t(l.number)] = 1;
    return by;
}

bool EmissionPlan::moves() const {
    return world_.moves() ||
           std::any_of(lights_.begin(), lights_.end(), [](const Light& l) { return l.light->instance->moving; });
}

float EmissionPlan::travel() const {
    float most = 0;
    for (const Light& l : lights_) {
        if (!l.light->instance->moving) continue;
        const auto at = [&](float shutter) { return Vec3(transformPoint(l.light->instance->toCurrentAt(shutter), {0, 0, 0})); };
        most = std::max(most, length(at(1) - at(0)));
    }
    return most;
}

std::vector<uint8_t> EmissionPlan::met(bool both) const {
    std::vector<uint8_t> by;
    for (size_t i = 0; i < world_.shapes().size(); ++i) {
        const PhotonBinding& b = world_.bindings()[size_t(world_.bindingOf()[i])].photons;
        by.push_back(both ? b.intersectsBoth : b.meets);
    }
    by.push_back(0); // not empty
    return by;
}

/// Position of a light that has the same one for all points that it lights.
bool EmissionPlan::findPlace(LightKernels& lights, Light& l) {
    std::vector<ShadePoint> q;
    for (const Vec3& to : {Vec3(1, 0, 0), Vec3(-.3f, .9f, .2f), Vec3(.1f, -.4f, -.8f)}) {
        ShadePoint p;
        p.P = Vec3(transformPoint(l.light->instance->toCurrent, {0, 0, 0}));
        p.Ps = centre + to * radius;
        p.Ns = -to;
        p.N = Vec3();
        world_.setTime(p);
        q.push_back(p);
    }
    std::vector<LightValue> v(q.size());
    lights.evaluateLight(*l.light, q, v);
    l.place = q[0].Ps - v[0].L;
    for (size_t i = 1; i < q.size(); ++i)
        if (!(length(q[i].Ps - v[i].L - l.place) <= 1e-3f * (radius + length(l.place)))) return false;
    return true;
}

/// Estimates the power of a light, and which side of an emitter it leaves. Uses a sequence that no photon uses.
void EmissionPlan::measure(LightKernels& lights, Light& l) {
    std::vector<EmissionStart> starts;
    const Sampler numbers(0x6d656173757265ull, l.number & 0xffffff, l.number >> 24);
    const bool area = l.light->kind == LightKind::Area && !l.light->mean && !l.light->photons;
    for (uint32_t k = 0; k < kProbes; ++k) {
        EmissionDraw d = draw(SampleNumbers(numbers, k));
        d.light = 0;
        d.chance = d.density = 1;
        starts.push_back({d});
    }
    l.front = .5f;
    startPhotons(lights, *this, l, starts);
    for (const EmissionStart& s : starts) l.pdf += double(s.pdf) / kProbes;
    if (l.light->photons) startPhotons(lights, *this, l, starts);
    for (EmissionStart& s : starts) s.length = radius;
    const std::vector<Color> power = emittedPower(lights, l, starts);
    double sum = 0, front = 0;
    for (size_t k = 0; k < power.size(); ++k) {
        const double y = std::max(0.f, luminance(power[k]));
        sum += y;
        if (starts[k].front) front += y;
    }
    l.power = sum / kProbes;
    if (area && sum > 0) l.front = front == sum ? 1.f : float(std::clamp(front / sum, .05, .95));
}

void EmissionPlan::share() {
    double sum = 0;
    for (const Light& l : lights_) sum += l.power;
    const double floor = sum > 0 ? .01 / double(std::max<size_t>(lights_.size(), 1)) : 1; // a spot that no probe hit
    double until = 0, shares = 0;
    for (Light& l : lights_) shares += l.share = sum > 0 ? std::max(l.power / sum, floor) : 1;
    for (Light& l : lights_) {
        l.share /= shares;
        l.until = until += l.share;
    }
}

EmissionDraw EmissionPlan::draw(const SampleNumbers& n) const {
    EmissionDraw d;
    d.numbers = n;
    if (!lights_.empty()) {
        const float u = n.get1(0, kUseLight, 0);
        const auto at =
            std::upper_bound(lights_.begin(), lights_.end() - 1, double(u), [](double x, const Light& l) { return x < l.until; });
        d.light = int(at - lights_.begin());
        d.chance = float(at->share);
    }
    d.place = n.get2(0, kUsePlace, 0);
    d.way = n.get2(0, kUseWay, 0);
    d.cone = n.get2(0, kUseCone, 0);
    d.choose = n.get1(0, kUseChoose, 0);
    d.side = n.get1(0, kUseSide, 0);
    d.time = n.get1(0, kUsePhotonTime, 0);
    if (d.light < 0 || lights_[size_t(d.light)].guide.empty()) return d;
    // Chooses a row by its probability, then a bin in it by its density; the remainders of the numbers are uniform again.
    const Light& l = lights_[size_t(d.light)];
    const auto pick = [](float u, const float* shares, float whole, int& bin) {
        float until = 0;
        for (bin = 0; bin < kBins; ++bin) {
            const float s = shares[bin] / whole;
            if (u < until + s || bin == kBins - 1) return std::clamp((u - until) / s, 0.f, 0x1.fffffep-1f);
            until += s;
        }
        return u;
    };
    int row = 0, column = 0;
    const float y = pick(d.way.y, l.rows.data(), 1, row);
    const float* bins = l.guide.data() + size_t(row) * kBins;
    const float x = pick(d.way.x, bins, l.rows[size_t(row)] * kBins * kBins, column);
    d.way = {(float(column) + x) / kBins, (float(row) + y) / kBins};
    d.density = bins[column];
    return d;
}

void EmissionPlan::learn(std::span<const StoredPhoton> stored, const PhotonJob& job, uint32_t emitted) {
    constexpr size_t kMostGuided = 256; // guides of more lights would have too few photons each
    if (stored.empty() || lights_.size() > kMostGuided || emitted == 0) return;
    std::vector<std::vector<double>> found(lights_.size(), std::vector<double>(size_t(kBins) * kBins));
    std::vector<double> ofLight(lights_.size());
    double all = 0;
    for (const StoredPhoton& s : stored) {
        const EmissionDraw d = draw(job.numbers(s.number));
        const double y = std::max(0.f, luminance(s.photon.power));
        const auto bin = [](float u) { return std::min(int(u * kBins), kBins - 1); };
        found[size_t(d.light)][size_t(bin(d.way.y)) * kBins + size_t(bin(d.way.x))] += y;
        ofLight[size_t(d.light)] += y;
        all += y;
    }
    if (!(all > 0)) return;
    double until = 0;
    for (size_t i = 0; i < lights_.size(); ++i) {
        Light& l = lights_[i];
        l.share = kUnlearned * l.share + (1 - kUnlearned) * ofLight[i] / all;
        l.until = until += l.share;
        if (!(ofLight[i] > 0) || l.light->photons) continue;
        l.guide.assign(size_t(kBins) * kBins, 0);
        l.rows.assign(kBins, 0);
        double mean = 0;
        std::vector<double> smooth(size_t(kBins) * kBins); // bins next to photons likely have some, too
        for (int y = 0; y < kBins; ++y)
            for (int x = 0; x < kBins; ++x)
                for (int dy = -1; dy <= 1; ++dy)
                    for (int dx = -1; dx <= 1; ++dx) {
                        const int sx = std::clamp(x + dx, 0, kBins - 1), sy = std::clamp(y + dy, 0, kBins - 1);
                        const double v = found[i][size_t(sy) * kBins + size_t(sx)] * (dx || dy ? .05 : .6);
                        smooth[size_t(y) * kBins + size_t(x)] += v;
                        mean += v / (kBins * kBins);
                    }
        for (int y = 0; y < kBins; ++y)
            for (int x = 0; x < kBins; ++x) {
                const size_t at = size_t(y) * kBins + size_t(x);
                l.guide[at] = float(kUnlearned + (1 - kUnlearned) * smooth[at] / mean);
                l.rows[size_t(y)] += l.guide[at] / (kBins * kBins);
            }
    }
}

} // namespace alpenglow::integrator
