// occlusion(), indirectdiffuse() and subsurface() from point clouds, without rays.
#include "bsdf/dipole.h"
#include "services/cloudspace.h"
#include "texture/lookup.h"
#include "world/pointsite.h"
#include <algorithm>

namespace alpenglow::services {

namespace {

/// The clouds that a lane names, valid until the next call.
void cloudsOf(Services& answers, const ServiceCall& call, int lane, bool light, const std::optional<pointcloud::Shear>& shear,
              std::vector<const pointcloud::PointOctree*>& to) {
    const PointSite& s = *call.s.points;
    to.clear();
    answers.trimOctrees();
    const auto add = [&](int32_t id) {
        if (const pointcloud::PointOctree* o = answers.octreeOf(id, light, shear, call)) to.push_back(o);
    };
    for (const int32_t id : s.names) add(id);
    for (const int row : s.nameRows) add(std::bit_cast<int32_t>(call.at(row, lane)));
    if (s.names.empty() && s.nameRows.empty())
        call.diagnostics.reportOnce("points:" + std::to_string(call.site) + call.place().file,
                                    {Severity::Error,
                                     Rie::MissingData,
                                     call.place(),
                                     call.d.op + "() with \"pointbased\" needs the name of a point cloud; it returns 0",
                                     "set \"filename\" or \"filenames\"",
                                     {}});
}

/// Makes a query in the space of the clouds. `scale`: of lengths there relative to current space. Returns false for invalid
/// arguments.
bool queryOf(const ServiceCall& call, int lane, const ShadePoint& p, const Matrix& to, float scale,
             pointcloud::HemisphereQuery& q) {
    const PointSite& s = *call.s.points;
    const auto number = [&](int row, float fallback) { return row < 0 ? fallback : call.at(row, lane); };
    q.P = Vec3(transformPoint(to, Vec3d(tripleAt(call, s.point, lane))));
    q.N = normalTo(to, tripleAt(call, s.normal, lane));
    if (!(dot(q.N, q.N) > 0)) q.N = normalTo(to, p.surface.n);
    if (!(dot(q.N, q.N) > 0) || !std::isfinite(dot(q.P, Vec3(1)))) return false;
    q.cone = number(s.cone, 1.57079633f);
    if (!(q.cone >= 0)) q.cone = 0;
    if (s.axis >= 0) q.axis = unitOr0(Vec3(transformVector(to, Vec3d(tripleAt(call, s.axis, lane)))));
    const float far = std::min(number(s.maxDistance, 1e38f), number(s.maxHit, 1e38f));
    q.maxDistance = far >= 0 && far < 1e30f ? far * scale : 1e38f;
    q.bias = std::max(0.f, number(s.bias, 0)) * scale;
    q.maxSolidAngle = number(s.solidAngle, .1f);
    if (!(q.maxSolidAngle > 0)) q.maxSolidAngle = 1e-6f;
    q.clamp = number(s.clamp, 1) != 0;
    q.sort = number(s.sort, 0) != 0;
    q.polynomial = number(s.fade.mode, 0) != 0;
    q.fall = std::max(0.f, number(s.fade.strength, 0));
    if (!q.polynomial) q.fall /= scale;
    q.sides = s.sidesRow < 0 ? s.sides : diskSides(rsl::internedString(std::bit_cast<int32_t>(call.at(s.sidesRow, lane))));
    q.uniform = s.uniform;
    q.colours = !s.blocks;
    return true;
}

void put(const ServiceCall& call, int row, int lane, const Color& c) {
    for (int k = 0; k < 3 && row >= 0; ++k) call.put(row + k, lane, c[k]);
}

/// Light from unoccluded directions: by the environment map; also the mean open direction.
Color between(Services& answers, const PointSite& s, const pointcloud::Hemisphere& h, const Matrix& back, Vec3& towards) {
    Color map(0);
    towards = Vec3(0.f);
    texture::LookupOptions colours;
    colours.asLight = true;
    h.eachOpen([&](const Vec3& d, float part) {
        const Vec3 w = unitOr0(Vec3(transformVector(back, Vec3d(d))));
        towards += w * part;
        if (!s.map) return;
        const Vec3 at = unitOr0(Vec3(transformVector(s.toMap, Vec3d(w))));
        const Vec3 u = unitOr0(cross(at, std::fabs(at.x) < .9f ? Vec3(1, 0, 0) : Vec3(0, 1, 0))), v = cross(at, u);
        float c[3] = {};
        texture::environment(s.map, answers.world().textures().latLong(), 0, 3, at, u * h.spread(), v * h.spread(), colours, c);
        map += Color(c[0], c[1], c[2]) * part;
    });
    return map;
}

} // namespace

void answerPointHemisphere(Services& answers, const ServiceCall& call) {
    const PointSite& s = *call.s.points;
    pointcloud::Hemisphere& h = answers.hemisphere();
    CloudSpace space(answers, call, s.space, s.spaceRow, true);
    std::vector<const pointcloud::PointOctree*> from;
    call.each([&](int lane, const ShadePoint& p) {
        const Matrix& to = space.at(lane, p);
        cloudsOf(answers, call, lane, !s.blocks, space.shear(), from);
        pointcloud::HemisphereQuery q;
        if (!queryOf(call, lane, p, to, space.growth(), q)) return;
        h.begin(q);
        for (const pointcloud::PointOctree* o : from) h.add(*o);
        h.finish();
        Color light = h.light();
        if (s.map || s.environment >= 0 || s.openTowards >= 0) {
            Vec3 towards;
            const Color map = between(answers, s, h, space.back(), towards);
            light += map;
            put(call, s.environment, lane, map);
            put(call, s.openTowards, lane, unitOr0(towards));
        }
        if (s.blocked >= 0) call.put(s.blocked, lane, h.blocked());
        if (s.value < 0) return;
        if (!s.blocks) put(call, s.value, lane, light);
        else if (call.d.resultKinds[0] == rsl::ir::Kind::Triple) put(call, s.value, lane, Color(h.blocked()));
        else call.put(s.value, lane, h.blocked());
    });
}

/// By Jensen and Buhler, A Rapid Hierarchical Rendering Technique for Translucent Materials (2002).
void answerPointSubsurface(Services& answers, const ServiceCall& call) {
    const PointSite& s = *call.s.points;
    SubsurfaceSite site = s.subsurface;
    if (site.model == SubsurfaceSite::Model::Walk) site.model = SubsurfaceSite::Model::Dipole;
    const bool better = site.model == SubsurfaceSite::Model::BetterDipole;
    std::vector<const pointcloud::PointOctree*> from;
    CloudSpace space(answers, call, s.space, s.spaceRow, true);
    call.each([&](int lane, const ShadePoint& p) {
        if (!p.shape) return;
        const Matrix& to = space.at(lane, p);
        cloudsOf(answers, call, lane, true, space.shear(), from);
        const double scale = double(space.growth()); // lengths of the file
        const Vec3 at(transformPoint(to, Vec3d(tripleAt(call, s.point, lane))));
        if (!std::isfinite(dot(at, Vec3(1))) || !(scale > 0)) return;
        const SubsurfaceMedium b = subsurfaceMediumOf(
            site, SubsurfaceValues(p.shape->attributes()), [&](int row) { return call.at(row, lane); },
            answers.albedoInversions());
        std::vector<Dipole> dipoles;
        for (int k = 0; k < 3; ++k)
            dipoles.emplace_back(answers.albedoInversions().of(b.index), better, double(b.absorption[k]),
                                 std::max(double(b.scattering[k]), 1e-12));
        const float most = s.solidAngle < 0 ? .1f : call.at(s.solidAngle, lane);
        double sum[3] = {};
        for (const pointcloud::PointOctree* o : from)
            o->each(at, most > 0 ? most : 1e-6f, [&](double distance, const Color& power, double radius) {
                const double d = distance / scale, r = radius / scale;
                for (int k = 0; k < 3; ++k)
                    if (power[k] != 0 && b.scattering[k] > 0)
                        sum[k] += double(power[k]) / (scale * scale) *
                                  (d > 4 * r ? dipoles[size_t(k)].at(d) : dipoles[size_t(k)].over(d, r));
            });
        put(call, s.value, lane, Color(float(sum[0]), float(sum[1]), float(sum[2])));
    });
}

} // namespace alpenglow::services
