// Rays of gather() statements.
#include "integrator/gathercalls.h"
#include "base/direction.h"
#include "base/exact.h"
#include "bsdf/sampling.h"
#include "integrator/context.h"
#include "integrator/gatherrows.h"
#include "integrator/intersector.h"
#include "integrator/kernelinputs.h"
#include "integrator/mediastacks.h"
#include "integrator/occlusioncalls.h"
#include "integrator/opacities.h"
#include "integrator/raystore.h"
#include "integrator/stageset.h"
#include "world/raysets.h"
#include <bit>
#include <set>

namespace alpenglow::integrator {

GatherCalls::GatherCalls(const StageSet& s) : Stage(s.context), set_(s), inputs_(s.inputs) {}

namespace {

/// A gather() with a larger half angle collects light from all sides; a smaller one may look along a refracted ray.
constexpr float kHemisphere = 1.4f;

using Of = GatherSite::Of;
using Output = GatherSite::Output;

/// One lane of a request: its arguments and its point.
struct Asking {
    const StageSet& set;
    BatchContext& c;
    const SiteInfo& s;
    int first, lanes, lane;
    const float* in;
    uint32_t occurrence;

    float f(int row) const { return in[size_t(row) * size_t(lanes) + size_t(lane)]; }
    float number(int row, float fallback) const { return row < 0 ? fallback : f(row); }
    Vec3 triple(int row) const { return {f(row), f(row + 1), f(row + 2)}; }
    const ShadePoint& point() const { return c.points[size_t(first + lane)]; }
    const geometry::SurfacePoint* surface() const { return c.light ? point().lit : &point().surface; }
    Vec3 at() const { return c.light ? point().Ps : point().P; }
    uint32_t site() const { return uint32_t(s.site - c.bound->kernel->sites().data()); }
    const SurfaceBinding* binding() const {
        if (c.light) return c.lit ? c.lit->binding(first + lane) : nullptr;
        return c.bindings.empty() ? nullptr : &set.context.world.bindings()[size_t(c.bindings[size_t(first + lane)])];
    }

    Vec3 origin(const Vec3& w) const {
        const Vec3 from = triple(s.rows[0]);
        float bias = number(s.rays->bias, -1);
        if (bias < 0) bias = set.occlusion.ofShape(point().shape).bias;
        const geometry::SurfacePoint* here = surface();
        if (here && length(from - at()) > geometry::roundingError(from) + 4 * here->pError) here = nullptr;
        return bias >= 0 ? from + w * bias
               : here    ? geometry::offsetOrigin(*here, w, length(at() - here->P) + length(from - at()))
                         : from + w * geometry::roundingError(from);
    }

    Random numbers(int k, int count) const { return set.store.random(*point().ray).draw(uint32_t(k), uint32_t(count)); }
    /// For ray k of count.
    Vec2 pair(int k, int count) const { return numbers(k, count).pair(point().ray->vertex, site(), occurrence * 4096); }

    Vec3 direction(int k, int count) const {
        const Vec3 axis = directionOr(triple(s.rows[1]), surface() ? surface()->n : Vec3(0, 0, 1));
        const float angle = f(s.rows[2]);
        if (!(angle > 0)) return axis;
        const bool cosine = s.gather->cosine;
        const double a = std::min(double(angle), cosine ? kPi / 2 : kPi);
        const Vec2 xi = pair(k, count);
        if (!cosine) {
            const float half = float(exact::sin(.5 * a));
            return Basis(axis).toWorld(sampleCone(2 * half * half, xi));
        }
        const float sine = float(exact::sin(a)), r2 = xi.x * sine * sine, r = std::sqrt(r2);
        const Vec2 d = unitCircle(xi.y);
        return Basis(axis).toWorld({r * d.x, r * d.y, std::sqrt(std::max(0.f, 1 - r2))});
    }

    /// Whether the depth limits forbid a ray from here.
    bool tooDeep(RayType type) const {
        const PathRay& from = *point().ray;
        const bool diffuse = type == RayType::Diffuse;
        const SurfaceBinding* b = binding();
        if (from.bounces + 1 > set.context.world.maxDepth()) return true;
        return b && ((b->maxDiffuse >= 0 && from.diffuseBounces + diffuse > b->maxDiffuse) ||
                     (b->maxSpecular >= 0 && from.specularBounces + !diffuse > b->maxSpecular));
    }

