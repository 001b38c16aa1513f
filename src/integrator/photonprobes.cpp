// Sends probes through mirrors and glass by the stages of photons.
#include "base/memory.h"
#include "integrator/accumulator.h"
#include "integrator/emission.h"
#include "integrator/intersector.h"
#include "integrator/lightkernels.h"
#include "integrator/photonstage.h"
#include "integrator/pipeline.h"
#include "integrator/raystore.h"
#include "world/mediaabout.h"
#include <map>

namespace alpenglow::integrator {

namespace {

EmissionPlan::Light lightOf(const WorldImpl& world, int number) {
    EmissionPlan::Light l;
    l.light = &world.lights()[size_t(number)];
    l.number = number;
    return l;
}

/// The light of each probe from the light's shader at its first hit; 1 where no probe asks for it.
std::vector<Color> lightOfProbes(const StageSet& set, const PhotonJob& job, std::span<const PhotonProbe> probes,
                                 std::span<ProbeEnd> ends) {
    const WorldImpl& world = set.context.world;
    std::vector<Color> light(probes.size(), Color(1));
    std::map<int, std::vector<size_t>> of;
    for (size_t i = 0; i < probes.size(); ++i)
        if (probes[i].power) of[probes[i].light].push_back(i);
    for (const auto& [number, some] : of) {
        std::vector<EmissionStart> starts(some.size());
        for (size_t k = 0; k < some.size(); ++k) {
            const PhotonProbe& p = probes[some[k]];
            EmissionStart& s = starts[k];
            s.drawn.cone = p.cone;
            s.drawn.time = p.time;
            s.drawn.numbers = p.numbers;
            s.origin = p.origin, s.dir = p.dir;
            s.factor = 1;
            accel::Ray ray;
            ray.org = s.origin;
            ray.dir = s.dir;
            ray.time = world.shadesAtOpen() ? 0 : p.time;
            ray.only = job.met;
            ray.sides = accel::Sides::Both;
            if (world.fades()) ray.level = Random(p.numbers).one(0, kLevel, 0);
            accel::Hit hit;
            s.length = set.intersector.intersect(ray, hit) ? hit.t : 0;
        }
        const std::vector<Color> found = emittedPower(set.lightKernels, lightOf(world, number), starts);
        for (size_t k = 0; k < some.size(); ++k) {
            light[some[k]] = found[k];
            ends[some[k]].keptDiffuse = starts[k].keptDiffuse, ends[some[k]].keptSpecular = starts[k].kept;
        }
    }
    return light;
}

} // namespace

bool Pipeline::probe(const PhotonJob& job, std::span<const PhotonProbe> probes, std::span<ProbeEnd> ends, const StopFlag* stop) {
    const StageSet& set = stages();
    const WorldImpl& w = world();
    PhotonTrace& t = beginPhotons(job, stop);
    t.out = nullptr;
    t.probes = probes;
    t.ends = ends;
    return withinRoom(
        [&] {
            Sched& sched = scheduler();
            sched.restart(stop);
            std::fill(ends.begin(), ends.end(), ProbeEnd());
            t.power = lightOfProbes(set, job, probes, ends);
            t.from.assign(probes.size(), {});
            set.store.samples.resize(probes.size());
            set.accumulator.begin(0);
            const AccumulatorId root = set.accumulator.nowhere = sched.newRoot();
            for (size_t i = 0; i < probes.size(); ++i) {
                const PhotonProbe& p = probes[i];
                const float most = maxComponent(t.power[i]);
                if (!(most > 0) || !std::isfinite(most)) continue;
                PathSample& sample = set.store.samples[i];
                sample = {0, 0, uint32_t(i), int(i), w.timeAt(p.time), p.time, 0.5f, false, p.numbers};
                PathRay& r = sched.spawn(0, root).payload;
                r.origin = p.origin;
                r.dir = p.dir;
                r.weight = t.power[i] / most;
                t.power[i] = Color(most);
                r.sample = &sample;
                r.kind = set.store.kindOf(t.specular);
                PhotonDepths().to(r);
                t.from[i] = {p.light, 1};
                EmissionStart start;
                start.origin = p.origin;
                start.drawn.time = p.time;
                r.media = set.photons.aboutLight(lightOf(w, p.light), start);
                if (w.fades()) sample.level = Random(p.numbers).one(0, kLevel, 0);
            }
            beginTrace();
            const bool done = sched.run();
            endTrace();
            return done;
        },
        [] {});
}

} // namespace alpenglow::integrator
