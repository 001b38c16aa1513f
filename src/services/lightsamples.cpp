// Light samples for the points of a loop: positions on lights, light kernels with sent values, and occlusion.
#include "base/direction.h"
#include "base/exact.h"
#include "bsdf/sampling.h"
#include "services/services.h"
#include "world/emitterfootprint.h"
#include "world/outputs.h"
#include "world/skysampler.h"
#include <bit>
#include <cstdlib>

namespace alpenglow::services {

Color coneNumbers(Vec2 random) {
    Vec2 d = unitCircle(random.y);
    return {random.x, d.x, d.y};
}

LitSurface Services::litSurface(KernelRun& c, const LightLoop& loop, const std::vector<int>& points, int first, int lanes) const {
    LitSurface lit;
    lit.binding = [this, &c, &points](int q) -> const SurfaceBinding* {
        const size_t point = size_t(points[size_t(q)]);
        return point < c.bindings.size() ? &world_->bindings()[size_t(c.bindings[point])] : c.binding;
    };
    lit.displaced = [&c, &points](int q, int& point) {
        point = points[size_t(q)];
        return c.displaced.get();
    };
    lit.output = [&c, &loop, &points, first, lanes](int q, const std::string& name, std::vector<float>& v) {
        if (loop.setup < 0) return false;
        const SiteInfo& s = c.bound->sites[size_t(loop.setup)];
        for (const SiteInfo::Output& o : s.outputs) {
            if (o.name.name != name) continue;
            for (int r = 0; r < o.size; ++r)
                v.push_back(loop.given[size_t(o.row + r) * size_t(lanes) + size_t(points[size_t(q)] - first)]);
            return true;
        }
        return false;
    };
    return lit;
}

void Services::evaluateForLoop(KernelRun& c, const LightLoop& loop, int li, int first, int lanes, std::vector<ShadePoint>& q,
                               const std::vector<int>& laneOf, std::vector<LightValue>& out, std::vector<float>& values) {
    const BoundLight& light = world_->lights()[size_t(li)];
    out.assign(q.size(), {});
    values.assign(q.size() * size_t(light.valueWidth), 0);
    std::vector<int> points;
    for (int lane : laneOf) points.push_back(first + lane);
    LightCall call;
    LitSurface lit;
    call.values = &values;
    if (loop.setup < 0) {
        if (light.asksSurface) lit = litSurface(c, loop, points, first, lanes), call.lit = &lit;
        lightEvaluator_->evaluateLight(light, q, out, call);
        return;
    }
    // Sent values: one run for all points that send equal values. Elements of an array go to an array of the same class.
    const SiteInfo& s = c.bound->sites[size_t(loop.setup)];
    if (!s.sentKey.empty())
        if (auto v = light.variants.find(s.sentKey); v != light.variants.end()) call.kernel = &v->second;
    struct Sent {
        std::string parameter;
        int row, size, at;
    }; ///< at: start of its numbers, for an element of an array
    std::vector<Sent> sent;
    for (const SiteInfo::Sent& v : s.sent) {
        const auto have = light.instance->parameters.numbers.find(v.parameter);
        if (have == light.instance->parameters.numbers.end()) continue;
        const int all = int(have->second.size()), at = std::max(v.element, 0) * v.size;
        const bool fits = v.element < 0 ? all == v.size : at + v.size <= all && elementsOf(light, v.parameter) * v.size == all;
        if (fits) sent.push_back({v.parameter, v.row, v.size, at});
    }
    auto given = [&](int row, int lane) { return loop.given[size_t(row) * size_t(lanes) + size_t(lane)]; };
    if (s.rowN >= 0)
        for (size_t i = 0; i < q.size(); ++i)
            q[i].Ns = Vec3(given(s.rowN, laneOf[i]), given(s.rowN + 1, laneOf[i]), given(s.rowN + 2, laneOf[i]));
    std::map<std::vector<uint32_t>, std::vector<int>> groups;
    for (size_t i = 0; i < q.size(); ++i) {
        std::vector<uint32_t> key;
        for (const Sent& v : sent)
            for (int r = 0; r < v.size; ++r) key.push_back(std::bit_cast<uint32_t>(given(v.row + r, laneOf[i])));
        groups[std::move(key)].push_back(int(i));
    }
    for (const auto& [key, members] : groups) {
        shading::ParameterBlock block;
        if (!sent.empty()) {
            block = light.instance->parameters;
            size_t at = 0;
            for (const Sent& v : sent)
                for (int r = 0; r < v.size; ++r) block.numbers[v.parameter][size_t(v.at + r)] = std::bit_cast<float>(key[at++]);
            call.parameters = &block;
        }
        std::vector<ShadePoint> some;
        std::vector<int> where;
        for (int i : members) some.push_back(q[size_t(i)]), where.push_back(points[size_t(i)]);
        std::vector<LightValue> result(some.size());
        std::vector<float> resultValues(some.size() * size_t(light.valueWidth));
        call.values = &resultValues;
        if (light.asksSurface) lit = litSurface(c, loop, where, first, lanes), call.lit = &lit;
        lightEvaluator_->evaluateLight(light, some, result, call);
        for (size_t k = 0; k < members.size(); ++k) {
            out[size_t(members[k])] = result[k];
            std::copy_n(resultValues.begin() + long(k) * light.valueWidth, light.valueWidth,
                        values.begin() + long(members[k]) * light.valueWidth);
        }
    }
}

int elementsOf(const BoundLight& light, const std::string& parameter) {
    for (const rsl::ParameterInfo& p : light.instance->program->parameters())
        if (p.name == parameter) return p.type.base == shadeops::Base::String ? 0 : std::max(p.type.array, 0);
    return 0;
}

void Services::keepChannels(KernelRun& c, const BoundLight& light, int point, const float* values) {
    size_t width = 0;
    for (int w : world_->widthsOfOutputs()) width += size_t(w);
    c.lightChannels.resize(c.points.size() * width);
    std::vector<const std::string*> missing; // not written by the light
    const auto given = [&](const rsl::OutputName& name) {
        return std::none_of(missing.begin(), missing.end(), [&](const std::string* m) { return *m == name.name; });
    };
    for (const BoundLight::Value& v : light.values) {
        if (v.name.what == rsl::OutputName::What::Given && *values == 0) missing.push_back(&v.name.name);
        if (v.aov >= 0 && given(v.name))
            for (int r = 0; r < v.components && size_t(v.aov + r) < width; ++r)
                c.lightChannels[size_t(point) * width + size_t(v.aov + r)] = values[r];
        values += v.components;
    }
}

void Services::sentSample(const BoundLight& light, int turn, const float* values, LightValue& v) {
    const float* way = values + light.sentL + 3 * turn;
    const float* sent = values + light.sentCl + 3 * turn;
    v.L = {way[0], way[1], way[2]};
    v.Cl = {sent[0], sent[1], sent[2]};
    v.lit &= (v.Cl.x != 0 || v.Cl.y != 0 || v.Cl.z != 0) && length(v.L) > 0;
}

void Services::chooseSent(const BoundLight& light, float u, const float* values, LightValue& v) {
    const auto weight = [&](int k) {
        const float* sent = values + light.sentCl + 3 * k;
        const float w = luminance(Color(sent[0], sent[1], sent[2]));
        return std::isfinite(w) ? std::max(w, 0.f) : 0.f;
    };
    double sum = 0, before = 0;
    for (int k = 0; k < limits::kLightIterations; ++k) sum += weight(k);
    int chosen = -1;
    for (int k = 0; k < limits::kLightIterations && before <= u * sum; ++k)
        if (const float w = weight(k); w > 0) chosen = k, before += w;
    if (chosen < 0) {
        v.lit = false;
        return;
    }
    sentSample(light, chosen, values, v);
    v.Cl *= float(sum / weight(chosen));
}

bool Services::lightQuery(const KernelRun& c, int li, int point, const Vec3& at, const Vec3& axis, float angle, int turn,
                          int turns, uint32_t nth, ShadePoint& p, float* factor) const {
    const BoundLight& light = world_->lights()[size_t(li)];
    const ShadePoint& of = c.points[size_t(point)];
    p = of;
    p.Ps = at;
    p.lit = at == of.P ? &of.surface : nullptr;
    p.Ns = p.N;
    p.viewI = p.I;
    p.Ci = Color(0);
    *factor = 1;
    const uint32_t use = kLightPoint + uint32_t(li);
    if (light.kind == LightKind::Area) {
        if (!light.emitter || !p.ray) return false;
        const Random rng = random(*p.ray).draw(uint32_t(turn), uint32_t(turns));
        Emitter::Sample s;
        const float choose = light.emitter->chooses() ? rng.one(p.ray->vertex, use, nth) : 0;
        const Vec2 u = rng.pair(p.ray->vertex, use, nth);
        if (!(light.mean ? light.emitter->sampleSurface(at, u, choose, of.shutter, s, p.surface, light.pointNeeds)
                         : light.emitter->sample(at, u, choose, of.shutter, s, p.surface, light.pointNeeds)))
            return false;
        if (world_->accel().hasSolids() && !world_->accel().keeps(world_->numberOfShape().at(s.shape), intersectsAt(p.surface),
                                                                  intersectsNormal(p.surface), p.shutter))
            return false; // the part of a lamp outside of its CSG solid
        p.shape = s.shape;
        p.P = intersectsAt(p.surface);
        p.N = p.surface.n;
        // A loop has no lobe: it sees an emitter with the footprint of diffuse().
        static const LobeKind* const diffuse = findLobe("diffuse");
        if (usesFootprint(light)) setEmitterFootprint(p, *p.ray, at, spreadBehind(*p.ray, diffuse->spread(LobeParams{})));
        // cosLight A / (pi d^2 n) (docs/light.md)
        *factor = light.mean ? 1 / (s.pdf * float(turns)) : 1 / (float(kPi) * s.pdf * float(turns));
    } else if (light.kind == LightKind::Environment && world_->settings().hider != Hider::Path) {
        // A single direction, the surface normal: diffuse() then returns what a uniform sky gives.
        const Vec3 w = directionOr(axis, directionOr(dot(p.N, p.I) > 0 ? -p.N : p.N, Vec3(0, 0, 1)));
        p.shape = nullptr;
        p.P = at + w;
    } else if (light.kind == LightKind::Environment) {
        // The sky in directions uniform in the cone of the loop; for a sky with a table, half of them by radiance.
        if (!p.ray) return false;
        const Vec3 way = directionOr(axis, {});
        const bool all = !(dot(way, way) > 0) || !(angle < float(kPi));
        const float half = float(exact::sin(0.5 * std::max(angle, 0.f))),
                    cap = all ? 2 : 2 * half * half; // 1 - cos of the half angle
        if (!(cap > 0)) return false;
        const Random rng = random(*p.ray).draw(uint32_t(turn), uint32_t(turns));
        const Vec3 middle = all ? Vec3(0, 0, 1) : way;
        Vec2 u = rng.pair(p.ray->vertex, use, nth);
        Vec3 w;
        float density = 0; // density by the table, for half of the directions
        const bool byTable = light.sky && u.x < .5f;
        if (light.sky) u.x = byTable ? 2 * u.x : 2 * u.x - 1;
        if (!byTable) w = Basis(middle).toWorld(sampleCone(cap, u));
        else if (!light.sky->sample(u, w, density) || (!all && !(dot(w, middle) > 1 - cap))) return false;
        p.shape = nullptr;
        p.P = at + w;
        *factor = 2 * cap / float(turns); // 1 / (pi pdf n)
        if (light.sky) *factor = 2 / (float(turns) * (1 / (2 * cap) + float(kPi) * light.sky->pdf(w)));
    } else {
        p.shape = nullptr;
        p.P = Vec3(transformPoint(light.instance->toCurrentAt(of.shutter), {0, 0, 0}));
        if (light.cone) {
            if (p.ray && world_->settings().hider == Hider::Path)
                p.Ci = coneNumbers(random(*p.ray).draw(uint32_t(turn), uint32_t(turns)).pair(p.ray->vertex, use, nth));
            *factor = 1 / float(turns);
        }
    }
    return true;
}

uint64_t Services::sampleLight(KernelRun& c, const LightLoop& loop, int li, int turn, int turns, int first, uint64_t mask,
                               int lanes, LightLoop::Kept& kept) {
    const BoundLight& light = world_->lights()[size_t(li)];
    auto row = [&](int r, int lane) { return loop.rows[size_t(r) * size_t(lanes) + size_t(lane)]; };
    std::vector<ShadePoint> q;
    std::vector<int> laneOf;
    std::vector<float> factor;
    uint64_t lit = 0;
    for (int lane = 0; lane < lanes; ++lane) {
        if (!(mask >> lane & 1) || first + lane >= int(c.points.size())) continue;
        const Vec3 at(row(0, lane), row(1, lane), row(2, lane)), axis(row(3, lane), row(4, lane), row(5, lane));
        ShadePoint& p = q.emplace_back();
        float f = 1;
        if (!lightQuery(c, li, first + lane, at, axis, row(6, lane), turn, turns, drawOf(loop), p, &f)) {
            q.pop_back();
            continue;
        }
        laneOf.push_back(lane);
        factor.push_back(f);
    }
    std::vector<LightValue> v;
    std::vector<float> values;
    const size_t width = size_t(light.valueWidth);
    // A light that sends many samples returns all of them in the run for the first.
    const auto ran = light.sentCl >= 0 && turn > 0
                         ? loop.kept.find(keptName(loop, light, li, 0, world_->settings().hider == Hider::Path))
                         : loop.kept.end();
    if (ran != loop.kept.end() && (ran->second.have & mask) == mask) {
        v.assign(q.size(), {});
        for (size_t i = 0; i < q.size(); ++i) {
            v[i].lit = ran->second.ran >> laneOf[i] & 1;
            const auto from = ran->second.values.begin() + laneOf[i] * light.valueWidth;
            values.insert(values.end(), from, from + light.valueWidth);
        }
    } else {
        evaluateForLoop(c, loop, li, first, lanes, q, laneOf, v, values);
    }
    kept.ran &= ~mask;
    if (light.sentCl >= 0)
        for (size_t i = 0; i < q.size(); ++i) {
            kept.ran |= uint64_t(v[i].lit) << laneOf[i];
            sentSample(light, turn, values.data() + i * width, v[i]);
        }
    if (light.shadows) lightEvaluator_->shadowLight(c, light, first, drawOf(loop), q, laneOf, v);
    for (size_t i = 0; i < q.size(); ++i) {
        const size_t lane = size_t(laneOf[i]);
        std::copy_n(values.begin() + long(i) * light.valueWidth, light.valueWidth,
                    kept.values.begin() + long(lane) * light.valueWidth);
        if (light.channels) keepChannels(c, light, first + laneOf[i], kept.values.data() + long(lane) * light.valueWidth);
        if (!v[i].lit) continue;
        const bool sky = light.kind == LightKind::Environment;
        const Vec3 toLight = sky ? q[i].P - q[i].Ps : -v[i].L;
        const float rows[9] = {
            toLight.x, toLight.y, toLight.z, v[i].Cl.x * factor[i], v[i].Cl.y * factor[i], v[i].Cl.z * factor[i],
            v[i].Ol.x, v[i].Ol.y, v[i].Ol.z};
        for (size_t r = 0; r < 9; ++r) kept.out[r * size_t(lanes) + lane] = rows[r];
        if (v[i].ownShadow) kept.reach[lane] = {0, 0};
        else kept.reach[lane] = {sky || light.kind == LightKind::Distant ? 1e38f : length(toLight), v[i].shadowRadius};
        lit |= uint64_t(1) << lane;
    }
    return lit;
}

} // namespace alpenglow::services
