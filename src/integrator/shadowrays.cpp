// Shadow rays: what lies on the way takes the share that its shader's Oi says. Where Oi is Os or a constant that was known when
// the world was built no shader runs; elsewhere the kernel that gives Oi alone runs for all rays that met it, wave by wave.
#include "base/exact.h"
#include "integrator/engine.h"
#include "lobes/sampling.h"
#include "world/raysets.h"
#include <limits>

namespace alpenglow::transport {

namespace {
accel::Ray shadowRay(const ShadowRay& s) {
    accel::Ray r;
    r.org = s.origin;
    r.dir = s.dir;
    r.tfar = s.distance;
    r.time = s.time;
    r.mask = visibilityBit(s.kind->type);
    r.sides = s.kind->set.sides;
    r.only = s.kind->set.only;
    if (s.ray && s.ray->sample) r.level = s.ray->sample->level;
    return r;
}
/// Whether a ray may meet something in a box: false only where it passes beside it.
bool passes(const geometry::Bounds& b, const ShadowRay& r) {
    const float error = geometry::roundingError(b.lo) + geometry::roundingError(b.hi) + geometry::roundingError(r.origin);
    double from = 0, to = r.distance;
    for (int k = 0; k < 3; ++k) {
        const double lo = double(b.lo[k]) - error - r.origin[k], hi = double(b.hi[k]) + error - r.origin[k], d = r.dir[k];
        if (std::fabs(d) < 1e-12) {
            if (lo > 0 || hi < 0) return false;
            continue;
        }
        from = std::max(from, std::min(lo / d, hi / d) * (1 - 1e-6));
        to = std::min(to, std::max(lo / d, hi / d) * (1 + 1e-6));
    }
    return from <= to;
}
Color between0And1(const Color& c) { return {std::clamp(c.x, 0.f, 1.f), std::clamp(c.y, 0.f, 1.f), std::clamp(c.z, 0.f, 1.f)}; }
} // namespace

Way wayBetween(const Vec3& a, const Vec3& b, const Vec3& at, const geometry::SurfacePoint* s) {
    const Vec3 all = b - a;
    const float distance = length(all);
    if (!(distance > 0)) return {a, Vec3(0, 0, 1), 0};
    const Vec3 d = all / distance;
    const auto end = [&](const Vec3& x, const Vec3& away) {
        const float near = geometry::roundingError(x);
        if (s && length(x - at) <= near + 4 * s->pError)
            return geometry::offsetOrigin(*s, away, length(at - s->P) + length(x - at));
        return x + away * near;
    };
    const Vec3 from = end(a, d), to = end(b, -d), left = to - from;
    const float l = length(left);
    return dot(left, d) > 0 ? Way{from, left / l, l} : Way{from, d, 0};
}

void Engine::opacities(std::span<const OpacityQuery> met, std::span<Color> out) {
    BatchContext c;
    c.engine = this;
    const SurfaceBinding& b = world_->bindings_[size_t(met[0].binding)];
    c.bound = met[0].kernel;
    c.binding = &b;
    c.forShadow = true;
    c.rays.reserve(met.size());
    c.points.reserve(met.size());
    for (const OpacityQuery& m : met) {
        PathRay& r = c.rays.emplace_back();
        if (m.ray->ray) {
            r = *m.ray->ray;
            r.footprint = r.footprint.after(length(m.ray->origin - r.origin));
        }
        r.kind = m.ray->kind;
        r.origin = m.ray->origin;
        r.dir = m.ray->dir;
        r.counts = false;
        c.bindings.push_back(m.binding);
        ShadePoint& p = c.points.emplace_back();
        p.ray = &r;
        p.shape = world_->shapes_[m.hit.shape].get();
        p.surface = world_->accel_->point(m.hit);
        p.P = p.surface.displaced && !b.moveS ? p.surface.displacedP : p.surface.P; // a shader that moves P does it here, too
        p.N = p.surface.N;
        p.I = p.P - r.origin;
        p.E = r.origin;
        p.shutter = m.ray->time;
        world_->tellTime(p);
        shading::setFootprint(p, r.footprint, r.dir, length(p.I), 1);
    }
    std::vector<shading::InstanceView> views(met.size(), b.surface->view());
    c.batch = std::make_shared<shading::Batch>(c.bound->kernel, *c.bound->plan, c.points, views, *world_);
    if (b.displacementTells && (c.displaced = displace(c))) c.batch->tell(*c.displaced->batch);
    bindCall(c.batch->call(), c);
    c.bound->kernel->run(&c.batch->call());
    c.ran();
    ++counters.batches;
    counters.points += met.size();
    for (size_t i = 0; i < met.size(); ++i) {
        Color o = c.batch->color(c.batch->plan().Oi, int(i));
        if (!isFinite(o)) {
            notFinite(met[i].ray->ray, "Oi", b.surface.get());
            o = Color(1);
        }
        out[i] = between0And1(o);
    }
}

bool Engine::meetsOpaqueAlone(const ShadowRay& r) const {
    if (r.hemisphere >= 0 && hemispheres_[size_t(r.hemisphere)].fade.fades()) return false; // it matters how far away they are
    return world_->media_.empty() && !r.kind->set.only && r.kind->set.mode == shading::HitMode::Default;
}

/// 0 for rays that a surface blocks which needs no shader for that, 1 for the others.
void Engine::blockedByOpaque(std::span<const ShadowRay> rays, std::span<Color> out) {
    shadowRays_.clear();
    std::vector<size_t> of;
    for (size_t i = 0; i < rays.size(); ++i) {
        out[i] = Color(1);
        if (!meetsOpaqueAlone(rays[i])) continue;
        shadowRays_.push_back(shadowRay(rays[i]));
        shadowRays_.back().only = world_->byOpacity_.opaque.data();
        of.push_back(i);
    }
    blocked_.resize(of.size());
    block(shadowRays_, blocked_);
    for (size_t k = 0; k < of.size(); ++k)
        if (blocked_[k]) out[of[k]] = Color(0);
}

/// The same where all surfaces are such ones.
void Engine::blockedByAll(std::span<const ShadowRay> rays, std::span<Color> out) {
    if (blockedInRows(rays, out)) return;
    constexpr size_t kAtOnce = 512; // they stay in a core's cache
    blocked_.resize(std::min(rays.size(), kAtOnce));
    for (size_t first = 0; first < rays.size(); first += kAtOnce) {
        const size_t n = std::min(kAtOnce, rays.size() - first);
        shadowRays_.clear();
        for (const ShadowRay& r : rays.subspan(first, n)) shadowRays_.push_back(shadowRay(r));
        block(shadowRays_, std::span(blocked_).first(n));
        for (size_t i = 0; i < n; ++i) out[first + i] = blocked_[i] ? Color(0) : Color(1);
    }
}

/// One batch a surface. The order inside a batch does not matter: a kernel's lanes know nothing of each other. `take` is told the
/// number and the opacity of what was met.
void Engine::takeOpacities(std::span<const OpacityQuery> met, const std::function<void(size_t, const Color&)>& take) {
    std::vector<size_t> order(met.size());
    for (size_t i = 0; i < order.size(); ++i) order[i] = i;
    const auto what = [&](size_t i) { return std::pair(met[i].binding, met[i].ray->kind->set.mode); };
    std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return what(a) < what(b); });
    std::vector<OpacityQuery> group;
    std::vector<Color> opacity;
    for (size_t first = 0, end; first < order.size(); first = end) {
        group.clear();
        for (end = first; end < order.size() && what(order[end]) == what(order[first]); ++end) group.push_back(met[order[end]]);
        opacity.resize(group.size());
        opacities(group, opacity);
        for (size_t k = first; k < end; ++k) take(order[k], opacity[k - first]);
    }
}

