#include "integrator/lightsample.h"
#include "services/lightloop.h"
#include "world/skysampler.h"
#include <bit>

namespace alpenglow::integrator {

void takeLitPoint(ShadePoint& p, const ShadePoint& lit) {
    p.Ps = lit.P;
    p.lit = &lit.surface;
    p.Ns = lit.N;
    p.viewI = p.I = lit.I;
    p.E = lit.E;
    p.du = lit.du;
    p.dv = lit.dv;
    p.time = lit.time;
    p.shutter = lit.shutter;
    p.ray = lit.ray;
}

Vec3 originOfLight(const ShaderInstance& of, float shutter) {
    Matrix moved;
    const auto& m = of.moving ? (moved = of.toCurrentAt(shutter)).m : of.toCurrent.m; // transformPoint() of the origin
    const Vec3d at(m[3][0], m[3][1], m[3][2]);
    return Vec3(m[3][3] == 1 || m[3][3] == 0 ? at : at / m[3][3]);
}

const LightGuide* guideOf(const WorldImpl& w, const BoundLight& l) {
    if (!w.photons() || w.photons()->lightGuides.empty()) return nullptr;
    return w.photons()->lightGuides[size_t(&l - w.lights().data())].get();
}

GuidedDraw::GuidedDraw(const LightGuide* guide, const Vec3& from, float& x) {
    cell = guide ? guide->find(from) : nullptr;
    if (!cell) return;
    toward = x < cell->share;
    x = std::min(toward ? x / cell->share : (x - cell->share) / (1 - cell->share), 1 - 0x1p-24f);
}

GuidedLanes::GuidedLanes(const LightGuide* guide, const VertexBlock& v, Lanes points, float* x) {
    for (Lanes left = guide ? points : 0; left; left &= left - 1) {
        const int i = std::countr_zero(left);
        const GuidedDraw by(guide, {v.P[0][i], v.P[1][i], v.P[2][i]}, x[i]);
        cell[i] = by.cell;
        toward |= Lanes(by.toward) << i;
        guided |= Lanes(by.cell != nullptr) << i;
    }
}

bool placeLightSample(const WorldImpl& world, const BoundLight& light, const LightGuide* guide, const LightNumbers& numbers,
                      bool path, ShadePoint& p, Emitter::Sample& s) {
    LightNumbers u = numbers;
    const GuidedDraw by(guide, p.Ps, u.pair.x);
    const auto mix = [&] {
        if (by.cell) s.pdf = guide->mixed(*by.cell, s.pdf, p.Ps, s.direction);
    };
    if (light.kind == LightKind::Area) {
        if (by.toward) {
            const Vec3 w = guide->draw(*by.cell, p.Ps, u.pair);
            if (!light.emitter->sampleToward(p.Ps, w, s, p.surface, light.pointNeeds)) return false;
        } else if (!(light.mean ? light.emitter->sampleSurface(p.Ps, u.pair, u.choose, p.shutter, s, p.surface, light.pointNeeds)
                                : light.emitter->sample(p.Ps, u.pair, u.choose, p.shutter, s, p.surface, light.pointNeeds)))
            return false;
        if (world.accel().hasSolids() && !world.accel().keeps(world.numberOfShape().at(s.shape), intersectsAt(p.surface),
                                                              intersectsNormal(p.surface), p.shutter))
            return false; // the part of a lamp outside of its CSG solid
        mix();
        p.shape = s.shape;
        p.P = intersectsAt(p.surface);
        p.N = p.surface.n;
        p.Ci = Color(0);
        return true;
    }
    p.shape = nullptr;
    p.surface = *p.lit;
    if (light.isSky()) {
        if (by.toward) {
            s.direction = guide->draw(*by.cell, p.Ps, u.pair);
            s.pdf = light.sky ? light.sky->pdf(s.direction) : 0;
        } else if (!light.sky || !light.sky->sample(u.pair, s.direction, s.pdf)) {
            return false;
        }
        mix();
        s.shape = nullptr;
        s.visibility = light.shadowless && light.sky ? 0 : ~0u; // rays of lobes do not count it
        p.P = p.Ps + s.direction;
        p.N = p.Ns;
        p.Ci = Color(0);
        return true;
    }
    p.N = p.Ns; // a light without area has no normal of its own
    p.P = originOfLight(*light.instance, p.shutter);
    p.Ci = light.cone && path ? coneNumbers(u.pair) : Color(0);
    return true;
}

} // namespace alpenglow::integrator
