// Atmospheres and media: runs volume shaders between a ray's origin and its hit. They are affine in the incoming light (Ci' = a +
// slope Ci), which the compiler proves where it can; the slope scales light that is added later: requests and emission.
#include "integrator/atmosphere.h"
#include "integrator/context.h"
#include "integrator/gathercalls.h"
#include "integrator/kernelinputs.h"
#include "integrator/stageset.h"
#include "world/outputs.h"
#include <algorithm>

namespace alpenglow::integrator {

Atmosphere::Atmosphere(const StageSet& s) : Stage(s.context), inputs_(s.inputs), gathers_(s.gathers) {}

void Atmosphere::atmosphereEffects(const Medium& medium, const SurfaceBinding& binding, std::vector<ShadePoint>& points,
                                   std::span<AtmosphereEffect> out, bool wantSlope, BatchContext* surface,
                                   std::span<const int> of) {
    const auto& kernel = medium.kernel.kernel;
    int slopeAt = medium.kernel.plan->output(rsl::OutputName::slope("Ci"));
    bool first = true;
    auto run = [&](auto&& take) {
        BatchContext c;
        c.bound = &medium.kernel;
        c.volume = &medium;
        c.binding = &binding;
        c.surface = surface;
        c.again = !first;
        c.dark = running_ > 0;
        c.surfacePoint.assign(of.begin(), of.end());
        c.points.swap(points); // lent
        std::vector<shading::InstanceView> views(c.points.size(), medium.shader->view());
        c.batch = std::make_shared<shading::Batch>(kernel, *medium.kernel.plan, c.points, views, world_);
        if (surface && !gathers_.gathered.empty()) {
            std::vector<AccumulatorId> targets;
            for (int k : of) targets.push_back(surface->targets[size_t(k)]);
            gathers_.takeSent(*c.batch, targets, rsl::PairName::To::Volume);
        }
        inputs_.bind(c.batch->call(), c);
        ++running_;
        kernel->run(&c.batch->call());
        --running_;
        c.ran();
        int ci = c.batch->plan().Ci, oi = c.batch->plan().Oi;
        for (size_t i = 0; i < c.points.size(); ++i)
            take(i, ci >= 0 ? c.batch->color(ci, int(i)) : c.points[i].Ci, oi >= 0 ? c.batch->color(oi, int(i)) : c.points[i].Oi,
                 slopeAt >= 0 ? c.batch->color(slopeAt, int(i)) : Color(0));
        if (surface && first) keepOutputs(*c.batch, *surface, of);
        first = false;
        points.swap(c.points);
    };
    run([&](size_t i, const Color& ci, const Color& oi, const Color& slope) { out[i] = {ci, oi, slope, true}; });
    if (slopeAt >= 0 || !wantSlope) return;
    // Not affine, or not proved: use the slope between no light and light of radiance 1. World::build has reported this.
    for (ShadePoint& p : points) p.Ci = Color(0);
    run([&](size_t i, const Color& ci, const Color&, const Color&) { out[i].slope = -ci; });
    for (ShadePoint& p : points) p.Ci = Color(1);
    run([&](size_t i, const Color& ci, const Color&, const Color&) { out[i].slope += ci; });
}

/// Adds outputs of the volume that displays request and that the surface lacks, or may not write.
void Atmosphere::keepOutputs(const shading::Batch& volume, BatchContext& surface, std::span<const int> of) {
    const auto& wanted = world_.wanted();
    size_t all = 0, at = 0;
    for (int w : world_.widthsOfOutputs()) all += size_t(w);
    for (size_t k = 0; k < wanted.size(); at += size_t(world_.widthsOfOutputs()[k++])) {
        if (!outputsNamed(*surface.batch, wanted[k]).empty() &&
            !(surface.binding && givesPerhaps(*surface.binding->surface, wanted[k])))
            continue;
        size_t to = at;
        const size_t end = at + size_t(world_.widthsOfOutputs()[k]);
        for (int o : outputsNamed(volume, wanted[k])) {
            if (surface.lightChannels.empty()) surface.lightChannels.assign(surface.points.size() * all, 0);
            for (int r = 0; r < rsl::ir::components(volume.kernel().outputs()[size_t(o)].kind) && to < end; ++r, ++to)
                for (size_t i = 0; i < of.size(); ++i)
                    if (givenAt(volume, wanted[k], int(i)))
                        surface.lightChannels[size_t(of[i]) * all + to] = volume.value(o, r, int(i));
        }
    }
}

void Atmosphere::atmosphereOfBatch(BatchContext& c, int first, int count, bool wantSlope) {
    int n = int(c.points.size()), end = std::min(first + count, n), ci = c.batch->plan().Ci, oi = c.batch->plan().Oi;
    c.atmosphereEffects.resize(size_t(n));
    const auto mediumOf = [&](int k) { return c.rays[size_t(k)].medium(); };
    std::vector<ShadePoint> points;
    std::vector<int> of;
    std::vector<AtmosphereEffect> out;
    std::vector<char> done(size_t(std::max(0, end - first)));
    for (int i = first; i < end; ++i) {
        const SurfaceBinding& b = world_.bindings()[size_t(c.bindings[size_t(i)])];
        const Medium* medium = mediumOf(i) >= 0 ? &world_.media()[size_t(mediumOf(i))] : &b.atmosphere;
        if (!medium->shader || medium->homogeneous || done[size_t(i - first)]) continue; // a flight has handled homogeneous media
        points.clear();
        of.clear();
        for (int k = i; k < end; ++k) {
            if (c.bindings[size_t(k)] != c.bindings[size_t(i)] || mediumOf(k) != mediumOf(i)) continue;
            done[size_t(k - first)] = 1;
            ShadePoint& p = points.emplace_back(c.points[size_t(k)]);
            p.ray = &c.rays[size_t(k)];
            if (p.ray->crossedMedium) p.I = p.P - p.ray->volumeBegin();
            p.Ci = ci >= 0 ? c.batch->color(ci, k) : Color(0);
            p.Oi = oi >= 0 ? c.batch->color(oi, k) : Color(1);
            of.push_back(k);
        }
        out.resize(points.size());
        atmosphereEffects(*medium, b, points, out, wantSlope, &c, of);
        for (size_t k = 0; k < of.size(); ++k) c.atmosphereEffects[size_t(of[k])] = out[k];
    }
}

void Atmosphere::scaleRequests(BatchContext& c) {
    for (const EmitRecord& e : c.emits)
        for (int lane = 0; lane < e.lanes; ++lane) {
            const size_t point = size_t(e.first + lane);
            if (!(e.mask >> lane & 1) || point >= c.atmosphereEffects.size() || !c.atmosphereEffects[point].on) continue;
            for (int k = 0; k < 3; ++k) c.arena[e.offset + size_t(k * e.lanes + lane)] *= c.atmosphereEffects[point].slope[k];
        }
}

void Atmosphere::atmosphereOfPhotons(BatchContext& c) {
    const WorldImpl& world = world_;
    c.atmosphereEffects.clear();
    // Origin and end of each segment as the volume shader sees them, by medium.
    struct ShadowSegment {
        const Medium* medium;
        int binding;
        size_t point;
        Vec3 end;
    };
    std::vector<ShadowSegment> ways;
    for (size_t i = 0; i < c.rays.size(); ++i) {
        const PathRay& r = c.rays[i];
        const int in = r.medium();
        const int binding = in >= 0 ? world.media()[size_t(in)].binding : r.lobeBinding;
        if (binding < 0) continue;
        const Medium& m = in >= 0 ? world.media()[size_t(in)] : world.bindings()[size_t(binding)].atmosphere;
        if (!m.shader || m.homogeneous) continue; // segment events handle homogeneous media
        ways.push_back({&m, binding, i, in >= 0 ? r.origin : r.lobeOrigin});
    }
    if (ways.empty()) return;
    c.atmosphereEffects.resize(c.rays.size());
    std::stable_sort(ways.begin(), ways.end(),
                     [](const ShadowSegment& a, const ShadowSegment& b) { return a.binding < b.binding; });
    std::vector<ShadePoint> points;
    std::vector<AtmosphereEffect> out;
    for (size_t first = 0, end; first < ways.size(); first = end) {
        points.clear();
        for (end = first; end < ways.size() && ways[end].medium == ways[first].medium; ++end) {
            const ShadePoint& here = c.points[ways[end].point];
            ShadePoint& p = points.emplace_back();
            p.shape = ways[end].medium->shape;
            p.P = p.surface.P = ways[end].end;
            p.E = here.surface.displaced ? here.surface.displacedP : here.surface.P;
            p.I = p.P - p.E;
            p.N = p.surface.n = p.surface.N = p.surface.Ng = length(p.I) > 0 ? -normalize(p.I) : Vec3(0, 0, 1);
            p.Ci = p.Oi = Color(1);
            p.ray = &c.rays[ways[end].point];
            p.shutter = here.shutter;
            p.time = here.time;
        }
        out.assign(points.size(), {});
        atmosphereEffects(*ways[first].medium, world.bindings()[size_t(ways[first].binding)], points, out, true);
        for (size_t k = first; k < end; ++k) {
            Color left = out[k - first].slope;
            for (int i = 0; i < 3; ++i) left[i] = std::isfinite(left[i]) ? std::max(left[i], 0.f) : 0;
            c.atmosphereEffects[ways[k].point] = {Color(0), Color(1), left, true};
        }
    }
}

void Atmosphere::atmosphereOfEmitters(const BoundLight& light, std::span<const ShadePoint> queries, std::span<LightValue> values,
                                      const std::vector<char>* inMedium) {
    if (!light.inAtmosphere) return;
    std::vector<ShadePoint> one(1);
    for (size_t i = 0; i < queries.size(); ++i) {
        auto found = world_.emittersInAtmosphere().find(queries[i].shape);
        if (inMedium && (*inMedium)[i]) continue;
        if (found == world_.emittersInAtmosphere().end() || values[i].Cl == Color(0)) continue;
        one[0] = queries[i];
        one[0].I = queries[i].P - queries[i].Ps;
        one[0].E = queries[i].Ps;
        one[0].Ci = values[i].Cl;
        one[0].Oi = Color(1);
        AtmosphereEffect h;
        const SurfaceBinding& b = world_.bindings()[size_t(found->second)];
        atmosphereEffects(b.atmosphere, b, one, {&h, 1}, true);
        values[i].Cl *= h.slope;
    }
}

} // namespace alpenglow::integrator
