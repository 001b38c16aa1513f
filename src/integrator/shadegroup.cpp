// Running a surface's kernel over a batch of points: to its end, or strip by strip where it waits for rays (strips.h); then what
// it asked for.
#include "base/direction.h"
#include "integrator/blockvertices.h"
#include "world/outputs.h"
#include <algorithm>

namespace alpenglow::transport {

namespace {
/// The unit shading normal on the side of a surface that a ray sees; 0 where there is none.
Vec3 normalSeen(const ShadePoint& p, const Vec3& dir) {
    const float l = length(p.N);
    if (l > 0 && std::isfinite(l)) return onSeenSide(p.N, p, dir) * (1 / l);
    const Vec3 n = directionOr(p.N, {});
    return dot(n, n) > 0 ? onSeenSide(n, p, dir) : n;
}
} // namespace

bool isOpaque(const shading::Batch& b) {
    const int oi = b.plan().Oi;
    for (int k = 0; k < 3 && oi >= 0; ++k)
        for (const float o : b.row(oi, k))
            if (o != 1) return false;
    return true;
}

Color Engine::leftBehind(const BatchContext& c, int i) const {
    // An atmosphere goes on behind what is not opaque, as if nothing were there. A medium ends, and another begins.
    if (world_->media_.empty() || c.haze.empty() || !c.haze[size_t(i)].on) return Color(1);
    const PathRay& ray = c.rays[size_t(i)];
    const SurfaceBinding& binding = world_->bindings_[size_t(c.bindings[size_t(i)])];
    const bool ends =
        ray.medium() >= 0 ||
        binding.beyond(ray.media ? *ray.media : shading::Media(), c.points[size_t(i)].surface.n, ray.dir, ray.dir).top() >= 0;
    return ends ? c.haze[size_t(i)].slope : Color(1);
}

Color Engine::clearAt(const BatchContext& c, int i) const {
    if (photonTrace_ && photonTrace_->job->models)
        if (const PhotonModel m = world_->bindings_[size_t(c.bindings[size_t(i)])].photons.model; m != PhotonModel::Shader)
            return Color(m == PhotonModel::Transparent) * leftBehind(c, i);
    const shading::Batch& b = *c.batch;
    const int oi = b.plan().Oi;
    if (oi < 0) return Color(0);
    Color clear = (Color(1) - b.color(oi, i)) * leftBehind(c, i);
    for (int k = 0; k < 3; ++k) clear[k] = clear[k] > 0 ? std::min(clear[k], 1.f) : 0; // not a number: opaque
    return clear;
}

/// What a call whose ray has met a point is told besides light.
void Engine::tellAsker(const BatchContext& c, int i, const Color& opacity, Sched& sched) {
    const PathRay& ray = c.rays[size_t(i)];
    const TargetId target = c.targets[size_t(i)];
    if (ray.first) {
        sched.setNearer(target, length(c.points[size_t(i)].P - ray.origin), c.points[size_t(i)].N);
        sched.setTransmission(target, Color(1) - opacity);
    }
    if (!gathered_.empty())
        if (const auto asks = gathered_.find(target); asks != gathered_.end()) tellGather(c, i, *asks->second);
    const RayExtra& extra = extraOf(ray);
    if (extra.fade.fades() && maxComponent(extra.environment) > 0) { // what does not block shows the sky
        const Color light = extra.whole * extra.environment * opacity * (1 - extra.kept);
        deposit(sched, {target, light, LightEvent::Map, &ray, extra.share});
        if (TraceSums* sums = sumsOf(target)) sums->add(TraceSums::Environment, light);
    }
    if (TraceSums* sums = sumsOf(target)) {
        const Color blocked = extra.part * opacity * extra.kept;
        sums->add(TraceSums::Blocked, blocked);
        sums->add(TraceSums::Open, ray.dir * -mean(blocked));
    }
}

/// The parts of what a volume shader shows: what the surface gives by itself, `met` of it, and what the volume adds.
void Engine::depositThroughVolume(Sched& sched, const PathRay& ray, const Color& met, const Color& shown) {
    depositPart(sched, &ray, pathEvent(ray.path, object_), ray.weight * met);
    depositPart(sched, &ray, pathEvent(pathEvent(ray.path, volume_), object_), ray.weight * (shown - met));
}

void Engine::finishStrip(BatchContext& c, int first, int lanes, Sched& sched, std::span<const uint32_t> asked) {
    if (c.aside) return finishAside(c, first, lanes, sched);
    shading::Batch& b = *c.batch;
    int ci = b.plan().Ci, oi = b.plan().Oi;
    const auto& wanted = world_->wanted_;
    std::vector<std::vector<int>> wantedAt; // by AOV: the kernel's outputs, for arrays one an element
    for (const rsl::OutputName& name : wanted) wantedAt.push_back(outputsNamed(b, name));
    std::vector<char>
        perhaps; // by AOV: a surface that makes the names of its outputs when it runs gives it at some points, and zero at others
    bool suspended = b.kernel().facts().suspends; // then nobody has asked for the atmosphere yet
    const bool media = !world_->media_.empty();
    if (suspended) hazeOfBatch(c, first, lanes, media || lightPaths_);
    for (int i = first; i < std::min(first + lanes, int(c.points.size())); ++i) {
        const PathRay& ray = c.rays[i];
        const SurfaceBinding& binding = world_->bindings_[c.bindings[i]];
        Color color = ci >= 0 ? b.color(ci, i) : Color(0), opacity = oi >= 0 ? b.color(oi, i) : Color(1);
        if (binding.matte && ray.camera()) {
            sched.setDistance(c.targets[i], 0);
            color = Color(0);
        }
        tellAsker(c, i, opacity, sched);
        Color shown = color;
        if (!c.haze.empty() && c.haze[size_t(i)].on && !(binding.matte && ray.camera())) { // pairs were scaled in shadeGroup
            shown = c.haze[size_t(i)].shown;
            opacity = c.haze[size_t(i)].opacity;
        }
        if (!isFinite(opacity)) notFinite(&ray, "Oi", binding.surface.get());
        const bool hazed = !c.haze.empty() && c.haze[size_t(i)].on; // then what it gives and what the volume adds are told apart
        if (isFinite(shown))
            deposit(sched, {c.targets[i], ray.weight * shown, LightEvent::Surface, &ray, extraOf(ray).share,
                            binding.surface.get(), hazed ? uint16_t(0) : pathEvent(ray.path, object_)});
        else notFinite(&ray, "Ci", binding.surface.get());
        if (hazed && ray.path && isFinite(shown))
            depositThroughVolume(sched, ray, binding.matte && ray.camera() ? shown : c.haze[size_t(i)].slope * color, shown);
        if (ray.counts) {
            SampleResult& r = *results[size_t(ray.sample->path)];
            if (world_->settings_.firstSeen)
                r.normal += normalSeen(c.points[size_t(i)], ray.dir) * luminance(ray.weight * opacity);
            if (!binding.matte) r.opacity += ray.weight * opacity;
            const float z = c.depths.empty() ? c.points[size_t(i)].P.z : c.depths[size_t(i)];
            if (r.z >= 1e38f) r.z = z;
            else if (r.zSecond >= 1e38f) r.zSecond = z;
            size_t at = 0;
            for (size_t k = 0; k < wanted.size(); ++k) {
                const int width = world_->outputWidths_[k];
                int to = 0;
                if (!binding.aside.empty() && binding.aside[k]) { // asides() give it
                    at += size_t(width);
                    continue;
                }
                bool others = wantedAt[k].empty(); // what lights and the atmosphere give
                if (!others && !c.lightChannels.empty()) {
                    if (perhaps.empty())
                        for (const rsl::OutputName& name : wanted)
                            perhaps.push_back(c.binding && givesPerhaps(*c.binding->surface, name));
                    others = perhaps[k] && !givenAt(b, wanted[k], i);
                }
                for (int o : wantedAt[k]) {
                    if (others) break;
                    const int size = rsl::ir::components(b.kernel().outputs()[size_t(o)].kind);
                    for (int w = 0; w < size && to < width; ++w, ++to)
                        r.aovs[at + size_t(to)] += (size == 3 ? ray.weight[w] : luminance(ray.weight)) * b.value(o, w, i);
                }
                if (others && !c.lightChannels.empty())
                    for (int w = 0; w < width; ++w)
                        r.aovs[at + size_t(w)] +=
                            (width % 3 == 0 ? ray.weight[w % 3] : luminance(ray.weight)) *
                            c.lightChannels[size_t(i) * (c.lightChannels.size() / c.points.size()) + at + size_t(w)];
                at += size_t(width);
            }
        }
        const float chance = c.passes.empty() ? 1 : c.passes[size_t(i)];
        const Color clear = chance > 0 && !c.opaque ? goesOn(c, i) : Color(0);
        if (ray.counts && ray.sample->grid) results[size_t(ray.sample->path)]->behind = clear;
        else if (maxComponent(clear) > 0)
            passThrough(binding, ray, c.targets[i], c.points[i], clear, chance, asked.empty() ? 0 : asked[size_t(i - first)],
                        sched);
    }
}

/// The parameters of a binding's surface as kernels of a plan read them.
const shading::ParameterRows* Engine::parametersOf(int binding, const shading::BatchPlan& plan) {
    parameters_.resize(world_->bindings_.size());
    auto& known = parameters_[size_t(binding)];
    for (const auto& rows : known)
        if (rows && rows->plan() == &plan) return rows.get();
    std::swap(known[0], known[1]);
    known[0] = std::make_unique<const shading::ParameterRows>(plan, world_->bindings_[size_t(binding)].surface->parameters);
    return known[0].get();
}

/// The instances of a batch's points, which are few: views_ and viewOf_.
void Engine::viewsOf(const BatchContext& c) {
    views_.clear();
    viewOf_.clear();
    slotOf_.resize(world_->bindings_.size(), -1);
    for (int b : c.bindings) {
        int& slot = slotOf_[size_t(b)];
        if (slot < 0) {
            const InstanceRef& i = world_->bindings_[size_t(b)].surface;
            slot = int(views_.size());
            views_.push_back(i->view());
            views_.back().rows = parametersOf(b, *c.bound->plan);
        }
        viewOf_.push_back(uint32_t(slot));
    }
    for (int b : c.bindings) slotOf_[size_t(b)] = -1;
}

/// The inputs of a batch from its points.
void Engine::fillBatch(BatchContext& c) {
    viewsOf(c);
    if (!c.batch) c.batch = std::make_shared<shading::Batch>();
    c.batch->assign(c.bound->kernel, *c.bound->plan, c.points, views_, viewOf_, *world_);
    bindCall(c.batch->call(), c);
}

void Engine::shadeGroup(const std::shared_ptr<BatchContext>& c, Sched& sched) {
    if (c->binding->displacement) takeDisplacement(*c);
    const auto& kernel = *c->bound->kernel;
    if (photonTrace_) hazeOfPhotons(*this, *c);
    if (photonTrace_ && kernel.facts().suspends) return photonsByModel(*c, sched);
    fillBatch(*c);
    if (c->displaced) c->batch->tell(*c->displaced->batch);
    if (!gathered_.empty()) takeSent(*c);
    auto aside = asides(*c, sched);
    if (c->binding->moveS) moveToFacets(*c); // the kernel moves P itself: it begins with the surface as it was
    int n = int(c->points.size());
    counters.points += uint64_t(n);
    ++counters.batches;
    counters.lanesUsed += uint64_t(n);
    counters.lanesRun += uint64_t((n + kernel.lanes() - 1) / kernel.lanes() * kernel.lanes());

    if (kernel.facts().suspends) {
        startStrips(c, sched);
        followAsides(shareLight(*c, {}, aside, sched), aside, sched);
        return;
    }
    kernel.run(&c->batch->call());
    c->ran();

    // Affine pairs by point, in order of emission. Atmosphere scales them.
    const bool media = !world_->media_.empty();
    bool hazy = media || std::any_of(c->bindings.begin(), c->bindings.end(),
                                     [&](int b) { return world_->bindings_[size_t(b)].atmosphere.shader != nullptr; });
    if (!hazy && aside.empty() && blockVertices_->takes(*c)) {
        c->opaque = isOpaque(*c->batch);
        if (!c->opaque) tellClear(*c);
        if (blockVertices_->run(*c, sched)) {
            counters.inBlocks += uint64_t(n);
            requestPairs(*c, std::vector<Color>(size_t(n), Color(1)), nullptr, sched, false);
            if (!ambients_.empty()) gatherAmbient(*c);
            flushShadows(sched);
            return finishStrip(*c, 0, n, sched);
        }
    }
    std::vector<Color> slope(n, Color(1));
    if (hazy && !photonTrace_) {
        hazeOfBatch(*c, 0, n, media || !c->emits.empty() || lightPaths_);
        for (int i = 0; i < n; ++i)
            if (c->haze[size_t(i)].on) slope[size_t(i)] = c->haze[size_t(i)].slope;
    }
    std::vector<AskedLobe> asked; // only where outputs share lobes
    requestPairs(*c, slope, aside.empty() ? nullptr : &asked, sched);
    if (photonTrace_) takeModels(*c, false);
    if (world_->settings_.hider == Hider::Path) tellClear(*c);
    const auto rest = shareLight(*c, asked, aside, sched);
    gather(*c, sched);
    flushShadows(sched);
    finishStrip(*c, 0, n, sched);
    followAsides(rest, aside, sched);
}

/// What comes through at each point, which decides which ray goes on.
void Engine::tellClear(BatchContext& c) {
    c.clear.resize(c.points.size());
    for (size_t i = 0; i < c.points.size(); ++i) c.clear[i] = clearAt(c, int(i));
    c.passes.assign(c.points.size(), 1.f);
}

/// What the pairs of a kernel that did not wait ask for. `slope`: by point. `asked`: gets the lobes; may be null. lobesToo:
/// false: all but lobes.
void Engine::requestPairs(BatchContext& c, std::span<const Color> slope, std::vector<AskedLobe>* asked, Sched& sched,
                          bool lobesToo) {
    const int n = int(c.points.size());
    std::vector<uint32_t>& occurrence = occurrence_;
    occurrence.assign(c.emits.empty() ? 0 : c.bound->sites.size() * size_t(n), 0);
    for (const EmitRecord& e : c.emits) {
        const SiteInfo& s = c.bound->sites[e.site];
        if (s.kind == SiteKind::Ambient ? !ambientLights_
                                        : !lobesToo && !asksShadows(s.kind) && s.kind != SiteKind::LightVisibility)
            continue;
        const float* rows = c.arena.data() + e.offset;
        for (int lane = 0; lane < e.lanes; ++lane) {
            int point = e.first + lane;
            if (!(e.mask >> lane & 1) || point >= n) continue;
            Color weight = Color(rows[lane], rows[e.lanes + lane], rows[2 * e.lanes + lane]) * slope[point];
            if (!isFinite(weight)) {
                notFinite(c, c.rays[size_t(point)], uint32_t(e.site));
                continue;
            }
            if (weight == Color(0) || c.rays[size_t(point)].quiet) continue;
            if (world_->bindings_[c.bindings[point]].matte && c.rays[point].camera()) continue;
            const float* args = rows + size_t(3) * e.lanes;
            if (photonTrace_ && (s.kind == SiteKind::LightVisibility || asksShadows(s.kind)))
                continue; // nobody asks what photons see
            if (s.kind == SiteKind::LightVisibility) {
                const size_t had = shadows.size();
                lightVisibility(c, s, point, args, e.lanes, lane, weight * c.rays[point].weight, c.targets[point]);
                if (shadows.size() > had) {
                    const PathRay& ray = c.rays[size_t(point)];
                    shadows.back().share = extraOf(ray).share;
                    shadows.back().path = atLoop(c.points[size_t(point)], ray, shadows.back().dir, loopLabel_);
                    shadows.back().light = e.light >= 0 && !lightSymbols_.empty() ? lightSymbols_[size_t(e.light)] : loopLight_;
                }
                continue;
            }
            if (asksShadows(s.kind)) weight *= c.rays[point].weight;
            const size_t had = lobes.size();
            if (shadows.size() > kShadowsAtOnce) flushShadows(sched);
            request(c, s, point, args, e.lanes, lane, weight, c.targets[point], false,
                    occurrence[size_t(e.site) * size_t(n) + size_t(point)]++);
            if (asked && lobes.size() > had) asked->push_back({int(had), int(&e - c.emits.data()), lane});
        }
    }
}

} // namespace alpenglow::transport