void Engine::transmittances(std::span<const ShadowRay> rays, std::span<Color> out) {
    counters.shadow += rays.size();
    passSurfaces(rays, out);
    for (FlightEvent* e : events_) e->dim(*this, rays, out);
}

void Engine::passSurfaces(std::span<const ShadowRay> rays, std::span<Color> out) {
    const bool media = !world_->media_.empty();
    const auto fades = [&](const ShadowRay& r) { return r.hemisphere >= 0 && hemispheres_[size_t(r.hemisphere)].fade.fades(); };
    const bool fading = std::any_of(rays.begin(), rays.end(), fades);
    std::vector<Color> taken(fading ? rays.size() : 0, Color(0)); // what surfaces far away block in part
    const bool counts = lightPaths_ && lightPaths_->countsStraight();
    std::vector<uint16_t> straights(counts ? rays.size() : 0, 0); // what runs on the way may send rays, too
    straights_.clear();
    const auto takes = [&](size_t i, const Color& opacity, double distance) {
        if (counts) ++straights[i];
        if (fading && fades(rays[i])) taken[i] += out[i] * opacity * hemispheres_[size_t(rays[i].hemisphere)].fade.at(distance);
        out[i] *= Color(1) - opacity;
    };
    if (world_->allOpaque_ && !media && !fading) return blockedByAll(rays, out);
    struct Going {
        accel::Ray ray;
        size_t index;
        int layers;
        const shading::Media* media;
        Vec3 begin;
    };
    const auto medium = [](const Going& g) { return g.media ? g.media->top() : -1; };
    std::vector<MediumPart> parts;
    std::vector<Going> now, next;
    std::vector<OpacityQuery> met;
    blockedByOpaque(rays, out);
    for (size_t i = 0; i < rays.size(); ++i) {
        if (!meetsOpaqueAlone(rays[i])) {
            now.push_back({shadowRay(rays[i]), i, 0, rays[i].media, rays[i].origin});
        } else if (out[i] != Color(0) && passes(world_->byOpacity_.clearBounds, rays[i])) {
            now.push_back({shadowRay(rays[i]), i, 0, rays[i].media, rays[i].origin});
            now.back().ray.only = world_->byOpacity_.clear.data();
        }
    }
    while (!now.empty()) {
        next.clear(), met.clear();
        for (Going& g : now) {
            Color& t = out[g.index];
            for (;; ++g.layers) {
                accel::Hit h;
                if (!meet(g.ray, h)) {
                    if (const float end = rays[g.index].distance; medium(g) >= 0 && end < 1e30f)
                        parts.push_back({medium(g), g.index, g.begin, rays[g.index].origin + g.ray.dir * end});
                    break;
                }
                if (g.layers >= limits::kShadowLayers) {
                    t = Color(0);
                    ++counters.depthCap;
                    break;
                }
                int binding = world_->bindingOf_[h.shape];
                const SurfaceBinding& b = world_->bindings_[size_t(binding)];
                world_->goOn(g.ray, h);
                if (media) {
                    const geometry::SurfacePoint at = world_->accel_->point(h);
                    const Vec3 end = at.displaced ? at.displacedP : at.P;
                    if (medium(g) >= 0) parts.push_back({medium(g), g.index, g.begin, end});
                    const bool overruled = b.overruled(g.media);
                    g.media = mediaBeyond(b, g.media, at.n, g.ray.dir, g.ray.dir);
                    g.begin = end;
                    if (overruled) continue;
                }
                const Opacity& opacity = b.opacityFor(rays[g.index].kind->set.mode);
                if (opacity.kernel) {
                    ++g.layers;
                    met.push_back({binding, h, &rays[g.index], &opacity.kernel});
                    next.push_back(g);
                    break;
                }
                takes(g.index, opacity.constant, h.distance);
                if (!(maxComponent(t) > 0)) break;
            }
        }
        if (next.empty()) break;
        takeOpacities(met, [&](size_t k, const Color& opacity) { takes(next[k].index, opacity, met[k].hit.distance); });
        std::erase_if(next, [&](const Going& g) { return !(maxComponent(out[g.index]) > 0); });
        now.swap(next);
        if (stop && *stop) break; // the result is void
    }
    for (size_t i = 0; i < taken.size(); ++i)
        if (fades(rays[i])) out[i] = Color(1) - taken[i];
    dim(parts, rays, out);
    straights_ = std::move(straights);
}

