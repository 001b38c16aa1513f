#include "world/bakes.h"
#include "scene/scene.h"
#include "shading/grids.h"
#include "world/cloudsite.h"
#include "world/cloudstore.h"
#include "world/impl.h"
#include <cmath>

namespace alpenglow::world {

namespace {

const WorldImpl& implOf(const World& w) { return static_cast<const WorldImpl&>(w); }

bool bakesAt(const BoundKernel& k) {
    return std::any_of(k.sites.begin(), k.sites.end(), [](const SiteInfo& s) { return s.cloud && s.cloud->writes; });
}

/// Whether a shader bakes at the points of a surface, among those that run there.
bool bakesAt(const WorldImpl& w, const SurfaceBinding& b) {
    bool bakes = false;
    for (const BoundKernel* k : {&b.surfaceS, &b.surfaceV, &b.displacementS, &b.atmosphere.kernel}) bakes |= bakesAt(*k);
    if (!bakes) w.eachLight(b.lights, [&](int l) { return bakes |= bakesAt(w.lights()[size_t(l)].kernel); });
    return bakes;
}

/// Sets du and dv of a point so that area(P) is that of its part of the surface: what shaders give as "_area" adds up to the area
/// of the surface. Of all such pairs, the one of sides that are alike. Where the surface has no area they stay those of the
/// pixel.
void setSize(shading::GridPoint& g, const geometry::SurfacePoint& p) {
    const float u = length(p.dPdu), v = length(p.dPdv), across = length(cross(p.dPdu, p.dPdv));
    const float side = std::sqrt(g.area * u * v / across);
    if (!(across > 0) || !(side > 0) || !std::isfinite(side / u) || !std::isfinite(side / v)) return;
    g.du = side / u, g.dv = side / v;
}

} // namespace

bool bakes(const World& world) {
    const auto* w = dynamic_cast<const WorldImpl*>(&world); // tests of other folders use their own World
    return w && w->needs().bakes;
}

std::vector<uint32_t> bakedShapes(const World& world) {
    const WorldImpl& w = implOf(world);
    std::vector<uint32_t> all;
    for (uint32_t i = 0; i < w.shapes().size(); ++i) {
        const SurfaceBinding& b = w.bindings()[size_t(w.bindingOf()[i])];
        if (bakesAt(w, b) && shading::hasGrid(*w.shapes()[i])) all.push_back(i);
    }
    return all;
}

bool bakesAllOrNone(const World& world, uint32_t shape) {
    const WorldImpl& w = implOf(world);
    const SurfaceBinding& b = w.bindings()[size_t(w.bindingOf()[shape])];
    bool varies = false;
    const auto look = [&](const BoundKernel& k) {
        return varies |= std::any_of(k.sites.begin(), k.sites.end(),
                                     [](const SiteInfo& s) { return s.cloud && s.cloud->writes && !s.cloud->steady; });
    };
    for (const BoundKernel* k : {&b.surfaceS, &b.surfaceV, &b.displacementS, &b.atmosphere.kernel}) look(*k);
    w.eachLight(b.lights, [&](int l) {
        for (const auto& [strings, k] : w.lights()[size_t(l)].variants) look(k);
        return look(w.lights()[size_t(l)].kernel);
    });
    return !varies;
}

bool bakingLightsRan(const World& world, uint32_t shape, std::span<const uint64_t> runs) {
    const WorldImpl& w = implOf(world);
    bool missing = false;
    w.eachLight(w.bindings()[size_t(w.bindingOf()[shape])].lights, [&](int l) {
        return missing |= bakesAt(w.lights()[size_t(l)].kernel) && (size_t(l) >= runs.size() || !runs[size_t(l)]);
    });
    return !missing;
}

void bakedPoints(const World& world, uint32_t shape, std::vector<shading::GridPoint>& to) {
    const WorldImpl& w = implOf(world);
    const size_t before = to.size();
    std::vector<Vec3> P;
    const geometry::Shape& s = *w.shapes()[shape];
    shading::gridOf(s, geometry::DiceCamera::from(w.frame().options), w.needs().bakesCentres, to, P);
    size_t kept = before;
    for (size_t i = before; i < to.size(); ++i) {
        to[i].shape = shape;
        const geometry::SurfacePoint at = s.evaluateHit(to[i].prim, to[i].b1, to[i].b2);
        if (w.accel().hasSolids() && !w.accel().keeps(shape, P[i - before], at.n, 0)) continue;
        setSize(to[i], at);
        to[kept++] = to[i];
    }
    to.resize(kept);
}

Vec3 placeOf(const World& world, const shading::GridPoint& p) {
    const geometry::SurfacePoint at = implOf(world).shapes()[p.shape]->evaluateHit(p.prim, p.b1, p.b2);
    return at.displaced ? at.displacedP : at.P;
}

bool bakedNow(const World& world) { return implOf(world).clouds().baked.pending(); }

void commitBakes(const World& world, bool keep) {
    pointcloud::BakeLog& log = implOf(world).clouds().baked;
    keep ? log.commit() : log.discard();
}

bool writeBakes(const World& world, bool allowWrite, const pointcloud::FileOwners& others, Diagnostics& d) {
    return implOf(world).clouds().baked.write({".", allowWrite}, d, others);
}

} // namespace alpenglow::world
