// Output variables that receive light. Ci is shaded as if there were none: each such output has a kernel of its own, which runs
// at camera points only. Where it makes the same request as Ci, it receives a part of the light of Ci's lobe, by the ratio of the
// two weights. So the parts of Ci that a shader writes to outputs add up to Ci in every sample. All other requests are followed
// separately.
#include "integrator/lightoutputs.h"
#include "integrator/accumulator.h"
#include "integrator/batchpool.h"
#include "integrator/context.h"
#include "integrator/displacement.h"
#include "integrator/kernelinputs.h"
#include "integrator/requests.h"
#include "integrator/shadowrays.h"
#include "integrator/stageset.h"
#include "integrator/vertexlight.h"
#include "integrator/waitingkernels.h"
#include <algorithm>
#include <cstring>
#include <map>
#include <tuple>

namespace alpenglow::integrator {

LightOutputs::LightOutputs(const StageSet& s)
    : Stage(s.context), accumulator_(s.accumulator), batches_(s.batches), displacement_(s.displacement), inputs_(s.inputs),
      requests_(s.requests), shadows_(s.shadows), vertexLight_(s.vertexLight), waitingKernels_(s.waitingKernels) {}

namespace {

/// An output with a larger ratio to Ci gets rays of its own: those of Ci are sent too rarely where Ci depends little on them.
constexpr float kMostShare = 16;

/// Whether two pairs make the same request.
bool sameArguments(const BatchContext& a, const EmitRecord& ra, int laneA, const BatchContext& b, const EmitRecord& rb,
                   int laneB) {
    size_t rows = 0;
    for (rsl::ir::Kind k : a.bound->sites[size_t(ra.site)].site->argKinds) rows += size_t(rsl::ir::components(k));
    for (size_t r = 3; r < rows + 3; ++r)
        if (std::memcmp(&a.arena[ra.offset + r * size_t(ra.lanes) + size_t(laneA)],
                        &b.arena[rb.offset + r * size_t(rb.lanes) + size_t(laneB)], sizeof(float)) != 0)
            return false;
    return true;
}

Color weightOf(const BatchContext& c, const EmitRecord& e, int lane) {
    const float* rows = c.arena.data() + e.offset;
    return {rows[lane], rows[e.lanes + lane], rows[2 * e.lanes + lane]};
}

} // namespace

std::vector<std::shared_ptr<BatchContext>> LightOutputs::lightOutputBatches(const BatchContext& c, Sched& sched) {
    std::vector<std::shared_ptr<BatchContext>> all;
    const SurfaceBinding& b = *c.binding;
    if (b.lightOutputs.empty() || (c.bound != &b.surfaceS && c.bound != &b.surfaceV)) return all;
    std::vector<size_t> of;
    for (size_t i = 0; i < c.points.size(); ++i)
        if (c.rays[i].counts) of.push_back(i);
    if (of.empty()) return all;
    if (c.displaced && of.size() < c.points.size()) { // displacement results are found by point index
        of.clear();
        for (size_t i = 0; i < c.points.size(); ++i) of.push_back(i);
    }
    for (const LightOutput& o : b.lightOutputs) {
        const BoundKernel& bound = (c.bound == &b.surfaceV ? o.V : o.S).bound;
        if (!bound) continue;
        auto run = batches_.take();
        run->bound = &bound;
        run->binding = c.binding;
        run->lightOutput = &o;
        run->displaced = c.displaced;
        run->points.resize(of.size());
        run->rays.reserve(of.size());
        for (size_t k = 0; k < of.size(); ++k) {
            PathRay& ray = run->rays.emplace_back(c.rays[of[k]]);
            ray.path = 0;   // light paths classify the light of Ci only
            ray.extra = -1; // belongs to the batch, which may be gone before the strips that wait here
            run->bindings.push_back(c.bindings[of[k]]);
            const size_t outputs = world_.lightOutputs().size();
            run->targets.push_back(ray.counts ? accumulator_.lightTargets[size_t(ray.sample->path) * outputs + size_t(o.number)]
                                              : accumulator_.nowhere);
            run->points[k] = c.points[of[k]];
            run->points[k].ray = &run->rays.back();
        }
        inputs_.fill(*run);
        if (run->displaced) run->batch->takeDisplacement(*run->displaced->batch);
        if (b.moveS) displacement_.moveToFacets(*run);
        if (!bound.kernel->facts().suspends) {
            bound.kernel->run(&run->batch->call());
            run->ran();
            finishLightOutputs(*run, 0, int(of.size()), sched);
        }
        all.push_back(std::move(run));
    }
    return all;
}

void LightOutputs::finishLightOutputs(BatchContext& c, int first, int lanes, Sched& sched) {
    const int output = c.batch->output(c.lightOutput->slot);
    const bool triple = world_.lightOutputs()[size_t(c.lightOutput->number)].size == 3;
    for (int i = first; output >= 0 && i < std::min(first + lanes, int(c.points.size())); ++i) {
        const PathRay& ray = c.rays[size_t(i)];
        if (!ray.counts) continue;
        const Color light =
            triple ? ray.weight * c.batch->color(output, i) : Color(luminance(ray.weight) * c.batch->value(output, 0, i), 0, 0);
        accumulator_.contribute(sched, {c.targets[size_t(i)], light, LightEvent::Output, &ray});
    }
}

std::vector<LightOutputRequest> LightOutputs::shareLight(const BatchContext& c, std::span<const AskedLobe> asked,
                                                         std::span<const std::shared_ptr<BatchContext>> runs, Sched&) {
    std::vector<LightOutputRequest> rest;
    if (runs.empty()) return rest;
    std::vector<std::vector<const AskedLobe*>> lobesOf(c.points.size());
    for (const AskedLobe& a : asked) lobesOf[size_t(requests_.lobes[size_t(a.lobe)].point)].push_back(&a);
    std::vector<int> pointOf; // by point of a run: index in the batch
    for (size_t i = 0; i < c.points.size(); ++i)
        if (runs[0]->points.size() == c.points.size() || c.rays[i].counts) pointOf.push_back(int(i));
    for (const auto& run : runs) {
        const LightOutput::Kernel& calls = run->bound == &run->lightOutput->V.bound ? run->lightOutput->V : run->lightOutput->S;
        for (size_t r = 0; r < run->emits.size(); ++r) {
            const EmitRecord& e = run->emits[r];
            const int same = calls.own[size_t(e.site)];
            for (int lane = 0; lane < e.lanes; ++lane) {
                const int point = e.first + lane;
                if (!(e.mask >> lane & 1) || point >= int(run->points.size()) || !run->rays[size_t(point)].counts) continue;
                Color weight = weightOf(*run, e, lane);
                if (!(std::isfinite(weight.x) && std::isfinite(weight.y) && std::isfinite(weight.z))) {
                    ++counters_.nonFinite;
                    continue;
                }
                if (world_.lightOutputs()[size_t(run->lightOutput->number)].size ==
                    1) { // a scalar uses the luminance of the throughput
                    const Color& through = run->rays[size_t(point)].weight;
                    for (int k = 0; k < 3; ++k) weight[k] *= through[k] > 0 ? luminance(through) / through[k] : 0;
                }
                for (const AskedLobe* a : lobesOf[size_t(pointOf[size_t(point)])]) {
                    const EmitRecord& main = c.emits[size_t(a->record)];
                    if (same < 0 || calls.main[size_t(main.site)] != same || !sameArguments(*run, e, lane, c, main, a->lane))
                        continue;
                    LobeVertex& l = requests_.lobes[size_t(a->lobe)];
                    Color ratio(0);
                    for (int k = 0; k < 3; ++k)
                        if (std::fabs(weight[k]) <= kMostShare * std::fabs(l.weight[k]) && l.weight[k] != 0) {
                            ratio[k] = weight[k] / l.weight[k];
                            weight[k] = 0;
                        }
                    if (ratio == Color(0)) continue;
                    accumulator_.aovSplits.push_back({run->targets[size_t(point)], ratio, l.share});
                    l.share = int32_t(accumulator_.aovSplits.size()) - 1;
                    break;
                }
                if (!(weight == Color(0))) rest.push_back({run.get(), int(r), lane, weight});
            }
        }
    }
    return rest;
}

void LightOutputs::followLightOutputs(std::span<const LightOutputRequest> rest, std::span<std::shared_ptr<BatchContext>> runs,
                                      Sched& sched) {
    size_t next = 0;
    for (const auto& run : runs) {
        BatchContext& c = *run;
        if (c.bound->kernel->facts().suspends) {
            waitingKernels_.start(run, sched);
            continue;
        }
        std::map<std::pair<int, int>, uint32_t> occurrence; // by call site and point
        for (; next < rest.size() && rest[next].run == &c; ++next) {
            const LightOutputRequest& a = rest[next];
            const EmitRecord& e = c.emits[size_t(a.record)];
            const SiteInfo& s = c.bound->sites[size_t(e.site)];
            const int point = e.first + a.lane;
            const float* args = c.arena.data() + e.offset + size_t(3) * size_t(e.lanes);
            const AccumulatorId target = c.targets[size_t(point)];
            const Color through = c.rays[size_t(point)].weight;
            if (s.kind == SiteKind::LightVisibility)
                requests_.lightVisibility(c, s, point, args, e.lanes, a.lane, a.weight * through, target);
            else
                requests_.request(c, s, point, args, e.lanes, a.lane, asksShadows(s.kind) ? a.weight * through : a.weight, target,
                                  false, occurrence[{e.site, point}]++);
        }
        vertexLight_.gather(c, sched);
        shadows_.flush(sched);
    }
    for (auto& run : runs) batches_.giveBack(std::move(run));
}

} // namespace alpenglow::integrator