Color Engine::transmittance(const ShadowRay& s) {
    Color t;
    transmittances({&s, 1}, {&t, 1});
    return t;
}

void Engine::transmissionRays(const SiteInfo& s, const ShadePoint& p, const Vec3& at, const geometry::SurfacePoint* surface,
                              const std::function<float(int)>& f, const Color& weight, TargetId target, uint32_t site,
                              uint32_t occurrence, std::vector<ShadowRay>& out) {
    const RaySite& r = *s.rays;
    auto point = [&](size_t arg) { return Vec3(f(s.rows[arg]), f(s.rows[arg] + 1), f(s.rows[arg] + 2)); };
    auto number = [&](int row, float fallback) { return row < 0 ? fallback : f(row); };
    const Vec3 a = point(0), b = point(1);
    ShadowRay ray{};
    ray.target = target;
    ray.time = p.shutter;
    ray.ray = p.ray;
    RayKind kind = kShadowKind;
    kind.set = raySetOf(s, f, p.shape, kind.type, kind.label);
    // Surfaces are seen from the shaded point, at whichever end of the way it is.
    if (!r.saysSides && length(b - at) < length(a - at)) kind.set.sides = accel::Sides::Back;
    ray.kind = kindOf(kind);
    const float bias = number(r.bias, -1), far = std::min(number(r.maxDistance, 1e38f), number(r.maxHit, 1e38f)),
                cone = number(r.cone, 0);
    const int count =
        cone > 0 && p.ray ? int(std::clamp(number(r.samples, 1), 1.f, 4096.f)) : 1; // rays all alike need not be sent twice
    ray.contribution = weight / float(count);
    for (int k = 0; k < count; ++k) {
        Vec3 end = b;
        if (cone > 0 && p.ray && length(b - a) > 0) { // evenly in a cone about the way; as far as b
            const float half = float(exact::sin(0.5 * std::min(cone, float(kPi)))), cap = 2 * half * half;
            end =
                a + Basis((b - a) / length(b - a))
                            .toWorld(sampleCone(
                                cap,
                                random(*p.ray).draw(uint32_t(k), uint32_t(count)).pair(p.ray->vertex, site, occurrence * 4096))) *
                        length(b - a);
        }
        const Way way = wayBetween(a, end, at, surface);
        ray.origin = bias >= 0 ? a + way.dir * bias : way.origin;
        ray.dir = way.dir;
        ray.distance = bias >= 0 ? std::max(0.f, way.distance - bias) : way.distance;
        if (far >= 0) ray.distance = std::min(ray.distance, far);
        out.push_back(ray);
    }
}

