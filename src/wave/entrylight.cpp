// Where a walk below a surface comes out, the shader there may say what light enters: by "irradiance" of its own subsurface().
#include "wave/subsurface.h"
#include <algorithm>

namespace alpenglow::transport {

namespace {

bool saysIrradiance(const SiteInfo& s) { return s.kind == SiteKind::Subsurface && s.subsurface->irradiance >= 0; }

} // namespace

void Walks::askSurfaces(Sched& sched) {
    if (e_.photonTrace()) return;
    const WorldImpl& world = e_.world();
    const auto number = [&](const Exit& x) { return world.bindingOf_[x.shape]; };
    const auto silent = [&](const Exit& x) {
        const BoundKernel& k = world.bindings_[size_t(number(x))].surfaceS;
        return k.kernel->facts().suspends || std::none_of(k.sites.begin(), k.sites.end(), saysIrradiance);
    };
    const auto middle = std::stable_partition(exits_.begin(), exits_.end(), silent);
    std::stable_sort(middle, exits_.end(), [&](const Exit& a, const Exit& b) { return number(a) < number(b); });
    const std::span<Exit> asked(middle, exits_.end());
    std::vector<Exit> left;
    for (size_t first = 0, end; first < asked.size(); first = end) {
        for (end = first; end < asked.size() && number(asked[end]) == number(asked[first]);) ++end;
        const std::span<Exit> same = asked.subspan(first, end - first);
        const size_t kept = askAt(same, sched);
        left.insert(left.end(), same.begin(), same.begin() + long(kept));
    }
    exits_.erase(middle, exits_.end());
    exits_.insert(exits_.end(), left.begin(), left.end());
}

size_t Walks::askAt(std::span<Exit> exits, Sched& sched) {
    const WorldImpl& world = e_.world();
    const SurfaceBinding& b = world.bindings_[size_t(world.bindingOf_[exits[0].shape])];
    auto c = e_.takeContext();
    c->engine = &e_;
    c->bound = b.usesObjectSpace && b.surfaceV ? &b.surfaceV : &b.surfaceS;
    c->binding = &b;
    c->again = true;
    settleAt(*c, exits);
    for (ShadePoint& p : c->points) {
        p.P = p.surface.P; // as surface and displacement shaders begin
        shading::setFootprint(p, p.ray->footprint, p.ray->dir, 0, 1);
    }
    if (b.displacement) e_.takeDisplacement(*c);
    for (ShadePoint& p : c->points) p.I = p.ray->dir;
    e_.fillBatch(*c);
    if (c->displaced) c->batch->tell(*c->displaced->batch);
    c->bound->kernel->run(&c->batch->call());
    c->ran();
    std::vector<char> said(exits.size());
    for (const EmitRecord& e : c->emits) {
        const SiteInfo& s = c->bound->sites[size_t(e.site)];
        if (!saysIrradiance(s)) continue;
        const float* row = c->arena.data() + e.offset + size_t(3 + s.subsurface->irradiance) * size_t(e.lanes);
        for (int lane = 0; lane < e.lanes; ++lane) {
            const size_t point = size_t(e.first + lane);
            if (!(e.mask >> lane & 1) || point >= exits.size() || std::exchange(said[point], 1)) continue;
            const PathRay& ray = c->rays[point];
            const Color light(row[lane], row[e.lanes + lane], row[2 * e.lanes + lane]);
            if (isFinite(light))
                e_.deposit(sched, {c->targets[point], ray.weight * light, LightEvent::Surface, &ray, e_.extraOf(ray).share,
                                   b.surface.get()});
        }
    }
    e_.giveBack(std::move(c));
    size_t kept = 0;
    for (size_t i = 0; i < exits.size(); ++i)
        if (!said[i]) exits[kept++] = exits[i];
    return kept;
}

} // namespace alpenglow::transport
