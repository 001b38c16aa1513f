// Lights: their kernels run in batches for the points they light; illuminance loops; shadow rays.
#include "transport/engine.h"
#include "transport/sampling.h"

namespace alpenglow::transport {

void Engine::evaluateLight(const BoundLight& light, std::vector<ShadePoint>& queries, std::span<LightValue> out) {
    if (queries.empty()) return;
    auto c = std::make_shared<BatchContext>();
    c->engine = this;
    c->bound = &light.kernel;
    c->points.swap(queries); // lent; given back below
    std::vector<shading::InstanceView> views(c->points.size(), {&light.instance->parameters, &light.instance->toCurrent});
    c->batch = std::make_shared<shading::Batch>(light.kernel.kernel, *light.kernel.plan, c->points, views, *world_);
    bindCall(c->batch->call(), *c);
    const auto& k = *light.kernel.kernel;
    if (k.facts().suspends) {
        // A light that decides on traced light: its few requests are answered in place, strip by strip.
        for (int first = 0; first < c->batch->size(); first += k.lanes()) {
            void* h = k.start(&c->batch->call(), first);
            while (h && !k.finished(h)) {
                const SiteInfo& s = light.kernel.sites[c->requestSite];
                for (int lane = 0; lane < c->requestLanes; ++lane) {
                    if (!(c->requestMask >> lane & 1)) continue;
                    Color t{0};
                    if (s.kind == SiteKind::Transmission) {
                        auto at = [&](int row) { return c->requestIn[size_t(row) * c->requestLanes + lane]; };
                        Vec3 a(at(s.rows[0]), at(s.rows[0] + 1), at(s.rows[0] + 2)), b(at(s.rows[1]), at(s.rows[1] + 1), at(s.rows[1] + 2));
                        float d = length(b - a);
                        t = d > 0 ? transmittance(a, (b - a) / d, d, 0) : Color(1);
                    }
                    for (int r = 0; r < s.resultRowCount; ++r) c->requestOut[size_t(r) * c->requestLanes + lane] = r < 3 ? t[r] : 0;
                }
                k.resume(h);
            }
            if (h) k.destroy(h);
        }
    } else {
        k.run(&c->batch->call());
    }
    const auto& b = *c->batch;
    queries.swap(c->points);
    for (size_t i = 0; i < queries.size(); ++i) {
        LightValue& v = out[i];
        if (light.outL >= 0) v.L = b.color(light.outL, int(i));
        v.Cl = b.color(light.outCl, int(i));
        v.lit = light.outLit < 0 || b.value(light.outLit, 0, int(i)) != 0;
        if (light.nonDiffuse >= 0) v.nonDiffuse = b.value(light.nonDiffuse, 0, int(i));
        if (light.nonSpecular >= 0) v.nonSpecular = b.value(light.nonSpecular, 0, int(i));
    }
    // Affine requests of the light itself: shadows that it asks for.
    for (const EmitRecord& e : c->emits) {
        const SiteInfo& s = light.kernel.sites[e.site];
        if (s.kind != SiteKind::Transmission) continue;
        for (int lane = 0; lane < e.lanes; ++lane) {
            if (!(e.mask >> lane & 1) || e.first + lane >= int(queries.size())) continue;
            auto at = [&](int row) { return c->arena[e.offset + size_t(row) * e.lanes + lane]; };
            Vec3 a(at(3 + s.rows[0]), at(4 + s.rows[0]), at(5 + s.rows[0])), d = Vec3(at(3 + s.rows[1]), at(4 + s.rows[1]), at(5 + s.rows[1])) - a;
            float l = length(d);
            out[e.first + lane].Cl += Color(at(0), at(1), at(2)) * (l > 0 ? transmittance(a, d / l, l, 0) : Color(1));
        }
    }
}

Color Engine::transmittance(const Vec3& origin, const Vec3& dir, float distance, float time) {
    ++counters.shadow;
    Color t(1);
    accel::Ray r;
    r.org = origin;
    r.dir = dir;
    r.tfar = distance;
    r.time = time;
    r.mask = accel::kTransmission;
    r.bothSides = true;
    if (world_->allOpaque_) return world_->accel_->occluded(r) ? Color(0) : t;
    for (int layers = 0; layers < 256; ++layers) {
        accel::Hit h;
        if (!world_->accel_->intersect(r, h)) return t;
        const SurfaceBinding& b = world_->bindings_[world_->bindingOf_[h.shape]];
        t *= Color(1) - b.opacity;
        if (!(maxComponent(t) > 0)) return Color(0);
        r.excludeShape = h.shape;
        r.excludePrim = h.prim;
        r.tnear = h.t;
    }
    return Color(0);
}

int32_t Engine::lightBegin(BatchContext& c, int site, int first, uint64_t mask, int lanes, const float* rows) {
    c.loopLights.clear();
    c.loopRows.assign(rows, rows + size_t(7) * lanes);
    const rsl::ir::Site& s = *c.bound->sites[site].site;
    std::string category = s.strings.empty() ? "" : s.strings[0];
    auto inCategory = [&](const BoundLight& l) {
        if (category.empty()) return true;
        auto i = l.instance->parameters.strings.find("__category");
        std::string have = i == l.instance->parameters.strings.end() ? "" : i->second;
        bool exclude = category[0] == '-';
        std::string want = exclude ? category.substr(1) : category;
        bool in = ("," + have + ",").find("," + want + ",") != std::string::npos;
        return in != exclude;
    };
    if (c.binding)
        for (int i : c.binding->lights) {
            const BoundLight& l = world_->lights_[i];
            if (l.kind == LightKind::Ambient || l.kind == LightKind::Environment || !inCategory(l)) continue;
            for (int k = 0; k < l.samples; ++k) c.loopLights.push_back({i, k});
        }
    return int32_t(c.loopLights.size());
}

uint64_t Engine::lightFetch(BatchContext& c, int index, int first, uint64_t mask, int lanes, float* out) {
    auto [li, k] = c.loopLights[index];
    const BoundLight& light = world_->lights_[li];
    c.currentLight = li;
    c.lightDistance.assign(lanes, 1e38f);
    std::vector<ShadePoint> q;
    std::vector<int> laneOf;
    std::vector<float> factor;
    for (int lane = 0; lane < lanes; ++lane) {
        if (!(mask >> lane & 1) || first + lane >= int(c.points.size())) continue;
        ShadePoint p = c.points[first + lane];
        Vec3 lit(c.loopRows[lane], c.loopRows[lanes + lane], c.loopRows[2 * lanes + lane]);
        p.Ps = lit;
        p.Ns = p.N;
        p.viewI = p.I;
        float f = 1;
        if (light.kind == LightKind::Area) {
            if (!light.emitter) continue;
            const PathRay& r = *p.ray;
            Random rng = random(r);
            uint32_t use = kLightPoint + uint32_t(li), turn = uint32_t(k) + 1; // 0 is gather()'s
            Emitter::Sample s;
            if (!light.emitter->sample(lit, rng.pair(r.vertex, use, turn), light.emitter->chooses() ? rng.one(r.vertex, use, turn) : 0, s)) continue;
            p.shape = s.shape;
            p.surface = s.point;
            p.P = s.point.P;
            p.N = s.point.n;
            f = 1 / (float(kPi) * s.pdf * light.samples); // cosLight A / (pi d^2 n), design decision 4
        } else {
            p.shape = nullptr;
            p.P = Vec3(transformPoint(light.instance->toCurrent, {0, 0, 0}));
        }
        q.push_back(p);
        laneOf.push_back(lane);
        factor.push_back(f);
    }
    std::vector<LightValue> v(q.size());
    evaluateLight(light, q, v);
    uint64_t lit = 0;
    for (size_t i = 0; i < q.size(); ++i) {
        int lane = laneOf[i];
        if (!v[i].lit) continue;
        Vec3 toLight = -v[i].L;
        float angle = c.loopRows[6 * lanes + lane];
        if (angle < float(kPi)) {
            Vec3 axis(c.loopRows[3 * lanes + lane], c.loopRows[4 * lanes + lane], c.loopRows[5 * lanes + lane]);
            float la = length(axis), ll = length(toLight);
            if (la > 0 && ll > 0 && !(dot(axis, toLight) >= la * ll * std::cos(angle))) continue;
        }
        lit |= uint64_t(1) << lane;
        c.lightDistance[lane] = light.kind == LightKind::Distant ? 1e38f : length(toLight);
        float rows[9] = {toLight.x, toLight.y, toLight.z, v[i].Cl.x * factor[i], v[i].Cl.y * factor[i], v[i].Cl.z * factor[i], 1, 1, 1};
        for (int r = 0; r < 9; ++r) out[size_t(r) * lanes + lane] = rows[r];
    }
    return lit;
}

void Engine::flushShadows(Sched& s) {
    for (const ShadowRay& r : shadows) s.add(r.target, r.contribution * transmittance(r.origin, r.dir, r.distance, r.time));
    shadows.clear();
}

} // namespace alpenglow::transport
