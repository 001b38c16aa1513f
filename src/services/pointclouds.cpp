// bake(), bake3d() and texture3d(): writes and reads point data files.
#include "services/cloudspace.h"
#include "shading/grids.h"
#include "world/cloudsite.h"
#include "world/information.h"

namespace alpenglow::services {

namespace {

/// Converts the numbers of a channel between spaces.
void turn(pointcloud::ChannelType type, const Matrix& m, float* v) {
    const Vec3d from(v[0], v[1], v[2]);
    Vec3 to;
    switch (type) {
    case pointcloud::ChannelType::Point:
        to = Vec3(transformPoint(m, from));
        break;
    case pointcloud::ChannelType::Vector:
        to = Vec3(transformVector(m, from));
        break;
    case pointcloud::ChannelType::Normal:
        to = Vec3(transformNormal(m, from));
        break;
    default:
        return;
    }
    for (int k = 0; k < 3; ++k) v[k] = to[k];
}
void turnMatrix(const Matrix& m, float* v) {
    Matrix of;
    for (int k = 0; k < 16; ++k) of.m[k / 4][k % 4] = double(v[k]);
    of = of * m;
    for (int k = 0; k < 16; ++k) v[k] = float(of.m[k / 4][k % 4]);
}

/// The ray of a lane's point; for a light, the ray that hit the lit surface. Null: none, or the point is not on a surface.
const shading::PathRay* rayOfLane(const ServiceCall& call, int lane, const ShadePoint& p) {
    const KernelRun& c = call.c;
    if (c.lightOutput || c.again || c.forShadow || c.between) return nullptr;
    if (c.light) return p.lit ? p.ray : nullptr;
    if (c.volume) return c.surface ? p.ray : nullptr;
    return c.rays.empty() || !c.binding ? nullptr : &c.rays[size_t(call.first + lane)];
}

/// A number that differs for lights of different shaders, but not for parts of a light.
uint32_t numberOf(const WorldImpl& world, const BoundLight& light) {
    const auto first = std::find_if(world.lights().begin(), world.lights().end(),
                                    [&](const BoundLight& l) { return &l == &light || (l.source && l.source == light.source); });
    return uint32_t(first - world.lights().begin()) + 1;
}

/// Whether the point of a lane bakes, and its position in the order of all. `light`: numberOf() one, 0: none.
bool keyOf(const shading::PathRay* r, const ShadePoint& p, bool centre, uint32_t light, pointcloud::BakeKey& key) {
    if (!r || !r->camera() || r->bounces > 0 || !r->sample) return false;
    const shading::GridPoint* g = r->sample->grid;
    if (g && !g->micropolygon) {
        if (r->layers > 0 || r->vertex != 0 || g->corner == centre) return false;
        key = {false, r->sample->py, r->sample->px, 0, light, r->sample->sample};
        return true;
    }
    if (light || r->sample->records || !p.shape || shading::hasGrid(*p.shape)) return false; // its grid has been shaded
    key = {true, r->sample->py, r->sample->px, r->layers, r->vertex, r->sample->sample};
    if (g) key.layers = int32_t(uint32_t(g->micropolygon >> 32)), key.vertex ^= uint32_t(g->micropolygon);
    return true;
}

/// Radius of the disk around a point, and the surface area that the point represents. Camera space.
std::pair<float, float> extentOf(const shading::PathRay& r, const ShadePoint& p) {
    if (r.sample->grid && !r.sample->grid->micropolygon) return {r.sample->grid->radius, r.sample->grid->area};
    const float edge = r.sample->grid ? float(geometry::diceEdge(p.shape->attributes())) : 1;
    const float half = edge * r.footprint.at(length(p.P - r.origin)); // of a micropolygon, or of a sample's pixel
    return {half * 1.41421356f, 4 * half * half};
}

bool isImager(const KernelRun& c) { return !c.binding && !c.light && !c.volume; }

void reportNotBaked(const ServiceCall& call) {
    if (!isImager(call.c)) return;
    call.diagnostics.reportOnce("bake:imager", {Severity::Warning,
                                                Rie::Unimplement,
                                                call.place(),
                                                call.d.op + "() has no effect in imager shaders",
                                                "surface, displacement, volume and light shaders bake",
                                                {}});
}

} // namespace

void answerBake(Services& answers, const ServiceCall& call) {
    const CloudSite& s = *call.s.cloud;
    const WorldImpl& world = answers.world();
    std::vector<float> row;
    CloudSpace space(answers, call, s.space, s.spaceRow);
    reportNotBaked(call);
    const uint32_t light = call.c.light ? numberOf(world, *call.c.light) : 0;
    call.each([&](int lane, const ShadePoint& p) {
        const std::string name = s.computed ? call.name(lane) : s.name;
        if (name.empty()) return;
        if (!s.layout.flat) call.put(0, lane, isImager(call.c) ? 0.f : 1.f);
        const bool centre = s.centres >= 0 && call.at(s.centres, lane) != 0;
        pointcloud::BakeKey key;
        const shading::PathRay* const ray = rayOfLane(call, lane, p);
        if (!keyOf(ray, p, centre, light, key)) return;
        row.clear();
        static const Matrix kSame;
        const Matrix& to = s.layout.flat ? kSame : space.at(lane, p);
        Vec3 normal(0.f);
        if (s.layout.flat) {
            row = {call.at(s.s, lane), call.at(s.t, lane)};
        } else {
            const Vec3 at(transformPoint(to, Vec3d(tripleAt(call, s.point, lane)))),
                n = normalTo(to, tripleAt(call, s.normal, lane));
            normal = unitOr0(tripleAt(call, s.normal, lane));
            const float grows = space.shear() ? std::sqrt(space.areaGrowth(normal)) : space.growth();
            const float radius = s.radius < 0 ? extentOf(*ray, p).first * grows : call.at(s.radius, lane);
            const float scale = s.scale < 0 ? 1 : call.at(s.scale, lane);
            row = {at.x, at.y, at.z, n.x, n.y, n.z, std::max(0.f, radius * scale)};
        }
        for (const CloudSite::Part& part : s.parts) {
            const size_t from = row.size();
            for (int k = 0; k < pointcloud::sizeOf(part.type); ++k) row.push_back(call.at(part.row + k, lane));
            if (s.layout.flat) continue;
            if (part.type == pointcloud::ChannelType::Matrix) turnMatrix(to, &row[from]);
            else turn(part.type, to, &row[from]);
        }
        if (!s.layout.flat && s.addsArea) row.push_back(extentOf(*ray, p).second * space.areaGrowth(normal));
        const bool kept = world.clouds().baked.add(name, s.layout, key, row);
        if (!s.layout.flat) call.put(0, lane, kept ? 1.f : 0.f);
    });
}

void answerTexture3d(Services& answers, const ServiceCall& call) {
    const CloudSite& s = *call.s.cloud;
    std::vector<float> found;
    CloudSpace space(answers, call, s.space, s.spaceRow);
    std::vector<std::pair<const pointcloud::CloudMap*, std::vector<int>>> places; // by map: index of the first of its channels
    call.each([&](int lane, const ShadePoint& p) {
        const pointcloud::CloudMap* map =
            answers.cloudOf(s.computed ? std::bit_cast<int32_t>(call.at(0, lane)) : call.s.nameId, call);
        if (!map) return;
        auto known = std::find_if(places.begin(), places.end(), [&](const auto& k) { return k.first == map; });
        if (known == places.end()) {
            known = places.insert(places.end(), {map, {}});
            for (const CloudSite::Part& part : s.parts) {
                const auto same = [&](const pointcloud::Channel& c) {
                    return c.name == part.name && pointcloud::sizeOf(c.type) == pointcloud::sizeOf(part.type);
                };
                const bool there = std::any_of(map->channels().begin(), map->channels().end(), same);
                known->second.push_back(there ? map->offsetOf(part.name) : -1);
                if (!there)
                    call.diagnostics.reportOnce("texture3d:" + call.name(lane) + ":" + part.name,
                                                {Severity::Warning,
                                                 Rie::MissingData,
                                                 call.place(),
                                                 "texture3d(): \"" + call.name(lane) + "\" has no channel \"" + part.name +
                                                     "\" of " + std::to_string(pointcloud::sizeOf(part.type)) +
                                                     " numbers; it is 0",
                                                 "alpenglow ptc info shows the contents of a file",
                                                 {}});
            }
        }
        const Matrix& to = space.at(lane, p);
        pointcloud::Query q;
        q.P = Vec3(transformPoint(to, Vec3d(tripleAt(call, s.point, lane))));
        q.N = normalTo(to, tripleAt(call, s.normal, lane));
        if (s.radius >= 0) q.radius = call.at(s.radius, lane);
        else
            for (const int step : {s.du, s.dv})
                q.radius = std::max(q.radius, length(Vec3(transformVector(to, Vec3d(tripleAt(call, step, lane))))) / 2);
        if (s.scale >= 0) q.radius *= call.at(s.scale, lane);
        if (s.maxDepth >= 0 && call.at(s.maxDepth, lane) >= 0) q.maxDepth = int(std::min(call.at(s.maxDepth, lane), 1e3f));
        if (!std::isfinite(dot(q.P, Vec3(1))) || !(q.radius >= 0)) return;
        q.radius = std::min(q.radius, 1e18f);
        found.assign(size_t(map->width()), 0.f);
        const bool there = map->lookup(q, found);
        answers.noteLookup(map, there, call);
        if (!there) return;
        for (size_t k = 0; k < s.parts.size(); ++k) {
            const int from = known->second[k], n = pointcloud::sizeOf(s.parts[k].type);
            if (from < 0) continue;
            pointcloud::ChannelType type = pointcloud::ChannelType::Float;
            for (const pointcloud::Channel& c : map->channels())
                if (c.name == s.parts[k].name) type = c.type;
            if (type == pointcloud::ChannelType::Matrix) turnMatrix(space.back(), &found[size_t(from)]);
            else if (type >= pointcloud::ChannelType::Point) turn(type, space.back(), &found[size_t(from)]);
            for (int i = 0; i < n; ++i) call.put(s.parts[k].row + i, lane, found[size_t(from + i)]);
        }
        call.put(0, lane, 1);
    });
}

} // namespace alpenglow::services
