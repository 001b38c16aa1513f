#include "integrator/lightsample.h"
#include "services/lightloop.h"
#include "world/skytable.h"

namespace alpenglow::integrator {

void tellLit(ShadePoint& p, const ShadePoint& lit) {
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

bool placeLightSample(const WorldImpl& world, const BoundLight& light, const LightNumbers& u, bool path, ShadePoint& p,
                      Emitter::Sample& s) {
    if (light.kind == LightKind::Area) {
        if (!(light.mean ? light.emitter->sampleSurface(p.Ps, u.pair, u.choose, p.shutter, s, p.surface, light.pointNeeds)
                         : light.emitter->sample(p.Ps, u.pair, u.choose, p.shutter, s, p.surface, light.pointNeeds)))
            return false;
        if (world.accel_->hasSolids() && !world.accel_->keeps(world.numberOfShape_.at(s.shape), intersectsAt(p.surface),
                                                              intersectsNormal(p.surface), p.shutter))
            return false; // the part of a lamp outside of its CSG solid
        p.shape = s.shape;
        p.P = intersectsAt(p.surface);
        p.N = p.surface.n;
        p.Ci = Color(0);
        return true;
    }
    p.shape = nullptr;
    p.surface = *p.lit;
    if (light.sky) {
        if (!light.sky->sample(u.pair, s.direction, s.pdf)) return false;
        s.shape = nullptr;
        s.visibility = ~0u;
        p.P = p.Ps + s.direction;
        p.N = -s.direction;
        p.Ci = Color(0);
        return true;
    }
    p.N = Vec3();
    p.P = originOfLight(*light.instance, p.shutter);
    p.Ci = light.cone && path ? coneNumbers(u.pair) : Color(0);
    return true;
}

} // namespace alpenglow::integrator
