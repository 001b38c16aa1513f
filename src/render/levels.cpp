#include "render/levels.h"
#include "geometry/instance_attributes.h"
#include "integrator/integrator.h"
#include "scene/scene.h"
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace alpenglow::render {
namespace {

constexpr float kUnlimited = 1e38f; // RI_INFINITY and similar values
constexpr double kInfinite = std::numeric_limits<double>::infinity();

struct Point {
    double x, y;
};
double turn(Point a, Point b, Point c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }

/// Area of the convex hull (monotone chain).
double hullArea(std::vector<Point> p) {
    std::sort(p.begin(), p.end(), [](Point a, Point b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
    std::vector<Point> hull;
    for (int side = 0; side < 2; ++side) {
        const size_t first = hull.size();
        for (Point q : p) {
            while (hull.size() >= first + 2 && turn(hull[hull.size() - 2], hull.back(), q) <= 0) hull.pop_back();
            hull.push_back(q);
        }
        hull.pop_back(); // the other chain starts there
        std::reverse(p.begin(), p.end());
    }
    double twice = 0;
    for (size_t i = 0; i < hull.size(); ++i) {
        const Point a = hull[i], b = hull[(i + 1) % hull.size()];
        twice += a.x * b.y - a.y * b.x;
    }
    return std::fabs(twice) / 2;
}

bool ranged(const scene::Attributes& a) {
    return a.detailRange[0] > 0 || a.detailRange[1] > 0 || a.detailRange[2] < kUnlimited || a.detailRange[3] < kUnlimited;
}

class Levels {
public:
    Levels(const scene::Frame& f, const Camera& camera) : frame_(f), camera_(camera) {}

    /// The attributes of a drawn primitive: null if not drawn, modified if it fades.
    scene::AttributesRef drawn(const scene::AttributesRef& a) {
        if (!a || !ranged(*a)) return a;
        auto [known, fresh] = known_.try_emplace(a.get());
        if (fresh) {
            kept_.push_back(a); // keeps the address unique
            const double size =
                a->detail ? detailSize(*a->detail, a->detailSpace, camera_) * double(frame_.options.relativeDetail) : kInfinite;
            const float* r = a->detailRange;
            const bool unlimited = r[3] >= kUnlimited;
            // Every sample has a number from 0 to 1 and sees the levels whose interval contains it: in a transition one level
            // ends where the next begins.
            const auto within = [&](double from, double to) {
                return to > from ? std::clamp((size - from) / (to - from), 0., 1.) : size >= from ? 1. : 0.;
            };
            const double begin = 1 - within(r[0], r[1]), end = unlimited ? 1 : 1 - within(r[2], r[3]);
            if (begin <= 0 && end >= 1) {
                known->second = a;
            } else if (begin < end) {
                auto fading = std::make_shared<scene::Attributes>(*a);
                fading->level = {float(begin), float(end)};
                known->second = std::move(fading);
            }
        }
        return known->second;
    }

private:
    const scene::Frame& frame_;
    const Camera& camera_;
    std::map<const scene::Attributes*, scene::AttributesRef> known_;
    std::vector<scene::AttributesRef> kept_;
};

} // namespace

double detailSize(const std::vector<float>& bound, const Matrix& toWorld, const Camera& camera) {
    const Matrix m = toWorld * camera.worldToNDC();
    std::vector<Point> corners;
    for (int k = 0; k < 8; ++k) {
        const double p[4] = {bound[k & 1 ? 1 : 0], bound[k & 2 ? 3 : 2], bound[k & 4 ? 5 : 4], 1};
        double q[4] = {};
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < 4; ++j) q[j] += p[i] * m.m[i][j];
        if (!(q[3] > 0)) return kInfinite;
        corners.push_back({q[0] / q[3] * camera.width(), q[1] / q[3] * camera.height()});
    }
    return hullArea(std::move(corners));
}

std::shared_ptr<const scene::Frame> drawnLevels(std::shared_ptr<const scene::Frame> frame, const Camera& camera) {
    Levels levels(*frame, camera);
    std::shared_ptr<scene::Frame> out; // made when a primitive is left out
    auto changed = [&]() -> scene::Frame& {
        if (!out) out = std::make_shared<scene::Frame>(*frame);
        return *out;
    };
    // Removes what is not drawn from a list, and marks what fades; `of` returns the attributes that apply.
    const auto draw = [&](std::vector<scene::PrimitiveRef>& list, auto&& of) {
        bool differs = false;
        for (scene::PrimitiveRef& p : list) {
            if (!p) continue;
            const scene::AttributesRef before = of(*p), after = levels.drawn(before);
            if (after == before) continue;
            differs = true;
            std::shared_ptr<scene::Primitive> other;
            if (after) {
                other = std::make_shared<scene::Primitive>(*p);
                auto marked = std::make_shared<scene::Attributes>(*p->attributes); // an instance combines its own with them
                marked->level = after->level;
                other->attributesBefore = p->attributesInside ? p->attributesBefore : p->attributes;
                other->attributesInside = true;
                other->attributes = std::move(marked);
            }
            p = std::move(other);
        }
        if (differs) std::erase(list, nullptr);
        return differs;
    };
    std::vector<scene::PrimitiveRef> primitives = frame->primitives;
    if (draw(primitives, [](const scene::Primitive& p) { return p.attributes; })) changed().primitives = std::move(primitives);
    std::vector<char> ranges; // by object: whether one of its primitives has a range of its own
    for (const scene::Object& o : frame->objects)
        ranges.push_back(std::any_of(o.primitives.begin(), o.primitives.end(),
                                     [](const scene::PrimitiveRef& p) { return p && p->attributes && ranged(*p->attributes); }));
    for (size_t i = 0; i < frame->instances.size(); ++i) {
        const scene::Instance& instance = frame->instances[i];
        if (instance.object < 0 || size_t(instance.object) >= frame->objects.size()) continue; // reported when shapes are made
        if (!ranges[size_t(instance.object)] && !(instance.attributes && ranged(*instance.attributes))) continue;
        const scene::Object& object = frame->objects[size_t(instance.object)];
        std::vector<scene::PrimitiveRef> drawn = object.primitives;
        if (!draw(drawn, [&](const scene::Primitive& p) { return geometry::instanceAttributes(p, instance); })) continue;
        scene::Frame& f = changed();
        f.instances[i].object = int(f.objects.size());
        f.objects.push_back({object.handle, std::move(drawn)});
    }
    return out ? out : frame;
}

} // namespace alpenglow::render
