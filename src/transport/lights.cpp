// Lights: their kernels run in batches for the points they light.
#include "transport/engine.h"
#include "transport/sampling.h"

namespace alpenglow::transport {

Color coneNumbers(Vec2 random) {
    Vec2 d = unitCircle(random.y);
    return {random.x, d.x, d.y};
}

void Engine::evaluateLight(const BoundLight& light, std::vector<ShadePoint>& queries, std::span<LightValue> out, const LightCall& call) {
    if (queries.empty()) return;
    const BoundKernel& bound = call.kernel ? *call.kernel : light.kernel;
    auto c = takeContext();
    c->engine = this;
    c->bound = &bound;
    c->lit = call.lit;
    c->light = &light;
    c->points.swap(queries); // lent; given back below
    shading::InstanceView view{call.parameters ? call.parameters : &light.instance->parameters, &light.instance->toCurrent};
    if (!c->batch) c->batch = std::make_shared<shading::Batch>();
    c->batch->assign(bound.kernel, *bound.plan, c->points, {&view, 1}, {}, *world_);
    bindCall(c->batch->call(), *c);
    const auto& k = *bound.kernel;
    if (k.facts().suspends) {
        // A light that decides on traced light: its few requests are answered in place, strip by strip.
        for (int first = 0; first < c->batch->size(); first += k.lanes()) {
            void* h = k.start(&c->batch->call(), first);
            while (h && !k.finished(h)) {
                const SiteInfo& s = bound.sites[c->requestSite];
                for (int lane = 0; lane < c->requestLanes; ++lane) {
                    if (!(c->requestMask >> lane & 1) || first + lane >= int(c->points.size())) continue;
                    Color t{0};
                    if (s.kind == SiteKind::Transmission) {
                        auto at = [&](int row) { return c->requestIn[size_t(row) * c->requestLanes + lane]; };
                        Vec3 a(at(s.rows[0]), at(s.rows[0] + 1), at(s.rows[0] + 2)), b(at(s.rows[1]), at(s.rows[1] + 1), at(s.rows[1] + 2));
                        const ShadePoint& p = c->points[size_t(first + lane)];
                        const Way way = wayBetween(a, b, p.Ps, p.lit);
                        t = way.distance > 0 ? transmittance(way.origin, way.dir, way.distance, p.time, p.ray) : Color(1);
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
        if (light.outOl >= 0) v.Ol = b.color(light.outOl, int(i));
        v.lit = light.outLit < 0 || b.value(light.outLit, 0, int(i)) != 0;
        if (light.nonDiffuse >= 0) v.nonDiffuse = b.value(light.nonDiffuse, 0, int(i));
        if (light.nonSpecular >= 0) v.nonSpecular = b.value(light.nonSpecular, 0, int(i));
        if (call.values) {
            float* to = call.values->data() + i * size_t(light.valueWidth);
            for (const BoundLight::Value& value : light.values)
                for (int r = 0; r < value.components; ++r) *to++ = b.value(value.output, r, int(i));
        }
    }
    // Affine requests of the light itself: shadows that it asks for.
    for (const EmitRecord& e : c->emits) {
        const SiteInfo& s = bound.sites[e.site];
        if (s.kind != SiteKind::Transmission) continue;
        for (int lane = 0; lane < e.lanes; ++lane) {
            if (!(e.mask >> lane & 1) || e.first + lane >= int(queries.size())) continue;
            auto at = [&](int row) { return c->arena[e.offset + size_t(row) * e.lanes + lane]; };
            const Vec3 a(at(3 + s.rows[0]), at(4 + s.rows[0]), at(5 + s.rows[0])), b(at(3 + s.rows[1]), at(4 + s.rows[1]), at(5 + s.rows[1]));
            const ShadePoint& p = queries[size_t(e.first + lane)];
            const Way way = wayBetween(a, b, p.Ps, p.lit);
            out[e.first + lane].Cl += Color(at(0), at(1), at(2)) * (way.distance > 0 ? transmittance(way.origin, way.dir, way.distance, p.time, p.ray) : Color(1));
        }
    }
    if (light.intensityScale > 0) // the kernel divided by the squared distance: radiance does not
        for (size_t i = 0; i < queries.size(); ++i) out[i].Cl *= dot(out[i].L, out[i].L) * light.intensityScale;
    hazeOfEmitters(light, queries, out);
    giveBack(std::move(c));
}

} // namespace alpenglow::transport
