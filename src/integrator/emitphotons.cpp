// Emits a block of photons and traces them through the same stages as paths.
#include "base/memory.h"
#include "integrator/accumulator.h"
#include "integrator/emission.h"
#include "integrator/intersector.h"
#include "integrator/lightkernels.h"
#include "integrator/photonstage.h"
#include "integrator/pipeline.h"
#include "integrator/raystore.h"
#include "world/mediaabout.h"
#include <algorithm>
#include <tuple>

namespace alpenglow::integrator {

namespace {

/// Random number that selects the level of detail for all hits of a photon.
float levelOf(const SampleNumbers& n) { return Random(n).one(0, kLevel, 0); }

/// Starts the photons of a block, light by light, because a kernel call is for one light.
std::vector<EmissionStart> startBlock(const StageSet& set, const PhotonJob& job, uint32_t first, uint32_t count,
                                      std::vector<Color>& power) {
    const EmissionPlan& plan = *job.plan;
    const WorldImpl& world = set.context.world;
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
        startPhotons(set.lightKernels, plan, plan.lights()[l], some);
        for (size_t k = 0; k < some.size(); ++k) { // finds the first hit
            EmissionStart& s = some[k];
            if (s.dir == Vec3(0.f)) continue;
            accel::Ray ray;
            ray.org = s.origin;
            ray.dir = s.dir;
            ray.time = world.shadesAtOpen() ? 0 : s.drawn.time;
            ray.only = job.met;
            ray.sides = accel::Sides::Both;
            if (world.fades()) ray.level = levelOf(job.numbers(first + of[l][k]));
            accel::Hit hit;
            s.length = set.intersector.intersect(ray, hit) ? hit.t : 0;
        }
        const std::vector<Color> brings = emittedPower(set.lightKernels, plan.lights()[l], some);
        for (size_t k = 0; k < of[l].size(); ++k) {
            all[of[l][k]] = some[k];
            power[of[l][k]] = brings[k];
        }
    }
    return all;
}

} // namespace

PhotonTrace& Pipeline::beginPhotons(const PhotonJob& job, const StopFlag* stop) {
    const StageSet& set = stages();
    if (!set.photons.photonTrace()) {
        Rules& rules = set.context.rules;
        rules.pickOne = rules.roulette = true;
        rules.lightsAtRequests = rules.emissionCounts = false;
    }
    PhotonTrace& t = set.photons.begin();
    set.context.stop = stop;
    t.job = &job;
    t.probes = {};
    t.ends = {};
    t.diffuse = {RayType::Diffuse, false, {job.met, accel::Sides::Both, shading::HitMode::Default}, 0};
    t.specular = t.diffuse;
    t.specular.type = RayType::Specular;
    return t;
}

bool Pipeline::emit(const PhotonJob& job, uint32_t first, uint32_t count, std::vector<StoredPhoton>& out, const StopFlag* stop) {
    const size_t before = out.size();
    PhotonTrace& t = beginPhotons(job, stop);
    t.first = first;
    t.out = &out;
    const bool done = withinRoom([&] { return emitAll(job, first, count); }, [&] { out.resize(before); });
    const auto key = [](const StoredPhoton& p) {
        return std::tuple(p.number, p.photon.bounces, p.photon.P.x, p.photon.P.y, p.photon.P.z);
    };
    std::sort(out.begin() + long(before), out.end(), [&](const auto& a, const auto& b) { return key(a) < key(b); });
    return done;
}

bool Pipeline::emitAll(const PhotonJob& job, uint32_t first, uint32_t count) {
    const StageSet& set = stages();
    const WorldImpl& w = world();
    PhotonTrace& t = *set.photons.photonTrace();
    Sched& sched = scheduler();
    sched.restart(set.context.stop);
    const EmissionPlan& plan = *job.plan;
    const std::vector<EmissionStart> starts = startBlock(set, job, first, count, t.power);
    t.from.assign(count, {});
    set.store.samples.resize(count);
    set.accumulator.begin(0);
    const AccumulatorId root = set.accumulator.nowhere = sched.newRoot(); // the light that photon rays see is discarded
    for (uint32_t i = 0; i < count; ++i) {
        const EmissionStart& s = starts[i];
        const float most = maxComponent(t.power[i]);
        if (!(most > 0) || !std::isfinite(most)) continue;
        PathSample& sample = set.store.samples[i];
        sample = {int(job.pass >> 24),
                  int(job.pass & 0xffffffu),
                  first + i,
                  int(i),
                  w.timeAt(s.drawn.time),
                  s.drawn.time,
                  0.5f,
                  false,
                  job.numbers(first + i)};
        PathRay& r = sched.spawn(0, root).payload;
        r.origin = s.origin;
        r.dir = s.dir;
        r.weight = t.power[i] / most; // roulette uses the weight
        t.power[i] = Color(most);
        r.sample = &sample;
        r.kind = set.store.kindOf(t.specular);
        PhotonDepths().to(r);
        t.from[i] = {plan.lights()[size_t(s.drawn.light)].number, s.kept};
        r.media = set.photons.aboutLight(plan.lights()[size_t(s.drawn.light)], s);
        if (s.shape) // the atmosphere at the light is applied at the hit
            if (const auto inAtmosphere = w.emittersInAtmosphere().find(s.shape);
                inAtmosphere != w.emittersInAtmosphere().end()) {
                r.lobeBinding = inAtmosphere->second;
                r.lobeOrigin = intersectsAt(s.surface);
            }
        if (w.fades()) sample.level = levelOf(sample.numbers);
    }
    beginTrace();
    const bool done = sched.run();
    endTrace();
    return done;
}

} // namespace alpenglow::integrator
