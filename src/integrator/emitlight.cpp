// Emission of photons, by kind of light. The value of the light's shader at the photon's first hit determines its power. So
// direct light by photons equals the shader's light at each point, even if it does not fall off with the square of the distance,
// or is projected through a slide.
#include "bsdf/sampling.h"
#include "integrator/emission.h"
#include "integrator/lightkernels.h"
#include "world/skysampler.h"

namespace alpenglow::integrator {

namespace {

constexpr float kPiF = float(kPi);

Vec3 evenDirection(Vec2 u) {
    const float z = 1 - 2 * u.x, r = std::sqrt(std::max(0.f, 1 - z * z));
    const Vec2 d = unitCircle(u.y);
    return {r * d.x, r * d.y, z};
}

/// A point on the disk that covers the bounding sphere of all geometry, on the side where photons along `dir` enter.
Vec3 onDisc(const EmissionPlan& plan, const Vec3& dir, Vec2 u) {
    const float r = plan.radius * std::sqrt(u.x);
    const Vec2 d = unitCircle(u.y);
    const Basis b(dir);
    return plan.centre - dir * (plan.radius * 1.001f) + b.t * (r * d.x) + b.u * (r * d.y);
}

/// From an emitter: uniform by area, and by cosine on the chosen side. Emitters that turn to the ray show their front to every
/// direction: there the direction is sampled first, then a point visible from it. A light of mean samples has no radiance; it
/// emits from each point like a point light.
void startArea(const WorldImpl& world, const EmissionPlan::Light& l, EmissionStart& s) {
    const Emitter& emitter = *l.light->emitter;
    float perArea = 0;
    const Vec3 even = evenDirection(s.drawn.way);
    s.shape = emitter.samplePoint(s.drawn.place, s.drawn.choose, s.drawn.time, even, s.surface, perArea);
    if (!(perArea > 0) || !std::isfinite(perArea)) return;
    if (world.accel().hasSolids() && !world.accel().keeps(world.numberOfShape().at(s.shape), intersectsAt(s.surface),
                                                          intersectsNormal(s.surface), s.drawn.time))
        return;
    const Vec3& n = intersectsNormal(s.surface);
    s.front = s.drawn.side < l.front;
    if (l.light->mean) {
        s.dir = even;
        s.factor = 4 * kPiF * kPiF / (perArea * float(emitter.area()));
    } else if (s.shape->facesRays()) {
        s.dir = even;
        s.front = true;
        s.factor = 4 * kPiF * std::fabs(dot(n, even)) / perArea;
    } else {
        if (!s.front && s.shape->oneSided()) return;
        s.dir = Basis(s.front ? n : -n).toWorld(sampleCosine(s.drawn.way));
        s.factor = kPiF / (perArea * (s.front ? l.front : 1 - l.front));
    }
    s.origin = leavesFrom(s.surface, s.dir);
}

/// The query to a light's shader for a photon that lights `at`.
ShadePoint queryOf(const WorldImpl& world, const EmissionPlan::Light& l, const EmissionStart& s, const Vec3& at) {
    ShadePoint p;
    p.Ps = at;
    p.Ns = -s.dir;
    p.shutter = world.shadesAtOpen() ? 0 : s.drawn.time;
    world.setTime(p);
    p.viewI = p.I = s.dir;
    if (l.light->kind == LightKind::Area) {
        p.surface = s.surface;
        p.shape = s.shape;
        p.P = intersectsAt(s.surface);
        p.N = s.surface.n;
    } else if (l.light->kind == LightKind::Environment) {
        p.P = at - s.dir;
        p.N = s.dir;
    } else {
        p.P = Vec3(transformPoint(l.light->instance->toCurrentAt(p.shutter), {0, 0, 0}));
        p.N = Vec3();
        if (l.light->cone) p.Ci = coneNumbers(s.drawn.cone);
    }
    return p;
}

/// From a bright direction of a sky. Dimmer directions carry no power: lobes find them without a guide. `way`, which emission
/// learns, is the place, because bright directions are few.
void startBright(const EmissionPlan& plan, const EmissionPlan::Light& l, EmissionStart& s) {
    Vec3 w;
    float density = 0;
    if (!l.light->sky->sampleBright(s.drawn.place, w, density)) return;
    s.dir = -w;
    s.origin = onDisc(plan, s.dir, s.drawn.way);
    s.factor = kPiF * plan.radius * plan.radius / density;
}

/// From a distant light: its shader gives the direction.
void startDistant(LightKernels& lights, const EmissionPlan& plan, const EmissionPlan::Light& l, std::span<EmissionStart> starts) {
    std::vector<ShadePoint> q;
    for (const EmissionStart& s : starts) q.push_back(queryOf(lights.world(), l, s, plan.centre));
    std::vector<LightValue> v(q.size());
    lights.evaluateLight(*l.light, q, v);
    for (size_t i = 0; i < starts.size(); ++i) {
        EmissionStart& s = starts[i];
        const float far = length(v[i].L);
        if (!(far > 0) || !std::isfinite(far)) continue;
        s.dir = v[i].L / far;
        s.origin = onDisc(plan, s.dir, s.drawn.way);
        s.factor = kPiF * kPiF * plan.radius * plan.radius;
    }
}

/// From a moving light with a position: its shader gives the position.
void startMoving(LightKernels& lights, const EmissionPlan& plan, const EmissionPlan::Light& l, std::span<EmissionStart> starts) {
    std::vector<ShadePoint> q;
    for (EmissionStart& s : starts) {
        s.dir = Vec3(0, 0, 1);
        q.push_back(queryOf(lights.world(), l, s, plan.centre + s.dir * plan.radius));
    }
    std::vector<LightValue> v(q.size());
    lights.evaluateLight(*l.light, q, v);
    for (size_t i = 0; i < starts.size(); ++i) starts[i].origin = q[i].Ps - v[i].L;
}

/// From a class light with generatePhoton(): origin and direction from that method. Its power is a radiance times an area, so pi
/// of it over all directions; photons of the light differ by power over pdf.
void startGenerated(LightKernels& lights, const EmissionPlan& plan, const EmissionPlan::Light& l,
                    std::span<EmissionStart> starts) {
    std::vector<shading::PathSample> samples(starts.size());
    std::vector<PathRay> rays(starts.size());
    std::vector<ShadePoint> q(starts.size());
    for (size_t i = 0; i < starts.size(); ++i) {
        samples[i].numbers = starts[i].drawn.numbers;
        rays[i].sample = &samples[i];
        q[i].ray = &rays[i];
        q[i].Ps = plan.centre;
        q[i].shutter = lights.world().shadesAtOpen() ? 0 : starts[i].drawn.time;
        lights.world().setTime(q[i]);
        q[i].P = Vec3(transformPoint(l.light->instance->toCurrentAt(q[i].shutter), {0, 0, 0}));
        q[i].N = Vec3();
    }
    std::vector<LightValue> v(q.size());
    std::vector<float> given;
    LightCall call;
    call.kernel = &l.light->photons;
    call.more = l.light->photonOutputs;
    call.moreValues = &given;
    lights.evaluateLight(*l.light, q, v, call);
    for (size_t i = 0; i < starts.size(); ++i) {
        EmissionStart& s = starts[i];
        const float* n = given.data() + 10 * i;
        const Vec3 from(n[0], n[1], n[2]), way(n[3], n[4], n[5]);
        const float far = length(way);
        s.pdf = n[9] > 0 && std::isfinite(n[9]) ? n[9] : 0;
        s.power = {std::max(n[6], 0.f), std::max(n[7], 0.f), std::max(n[8], 0.f)};
        if (!(far > 0) || !std::isfinite(far) || !std::isfinite(length(from)) || !(s.pdf > 0) || !isFinite(s.power)) continue;
        s.origin = from;
        s.dir = way / far;
        s.factor = kPiF * float(l.pdf / s.pdf) / s.drawn.chance;
    }
}

} // namespace

void startPhotons(LightKernels& lights, const EmissionPlan& plan, const EmissionPlan::Light& l, std::span<EmissionStart> starts) {
    if (l.light->photons) return startGenerated(lights, plan, l, starts);
    const bool moves = l.light->kind == LightKind::Point && l.light->instance->moving;
    if (l.light->kind == LightKind::Distant) startDistant(lights, plan, l, starts);
    if (moves) startMoving(lights, plan, l, starts);
    for (EmissionStart& s : starts) {
        switch (l.light->kind) {
        case LightKind::Area:
            startArea(lights.world(), l, s);
            break;
        case LightKind::Point:
            s.dir = evenDirection(s.drawn.way);
            if (!moves) s.origin = l.place;
            s.factor = 4 * kPiF * kPiF; // power: pi Cl d^2 per steradian
            break;
        case LightKind::Environment:
            if (l.bright) {
                startBright(plan, l, s);
                break;
            }
            s.dir = evenDirection(s.drawn.way);
            s.origin = onDisc(plan, s.dir, s.drawn.place);
            s.factor = 4 * kPiF * kPiF * plan.radius * plan.radius;
            break;
        default:
            break;
        }
        s.factor /= s.drawn.chance * s.drawn.density;
    }
}

std::vector<Color> emittedPower(LightKernels& lights, const EmissionPlan::Light& l, std::span<EmissionStart> starts) {
    if (l.light->photons) {
        std::vector<Color> given;
        for (const EmissionStart& s : starts) given.push_back(s.length > 0 ? s.power * s.factor : Color(0));
        return given;
    }
    std::vector<ShadePoint> q;
    std::vector<size_t> of;
    for (size_t i = 0; i < starts.size(); ++i) {
        const EmissionStart& s = starts[i];
        if (!(s.length > 0) || !(s.factor > 0) || s.dir == Vec3(0.f)) continue;
        q.push_back(queryOf(lights.world(), l, s, s.origin + s.dir * s.length));
        of.push_back(i);
    }
    std::vector<LightValue> v(q.size());
    const std::vector<char> apart(q.size(), 1); // an emitter's atmosphere is applied at the photon's hit
    LightCall call;
    call.inMedium = &apart;
    lights.evaluateLight(*l.light, q, v, call);
    std::vector<Color> power(starts.size(), Color(0));
    const bool falls = l.light->kind == LightKind::Point || l.light->mean; // then the shader's value is an irradiance
    for (size_t k = 0; k < of.size(); ++k) {
        EmissionStart& s = starts[of[k]];
        s.kept = v[k].kept(RayType::Specular);
        s.keptDiffuse = v[k].kept(RayType::Diffuse);
        if (!v[k].lit || !isFinite(v[k].Cl)) continue;
        const float far = length(q[k].Ps - (l.light->kind == LightKind::Point ? s.origin : intersectsAt(s.surface)));
        const Color c = v[k].Cl * (s.factor * (falls ? far * far : 1));
        if (isFinite(c)) power[of[k]] = {std::max(c.x, 0.f), std::max(c.y, 0.f), std::max(c.z, 0.f)};
    }
    return power;
}

} // namespace alpenglow::integrator
