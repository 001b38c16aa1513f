// What becomes of the requests of a batch: lobes are gathered over lights, then rays are sent (design decisions 2 and 3).
#include "transport/engine.h"
#include "texture/lookup.h"
#include "transport/emitterfootprint.h"
#include "transport/raysets.h"
#include "transport/sampling.h"

namespace alpenglow::transport {

namespace {
Vec3 unit(Vec3 v, Vec3 fallback) {
    float l = length(v);
    return l > 0 && std::isfinite(l) ? v / l : fallback;
}
/// Parameters of the distributions of bsdf(), as given or as they are when not (rsl.md 12.4).
template <class Row> DistributionParams distributionOf(const SiteInfo& s, const Row& f) {
    const TraceSite& t = *s.trace;
    DistributionParams m;
    auto triple = [&](int row) { return Color(f(row), f(row + 1), f(row + 2)); };
    if (t.roughness >= 0) m.roughness = f(t.roughness);
    m.roughnessv = t.roughnessv >= 0 ? f(t.roughnessv) : m.roughness;
    if (t.udir >= 0) m.udir = triple(t.udir);
    if (t.absorption >= 0) m.absorption = triple(t.absorption);
    m.eta = Color(s.lobe->name == "glass-ggx" ? 1.5f : s.lobe->name == "hair" ? 1.55f : 0.f);
    for (size_t k = 0; k < t.eta.size() && k < 2; ++k) (k ? m.k : m.eta) = t.eta[k].second == 1 ? Color(f(t.eta[k].first)) : triple(t.eta[k].first);
    for (int row : t.lobes) m.lobes.push_back(f(row));
    m.part = t.part;
    return m;
}
} // namespace

void Engine::request(BatchContext& c, const SiteInfo& s, int point, const float* in, int lanes, int lane, Color weight, TargetId target, bool owns,
                     uint32_t occurrence) {
    const ShadePoint& p = c.points[point];
    auto f = [&](int row) { return in[size_t(row) * lanes + lane]; };
    auto v = [&](int arg) { return Vec3(f(s.rows[arg]), f(s.rows[arg] + 1), f(s.rows[arg] + 2)); };
    auto number = [&](int row, float fallback) { return row < 0 ? fallback : f(row); };
    auto vector = [&](int row, Vec3 fallback) { return row < 0 ? fallback : Vec3(f(row), f(row + 1), f(row + 2)); };
    if (s.kind == SiteKind::Transmission) {
        const size_t had = shadows.size();
        transmissionRays(s, p, p.P, &p.surface, f, weight, target, uint32_t(s.site - c.bound->kernel->sites().data()), occurrence, shadows);
        if (!owns && p.ray)
            for (size_t k = had; k < shadows.size(); ++k) shadows[k].share = extraOf(*p.ray).share;
        shadowsInMedia(std::span(shadows).subspan(had), v(0), v(1), p.P, &p.surface, c.bindings.empty() ? nullptr : &world_->bindings_[size_t(c.bindings[size_t(point)])]);
        return;
    }
    // Under path ambient light is what escaping diffuse rays see.
    if (s.kind != SiteKind::Diffuse && s.kind != SiteKind::Specular && s.kind != SiteKind::Phong && s.kind != SiteKind::Trace) return;
    LobeVertex& l = lobes.emplace_back();
    l.kind = s.lobe;
    LobeParams params;
    l.point = point;
    l.weight = weight;
    l.target = target;
    l.ownsTarget = owns;
    l.site = uint32_t(s.site - c.bound->kernel->sites().data());
    l.occurrence = occurrence;
    if (world_->lightsAsk()) {
        l.lit = int(litValues_.size());
        LitValues& told = litValues_.emplace_back();
        told.binding = size_t(point) < c.bindings.size() ? c.bindings[size_t(point)] : -1; // a light's own ray: none
        told.displaced = c.displaced;
        told.point = point;
        for (const SiteInfo::Output& o : s.outputs) {
            auto& of = told.outputs.emplace_back(o.name, std::vector<float>());
            for (int r = 0; r < o.size; ++r) of.second.push_back(f(o.row + r));
        }
    }
    if (s.kind != SiteKind::Diffuse) params.wo = unit(-p.I, p.surface.n);
    switch (s.kind) {
    case SiteKind::Diffuse:
        params.axis = unit(v(0), p.surface.n);
        l.rays = &kDiffuseKind;
        break;
    case SiteKind::Specular:
    case SiteKind::Phong:
        params.axis = unit(v(0), p.surface.n);
        params.wo = unit(v(1), params.wo);
        params.a = f(s.rows[2]);
        if (s.kind == SiteKind::Specular)
            params.a = s.exponent / std::max(params.a, 1e-6f);
        l.rays = &kSpecularKind;
        break;
    case SiteKind::Trace:
        params.axis = unit(v(1), p.surface.n);
        params.wo = unit(vector(s.rowWo, params.wo), params.wo);
        params.a = s.lobe->name == "slphong" ? number(s.rowExponent, 1000) : number(s.rowCone, 0);
        l.trace = s.trace.get();
        if (s.rowHorizon >= 0) {
            params.horizon = unit(vector(s.rowHorizon, p.surface.n), p.surface.n);
            params.hasHorizon = true;
        }
        if (s.rays->fixed && !(world_->traceSubsets_ && s.rays->subsetText.empty())) { // what most calls are, many times a sample
            l.rays = kindOf({s.rays->rays, true, s.rays->set, s.label});
        } else {
            RayKind kind{RayType::Diffuse, true, {}, 0};
            kind.set = raySetOf(s, f, p.shape, kind.type, kind.label);
            l.rays = kindOf(kind);
        }
        l.lights = number(s.rowLights, 0) != 0;
        l.bias = number(s.rays->bias, -1);
        l.base = number(s.rays->base, 0);
        if (s.trace->map) l.tint = vector(s.trace->tint, Color(1));
        // From a point that is not the surface's no light is sampled: rays that meet an emitter count in full.
        if (const Vec3 from = v(0), away = from - p.P; !p.surface.displaced && length(away) > geometry::roundingError(p.P) + 4 * p.surface.pError) {
            l.elsewhere = true;
            l.from = from;
        }
        l.deltaLights = false;
        l.lobeOfShader = false;
        l.maxDistance = std::min(number(s.rays->maxDistance, 1e38f), number(s.rays->maxHit, 1e38f));
        if (l.maxDistance < 0) l.maxDistance = 1e38f; // PRMan: none
        l.samples = std::clamp(int(std::clamp(number(s.rays->samples, 1), 1.f, 4096.f)), 1, 4096);
        break;
    default: break;
    }
    if (l.kind->distribution) {
        const DistributionParams more = distributionOf(s, f);
        l.place = lobeRows_.add(*l.kind, params, &more);
    } else {
        l.place = lobeRows_.add(*l.kind, params);
    }
}

Color Engine::mapTowards(const TraceSite& t, const Vec3& w, float spread) const {
    const Vec3 at(transformVector(t.toMap, Vec3d(w)));
    const Basis b(at / length(at));
    float v[3] = {};
    texture::LookupOptions colours;
    colours.asLight = true;
    texture::environment(t.map, world_->textures_->latLong(), 0, 3, at, b.t * spread, b.u * spread, colours, v);
    return {v[0], v[1], v[2]};
}

float Engine::chooseLobes(const BatchContext& c, size_t pi, std::span<const int> list, float& passes) {
    const Settings& set = world_->settings_;
    const bool path = set.hider == Hider::Path;
    const PathRay& from = c.rays[pi];
    const SurfaceBinding& b = world_->bindings_[size_t(c.bindings[pi])];
    const Color clear = c.clear.empty() ? Color(0) : c.clear[pi];
    // Under path one ray goes on from a vertex: along one of the lobes, or behind the surface where that lets light through.
    // Those two may have quite different colours: what the way here has left of each decides, else a channel could grow without
    // end. A camera ray goes on besides.
    const bool competes = path && from.bounces > 0 && maxComponent(clear) > 0;
    const Color left(std::fabs(from.weight.x), std::fabs(from.weight.y), std::fabs(from.weight.z));
    const auto worth = [&](const Color& share) { return competes ? dot(share, left) / 3 : luminance(share); };
    Color sum(0);
    bool cut = false; // by the depth of the render, not by a depth that a primitive asks for
    for (int i : list) {
        LobeVertex& l = lobes[size_t(i)];
        const Color weight(std::fabs(l.weight.x), std::fabs(l.weight.y), std::fabs(l.weight.z));
        l.albedo = lobeRows_.albedo(l.place);
        l.delta = lobeRows_.delta(l.place);
        if (l.lobeOfShader) sum += weight * l.albedo;
        l.chosen = std::max(worth(weight) * l.albedo, 0.f);
        if (!std::isfinite(l.chosen)) {
            notFinite(c, from, l.site);
            l.chosen = 0;
        }
        // A lobe whose ray would go too deep is not followed; light samples then count in full.
        const bool diffuse = l.rays->type == RayType::Diffuse;
        const bool deep = from.bounces + 1 > world_->maxDepth_ ||
                          (b.maxDiffuse >= 0 && from.diffuseBounces + diffuse > b.maxDiffuse) ||
                          (b.maxSpecular >= 0 && from.specularBounces + !diffuse > b.maxSpecular);
        cut |= from.bounces + 1 > world_->maxDepth_ && l.chosen > 0;
        const bool stays = deep || (diffuse && !set.indirect);
        if (stays) l.chosen = 0;
        l.followed = l.chosen > 0 || (l.ownsTarget && !stays);
    }
    counters.depthCap += cut;
    // What is reflected and what comes through is at most what arrives.
    float scale = 1;
    for (int k = 0; k < 3 && !set.unbiased && !c.aside; ++k) // what an output adds up is nobody's energy
        if (sum[k] + clear[k] > 1 && sum[k] > 0) scale = std::min(scale, (1 - clear[k]) / sum[k]);
    const bool more = maxComponent(sum) > 1; // by itself: else a highlight on what is clear, say, which is common
    if (scale < 0.999f && (more ? tamed_ : tamedClear_).insert(b.surface.get()).second) // beyond rounding; said once a shader
        diagnostics_.reportOnce((more ? "energy:" : "energyclear:") + b.surface->name,
                                {more ? Severity::Warning : Severity::Info,
                                 Rie::NoError,
                                 b.surface->place,
                                 "shader \"" + b.surface->name + "\" reflects" +
                                     (more ? "" : ", together with what comes through it,") +
                                     " more light than it receives; its indirect light is scaled down to what it receives",
                                 "--unbiased leaves it as it is",
                                 {}});
    const float behind = competes ? worth(clear) : 0;
    double total = behind;
    for (int i : list)
        if (LobeVertex& l = lobes[size_t(i)]; !l.ownsTarget) {
            if (behind > 0 && l.lobeOfShader) l.chosen *= scale;
            total += l.chosen;
        }
    for (int i : list) {
        LobeVertex& l = lobes[size_t(i)];
        if (l.ownsTarget || !path) l.chosen = l.followed ? 1 : 0;
        else l.chosen = total > 0 ? (total == l.chosen ? 1 : float(l.chosen / total)) : 0;
    }
    passes = behind > 0 && total > behind ? float(behind / total) : 1;
    return scale;
}

// Gathers light over the lobes collected for this batch, then sends rays.
void Engine::gather(BatchContext& c, Sched& sched) {
    const Settings& set = world_->settings_;
    bool path = set.hider == Hider::Path;
    if (lobes.empty()) return;
    lobeRows_.prepare();

    // Lobes by point, in order of emission: of point pi those at order[begin[pi]] to order[begin[pi + 1]].
    GatherRoom room = std::move(gatherRoom_); // taken, so that a gather() inside this one has its own
    std::vector<int>&begin = room.begin, &order = room.order;
    begin.assign(c.points.size() + 1, 0);
    order.resize(lobes.size());
    for (const LobeVertex& l : lobes) ++begin[size_t(l.point) + 1];
    for (size_t i = 1; i < begin.size(); ++i) begin[i] += begin[i - 1];
    {
        std::vector<int>& next = room.next;
        next.assign(begin.begin(), begin.end() - 1);
        for (size_t i = 0; i < lobes.size(); ++i) order[size_t(next[size_t(lobes[i].point)]++)] = int(i);
    }
    auto lobesOf = [&](size_t pi) { return std::span<const int>(order).subspan(size_t(begin[pi]), size_t(begin[pi + 1] - begin[pi])); };

    // What lights are told: a vertex has one answer. Where its requests are summed up, its kernel is done: its outputs as they are now.
    if (world_->lightsAsk())
        for (size_t pi = 0; pi < c.points.size(); ++pi) {
            auto list = lobesOf(pi);
            if (list.empty()) continue;
            const int first = lobes[size_t(list[0])].lit;
            for (auto& [name, v] : litValues_[size_t(first)].outputs) {
                const int o = c.bound->kernel->facts().suspends ? -1 : c.batch->output("param:" + name);
                for (size_t r = 0; o >= 0 && r < v.size(); ++r) v[r] = c.batch->value(o, int(r), int(pi));
            }
            for (int i : list) lobes[size_t(i)].lit = first;
        }

    auto sourcePoint = [&](size_t pi, const Vec3& w) {
        const ShadePoint& p = c.points[pi];
        if (const float bias = world_->bindings_[size_t(c.bindings[pi])].bias; bias > 0) return p.P + w * bias;
        return geometry::offsetOrigin(p.surface, w, p.P == p.surface.P ? 0 : length(p.P - p.surface.P));
    };

    // A waiting kernel's result goes to the target of its own that has no shares; what it makes of it has those of its ray.
    auto shareOf = [&](const LobeVertex& l) {
        return l.ownsTarget ? -1 : l.share >= 0 ? l.share : extraOf(c.rays[size_t(l.point)]).share;
    };

    std::vector<float>& indirectScale = room.indirectScale;
    indirectScale.assign(c.points.size(), 1.f);
    std::vector<float>& passes = room.passes; // by point: the chance that its ray goes on behind it
    passes.assign(c.points.size(), 1.f);
    for (size_t pi = 0; pi < c.points.size(); ++pi)
        if (auto list = lobesOf(pi); !list.empty()) indirectScale[pi] = chooseLobes(c, pi, list, passes[pi]);

    // Whether a lobe asks this light for samples. trace() knows emitters only, and not those that are illuminance's.
    auto samples = [](const LobeVertex& l, const BoundLight& light) {
        bool area = light.kind == LightKind::Area;
        return l.lights && !l.elsewhere && (area || l.deltaLights) && (l.lobeOfShader || light.strategy != LightStrategy::Illuminance);
    };

    // A light sample of trace() finds what a ray of it could meet there: within its distance, of its set, from the sides that it
    // meets.
    auto meets = [&](const LobeVertex& l, const Emitter::Sample& s, const geometry::SurfacePoint& at, const Vec3& w,
                     const Vec3& from, const Vec3& end) {
        if (l.rays->set.only && !l.rays->set.only[world_->numberOfShape_.at(s.shape)]) return false;
        if (s.shape->oneSided() && l.rays->set.sides != accel::Sides::Both &&
            (dot(at.n, w) >= 0) != (l.rays->set.sides == accel::Sides::Back))
            return false;
        const Vec3 way = end - from;
        return dot(way, w) > 0 && !(length(way) > l.maxDistance);
    };

    // Light samples: every light for every point with lobes that want it, in batches a light.
    if (set.direct && !set.bsdfOnly) {
        std::vector<ShadePoint>& q = room.q; // the batch shares one list of lights
        std::vector<int>& pointOf = room.pointOf;
        std::vector<Emitter::Sample>& drawn = room.drawn;
        std::vector<LightValue>& value = room.value;
        const std::vector<int>& on = world_->sampledLights_[size_t(world_->bindings_[size_t(c.bindings[0])].lightList)];
        // With many lights some are chosen at each point: by light, the points and the probability of the choice.
        bool many = path && on.size() > size_t(limits::kLightsSampled);
        std::vector<std::vector<std::pair<int, float>>> chosenAt(many ? on.size() : 0);
        if (many) {
            LightChooser::Chosen chosen;
            const LightChooser& chooser = world_->choosers_[size_t(world_->bindings_[size_t(c.bindings[0])].lightList)].chooser;
            for (size_t pi = 0; pi < c.points.size(); ++pi) {
                auto list = lobesOf(pi);
                if (list.empty()) continue;
                const LobeVertex& l0 = lobes[size_t(list[0])];
                uint32_t vertex = l0.ownsTarget ? childVertex(c.rays[pi].vertex, kLightPoint + l0.site, l0.occurrence) : c.rays[pi].vertex;
                chooser.choose(c.points[pi].P, random(c.rays[pi]).one(vertex, kChooseLight, 0), chosen);
                for (auto [i, chance] : chosen) chosenAt[size_t(i)].push_back({int(pi), chance});
            }
        }
        std::vector<float>& chance = room.chance;
        for (size_t at = 0; at < on.size(); ++at) {
            size_t li = size_t(on[at]);
            const BoundLight& light = world_->lights_[li];
            bool area = light.kind == LightKind::Area;
            // A light that filters over its surface is asked once for every width of the lobes at a point, at the same sample.
            const bool wide = area && usesFootprint(light);
            std::vector<float> spread; // by query; empty: it is for all lobes of its point
            size_t used = 0; // of q: its points are written again, not made anew
            chance.clear();
            pointOf.clear();
            drawn.clear();
            drawn.reserve(c.points.size());
            size_t count = many ? chosenAt[at].size() : c.points.size();
            for (size_t k = 0; k < count; ++k) {
                size_t pi = many ? size_t(chosenAt[at][k].first) : k;
                bool wanted = false;
                for (int i : lobesOf(pi)) wanted |= samples(lobes[i], light) && !lobes[i].delta;
                if (!wanted) continue;
                const ShadePoint& lit = c.points[pi];
                if (used == q.size()) q.emplace_back();
                ShadePoint& p = q[used];
                p.Ps = lit.P;
                p.lit = &lit.surface;
                p.Ns = lit.N;
                p.viewI = p.I = lit.I;
                p.E = lit.E;
                p.du = lit.du;
                p.dv = lit.dv;
                p.time = lit.time;
                p.ray = lit.ray;
                if (area) {
                    // Affine lobes of a vertex share its light sample; each suspended request has its own.
                    const PathRay& ray = c.rays[pi];
                    const LobeVertex& l0 = lobes[size_t(lobesOf(pi)[0])];
                    uint32_t vertex = l0.ownsTarget ? childVertex(ray.vertex, kLightPoint + l0.site, l0.occurrence) : ray.vertex;
                    Random rng = random(ray);
                    uint32_t use = kLightPoint + uint32_t(li);
                    Emitter::Sample& s = drawn.emplace_back();
                    const Vec2 u = rng.pair(vertex, use, 0);
                    const float choose = light.emitter->chooses() ? rng.one(vertex, use, 0) : 0;
                    if (!(light.mean ? light.emitter->sampleSurface(p.Ps, u, choose, s, p.surface, light.pointNeeds)
                                     : light.emitter->sample(p.Ps, u, choose, s, p.surface, light.pointNeeds))) {
                        drawn.pop_back();
                        continue;
                    }
                    p.shape = s.shape;
                    p.P = p.surface.P;
                    p.N = p.surface.n;
                } else {
                    p.shape = nullptr;
                    p.surface = lit.surface;
                    p.N = Vec3();
                    p.P = Vec3(transformPoint(light.instance->toCurrent, {0, 0, 0}));
                    p.Ci = light.cone && path ? coneNumbers(random(c.rays[pi]).pair(c.rays[pi].vertex, kLightPoint + uint32_t(li), 0)) : Color(0);
                    drawn.emplace_back();
                }
                ++used;
                pointOf.push_back(int(pi));
                chance.push_back(many ? chosenAt[at][k].second : 1.f);
                const size_t first = spread.size();
                for (int i : wide ? lobesOf(pi) : std::span<const int>()) {
                    const LobeVertex& l = lobes[size_t(i)];
                    if (l.delta || !samples(l, light)) continue;
                    const float s = spreadBehind(c.rays[pi], lobeRows_.spread(l.place));
                    if (std::find(spread.begin() + long(first), spread.end(), s) != spread.end()) continue;
                    spread.push_back(s);
                    if (spread.size() > used) {
                        if (used == q.size()) q.emplace_back();
                        q[used] = q[used - 1];
                        ++used;
                        drawn.push_back(Emitter::Sample(drawn.back()));
                        pointOf.push_back(int(pi));
                        chance.push_back(chance.back());
                    }
                    setEmitterFootprint(q[used - 1], c.rays[pi], c.points[pi].P, s);
                }
            }
            q.resize(used);
            value.assign(used, {});
            LightCall call;
            LitSurface lit;
            auto told = [&](int k) -> const LitValues& { return litValues_[size_t(lobes[size_t(lobesOf(size_t(pointOf[size_t(k)]))[0])].lit)]; };
            if (light.asksSurface) {
                lit.binding = [&](int k) { return told(k).binding < 0 ? nullptr : &world_->bindings_[size_t(told(k).binding)]; };
                lit.output = [&](int k, const std::string& name, std::vector<float>& now) { return told(k).output(name, now); };
                lit.displaced = [&](int k, int& point) { return point = told(k).point, told(k).displaced.get(); };
                call.lit = &lit;
            }
            std::vector<char> inMedium;
            if (!world_->media_.empty() && area) {
                for (size_t k = 0; k < used; ++k) inMedium.push_back(mediumOf(mediaTowards(c, pointOf[k], drawn[k].direction)) >= 0);
                call.inMedium = &inMedium;
            }
            const bool sends = light.sentCl >= 0; // many samples: one of them
            std::vector<float> values(light.channels || sends ? used * size_t(light.valueWidth) : 0);
            if (light.channels || sends) call.values = &values;
            evaluateLight(light, q, value, call);
            for (size_t k = 0; k < used && sends; ++k) {
                const PathRay& ray = c.rays[size_t(pointOf[k])];
                const LobeVertex& l0 = lobes[size_t(lobesOf(size_t(pointOf[k]))[0])];
                uint32_t vertex = ray.vertex;
                if (l0.ownsTarget) vertex = childVertex(vertex, kLightPoint + l0.site, l0.occurrence);
                const float u = random(ray).one(vertex, kLightPoint + uint32_t(li), 0);
                chooseSent(light, u, values.data() + k * size_t(light.valueWidth), value[k]);
            }
            for (size_t k = 0; k < used && light.channels; ++k)
                if (k == 0 || pointOf[k] != pointOf[k - 1]) // of several widths the first
                    keepChannels(c, light, pointOf[k], values.data() + long(k) * light.valueWidth);
            // Which lobes the light reaches; then the values of all of them at once.
            std::vector<LitLobe>& reached = room.reached;
            reached.clear();
            for (size_t k = 0; k < used; ++k) {
                const LightValue& v = value[k];
                if (v.lit && !isFinite(v.Cl)) {
                    notFinite(&c.rays[size_t(pointOf[k])], "Cl", light.instance.get());
                    continue;
                }
                if (!v.lit || !(maxComponent(v.Cl) > 0)) continue;
                Vec3 w = area ? drawn[k].direction : unit(-v.L, Vec3(0, 0, 1));
                for (int i : lobesOf(size_t(pointOf[k]))) {
                    const LobeVertex& l = lobes[size_t(i)];
                    if (l.delta || !samples(l, light)) continue;
                    if (!spread.empty() && spread[k] != spreadBehind(c.rays[size_t(l.point)], lobeRows_.spread(l.place))) continue;
                    // Sides 1: from where rays of this lobe pass through the emitter they cannot meet it, and it sends nothing.
                    if (area && !light.mean && drawn[k].shape->oneSided() && l.rays->set.sides != accel::Sides::Both &&
                        (dot(q[k].surface.n, w) >= 0) != (l.rays->set.sides == accel::Sides::Back))
                        continue;
                    lobeRows_.ask(l.place, w);
                    reached.push_back({k, i, w});
                }
            }
            lobeRows_.evaluate();
            for (const auto& [k, i, w] : reached) {
                LobeVertex& l = lobes[size_t(i)];
                const LightValue& v = value[k];
                const ShadePoint& p = c.points[size_t(l.point)];
                const LobeValue f = lobeRows_.value(l.place);
                const float fcos = f.fcos;
                const float distance = area ? drawn[k].distance : light.kind == LightKind::Distant ? 1e38f : length(v.L);
                {
                    if (std::isnan(fcos)) notFinite(c, c.rays[size_t(l.point)], l.site);
                    if (!(fcos > 0)) continue;
                    float kept = l.lobeOfShader ? v.kept(l.rays->type) : 1;
                    Vec3 o = l.bias >= 0 ? p.P + w * l.bias : sourcePoint(size_t(l.point), w);
                    if (l.trace && area && !meets(l, drawn[k], q[k].surface, w, o, geometry::offsetOrigin(q[k].surface, -w)))
                        continue;
                    Color contribution = l.weight * c.rays[l.point].weight * v.Cl;
                    if (l.ownsTarget) contribution = l.weight * v.Cl;
                    contribution *= f.colour / fcos;
                    const bool sums = l.trace && l.trace->sums;
                    if (sums)
                        if (TraceSums* of = sumsOf(l.target)) of->add(TraceSums::UnshadowedAreaLight, contribution * (fcos / (drawn[k].pdf * chance[k])));
                    if (area && !light.mean) {
                        float other = 0; // the density with which the lobe's own ray would have come here
                        if (!set.lightOnly && l.chosen > 0 && (drawn[k].visibility & visibilityBit(l.rays->type)))
                            other = f.pdf * l.chosen;
                        float pdf = drawn[k].pdf * chance[k];
                        contribution *= kept * fcos / pdf * misWeight(pdf, other);
                    } else {
                        contribution *=
                            kept * float(kPi) * fcos / (chance[k] * (area ? drawn[k].pdf : 1)); // Cl is irradiance / pi
                    }
                    // The light's own surface must not block: stop short of it by both error bounds.
                    float stop = distance;
                    if (area) {
                        Vec3 end = geometry::offsetOrigin(q[k].surface, -w);
                        stop = length(end - o);
                        shadows.push_back({o, unit(end - o, w), stop * (1 - 1e-6f), contribution, l.target, p.time, p.ray, sums});
                    } else {
                        shadows.push_back({o, w, stop < 1e30f ? stop * (1 - 1e-5f) : stop, contribution, l.target, p.time, p.ray});
                    }
                    if (l.trace) shadows.back().kind = kindOf({RayType::Transmission, false, l.rays->set, 0});
                    shadows.back().media = mediaTowards(c, l.point, w);
                    shadows.back().share = shareOf(l);
                }
            }
        }
    }

    // A ray that is to bring nothing but the light of emitters, and goes past the balls about all of them, brings none.
    auto meetsEmitter = [&](const LobeVertex& l, const Vec3& from, const Vec3& w, float bias) {
        if (!l.lights) return false;
        const float error = 1e-3f * (1 + length(from)) + std::fabs(bias);
        for (const BoundLight& light : world_->lights_) {
            if (light.kind != LightKind::Area || !light.emitter || light.emitter->empty()) continue;
            const Vec3 to = light.centre - from;
            const float along = std::max(dot(to, w), 0.f), reach = light.radius * 1.001f + error;
            const Vec3 beside = to - w * along;
            if (!(dot(beside, beside) > reach * reach)) return true;
        }
        return false;
    };

    // Rays. Under path one of the vertex's lobes is followed; elsewhere all.
    std::vector<SentLobe>& sent = room.sent;
    sent.clear();
    int rounds = 0;
    for (size_t pi = 0; pi < c.points.size(); ++pi) {
        auto list = lobesOf(pi);
        if (list.empty()) continue;
        const PathRay& from = c.rays[pi];
        const bool mayPass = passes[pi] < 1; // then lobes have the rest of the chance
        float pick = path && (list.size() > 1 || mayPass) ? random(from).one(from.vertex, kChooseLobe, 0) : 0, sum = 0;
        bool taken = false;
        for (int i : list) {
            LobeVertex& l = lobes[i];
            if (!(l.chosen > 0)) continue;
            float scale = 1;
            int count = l.samples;
            if (path && !l.ownsTarget) {
                sum += l.chosen;
                if (taken || (pick >= sum && (mayPass || i != list.back()))) continue;
                taken = true;
                scale = 1 / l.chosen;
                count = 1;
            }
            if (l.lobeOfShader) scale *= indirectScale[pi];
            sent.push_back({pi, i, count, scale, true, Vec3()});
            rounds = std::max(rounds, count);
        }
        if (mayPass) c.passes[pi] = taken ? 0 : passes[pi];
    }
    // One ray of each lobe at a time, the draws and then the values of all together.
    for (int k = 0; k < rounds; ++k) {
        for (const SentLobe& s : sent) {
            if (s.count <= k) continue;
            const LobeVertex& l = lobes[size_t(s.lobe)];
            const PathRay& from = c.rays[s.point];
            lobeRows_.ask(l.place, random(from).pair(from.vertex, l.site, l.occurrence * 4096 + uint32_t(k)));
        }
        lobeRows_.sample();
        for (SentLobe& s : sent) {
            if (s.count <= k) continue;
            const LobeVertex& l = lobes[size_t(s.lobe)];
            s.goes = lobeRows_.drawn(l.place, s.w);
            if (s.goes && !l.delta) lobeRows_.ask(l.place, s.w);
        }
        lobeRows_.evaluate();
        for (const SentLobe& s : sent) {
            if (s.count <= k || !s.goes) continue;
            {
                const size_t pi = s.point;
                const int count = s.count;
                const float scale = s.scale;
                LobeVertex& l = lobes[size_t(s.lobe)];
                const ShadePoint& p = c.points[pi];
                const PathRay& from = c.rays[pi];
                Random rng = random(from);
                uint32_t occurrence = l.occurrence * 4096 + uint32_t(k);
                const Vec3 w = s.w;
                if (l.trace && l.trace->onlyLights && !(l.base > 0) && !meetsEmitter(l, l.elsewhere ? l.from : p.P, w, l.bias)) continue;
                bool delta = l.delta;
                const LobeValue value = delta ? LobeValue{Color(l.albedo), l.albedo, 0} : lobeRows_.value(l.place);
                const float pdf = value.pdf;
                Color f(0);
                if (delta) f = value.colour;
                else if (pdf > 0) f = value.colour / pdf;
                Color through = l.weight * (f * scale / float(count));
                Color environment(0);
                if (l.trace && l.trace->map) {
                    environment = l.tint * mapTowards(*l.trace, w, from.spread);
                    if (TraceSums* of = l.trace->sums ? sumsOf(l.target) : nullptr) of->add(TraceSums::UnshadowedEnvironment, through * environment);
                }
                Color weight = l.ownsTarget ? through : from.weight * through;
                if (!isFinite(weight)) {
                    notFinite(c, from, l.site);
                    continue;
                }
                if (!(maxComponent(weight) > 0) && !(std::min({weight.x, weight.y, weight.z}) < 0) && !l.ownsTarget) continue;
                const uint32_t vertex = childVertex(from.vertex, l.site, occurrence);
                uint16_t asked = from.asked;
                if (path && set.roulette) {
                    float q = 1;
                    auto dice = [&] { return rng.one(vertex, kRoulette, 0); };
                    if (l.ownsTarget) {
                        asked = uint16_t(std::min<uint32_t>(std::max<uint32_t>(from.asked, l.before + uint32_t(k) + 1), 0xffff));
                        q = rouletteWaiting(from.bounces, asked);
                        if (q < 1 && dice() >= q) q = 0;
                    } else if (set.localRoulette) {
                        q = rouletteLocal(from.bounces + 1, l.weight, from.bounces + 1 > 3 ? dice() : 0);
                    } else if (from.bounces + 1 > 3) {
                        float m = std::min(1.f, maxComponent(Color(std::fabs(weight.x), std::fabs(weight.y), std::fabs(weight.z))));
                        q = m <= 0 ? 0 : m >= 1 ? 1 : dice() < m ? m : 0;
                    }
                    if (q <= 0) continue;
                    weight = weight / q;
                }
                const int bounces = from.bounces + 1;
                PathRay& r = sched.spawn(bounces + from.layers, l.target, from).payload;
                r.weight = weight;
                r.vertex = vertex;
                r.asked = asked;
                r.bounces = int16_t(bounces);
                if (l.rays->type == RayType::Diffuse) ++r.diffuseBounces;
                else ++r.specularBounces;
                r.origin = l.elsewhere ? l.from : sourcePoint(pi, w);
                if (l.bias >= 0) r.origin = (l.elsewhere ? l.from : p.P) + w * l.bias;
                else if (l.elsewhere) r.origin += w * geometry::roundingError(l.from);
                r.dir = w;
                r.maxDistance = l.maxDistance;
                r.kind = l.rays;
                r.media = mediaTowards(c, int(pi), w);
                r.parted = false;
                if (l.base > 0) { // somewhere on the footprint
                    const Vec2 at = rng.pair(vertex, kSampleBase, 0);
                    r.origin += (p.surface.dPdu * (p.du * (at.x - .5f)) + p.surface.dPdv * (p.dv * (at.y - .5f))) * l.base;
                }
                RayExtra extra{environment, Color(0), shareOf(l), l.lit};
                if (l.ownsTarget && l.trace && l.trace->sums) extra.part = Color(1.f / float(count));
                r.extra = newExtra(extra);
                bool sampled = l.lights && !l.elsewhere && !delta && set.direct && !set.bsdfOnly && path;
                bool sampledElsewhere = l.lights && !l.elsewhere && !delta && set.direct && !set.bsdfOnly && !path && l.ownsTarget;
                r.lobePdf = sampled || sampledElsewhere ? pdf * l.chosen : l.lights && !l.elsewhere && !delta && !path && set.direct && !set.bsdfOnly ? pdf : -1;
                r.lobeOrigin = p.P;
                r.lobeBinding = l.lights && !l.elsewhere && !delta ? c.bindings[pi] : -1;
                r.width = from.width + from.spread * length(p.P - from.origin);
                r.spread = spreadBehind(from, lobeRows_.spread(l.place));
                r.counts = false;
                r.first = l.ownsTarget;
                counters.depthMax = std::max(counters.depthMax, bounces);
                ++counters.depthSum; // over camera rays: the mean number of bounces
            }
        }
    }
    lobes.clear();
    lobeRows_.clear();
    gatherRoom_ = std::move(room);
}

} // namespace alpenglow::transport
