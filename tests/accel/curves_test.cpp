// Rays against curves in the tree: what leaves pieces out overlooks none, and the shorter way to the nearest point changes no
// bit.
#include "../geometry/make.h"
#include "accel/impl.h"
#include "geometry/curves.h"
#include "scene/scene.h"
#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace curve_rays_test {

using namespace alpenglow;
using namespace alpenglow::geometry;
using namespace alpenglow::geometry::test;
using accel::Accel;
using accel::Hit;
using accel::Ray;

namespace {

using Rng = std::mt19937;
double uniform(Rng& r, double lo, double hi) { return lo + (hi - lo) * (r() / 4294967296.0); }
Vec3d within(Rng& r, double size) {
    const double x = uniform(r, -size, size), y = uniform(r, -size, size), z = uniform(r, -size, size);
    return {x, y, z};
}

struct Kind {
    const char *type, *wrap;
    bool round, normals;
};
constexpr Kind kKinds[] = {{"cubic", "nonperiodic", true, false},
                           {"linear", "nonperiodic", true, false},
                           {"cubic", "periodic", false, false},
                           {"linear", "nonperiodic", false, false},
                           {"cubic", "nonperiodic", false, true}};

/// Forty curves of widths that change, some of them bent within their width.
std::shared_ptr<scene::Primitive> tangle(Rng& rng, const Kind& kind) {
    auto p = std::make_shared<scene::Primitive>();
    p->kind = "Curves";
    p->strings = {kind.type, kind.wrap};
    std::vector<float> P, N, widths;
    for (int c = 0; c < 40; ++c) {
        p->ints.push_back(6);
        Vec3d at = within(rng, 1);
        for (int k = 0; k < 6; ++k) {
            for (const double x : {at.x, at.y, at.z}) P.push_back(float(x));
            for (int i = 0; i < 3; ++i) N.push_back(float(uniform(rng, -1, 1)));
            widths.push_back(float(std::exp(uniform(rng, -6, -2))));
            at = at + within(rng, c % 4 ? 0.3 : 0.03);
        }
    }
    p->params = {points(P), param("width", scene::Class::Vertex, scene::Type::Float, widths)};
    if (kind.normals) p->params.push_back(param("N", scene::Class::Vertex, scene::Type::Normal, N));
    scene::Attributes a;
    scene::Param round = param("roundcurve", scene::Class::Constant, scene::Type::Float, {kind.round ? 1.f : 0.f});
    a.values["dice:roundcurve"] = round;
    const double catmull[16] = {-.5, 1.5, -1.5, .5, 1, -2.5, 2, -.5, -.5, 0, .5, 0, 0, 1, 0, 0};
    for (int i = 0; i < 16; ++i) a.vbasis.m[i / 4][i % 4] = catmull[i];
    a.vbasis.step = 1;
    p->attributes = std::make_shared<scene::Attributes>(a);
    return p;
}

/// Every primitive of every shape, by the tree's rule.
Hit slowly(const Accel::Impl& in, const Ray& r) {
    accel::Query q{&r, {INFINITY, accel::kNone, accel::kNone, 0, 0}, false};
    for (uint32_t s = 0; s < in.shapes.size(); ++s) {
        const Placed* p = in.shapes[s]->placed();
        Affine to;
        if (p) EXPECT_TRUE(p->toGeometry(r.time, to));
        const Accel::Impl::Inside at{p ? &in.geometryAt(s) : nullptr, p, s, to.point(Vec3d(r.org)), to.vector(Vec3d(r.dir))};
        for (uint32_t k = 0, n = p ? p->geometry()->exactPrims() : in.shapes[s]->exactPrims(); k < n; ++k)
            if (p) in.intersectInside(q, at, k);
            else in.intersectExact(q, s, k);
    }
    return {float(q.best.t), q.best.shape, q.best.prim, r.time, q.best.b1, q.best.b2, q.best.t};
}

CurveSegment segment(Rng& rng) {
    CurveSegment g;
    const double bend = std::exp(uniform(rng, -7, 0.5)), radius = std::exp(uniform(rng, -7, 0));
    const Vec3d along = normalize(within(rng, 1)), at = within(rng, 1);
    for (int k = 0; k < 4; ++k) {
        g.p[k] = at + along * (k / 3.) + within(rng, bend);
        g.h[k] = radius * uniform(rng, 0.7, 1);
    }
    g.axis = Vec3d(1, 0, 0);
    return g;
}

} // namespace

/// One cubic segment of Bezier points.
static ShapeRef bent(const Vec3d (&points4)[4], float width) {
    auto p = std::make_shared<scene::Primitive>();
    p->kind = "Curves";
    p->strings = {"cubic", "nonperiodic"};
    p->ints = {4};
    std::vector<float> P;
    for (const Vec3d& q : points4) P.insert(P.end(), {float(q.x), float(q.y), float(q.z)});
    p->params = {points(P), param("constantwidth", scene::Class::Constant, scene::Type::Float, {width})};
    Diagnostics diag;
    return build(p, Matrix(), diag); // the basis is Bezier's unless another is named
}