void Engine::flushShadows(Sched& s) {
    for (const Deposit& d : settled_) deposit(s, d);
    settled_.clear();
    followRecords(s);
    if (shadows.empty()) return;
    transmitted_.resize(shadows.size());
    transmittances(shadows, transmitted_);
    for (size_t i = 0; i < shadows.size(); ++i) {
        const ShadowRay& r = shadows[i];
        const auto arrives = [&](const Color& contribution, TargetId target, int32_t share, bool areaLight, uint16_t path) {
            const Color light = contribution * transmitted_[i];
            for (int k = path && !straights_.empty() ? straights_[i] : 0; k > 0; --k) path = pathEvent(path, straight_);
            deposit(s, {target, light, LightEvent::Sampled, r.ray, share, nullptr, pathEvent(path, r.light)});
            if (TraceSums* sums = areaLight ? sumsOf(target) : nullptr) sums->add(TraceSums::AreaLight, light);
        };
        if (r.hemisphere >= 0) { // only these, and nothing else goes their way
            if (transmitted_[i] == Color(0) && isFinite(r.contribution)) continue;
            deposit(s, {r.target, openLight(r, transmitted_[i], sumsOf(r.target)), LightEvent::Sampled, r.ray, r.share, nullptr,
                        pathEvent(r.path, r.light)});
            continue;
        }
        arrives(r.contribution, r.target, r.share, r.areaLight, r.path);
        for (int32_t k = r.more; k >= 0; k = moreLight_[size_t(k)].more) {
            const MoreLight& m = moreLight_[size_t(k)];
            arrives(m.contribution, m.target, m.share, m.areaLight, m.path);
        }
    }
    shadows.clear();
    moreLight_.clear();
    hemispheres_.clear();
}

} // namespace alpenglow::transport
