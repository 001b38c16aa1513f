// Lights: their kernels run in batches for the points they light; illuminance loops; shadow rays.
#include "transport/engine.h"
#include "transport/sampling.h"

namespace alpenglow::transport {

void Engine::evaluateLight(const BoundLight& light, std::vector<ShadePoint>& queries, std::span<LightValue> out) {
    if (queries.empty()) return;
    auto c = takeContext();
    c->engine = this;
    c->bound = &light.kernel;
    c->points.swap(queries); // lent; given back below
    shading::InstanceView view{&light.instance->parameters, &light.instance->toCurrent};
    if (!c->batch) c->batch = std::make_shared<shading::Batch>();
    c->batch->assign(light.kernel.kernel, *light.kernel.plan, c->points, {&view, 1}, {}, *world_);
    bindCall(c->batch->call(), *c);
    const auto& k = *light.kernel.kernel;
    if (k.facts().suspends) {
        // A light that decides on traced light: its few requests are answered in place, strip by strip.
        for (int first = 0; first < c->batch->size(); first += k.lanes()) {
            void* h = k.start(&c->batch->call(), first);
            while (h && !k.finished(h)) {
                const SiteInfo& s = light.kernel.sites[c->requestSite];
                for (int lane = 0; lane < c->requestLanes; ++lane) {
                    if (!(c->requestMask >> lane & 1) || first + lane >= int(c->points.size())) continue;
                    Color t{0};
                    if (s.kind == SiteKind::Transmission) {
                        auto at = [&](int row) { return c->requestIn[size_t(row) * c->requestLanes + lane]; };
                        Vec3 a(at(s.rows[0]), at(s.rows[0] + 1), at(s.rows[0] + 2)), b(at(s.rows[1]), at(s.rows[1] + 1), at(s.rows[1] + 2));
                        float d = length(b - a);
                        t = d > 0 ? transmittance(a, (b - a) / d, d, c->points[size_t(first + lane)].time, c->points[size_t(first + lane)].ray) : Color(1);
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
            out[e.first + lane].Cl += Color(at(0), at(1), at(2)) *
                                      (l > 0 ? transmittance(a, d / l, l, queries[size_t(e.first + lane)].time, queries[size_t(e.first + lane)].ray) : Color(1));
        }
    }
    if (light.intensityScale > 0) // the kernel divided by the squared distance: radiance does not
        for (size_t i = 0; i < queries.size(); ++i) out[i].Cl *= dot(out[i].L, out[i].L) * light.intensityScale;
    hazeOfEmitters(light, queries, out);
    giveBack(std::move(c));
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
            if (l.kind == LightKind::Ambient || l.strategy == LightStrategy::Trace || !inCategory(l)) continue;
            if (l.kind == LightKind::Environment && world_->settings_.hider != Hider::Path) continue; // a sky is a light of path
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
            if (!light.emitter->sample(lit, rng.pair(r.vertex, use, turn), light.emitter->chooses() ? rng.one(r.vertex, use, turn) : 0, s, p.surface)) continue;
            p.shape = s.shape;
            p.P = p.surface.P;
            p.N = p.surface.n;
            f = 1 / (float(kPi) * s.pdf * light.samples); // cosLight A / (pi d^2 n), design decision 4
        } else if (light.kind == LightKind::Environment) {
            // The sky from directions evenly in the cone of the loop.
            Vec3 axis(c.loopRows[3 * lanes + lane], c.loopRows[4 * lanes + lane], c.loopRows[5 * lanes + lane]);
            float angle = c.loopRows[6 * lanes + lane], la = length(axis);
            bool all = !(la > 0) || !(angle < float(kPi));
            float cap = all ? 2 : 2 * std::pow(std::sin(0.5f * std::max(angle, 0.f)), 2.f); // 1 - cos of the half angle
            if (!(cap > 0)) continue;
            Random rng = random(*p.ray);
            Vec3 w = Basis(all ? Vec3(0, 0, 1) : axis / la).toWorld(sampleCone(cap, rng.pair(p.ray->vertex, kLightPoint + uint32_t(li), uint32_t(k) + 1)));
            p.shape = nullptr;
            p.P = lit + w;
            p.N = -w;
            f = 2 * cap / float(light.samples); // 1 / (pi pdf n)
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
        bool sky = light.kind == LightKind::Environment;
        Vec3 toLight = sky ? q[i].P - q[i].Ps : -v[i].L;
        float angle = c.loopRows[6 * lanes + lane];
        if (angle < float(kPi) && !sky) {
            Vec3 axis(c.loopRows[3 * lanes + lane], c.loopRows[4 * lanes + lane], c.loopRows[5 * lanes + lane]);
            float la = length(axis), ll = length(toLight);
            if (la > 0 && ll > 0 && !(dot(axis, toLight) >= la * ll * std::cos(angle))) continue;
        }
        lit |= uint64_t(1) << lane;
        c.lightDistance[lane] = sky || light.kind == LightKind::Distant ? 1e38f : length(toLight);
        float rows[9] = {toLight.x, toLight.y, toLight.z, v[i].Cl.x * factor[i], v[i].Cl.y * factor[i], v[i].Cl.z * factor[i], 1, 1, 1};
        for (int r = 0; r < 9; ++r) out[size_t(r) * lanes + lane] = rows[r];
    }
    return lit;
}

} // namespace alpenglow::transport
