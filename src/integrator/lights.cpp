// Lights: their kernels run in batches for the points they light.
#include "integrator/gatherloop.h"
#include "integrator/strips.h"
#include "lobes/sampling.h"

namespace alpenglow::transport {

shading::TargetValue Engine::rayOfLight(BatchContext& c, const SiteInfo& s, int point, const std::function<float(int)>& row,
                                        uint32_t occurrence, TraceSums* sums) {
    const ShadePoint& p = c.points[size_t(point)];
    shading::TargetValue value;
    const uint32_t site = uint32_t(s.site - c.bound->kernel->sites().data());
    if (s.kind == SiteKind::Transmission) {
        std::vector<ShadowRay> rays;
        if (s.rays->samples >= 0 && s.rays->cone >= 0 && row(s.rays->cone) > 0)
            samplesOf(std::max(1.f, row(s.rays->samples)), p.shape, s, c); // says when there are too many
        transmissionRays(s, p, p.Ps, p.lit, row, Color(1), shading::kNoTarget, site, occurrence, rays);
        const auto point3 = [&](size_t arg) { return Vec3(row(s.rows[arg]), row(s.rows[arg] + 1), row(s.rows[arg] + 2)); };
        const Vec3 from = point3(0), to = point3(1);
        shadowsInMedia(rays, from, to, p.Ps, p.lit, c.lit ? c.lit->binding(point) : nullptr);
        // The lit point as shaders give it, perhaps moved off its surface.
        if (std::min(length(from - p.Ps), length(to - p.Ps)) <= 0.01f * length(to - from)) {
            c.ownShadows.resize(c.points.size());
            c.ownShadows[size_t(point)] = 1;
        }
        for (const ShadowRay& r : rays) value.radiance += r.contribution * (r.distance > 0 ? transmittance(r) : Color(1));
        return value;
    }
    if (s.kind == SiteKind::Occlusion) {
        std::vector<ShadowRay> rays;
        const size_t had = hemispheres_.size();
        if (world_->accel_) hemisphereRays(c, s, p, p.Ps, p.lit, row, Color(1), shading::kNoTarget, site, occurrence, rays);
        else value.radiance = Color(1);
        std::vector<Color> left(rays.size());
        transmittances(rays, left);
        for (size_t i = 0; i < rays.size(); ++i) value.radiance += openLight(rays[i], left[i], sums);
        hemispheres_.resize(had);
        return value;
    }
    if (s.kind != SiteKind::Trace || !p.ray || !world_->accel_) return value; // lights that are measured see nothing
    value = inner().follow(c, s, point, row, occurrence);
    takeInner();
    return value;
}

/// An engine of its own follows rays of lights and all that comes of them, to the end: the lights that they meet may trace as
/// well, one bounce deeper.
Engine& Engine::inner() {
    if (!inner_) {
        inner_ = std::make_unique<Engine>(world_, diagnostics_);
        inner_->events_ = events_;
        inner_->raysAtOnce_ = std::min(raysAtOnce_, int(Sched::kStripRays));
        inner_->sched_ = std::make_unique<Sched>(*inner_, stop, limits::kFrameBytesPerThread, inner_->raysAtOnce_);
    }
    inner_->stop = stop;
    inner_->beginsAnew_ = beginsAnew_;
    inner_->sched_->restart(stop);
    inner_->waiting_.clear();
    inner_->traceSums_.clear();
    inner_->gathered_.clear();
    inner_->lobes.clear();
    inner_->lobeRows_.clear();
    return *inner_;
}

void Engine::takeInner() {
    counters += inner_->counters;
    inner_->counters = {};
    spoiled_.insert(spoiled_.end(), inner_->spoiled_.begin(), inner_->spoiled_.end());
    inner_->spoiled_.clear();
}

shading::TargetValue Engine::follow(BatchContext& c, const SiteInfo& s, int point, const std::function<float(int)>& row,
                                    uint32_t occurrence) {
    const ShadePoint& p = c.points[size_t(point)];
    const PathRay& from = *p.ray;
    Sched& sched = *sched_;
    const TargetId target = sched.newRoot();
    // request() reads rows of lanes: this is one lane.
    std::vector<float> in;
    for (int r = 0; r < rowsOfArguments(s); ++r) in.push_back(row(r));
    request(c, s, point, in.data(), 1, 0, Color(1), target, true, occurrence);
    if (lobes.empty()) return {};
    LobeVertex l = lobes.back();
    lobes.clear();
    if (from.bounces + 1 > world_->maxDepth_) return {};
    uint32_t many = from.asked;
    float chance = 1;
    const bool onlyDistance = s.givesDistance() && s.resultRows.size() < 2;
    if (rules_.roulette && !onlyDistance) {
        many = std::max<uint32_t>(many, uint32_t(world_->lightTraces_) * (occurrence + 1) * uint32_t(std::max(l.samples, 1)));
        chance = rouletteOfLight(from.bounces, many);
        const uint32_t vertex = childVertex(from.vertex, kLightPoint + l.site, occurrence * 4096);
        if (chance < 1 && random(from).one(vertex, kRoulette, 0) >= chance) return {};
    }
    const Vec3 start = l.elsewhere ? l.from : p.P;
    const bool leaves = p.lit && length(start - p.Ps) <= geometry::roundingError(p.Ps) + 4 * p.lit->pError;
    lobeRows_.prepare();
    const LobeColumns::Place place = l.place;
    const bool delta = lobeRows_.delta(place);
    const float spread = lobeRows_.spread(place);
    if (delta) l.samples = 1;
    const uint32_t drawn = childVertex(from.vertex, kLightPoint + l.site, occurrence * 4096);
    for (int k = 0; k < l.samples; ++k) {
        const uint32_t nth = occurrence * 4096 + uint32_t(k), vertex = childVertex(from.vertex, kLightPoint + l.site, nth);
        Vec3 w;
        const Random ofDraw = random(from).draw(uint32_t(k), uint32_t(l.samples));
        int tries = 0;
        const int most = l.trace->axis ? kDrawTries : 1;
        do {
            lobeRows_.ask(place, tries ? random(from).pair(vertex, kDrawAgain, uint32_t(tries))
                                       : ofDraw.pair(drawn, l.site, occurrence));
            lobeRows_.sample();
        } while (!lobeRows_.drawn(place, w) && ++tries < most);
        if (tries == most) continue;
        lobeRows_.ask(place, w);
        lobeRows_.evaluate();
        const LobeValue value = lobeRows_.value(place);
        const Color f = delta ? Color(lobeRows_.albedo(place)) : value.pdf > 0 ? value.colour / value.pdf : Color(0);
        PathRay r = from;
        r.weight = f / float(l.samples);
        r.vertex = vertex;
        r.asked = uint16_t(std::min<uint32_t>(many, 0xffff));
        r.bounces = int16_t(onlyDistance ? world_->maxDepth_ : from.bounces + 1); // nothing goes on behind a distance
        ++(l.rays->type == RayType::Diffuse ? r.diffuseBounces : r.specularBounces);
        r.origin = l.bias >= 0 ? start + w * l.bias
                   : leaves    ? geometry::offsetOrigin(*p.lit, w, 0)
                               : start + w * geometry::roundingError(start);
        r.parted = r.passed = false, r.trail = 0, r.path = 0; // what it brings is the light's
        if (!leaves || (dot(from.dir, p.lit->n) < 0) != (dot(w, p.lit->n) > 0)) r.media = nullptr; // nobody knows
        r.dir = w;
        r.maxDistance = l.maxDistance;
        r.kind = l.rays;
        RayExtra extra;
        if (l.trace && l.trace->map) extra.environment = l.tint * mapTowards(*l.trace, w, from.footprint.spread);
        r.extra = newExtra(extra);
        r.lobePdf = -1, r.lobeBinding = -1; // no light was sampled: all that shines counts
        r.first = true, r.counts = false;
        r.footprint.spread = std::max(from.footprint.spread, spread * 0.5f);
        sched.spawn(r.bounces + r.layers, target, r);
    }
    lobeRows_.clear();
    sched.run();
    litValues_.clear();
    shadows.clear();
    // The chance is not in the rays' weights: what they meet goes on as if they were certain.
    shading::TargetValue value = sched.value(target);
    value.radiance = value.radiance / chance;
    return value;
}

void Engine::followGather(std::span<GatherSent> sent) {
    std::vector<TargetId> targets;
    for (GatherSent& g : sent) {
        targets.push_back(sched_->newRoot());
        gathered_[targets.back()] = &g;
        sched_->spawn(g.ray.bounces + g.ray.layers, targets.back(), g.ray);
    }
    sched_->run();
    for (size_t k = 0; k < sent.size(); ++k)
        if (!sent[k].quiet) endGatherRay(*sent[k].site, sched_->value(targets[k]), sent[k].row);
    gathered_.clear();
    litValues_.clear();
    shadows.clear();
}

/// A gather in a light's kernel.
void Engine::gatherOfLight(BatchContext& c, const SiteInfo& s, int first, std::span<uint32_t> asked) {
    const int lanes = c.requestLanes;
    const size_t points = asked.size() / c.bound->sites.size();
    std::vector<uint32_t> occurrence(size_t(lanes), 0), rays(size_t(lanes), 0);
    for (int lane = 0; lane < lanes; ++lane) {
        if (!(c.requestMask >> lane & 1) || first + lane >= int(c.points.size())) continue;
        uint32_t& turn = asked[size_t(c.requestSite) * points + size_t(first + lane)];
        if (c.requestIn[size_t(s.rows[4]) * size_t(lanes) + size_t(lane)] < 0.5f) ++turn;
        occurrence[size_t(lane)] = turn;
    }
    std::vector<GatherSent> sent;
    const GatherRows& g = castGather(*this, c, s, first, c.requestMask, lanes, c.requestIn.data(), occurrence, rays, sent);
    if (!sent.empty()) {
        inner().followGather(sent);
        takeInner();
    }
    for (int lane = 0; lane < lanes; ++lane) c.requestOut[lane] = float(g.counts[size_t(lane)]);
}

void Engine::runWaitingLight(BatchContext& context) {
    BatchContext* c = &context;
    const BoundKernel& bound = *c->bound;
    const auto& k = *bound.kernel;
    // A light that decides on traced light: its few requests are answered in place, strip by strip.
    std::vector<uint32_t> asked(bound.sites.size() * size_t(c->batch->size()));
    for (int first = 0; first < c->batch->size(); first += k.lanes()) {
        void* h = k.start(&c->batch->call(), first);
        if (!h) throw std::bad_alloc();
        const std::unique_ptr<void, std::function<void(void*)>> frame(h, [&](void* f) { k.destroy(f); });
        c->ran();
        while (!k.finished(h)) {
            const SiteInfo& s = bound.sites[c->requestSite];
            if (s.kind == SiteKind::Gather) {
                gatherOfLight(*c, s, first, asked);
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
                    rayOfLight(*c, s, first + lane, row,
                               asked[size_t(c->requestSite) * size_t(c->batch->size()) + size_t(first + lane)]++, &sums);
                putResult(s, t, s.kind == SiteKind::Occlusion ? &sums : nullptr, c->requestOut, c->requestLanes, lane);
            }
            k.resume(h);
            c->ran();
        }
    }
}

void Engine::addLightPairs(BatchContext& context, std::vector<ShadePoint>& queries, std::span<LightValue> out) {
    BatchContext* c = &context;
    const BoundKernel& bound = *c->bound;
    // Affine requests of the light itself: shadows that it asks for. Counted by site and point: no random number depends on the
    // batch.
    std::vector<uint32_t> asked(c->emits.empty() ? 0 : bound.sites.size() * queries.size());
    for (const EmitRecord& e : c->emits) {
        const SiteInfo& s = bound.sites[e.site];
        if (s.kind != SiteKind::Transmission && s.kind != SiteKind::Trace && s.kind != SiteKind::Occlusion) continue;
        for (int lane = 0; lane < e.lanes; ++lane) {
            if (!(e.mask >> lane & 1) || e.first + lane >= int(queries.size())) continue;
            auto at = [&](int row) { return c->arena[e.offset + size_t(row) * e.lanes + lane]; };
            c->points.swap(queries); // the rays start from them
            const Color light = rayOfLight(
                                    *c, s, e.first + lane, [&](int row) { return at(row + 3); },
                                    asked[size_t(e.site) * queries.size() + size_t(e.first + lane)]++)
                                    .radiance;
            c->points.swap(queries);
            out[e.first + lane].Cl += Color(at(0), at(1), at(2)) * light;
        }
    }
}

void Engine::evaluateLight(const BoundLight& light, std::vector<ShadePoint>& queries, std::span<LightValue> out,
                           const LightCall& call) {
    if (queries.empty()) return;
    const BoundKernel& bound = call.kernel ? *call.kernel : light.kernel;
    auto c = takeContext();
    c->engine = this;
    c->bound = &bound;
    c->lit = call.lit;
    c->light = &light;
    c->ownShadows.clear();
    c->points.swap(queries); // lent; given back below
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
    c->batch->assign(bound.kernel, *bound.plan, c->points, views, viewOf, *world_);
    bindCall(c->batch->call(), *c);
    const auto& k = *bound.kernel;
    if (k.facts().suspends) {
        runWaitingLight(*c);
    } else {
        k.run(&c->batch->call());
        c->ran();
    }
    if (world_->clouds_ && world_->clouds_->notesLights) world_->clouds_->noteLights(light, call.of);
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
    addLightPairs(*c, queries, out);
    for (size_t i = 0; i < c->ownShadows.size(); ++i) out[i].ownShadow = c->ownShadows[i] != 0;
    for (size_t i = 0; i < queries.size(); ++i) // the kernel divided by the squared distance: radiance does not
        if (const float scale = (call.of.empty() ? light : *call.of[i]).intensityScale; scale > 0)
            out[i].Cl *= dot(out[i].L, out[i].L) * scale;
    hazeOfEmitters(light, queries, out, call.inMedium);
    giveBack(std::move(c));
}

bool LitValues::output(const std::string& name, std::vector<float>& v) const {
    for (const auto& [known, numbers] : outputs)
        if (known->name.name == name) {
            v = numbers;
            return true;
        }
    return false;
}

LitSurface Engine::litBy(std::span<const int> of) const {
    LitSurface lit;
    lit.binding = [this, of](int q) -> const SurfaceBinding* {
        const int b = of[size_t(q)] < 0 ? -1 : litValues_[size_t(of[size_t(q)])].binding;
        return b < 0 ? nullptr : &world_->bindings_[size_t(b)];
    };
    lit.output = [this, of](int q, const std::string& name, std::vector<float>& v) {
        return of[size_t(q)] >= 0 && litValues_[size_t(of[size_t(q)])].output(name, v);
    };
    lit.displaced = [this, of](int q, int& point) -> const KernelRun* {
        if (of[size_t(q)] < 0) return nullptr;
        point = litValues_[size_t(of[size_t(q)])].point;
        return litValues_[size_t(of[size_t(q)])].displaced.get();
    };
    return lit;
}

} // namespace alpenglow::transport
