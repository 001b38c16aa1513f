// Emitting a block of photons: they start at their lights, and are followed as rays of a path are, through the same stages.
#include "base/memory.h"
#include "integrator/emission.h"
#include "world/mediaabout.h"
#include <algorithm>
#include <tuple>

namespace alpenglow::transport {

namespace {

/// Between levels of detail: what a photon meets on its whole way.
float levelOf(const render::SampleNumbers& n) { return Random(n).one(0, kLevel, 0); }

/// Photons of a block by light, and what they carry: light by light, since a kernel call is of one light.
std::vector<EmissionStart> startBlock(Engine& e, const PhotonJob& job, uint32_t first, uint32_t count,
                                      std::vector<Color>& power) {
    const EmissionPlan& plan = *job.plan;
    const WorldImpl& world = e.world();
    std::vector<EmissionStart> all(count);
    std::vector<std::vector<uint32_t>> of(plan.lights().size());
    for (uint32_t i = 0; i < count; ++i) {
        all[i].drawn = plan.draw(job.numbers(first + i));
        if (all[i].drawn.light >= 0) of[size_t(all[i].drawn.light)].push_back(i);
    }
    power.assign(count, Color(0));
    std::vector<EmissionStart> some;
    for (size_t l = 0; l < of.size(); ++l) {
        if (of[l].empty()) continue;
        some.clear();
        for (uint32_t i : of[l]) some.push_back(all[i]);
        startPhotons(e, plan, plan.lights()[l], some);
        for (size_t k = 0; k < some.size(); ++k) { // what it meets first
            EmissionStart& s = some[k];
            if (s.dir == Vec3(0.f)) continue;
            accel::Ray ray;
            ray.org = s.origin;
            ray.dir = s.dir;
            ray.time = world.shadesAtOpen_ ? 0 : s.drawn.time;
            ray.only = job.met;
            ray.sides = accel::Sides::Both;
            if (world.fades_) ray.level = levelOf(job.numbers(first + of[l][k]));
            accel::Hit hit;
            s.length = e.meet(ray, hit) ? hit.t : 0;
        }
        const std::vector<Color> brings = emittedPower(e, plan.lights()[l], some);
        for (size_t k = 0; k < of[l].size(); ++k) {
            all[of[l][k]] = some[k];
            power[of[l][k]] = brings[k];
        }
    }
    return all;
}

} // namespace

bool Engine::emit(const PhotonJob& job, uint32_t first, uint32_t count, std::vector<StoredPhoton>& out,
                  const StopFlag* stopFlag) {
    if (!photonTrace_) {
        photonTrace_ = std::make_unique<PhotonTrace>();
        rules_.pickOne = rules_.roulette = true;
        rules_.lightsAtRequests = rules_.emissionCounts = false;
    }
    PhotonTrace& t = *photonTrace_;
    stop = stopFlag;
    const size_t before = out.size();
    t.job = &job;
    t.first = first;
    t.out = &out;
    t.diffuse = {RayType::Diffuse, false, {job.met, accel::Sides::Both, shading::HitMode::Default}, 0};
    t.specular = t.diffuse;
    t.specular.type = RayType::Specular;
    bool done = true;
    while (true) {
        beginsAnew_ = raysAtOnce_ > 1;
        try {
            done = emitAll(job, first, count);
            break;
        } catch (const LimitReached&) { // as in trace(): what is stored does not depend on how many points are shaded at a time
            if (!std::exchange(beginsAnew_, false)) throw;
        }
        out.resize(before);
        raysAtOnce_ = std::max(1, raysAtOnce_ / 8);
        inner_.reset();
        sched_.reset();
        forget();
    }
    beginsAnew_ = false;
    const auto key = [](const StoredPhoton& p) {
        return std::tuple(p.number, p.photon.bounces, p.photon.P.x, p.photon.P.y, p.photon.P.z);
    };
    std::sort(out.begin() + long(before), out.end(), [&](const auto& a, const auto& b) { return key(a) < key(b); });
    return done;
}

/// A surface with Sides 1 is not there for who comes from behind. Photons go the other way: what comes from the front is there
/// and goes straight on as well, for those who look from behind; what comes from behind is there alone.
Color Engine::goesOn(const BatchContext& c, int i) const {
    const ShadePoint& p = c.points[size_t(i)];
    if (photonTrace_ && p.shape->oneSided() && dot(c.rays[size_t(i)].dir, meetsNormal(p.surface)) < 0) return leftBehind(c, i);
    return c.clear.empty() ? clearAt(c, i) : c.clear[size_t(i)];
}

/// The volumes in which a photon begins; null: none.
const shading::Media* Engine::aboutLight(const EmissionPlan::Light& l, const EmissionStart& s) {
    const bool placed = l.light->photons || l.light->kind == LightKind::Point || l.light->kind == LightKind::Area;
    if (world_->media_.empty() || !placed) return nullptr;
    return kept(mediaAbout(*world_, s.origin, world_->shadesAtOpen_ ? 0 : s.drawn.time));
}

bool Engine::emitAll(const PhotonJob& job, uint32_t first, uint32_t count) {
    PhotonTrace& t = *photonTrace_;
    if (!sched_) sched_ = std::make_unique<Sched>(*this, stop, limits::kFrameBytesPerThread, raysAtOnce_);
    Sched& sched = *sched_;
    sched.restart(stop);
    const EmissionPlan& plan = *job.plan;
    const std::vector<EmissionStart> starts = startBlock(*this, job, first, count, t.power);
    t.from.assign(count, {});
    samples_.resize(count);
    results.clear();
    lightTargets_.clear();
    shares_.clear();
    const TargetId root = nowhere_ = sched.newRoot(); // nobody asks what photons see
    for (uint32_t i = 0; i < count; ++i) {
        const EmissionStart& s = starts[i];
        const float most = maxComponent(t.power[i]);
        if (!(most > 0) || !std::isfinite(most)) continue;
        PathSample& sample = samples_[i];
        sample = {int(job.pass >> 24),
                  int(job.pass & 0xffffffu),
                  first + i,
                  int(i),
                  world_->timeAt(s.drawn.time),
                  s.drawn.time,
                  0.5f,
                  false,
                  job.numbers(first + i)};
        PathRay& r = sched.spawn(0, root).payload;
        r.origin = s.origin;
        r.dir = s.dir;
        r.weight = t.power[i] / most; // so that roulette looks at what is left of it
        t.power[i] = Color(most);
        r.sample = &sample;
        r.kind = kindOf(t.specular);
        PhotonDepths().to(r);
        t.from[i] = {plan.lights()[size_t(s.drawn.light)].number, s.kept};
        r.media = aboutLight(plan.lights()[size_t(s.drawn.light)], s);
        if (s.shape) // what its light loses in the atmosphere there is told where it arrives
            if (const auto hazy = world_->hazyEmitters_.find(s.shape); hazy != world_->hazyEmitters_.end()) {
                r.lobeBinding = hazy->second;
                r.lobeOrigin = meetsAt(s.surface);
            }
        if (world_->fades_) sample.level = levelOf(sample.numbers);
    }
    beginTrace();
    const bool done = sched.run();
    endTrace(sched);
    return done;
}

} // namespace alpenglow::transport
