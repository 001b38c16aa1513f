// Runs light kernels in batches for the points that they light.
#include "integrator/lightkernels.h"
#include "bsdf/sampling.h"
#include "integrator/accumulator.h"
#include "integrator/atmosphere.h"
#include "integrator/batchpool.h"
#include "integrator/context.h"
#include "integrator/gathercalls.h"
#include "integrator/kernelinputs.h"
#include "integrator/mediastacks.h"
#include "integrator/nestedtrace.h"
#include "integrator/occlusioncalls.h"
#include "integrator/raystore.h"
#include "integrator/shadowrays.h"
#include "integrator/stageset.h"
#include "integrator/strips.h"
#include "world/gathersite.h"

namespace alpenglow::integrator {

LightKernels::LightKernels(const StageSet& s)
    : Stage(s.context), atmosphere_(s.atmosphere), batches_(s.batches), gathers_(s.gathers), inputs_(s.inputs), media_(s.media),
      nested_(s.nested), occlusion_(s.occlusion), store_(s.store), shadows_(s.shadows) {}

shading::TargetValue LightKernels::followRay(BatchContext& c, const SiteInfo& s, int point, const std::function<float(int)>& row,
                                             uint32_t occurrence, TraceSums* sums) {
    const ShadePoint& p = c.points[size_t(point)];
    shading::TargetValue value;
    const uint32_t site = uint32_t(s.site - c.bound->kernel->sites().data());
    if (s.kind == SiteKind::Transmission) {
        std::vector<ShadowRay> rays;
        if (s.rays->samples >= 0 && s.rays->cone >= 0 && row(s.rays->cone) > 0)
            occlusion_.samplesOf(std::max(1.f, row(s.rays->samples)), p.shape, s, c); // reports too many samples
        shadows_.transmissionRays(s, p, p.Ps, p.lit, row, Color(1), shading::kNoAccumulator, site, occurrence, rays);
        const auto point3 = [&](size_t arg) { return Vec3(row(s.rows[arg]), row(s.rows[arg] + 1), row(s.rows[arg] + 2)); };
        const Vec3 from = point3(0), to = point3(1);
        media_.shadowsInMedia(rays, from, to, p.Ps, p.lit, c.lit ? c.lit->binding(point) : nullptr);
        // The lit point as the shader passes it, possibly moved off its surface.
        if (std::min(length(from - p.Ps), length(to - p.Ps)) <= 0.01f * length(to - from)) {
            c.ownShadows.resize(c.points.size());
            c.ownShadows[size_t(point)] = 1;
        }
        for (const ShadowRay& r : rays)
            value.radiance += r.contribution * (r.distance > 0 ? shadows_.transmittance(r) : Color(1));
        return value;
    }
    if (s.kind == SiteKind::Occlusion) {
        std::vector<ShadowRay> rays;
        const size_t had = occlusion_.hemispheres.size();
        if (world_.canTrace())
            occlusion_.hemisphereRays(c, s, p, p.Ps, p.lit, row, Color(1), shading::kNoAccumulator, site, occurrence, rays);
        else value.radiance = Color(1);
        std::vector<Color> left(rays.size());
        shadows_.transmittances(rays, left);
        for (size_t i = 0; i < rays.size(); ++i) value.radiance += occlusion_.openLight(rays[i], left[i], sums);
        occlusion_.hemispheres.resize(had);
        return value;
    }
    if (s.kind != SiteKind::Trace || !p.ray || !world_.canTrace()) return value; // lights being measured see no geometry
    return nested_.trace(c, s, point, row, occurrence);
}

/// Answers a gather() in a light's kernel.
void LightKernels::gather(BatchContext& c, const SiteInfo& s, int first, std::span<uint32_t> asked) {
    const int lanes = c.requestLanes;
    if (!world_.canTrace() || !c.points[size_t(first)].ray) { // lights being measured see no geometry: one ray without a hit
        GatherRows& g = c.gathers[{s.gather->number, first}];
        g.width = s.gather->width;
        g.counts.assign(size_t(lanes), 1);
        g.begins.assign(size_t(lanes), 0);
        g.rows.assign(size_t(lanes) * size_t(rsl::kGatherRays) * size_t(g.width), 0.f);
        std::fill_n(c.requestOut, lanes, 1.f);
        return;
    }
    const size_t points = asked.size() / c.bound->sites.size();
    std::vector<uint32_t> occurrence(size_t(lanes), 0), rays(size_t(lanes), 0);
    for (int lane = 0; lane < lanes; ++lane) {
        if (!(c.requestMask >> lane & 1) || first + lane >= int(c.points.size())) continue;
        uint32_t& turn = asked[size_t(c.requestSite) * points + size_t(first + lane)];
        if (c.requestIn[size_t(s.rows[4]) * size_t(lanes) + size_t(lane)] < 0.5f) ++turn;
        occurrence[size_t(lane)] = turn;
    }
    std::vector<GatherSent> sent;
    const GatherRows& g = gathers_.cast(c, s, first, c.requestMask, lanes, c.requestIn.data(), occurrence, rays, sent);
    if (!sent.empty()) nested_.gather(sent);
    for (int lane = 0; lane < lanes; ++lane) c.requestOut[lane] = float(g.counts[size_t(lane)]);
}

void LightKernels::countRuns(const BoundLight& light, std::span<const BoundLight* const> group) {
    std::vector<uint64_t>& runs = counters_.lightRuns;
    runs.resize(world_.lights().size());
    const auto count = [&](const BoundLight& l) { ++runs.at(size_t(&l - world_.lights().data())); };
    count(light);
    for (const BoundLight* l : group) count(*l);
}

void LightKernels::runWaiting(BatchContext& context) {
    BatchContext* c = &context;
    const BoundKernel& bound = *c->bound;
    const auto& k = *bound.kernel;
    // A light that branches on traced light: its few requests are answered in place, strip by strip.
    std::vector<uint32_t> asked(bound.sites.size() * size_t(c->batch->size()));
    for (int first = 0; first < c->batch->size(); first += k.lanes()) {
        void* h = k.start(&c->batch->call(), first);
        if (!h) throw std::bad_alloc();
        const std::unique_ptr<void, std::function<void(void*)>> frame(h, [&](void* f) { k.destroy(f); });
        c->ran();
        while (!k.finished(h)) {
            const SiteInfo& s = bound.sites[c->requestSite];
            if (s.kind == SiteKind::Gather) {
                gather(*c, s, first, asked);
                k.resume(h);
                c->ran();
                continue;
            }
            for (int lane = 0; lane < c->requestLanes; ++lane) {
                if (!(c->requestMask >> lane & 1) || first + lane >= int(c->points.size())) continue;
                const std::function<float(int)> row = [&](int r) { return c->requestIn[size_t(r) * c->requestLanes + lane]; };
                for (int r = 0; r < s.resultRowCount; ++r) c->requestOut[size_t(r) * c->requestLanes + lane] = 0;
                TraceSums sums;
                const shading::TargetValue t =
                    followRay(*c, s, first + lane, row,
                              asked[size_t(c->requestSite) * size_t(c->batch->size()) + size_t(first + lane)]++, &sums);
                putResult(s, t, s.kind == SiteKind::Occlusion ? &sums : nullptr, c->requestOut, c->requestLanes, lane);
            }
            k.resume(h);
            c->ran();
        }
    }
}

void LightKernels::addPairs(BatchContext& context, std::vector<ShadePoint>& queries, std::span<LightValue> out) {
    BatchContext* c = &context;
    const BoundKernel& bound = *c->bound;
    // Affine requests of the light itself: its shadows. Counted by call site and point, so that no random number depends on the
    // batch.
    std::vector<uint32_t> asked(c->emits.empty() ? 0 : bound.sites.size() * queries.size());
    for (const EmitRecord& e : c->emits) {
        const SiteInfo& s = bound.sites[e.site];
        if (s.kind != SiteKind::Transmission && s.kind != SiteKind::Trace && s.kind != SiteKind::Occlusion) continue;
        for (int lane = 0; lane < e.lanes; ++lane) {
            if (!(e.mask >> lane & 1) || e.first + lane >= int(queries.size())) continue;
            auto at = [&](int row) { return c->arena[e.offset + size_t(row) * e.lanes + lane]; };
            c->points.swap(queries); // the rays start from them
            const Color light = followRay(
                                    *c, s, e.first + lane, [&](int row) { return at(row + 3); },
                                    asked[size_t(e.site) * queries.size() + size_t(e.first + lane)]++)
                                    .radiance;
            c->points.swap(queries);
            out[e.first + lane].Cl += Color(at(0), at(1), at(2)) * light;
        }
    }
}

void LightKernels::evaluateLight(const BoundLight& light, std::vector<ShadePoint>& queries, std::span<LightValue> out,
                                 const LightCall& call) {
    if (queries.empty()) return;
    const BoundKernel& bound = call.kernel ? *call.kernel : light.kernel;
    auto c = batches_.take();
    c->bound = &bound;
    c->lit = call.lit;
    c->light = &light;
    c->ownShadows.clear();
    c->points.swap(queries); // swapped back below
    std::vector<shading::InstanceView> views;
    std::vector<uint32_t> viewOf;
    for (size_t i = 0; i < call.of.size(); ++i) {
        if (i == 0 || call.of[i] != call.of[i - 1]) {
            views.push_back(call.of[i]->instance->view());
            views.back().rows = call.of[i]->rows.get();
        }
        viewOf.push_back(uint32_t(views.size() - 1));
    }
    if (views.empty())
        views.push_back({call.parameters ? call.parameters : &light.instance->parameters, &light.instance->toCurrent,
                         light.instance->moving.get()});
    if (!c->batch) c->batch = std::make_shared<shading::Batch>();
    c->batch->assign(bound.kernel, *bound.plan, c->points, views, viewOf, world_);
    inputs_.bind(c->batch->call(), *c);
    const auto& k = *bound.kernel;
    if (k.facts().suspends) {
        runWaiting(*c);
    } else {
        k.run(&c->batch->call());
        c->ran();
    }
    if (world_.needs().bakes) countRuns(light, call.of);
    const auto& b = *c->batch;
    queries.swap(c->points);
    for (size_t i = 0; i < queries.size(); ++i) {
        LightValue& v = out[i];
        if (light.outL >= 0) v.L = b.color(light.outL, int(i));
        v.Cl = b.color(light.outCl, int(i));
        if (light.outOl >= 0) v.Ol = b.color(light.outOl, int(i));
        v.lit = light.outLit < 0 || b.value(light.outLit, 0, int(i)) != 0;
        if (light.nonDiffuse >= 0) v.nonDiffuse = b.value(light.nonDiffuse, 0, int(i));
        if (light.nonSpecular >= 0) v.nonSpecular = b.value(light.nonSpecular, 0, int(i));
        if (light.shadowRadius >= 0)
            takeShadowSays(v, light, b.value(light.shadowRadius, 0, int(i)),
                           light.shadowSamples < 0 ? 1 : b.value(light.shadowSamples, 0, int(i)));
        for (const int o : call.more)
            for (int r = 0; r < rsl::ir::components(bound.kernel->outputs()[size_t(o)].kind); ++r)
                call.moreValues->push_back(b.value(o, r, int(i)));
        if (call.values) {
            float* to = call.values->data() + i * size_t(light.valueWidth);
            for (const BoundLight::Value& value : light.values)
                for (int r = 0; r < value.components; ++r) *to++ = b.value(value.output, r, int(i));
        }
    }
    addPairs(*c, queries, out);
    for (size_t i = 0; i < c->ownShadows.size(); ++i) out[i].ownShadow = c->ownShadows[i] != 0;
    for (size_t i = 0; i < queries.size(); ++i) // the kernel divided by the squared distance; radiance does not
        if (const float scale = (call.of.empty() ? light : *call.of[i]).intensityScale; scale > 0)
            out[i].Cl *= dot(out[i].L, out[i].L) * scale;
    atmosphere_.atmosphereOfEmitters(light, queries, out, call.inMedium);
    batches_.giveBack(std::move(c));
}

float LightKernels::chanceOf(int light, int binding, const Vec3& from, int bounces) const {
    const WorldImpl::LightList& list = world_.lightLists()[size_t(world_.bindings()[size_t(binding)].lightList)];
    const LightChooser& chooser = world_.chooserAt(list, bounces);
    if (chooser.empty()) return 1;
    const std::vector<int>& on = world_.sampledOf(list);
    const auto at = std::lower_bound(on.begin(), on.end(), light);
    return at != on.end() && *at == light ? chooser.pmf(int(at - on.begin()), from) : 0;
}

} // namespace alpenglow::integrator