TEST(CurveRays, CapsulesHoldTheMiddleAndTheWidth) {
    Rng rng(6);
    for (int turn = 0; turn < 300; ++turn) {
        Vec3d p[4];
        for (Vec3d& q : p) q = within(rng, turn % 3 ? 1 : 0.1) + Vec3d(0, 0, double(&q - p));
        const float width = float(std::exp(uniform(rng, -7, -1)));
        const ShapeRef s = bent(p, width);
        const auto* in = dynamic_cast<const InCapsules*>(s.get());
        ASSERT_NE(in, nullptr);
        const uint32_t parts = s->exactPrims();
        for (uint32_t k = 0; k < parts; ++k) {
            Capsule c;
            ASSERT_TRUE(in->capsule(k, c));
            const Vec3d a(c.a), e(c.along);
            for (int i = 0; i <= 32; ++i) {
                const double f = (k + i / 32.) / parts, g = 1 - f;
                const Vec3d at = p[0] * (g * g * g) + p[1] * (3 * g * g * f) + p[2] * (3 * g * f * f) + p[3] * (f * f * f);
                const double along = std::clamp(dot(at - a, e) / dot(e, e), 0.0, 1.0);
                ASSERT_LE(length(at - a - e * along) + 0.5 * double(width), double(c.radius) * (1 + 1e-6)) << turn << " " << k;
            }
        }
    }
}

TEST(CurveRays, CapsulesAreClose) {
    // Both inner points are .4 off the chord: the middle is off it by up to 3/4 of that, so half of this on either side.
    const Vec3d p[4] = {{0, 0, 0}, {1. / 3, 0.4, 0}, {2. / 3, 0.4, 0}, {1, 0, 0}};
    const ShapeRef s = bent(p, 0.5f);
    ASSERT_EQ(s->exactPrims(), 1u);
    Capsule c;
    ASSERT_TRUE(dynamic_cast<const InCapsules&>(*s).capsule(0, c));
    EXPECT_NEAR(double(c.radius), 0.25 + 0.15, 1e-5);
    EXPECT_NEAR(double(c.a.y), 0.15, 1e-6);
}

TEST(CurveRays, TheTreeOverlooksNone) {
    size_t met = 0;
    for (const Kind& kind : kKinds)
        for (const bool placed : {false, true}) {
            Rng rng(4);
            scene::Frame f;
            f.options.hider = "path"; // others turn each to the eye
            f.objects.push_back({"tangle", {tangle(rng, kind)}});
            for (int i = 0; i < 2; ++i) {
                scene::Instance inst;
                inst.object = 0;
                inst.attributes = f.objects[0].primitives[0]->attributes;
                inst.toWorld = scene::Transform(i ? skewed() : translateMatrix(300, 20, 7));
                f.instances.push_back(inst);
            }
            Diagnostics diag;
            Accel::Impl in;
            in.shapes = buildShapes(f, diag, {.shareFrom = placed ? 0 : size_t(1) << 30});
            ASSERT_EQ(in.shapes.size(), 2u);
            ASSERT_EQ(in.shapes[0]->placed() != nullptr, placed);
            in.visibility.assign(2, accel::kAll);
            in.readyPlaced();
            in.buildTree();
            ASSERT_EQ(placed, in.tree.capsules() == nullptr);
            std::vector<Ray> rays(1000);
            for (size_t i = 0; i < rays.size(); ++i) {
                const Vec3d aim = transformPoint(i % 2 ? skewed() : translateMatrix(300, 20, 7), within(rng, 1));
                rays[i].org = Vec3(aim + within(rng, i % 3 ? 1 : 20));
                rays[i].dir = (Vec3(aim) - rays[i].org) * float(std::exp(uniform(rng, -3, 3)));
            }
            std::vector<Hit> hits(rays.size());
            std::vector<uint8_t> any(rays.size());
            in.walkNearest(rays, hits);
            in.walkAny(rays, any);
            for (size_t i = 0; i < rays.size(); ++i) {
                const Hit slow = slowly(in, rays[i]);
                ASSERT_EQ(slow.shape, hits[i].shape) << kind.type << kind.round << placed << " " << i;
                ASSERT_EQ(any[i] != 0, slow.valid());
                if (!slow.valid()) continue;
                ++met;
                ASSERT_EQ(slow.prim, hits[i].prim);
                ASSERT_EQ(slow.distance, hits[i].distance);
                ASSERT_EQ(slow.b1, hits[i].b1);
                ASSERT_EQ(slow.b2, hits[i].b2);
            }
        }
    EXPECT_GT(met, 1500u);
}

TEST(CurveRays, TheNearestIsTheFirstOfAll) {
    Rng rng(6);
    size_t met = 0;
    for (int i = 0; i < 60000; ++i) {
        const CurveSegment g = segment(rng);
        const double f = uniform(rng, 0, 1);
        const Vec3d aim = curveAt(g, f).f + within(rng, g.widest());
        Vec3d d = within(rng, 1);
        if (i % 4 == 0) d = normalize(curveAt(g, f).d) + d * std::exp(uniform(rng, -6, 0)); // along it
        const double lo = i % 3 ? 0 : uniform(rng, -1, 1), hi = i % 5 ? 1e38 : uniform(rng, 0, 2);
        const CurveRay ray(aim - d * uniform(rng, 0, 2), d, g.p[1], lo, hi);
        CurveHit all[6], nearest[6], plain[6];
        const int n = intersectTube(g, 0, 1, ray, all), few = intersectTube(g, 0, 1, ray, nearest, true),
                  same = intersectTube(g, 0, 1, ray, plain, true, true);
        const auto before = [](const CurveHit& a, const CurveHit& b) { return a.t < b.t; };
        ASSERT_EQ(n > 0, few > 0) << i;
        ASSERT_EQ(few, same) << i;
        for (int k = 0; k < few; ++k) {
            ASSERT_EQ(nearest[k].t, plain[k].t) << i;
            ASSERT_EQ(nearest[k].f, plain[k].f) << i;
        }
        if (!n) continue;
        ++met;
        ASSERT_EQ(std::min_element(all, all + n, before)->t, std::min_element(nearest, nearest + few, before)->t) << i;
    }
    EXPECT_GT(met, 20000u);
}

} // namespace curve_rays_test