    PathRay ray(const Vec3& w, const Vec3& begin, float reach, const RayKind* kind, int k, int count) const {
        const ShadePoint& p = point();
        PathRay r = *p.ray;
        r.trail = 0;
        r.path = 0; // its light belongs to the loop
        r.weight = Color(s.gather->light ? 1.f : 0.f);
        r.vertex = childVertex(p.ray->vertex, site(), occurrence * 4096 + uint32_t(k));
        ++r.bounces;
        ++(kind->type == RayType::Diffuse ? r.diffuseBounces : r.specularBounces);
        r.origin = begin;
        r.dir = w;
        r.maxDistance = reach;
        r.kind = kind;
        r.media = c.light ? nullptr : set.media.towards(c, first + lane, w);
        r.crossedMedium = r.passed = false;
        r.extra = -1;
        r.lobePdf = -1; // no light is sampled for it: emission counts in full
        r.lobeBinding = -1;
        r.footprint = p.ray->footprint.after(length(at() - p.ray->origin));
        r.footprint.spread = std::max(r.footprint.spread, std::min(std::max(f(s.rows[2]), 0.f), .7f) / std::sqrt(float(count)));
        r.counts = false;
        r.first = true;
        return r;
    }
};

void skySamples(const Asking& a, GatherRows& rows, int begin, int end, int count) {
    const GatherSite& g = *a.s.gather;
    for (int k = begin; k < end; ++k) {
        float* row = rows.of(a.lane, k - begin);
        const texture::SkyDirections::Direction d = g.sky->at(a.pair(k, count));
        row[0] = 1;
        writeRayValues(g, row, a.triple(a.s.rows[0]), d.w, 1e38f);
        for (const Output& o : g.outputs) {
            if (o.of == Of::SkyColor) putGathered(row, o, d.light);
            else if (o.of == Of::SkyDirection) putGathered(row, o, d.w);
            else if (o.of == Of::SkySolidAngle) putGathered(row, o, {1 / (d.density * float(count))});
        }
    }
}

/// Oi of a hit whose shaders do not run for light.
Color opacityAt(const Asking& a, const accel::Hit& hit, const Vec3& from, const Vec3& w, const RayKind* kind) {
    const WorldImpl& world = a.set.context.world;
    const int binding = world.bindingOf()[hit.shape];
    const Opacity& o = world.bindings()[size_t(binding)].opacityFor(kind->set.mode);
    Color c = o.constant;
    if (!o.kernel) return c;
    ShadowRay as{};
    as.origin = from;
    as.dir = w;
    as.distance = float(hit.distance);
    as.time = a.point().shutter;
    as.ray = a.point().ray;
    as.kind = kind;
    const OpacityQuery q{binding, hit, &as, &o.kernel};
    a.set.opacities.opacities({&q, 1}, {&c, 1});
    return c;
}

/// Behind a camera ray's hit, light is followed only for some of the rays with a hit, with weights that compensate. Other outputs
/// of gather() do not depend on this choice: all rays are cast, and shaders run for them. `before`: rays that the kernel has
/// requested; `many`: those of this call, as far as known.
bool goesOn(const Asking& a, PathRay& sent, int count, uint32_t before, uint32_t many) {
    if (!a.set.context.rules.roulette) return true;
    const PathRay& from = *a.point().ray;
    const uint32_t all = a.c.light ? uint32_t(count) : before + many;
    sent.asked = uint16_t(std::min<uint32_t>(std::max<uint32_t>(from.asked, all), 0xffff));
    const float q =
        a.c.light ? rouletteOfLight(from.bounces, sent.asked) : rouletteWaiting(from.bounces, from.asked, before, many);
    if (q < 1 && !(a.set.store.random(from).one(sent.vertex, kRoulette, 0) < q)) return false;
    sent.weight = sent.weight / q;
    return true;
}

/// A ray of a gather() with a hit whose shaders may have to run.
struct GatherMet {
    PathRay ray;
    float* row;
    accel::Hit hit;
};

/// Selects the hits to shade among rays begin to end of `turns`. All rays are cast before the selection, which depends on the
/// number of hits. `asked`: rays requested before the kernel's call, and after it including these.
void sendMet(const Asking& a, std::span<GatherMet> met, int begin, int end, int turns, int count, const RayKind* kind,
             uint32_t& asked, std::vector<GatherSent>& out) {
    const GatherSite& g = *a.s.gather;
    if (met.empty()) return;
    const uint64_t all = (uint64_t(met.size()) * uint64_t(turns - begin) + uint64_t(end - begin) - 1) / uint64_t(end - begin);
    const uint32_t before = asked, many = g.asks ? std::max(uint32_t(all), uint32_t(count)) : uint32_t(all);
    asked += uint32_t(met.size());
    for (GatherMet& m : met) {
        PathRay& sent = m.ray;
        const bool quiet = a.point().ray->quiet;
        if (quiet || !goesOn(a, sent, count, before, many)) {
            const Color open = g.opacity ? Color(1) - opacityAt(a, m.hit, sent.origin, sent.dir, kind) : Color(1);
            endGatherRay(g, {Color(0), open}, m.row);
            if (quiet || !g.asks) continue;
            sent.weight = Color(0);
            sent.quiet = true;
            sent.asked = uint16_t(std::clamp(turns, int(sent.asked), 0xffff));
        }
        out.push_back({sent, m.row, a.set.context.world.shapes()[m.hit.shape].get(), &g, sent.quiet, false, {}, {}});
        for (const GatherSite::Sent& s : g.sent) {
            const int elements = s.lengthRow < 0 ? 1 : int(std::clamp(a.f(s.lengthRow), 0.f, float(s.elements)));
            for (int k = 0; k < elements * rsl::ir::components(s.kind); ++k) out.back().values.push_back(a.f(s.row + k));
            out.back().ends.push_back(out.back().values.size());
        }
    }
}

/// Number of rays to cast for `count` iterations: a power of two, or all. If a gather() requests outputs, shaders run at all
/// hits. Behind such a hit each gather() casts only its share of rays, so that nested gathers cost linear time: one ray serves
/// several iterations. Sums over the iterations keep their mean.
int raysFor(const Asking& a, int count) {
    const PathRay& from = *a.point().ray;
    if (!a.set.context.rules.roulette || from.bounces < 1 || from.asked < 2 || !(from.quiet || a.s.gather->asks)) return count;
    const int fair = (count + int(from.asked) - 1) / int(from.asked);
    const int rays = int(std::bit_ceil(uint32_t(fair)));
    return rays <= rsl::kGatherRays && rays < count ? rays : count;
}

/// Casts the rays of one lane.
void castRays(const Asking& a, GatherRows& rows, int begin, int end, int count, uint32_t& asked, std::vector<GatherSent>& out) {
    const GatherSite& g = *a.s.gather;
    const RaySite& r = *a.s.rays;
    const ShadePoint& p = a.point();
    const bool aimed = a.triple(a.s.rows[1]) != Vec3(0); // refract() gives no direction at total reflection
    const bool cast = g.category == GatherSite::Category::Rays && a.set.context.world.canTrace() && aimed;
    RayKind kind{RayType::Specular, true, {}, 0};
    kind.set = a.set.store.raySetOf(a.s, [&](int row) { return a.f(row); }, p.shape, kind.type, kind.label);
    const RayKind* const kept = a.set.store.kindOf(kind);
    const bool deep = a.tooDeep(kind.type);
    const float angle = a.f(a.s.rows[2]);
    if (begin == 0 && cast && angle > kHemisphere && p.shape && p.ray)
        a.set.occlusion.noteTurnedAway(a.c, a.s, a.first + a.lane, directionOr(a.triple(a.s.rows[1]), p.surface.n));
    const float far = std::min(a.number(r.maxDistance, 1e38f), a.number(r.maxHit, 1e38f)), reach = far >= 0 ? far : 1e38f;
    const float base = a.number(r.base, 0);
    const int turns = count;
    count = raysFor(a, turns);
    std::vector<GatherMet> shaded;
    for (int turn = begin; turn < end; ++turn) {
        float* row = rows.of(a.lane, turn - begin);
        if (turn - begin >= count) {
            row[0] = -float(count);
            continue;
        }
        const int k = turn % count;
        const Vec3 w = a.direction(k, count);
        Vec3 from = a.origin(w);
        if (const geometry::SurfacePoint* s = a.surface(); base > 0 && s) {
            const Vec2 u = a.numbers(k, count).pair(childVertex(p.ray->vertex, a.site(), a.occurrence), kSampleBase, 0);
            from += (s->dPdu * (p.du * (u.x - .5f)) + s->dPdv * (p.dv * (u.y - .5f))) * base;
        }
        accel::Hit hit;
        bool met = false;
        if (cast && !deep) {
            ShadowRay as{};
            as.origin = from;
            as.dir = w;
            as.distance = reach;
            as.time = p.shutter;
            as.ray = p.ray;
            as.kind = kept;
            accel::Ray ray;
            ray.org = from;
            ray.dir = w;
            ray.tfar = reach;
            ray.time = p.shutter;
            ray.mask = visibilityBit(kind.type);
            ray.sides = kind.set.sides;
            ray.only = kind.set.only;
            if (p.ray->sample) ray.level = p.ray->sample->level;
            met = firstOpaque(a.set, ray, as, g.threshold >= 0 ? Color(a.triple(g.threshold)) : Color(0), hit);
            ++a.set.context.raysOf(kind.type);
        }
        writeRayValues(g, row, from, w, met ? float(hit.distance) : 1e38f);
        if (!met) continue;
        row[0] = 1;
        writeHitValues(a.set.context.world, g, row, hit, w);
        if (g.shades) shaded.push_back({a.ray(w, from, reach, kept, k, count), row, hit});
    }
    sendMet(a, shaded, begin, end, turns, count, kept, asked, out);
}

} // namespace

GatherRows& GatherCalls::cast(BatchContext& c, const SiteInfo& s, int first, uint64_t mask, int lanes, const float* in,
                              std::span<const uint32_t> occurrence, std::span<uint32_t> asked, std::vector<GatherSent>& sent) {
    GatherRows& g = c.gathers[{s.gather->number, first}];
    g.width = s.gather->width;
    g.counts.resize(size_t(lanes));
    g.begins.resize(size_t(lanes));
    g.rows.assign(size_t(lanes) * size_t(rsl::kGatherRays) * size_t(g.width), 0);
    sent.clear();
    for (int lane = 0; lane < lanes; ++lane) {
        if (!(mask >> lane & 1) || first + lane >= int(c.points.size())) continue;
        const Asking a{set_, c, s, first, lanes, lane, in, occurrence[size_t(lane)]};
        const ShadePoint& p = a.point();
        const float samples = a.f(s.rows[3]);
        const int count = samples >= 1 && p.ray ? set_.occlusion.samplesOf(samples, p.shape, s, c) : 0,
                  begin = int(a.f(s.rows[4]));
        g.counts[size_t(lane)] = count;
        g.begins[size_t(lane)] = begin;
        const int end = std::min(begin + rsl::kGatherRays, count);
        if (s.gather->category == GatherSite::Category::Sky) skySamples(a, g, begin, end, count);
        else castRays(a, g, begin, end, count, asked[size_t(lane)], sent);
    }
    return g;
}

shading::GivenValue GatherSent::value(size_t sent) const {
    const GatherSite::Sent& s = site->sent[sent];
    const size_t begin = sent ? ends[sent - 1] : 0;
    return {s.kind, s.lengthRow >= 0, std::span(values).subspan(begin, ends[sent] - begin)};
}

void GatherCalls::takeSent(shading::Batch& batch, std::span<const AccumulatorId> targets, rsl::PairName::To to) const {
    if (gathered.empty()) return;
    for (size_t i = 0; i < targets.size(); ++i)
        if (const GatherSent* ray = sending(targets[i], to))
            for (size_t k = 0; k < ray->site->sent.size(); ++k)
                if (ray->site->sent[k].to == to) batch.give(ray->site->sent[k].parameter, int(i), ray->value(k));
}

const GatherSent* GatherCalls::sending(AccumulatorId target, rsl::PairName::To to) const {
    const auto asks = gathered.find(target);
    return asks != gathered.end() && asks->second->site->sendsTo(to) ? asks->second : nullptr;
}

bool GatherCalls::lightParameters(const GatherSent& ray, const ShaderInstance& light, shading::ParameterBlock& all) {
    bool any = false;
    for (size_t k = 0; k < ray.site->sent.size(); ++k) {
        const GatherSite::Sent& s = ray.site->sent[k];
        if (s.to != rsl::PairName::To::Light) continue;
        const shading::GivenValue v = ray.value(k);
        const auto own = std::find_if(light.program->parameters().begin(), light.program->parameters().end(),
                                      [&](const rsl::ParameterInfo& p) { return p.name == s.parameter; });
        const auto have = light.parameters.numbers.find(s.parameter);
        if (own == light.program->parameters().end() || have == light.parameters.numbers.end()) continue;
        const bool fits = ShaderValue::kindOf(own->type.base) == v.kind && (own->type.array != 0 || own->open) == v.array;
        if (!fits) continue;
        if (!any) all = light.parameters;
        any = true;
        std::vector<float>& to = all.numbers[s.parameter];
        std::copy_n(v.numbers.begin(), std::min(v.numbers.size(), to.size()), to.begin());
    }
    return any;
}

/// A parameter that is no output is what was sent to it.
static void tellSent(const GatherSent& ray, const GatherSite::Output& asked, const ShaderInstance* shader, ShaderValue& t) {
    using To = rsl::PairName::To;
    const To to = asked.of == Of::Surface ? To::Surface : asked.of == Of::Displacement ? To::Displacement : To::Volume;
    const std::string& name = rsl::internedString(asked.id);
    for (size_t k = 0; k < ray.site->sent.size(); ++k) {
        const GatherSite::Sent& s = ray.site->sent[k];
        if (s.to != to || s.parameter != name || !shader) continue;
        const shading::GivenValue v = ray.value(k);
        const bool own = std::any_of(shader->program->parameters().begin(), shader->program->parameters().end(),
                                     [&](const rsl::ParameterInfo& p) {
                                         return p.name == name && !p.output && ShaderValue::kindOf(p.type.base) == v.kind &&
                                                (p.type.array != 0 || p.open) == v.array;
                                     });
        if (!own) continue;
        if (v.kind == rsl::ir::Kind::String) {
            t.texts.resize(std::max(t.texts.size(), v.numbers.size()));
            for (size_t n = 0; n < v.numbers.size(); ++n) t.texts[n] = rsl::internedString(std::bit_cast<int32_t>(v.numbers[n]));
        } else {
            t.numbers.resize(std::max(t.numbers.size(), v.numbers.size()));
            std::copy(v.numbers.begin(), v.numbers.end(), t.numbers.begin());
        }
    }
}

void GatherCalls::answerGather(const BatchContext& c, int point, GatherSent& sent) {
    const ShadePoint& p = c.points[size_t(point)];
    if (sent.shaded || p.shape != sent.met) return;
    sent.shaded = true;
    const SurfaceBinding& b = world_.bindings()[size_t(c.bindings[size_t(point)])];
    for (const Output& o : sent.site->outputs) {
        if (o.of != Of::Surface && o.of != Of::Displacement && o.of != Of::Volume) continue;
        const InstanceRef& shader = o.of == Of::Surface        ? b.surface
                                    : o.of == Of::Displacement ? b.displacement
                                                               : b.atmosphere.shader;
        const shading::Batch* run = o.of == Of::Surface                       ? c.batch.get()
                                    : o.of == Of::Displacement && c.displaced ? c.displaced->batch.get()
                                                                              : nullptr;
        if (auto t = valueAtHit(inputs_.answers, p, shader, o.id, run, point)) {
            tellSent(sent, o, shader.get(), *t);
            putGathered(sent.row, o, *t);
        }
    }
}

} // namespace alpenglow::integrator
