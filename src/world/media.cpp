// Interior and Exterior (RISpec 3.2): which volume a ray is in. A ray that continues on the side that N points away from is in
// the Interior of the primitive; on the other side it is in the Exterior. A surface with neither bounds no volume.
#include "world/mediaabout.h"
#include <algorithm>

namespace alpenglow::world {

using shading::Media;

Media SurfaceBinding::beyond(const Media& from, const Vec3& n, const Vec3& in, const Vec3& to) const {
    Media m = from;
    if (inside < 0 && outside < 0) return m;
    const bool fromInside = dot(in, n) > 0, toInside = dot(to, n) < 0;
    if (toInside) {
        const bool below = m.topPriority() > insidePriority && m.has(inside); // another medium overrides it
        if (!fromInside) m.push(inside, insidePriority);
        else if (inside >= 0 && m.top() != inside && !below) m.push(inside, insidePriority); // the ray started inside
        return m;
    }
    if (fromInside) m.leave(inside);
    if (outside < 0 || m.top() == outside) return m;
    if (m.count) --m.count; // replaces the known medium there
    m.push(outside, outsidePriority);
    return m;
}

void MutableWorld::findEye() { eye_ = mediaAbout(*this, Vec3(0, 0, 0), 0); }

Media mediaAbout(const WorldImpl& world, const Vec3& at, float time) {
    Media about;
    if (world.media().empty()) return about;
    // A point is inside a medium if rays in both directions leave it without having entered. Two opposite directions tell a
    // closed surface from one seen from behind; the line is along no axis, so it rarely hits an edge.
    std::vector<int> left[2]; // bindings, innermost first
    for (int side = 0; side < 2; ++side) {
        accel::Ray ray;
        ray.org = at;
        ray.time = time;
        ray.dir = normalize(Vec3(0.2617f, 0.3471f, 0.9006f)) * (side ? -1.f : 1.f);
        ray.sides = accel::Sides::Both;
        std::vector<int> entered;
        for (int layer = 0; layer < limits::kShadowLayers; ++layer) {
            accel::Hit h;
            if (!world.accel().intersect(ray, h)) break;
            world.goOn(ray, h);
            const int binding = world.bindingOf()[h.shape];
            const int medium = world.bindings()[size_t(binding)].inside;
            if (medium < 0) continue;
            if (dot(world.accel().point(h).n, ray.dir) < 0) entered.push_back(medium);
            else if (const auto i = std::find(entered.rbegin(), entered.rend(), medium); i != entered.rend())
                entered.erase(std::next(i).base());
            else left[side].push_back(medium);
        }
    }
    for (size_t i = left[0].size(); i-- > 0;)
        if (std::find(left[1].begin(), left[1].end(), left[0][i]) != left[1].end())
            about.push(left[0][i], world.media()[size_t(left[0][i])].priority);
    return about;
}

} // namespace alpenglow::world
