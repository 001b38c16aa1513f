// Shapes that are placed: instances that share a geometry against copies of it, and motion against closed forms.
#include "accel/accel.h"
#include "accel/impl.h"
#include "geometry/build.h"
#include "geometry/dice.h"
#include "geometry/placed.h"
#include "scene/scene.h"
#include <gtest/gtest.h>
#include <random>

namespace placed_test {

using namespace alpenglow;
using namespace alpenglow::geometry;
using accel::Accel;
using accel::Hit;
using accel::Ray;

namespace {

scene::Param variable(const char* name, scene::Class c, scene::Type t, std::vector<float> v) {
    scene::Param p;
    p.name = name;
    p.cls = c;
    p.type = t;
    p.numbers = std::move(v);
    return p;
}

/// A bumpy ball of quadrilaterals, with variables of all types that turn. normals: "N" along P times this; 0: they lie anyhow.
std::shared_ptr<scene::Primitive> ball(int n, float normals = 0) {
    auto p = std::make_shared<scene::Primitive>();
    p->kind = "PointsPolygons";
    std::vector<float> P, V, N;
    std::mt19937 rng(7);
    std::uniform_real_distribution<float> bump(0.9f, 1.1f);
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i < 2 * n; ++i) {
            const double theta = kPi * j / n, phi = kPi * i / n, r = bump(rng);
            P.insert(P.end(), {float(r * std::sin(theta) * std::cos(phi)), float(r * std::sin(theta) * std::sin(phi)),
                               float(r * std::cos(theta))});
            V.insert(V.end(), {bump(rng), bump(rng), bump(rng)});
        }
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < 2 * n; ++i) {
            const int k = (i + 1) % (2 * n);
            p->ints.push_back(4);
            p->ints2.insert(p->ints2.end(), {j * 2 * n + i, j * 2 * n + k, (j + 1) * 2 * n + k, (j + 1) * 2 * n + i});
        }
    for (const float x : P) N.push_back(normals * x);
    using scene::Class;
    using scene::Type;
    p->params = {variable("P", Class::Vertex, Type::Point, P), variable("N", Class::Vertex, Type::Normal, normals == 0 ? V : N),
                 variable("way", Class::Varying, Type::Vector, V), variable("spot", Class::Varying, Type::Point, V),
                 variable("facing", Class::Varying, Type::Normal, V)};
    p->attributes = std::make_shared<scene::Attributes>();
    return p;
}

struct World {
    std::vector<ShapeRef> shapes;
    std::unique_ptr<Accel> accel;
    Diagnostics diag;
    World(const scene::Frame& f, size_t shareFrom) {
        shapes = buildShapes(f, diag, {.shareFrom = shareFrom});
        diceShapes(shapes, DiceOptions{.camera = DiceCamera::from(f.options)}, diag);
        accel = std::make_unique<Accel>(shapes, std::vector<uint32_t>{}, diag);
    }
};

scene::Frame manyBalls(int sides, float normals) {
    scene::Frame f;
    f.objects.push_back({"ball", {ball(12, normals)}});
    std::mt19937 rng(3);
    std::uniform_real_distribution<double> u(-1, 1);
    auto a = std::make_shared<scene::Attributes>();
    a->sides = sides;
    for (int i = 0; i < 40; ++i) {
        scene::Instance inst;
        inst.object = 0;
        inst.attributes = a;
        const Matrix m = scaleMatrix(1 + 0.5 * u(rng), i % 3 == 0 ? -1 : 1, 1) * rotateMatrix(180 * u(rng), u(rng), u(rng), 1) *
                         translateMatrix(6 * u(rng), 6 * u(rng), 20 + 6 * u(rng));
        inst.toWorld = scene::Transform(m);
        f.instances.push_back(inst);
    }
    return f;
}

std::vector<Ray> rays(int n, float time = 0) {
    std::mt19937 rng(11);
    std::uniform_real_distribution<float> u(-1, 1);
    std::vector<Ray> r(static_cast<size_t>(n));
    for (Ray& x : r) {
        x.org = Vec3(8 * u(rng), 8 * u(rng), 20 + 8 * u(rng));
        x.dir = Vec3(u(rng), u(rng), u(rng));
        x.time = time;
    }
    return r;
}

void expectNear(const Vec3& a, const Vec3& b, float room, const char* what) {
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(a[k], b[k], room) << what;
}

} // namespace

// The vertices of copies are rounded once in camera space, those of instances once in the space that they share: coordinates up
// to 30 and sizes of about 1 make that 30 * 2^-24 * 2, and a facet of size 0.2 turns by ten times that.
TEST(Placed, InstancesAreCopies) {
    const std::pair<int, float> cases[] = {{2, 0.f}, {1, 0.f}, {1, 1.f}, {1, -1.f}};
    for (const auto& [sides, normals] : cases) {
        const scene::Frame f = manyBalls(sides, normals);
        World copies(f, SIZE_MAX), shared(f, 0);
        ASSERT_EQ(copies.shapes.size(), 40u);
        ASSERT_EQ(shared.shapes.size(), 40u);
        ASSERT_NE(shared.shapes[1]->placed(), nullptr);
        EXPECT_EQ(copies.shapes[1]->placed(), nullptr);
        EXPECT_EQ(shared.shapes[0]->placed()->geometry(), shared.shapes[39]->placed()->geometry());
        const auto r = rays(20000);
        std::vector<Hit> a(r.size()), b(r.size());
        copies.accel->intersect(r, a);
        shared.accel->intersect(r, b);
        std::vector<uint8_t> met(r.size());
        shared.accel->occluded(r, met);
        size_t differ = 0, hits = 0, against = 0;
        for (size_t i = 0; i < r.size(); ++i) {
            EXPECT_EQ(met[i] != 0, b[i].valid());
            if (a[i].valid() != b[i].valid() || a[i].shape != b[i].shape || a[i].prim != b[i].prim) {
                ++differ;
                continue;
            }
            if (!a[i].valid()) continue;
            ++hits;
            const SurfacePoint p = copies.accel->point(a[i]), q = shared.accel->point(b[i]);
            expectNear(p.P, q.P, 1e-4f, "P");
            expectNear(p.n, q.n, 1e-3f, "n");
            expectNear(p.N, q.N, 1e-4f, "N");
            EXPECT_EQ(p.orientation, q.orientation);
            against += dot(p.n, p.N) < 0;
            EXPECT_NEAR(p.u, q.u, 1e-4f);
            expectNear(normalize(p.Ng), normalize(q.Ng), 1e-3f, "Ng");
            const float size = 1 + length(p.dPdu) + length(p.dPdv);
            if (size < 30) {
                expectNear(p.dPdu, q.dPdu, 2e-3f * size * size, "dPdu");
                expectNear(p.dPdv, q.dPdv, 2e-3f * size * size, "dPdv");
            }
            for (const char* name : {"way", "spot", "facing"}) {
                float x[3], y[3];
                const ShapeRef &s = copies.shapes[a[i].shape], &t = shared.shapes[b[i].shape];
                s->interpolate(s->findPrimvar(name), p, x, nullptr, nullptr);
                t->interpolate(t->findPrimvar(name), q, y, nullptr, nullptr);
                expectNear(Vec3(x[0], x[1], x[2]), Vec3(y[0], y[1], y[2]), 2e-4f, name);
            }
        }
        EXPECT_GT(hits, 3000u);
        EXPECT_LE(differ, r.size() / 1000); // rays through edges
        // Given normals say which side is the front; some bumps lean.
        if (normals != 0) EXPECT_LE(against, hits / 50);
    }
}

// A quadric that moves: where it is at the time of the ray, met exactly.
TEST(Placed, MovingSphere) {
    scene::Frame f;
    f.options.shutterOpen = 1;
    f.options.shutterClose = 3;
    auto p = std::make_shared<scene::Primitive>();
    p->kind = "Sphere";
    p->numbers = {1, -1, 1, 360};
    p->attributes = std::make_shared<scene::Attributes>();
    p->toWorld.times = {0, 2, 4}; // at 1: x = 1; at 2: 2; at 3: 2 and y = 1
    p->toWorld.keys = {translateMatrix(0, 0, 5), translateMatrix(2, 0, 5), translateMatrix(2, 2, 5)};
    f.primitives = {p};
    World w(f, 0);
    ASSERT_EQ(w.shapes.size(), 1u);
    for (float t : {0.f, .25f, .5f, .75f, 1.f}) {
        const double x = t < .5f ? 1 + 2 * t : 2, y = t < .5f ? 0 : 2 * t - 1;
        Ray r;
        r.org = Vec3(float(x + 0.3), float(y - 0.2), 0);
        r.dir = Vec3(0, 0, 1);
        r.time = t;
        Hit h;
        ASSERT_TRUE(w.accel->intersect(r, h));
        EXPECT_NEAR(h.distance, 5 - std::sqrt(1 - 0.09 - 0.04), 1e-6);
        EXPECT_EQ(h.time, t);
        const SurfacePoint at = w.accel->point(h);
        expectNear(at.P, Vec3(float(x + 0.3), float(y - 0.2), float(h.distance)), 1e-6f, "P");
        expectNear(at.n, Vec3(0.3f, -0.2f, float(h.distance - 5)), 1e-5f, "n");
        expectNear(w.shapes[0]->velocity(at), t < .5f ? Vec3(2, 0, 0) : Vec3(0, 2, 0), 1e-5f, "velocity");
        r.org = Vec3(float(x + 1.01), float(y), 0); // beside it
        EXPECT_FALSE(w.accel->intersect(r, h));
        EXPECT_FALSE(w.accel->occluded(r));
    }
}

// At a key, and before and behind all keys, what moves is what stands there: to the bit at the opening, where it lives.
TEST(Placed, MovingMeshStandsStillAtItsKeys) {
    for (double open : {0., 1.}) {
        scene::Frame moving, still;
        auto p = ball(8), q = ball(8);
        p->toWorld.times = {0, 1};
        p->toWorld.keys = {translateMatrix(1, 2, 20), rotateMatrix(30, 1, 2, 3) * translateMatrix(-2, 1, 18)};
        moving.options.shutterOpen = float(open);
        moving.options.shutterClose = 2;
        moving.primitives = {p};
        q->toWorld = scene::Transform(p->toWorld.keys[open == 0 ? 0 : 1]);
        still.primitives = {q};
        World a(moving, 0), b(still, 0);
        const auto r = rays(20000);
        size_t hits = 0;
        for (const Ray& x : r) {
            Hit h, g;
            EXPECT_EQ(a.accel->intersect(x, h), b.accel->intersect(x, g));
            EXPECT_EQ(h.distance, g.distance);
            EXPECT_EQ(h.prim, g.prim);
            hits += h.valid();
        }
        EXPECT_GT(hits, 100u);
    }
}

// A mesh whose points move linearly: at each time it is the mesh of the points between, whatever way its quadrilaterals bend.
TEST(Placed, DeformingMesh) {
    scene::Frame f;
    f.options.shutterClose = 1;
    auto first = ball(8), last = ball(8);
    std::vector<float>& to = last->params[0].numbers;
    for (size_t i = 0; i < to.size(); i += 3) to[i] = to[i] * 2 + 1, to[i + 1] = to[i + 1] * 0.5f + to[i + 2];
    first->motionKeys = {last};
    first->motionTimes = {0, 1};
    first->toWorld = scene::Transform(translateMatrix(0, 0, 20));
    f.primitives = {first};
    World w(f, 0);
    for (const Diagnostic& d : w.diag.all()) EXPECT_NE(d.severity, Severity::Error) << d.message; // its normals are random
    for (float t : {0.f, .3f, 1.f}) {
        scene::Frame g;
        auto p = ball(8);
        for (size_t i = 0; i < to.size(); ++i)
            p->params[0].numbers[i] = float((1 - double(t)) * p->params[0].numbers[i] + double(t) * to[i]);
        p->toWorld = first->toWorld;
        g.primitives = {p};
        World still(g, 0);
        size_t hits = 0, differ = 0;
        for (const Ray& x : rays(20000, t)) {
            Hit a, b;
            w.accel->intersect(x, a);
            still.accel->intersect(x, b);
            if (a.valid() != b.valid()) {
                ++differ;
                continue;
            }
            if (!a.valid()) continue;
            ++hits;
            if (std::fabs(a.distance - b.distance) > 1e-4) {
                ++differ; // another cut of a bent quadrilateral: only at t = 0 the same
                continue;
            }
            const SurfacePoint seen = w.accel->point(a), q = still.accel->point(b);
            expectNear(seen.P, q.P, 2e-4f, "P");
            if (a.prim != b.prim) continue;
            expectNear(seen.n, q.n, 2e-3f, "n");
            EXPECT_NEAR(seen.u, q.u, 1e-3f);
            const float size = 1 + length(q.dPdu) + length(q.dPdv);
            if (size < 10) expectNear(seen.dPdu, q.dPdu, 2e-3f * size * size, "dPdu");
        }
        EXPECT_GT(hits, 100u);
        EXPECT_LE(differ, t == 0 ? 0u : 40u) << t;
    }
}

// A radius moves as the number that it is.
TEST(Placed, GrowingSphere) {
    scene::Frame f;
    f.options.shutterClose = 1;
    f.options.projection = "perspective";
    auto p = std::make_shared<scene::Primitive>();
    p->kind = "Sphere";
    p->numbers = {1, -1, 1, 360};
    p->attributes = std::make_shared<scene::Attributes>();
    auto q = std::make_shared<scene::Primitive>(*p);
    q->numbers = {2, -2, 2, 360};
    p->motionKeys = {q};
    p->motionTimes = {0, 1};
    p->toWorld = scene::Transform(translateMatrix(0, 0, 5));
    f.primitives = {p};
    World w(f, 0);
    for (float t : {0.f, .2f, .5f, .9f, 1.f}) {
        Ray r;
        r.org = Vec3(0.3f, 0.2f, 0);
        r.dir = Vec3(0, 0, 1);
        r.time = t;
        Hit h;
        ASSERT_TRUE(w.accel->intersect(r, h)) << t;
        const double radius = 1 + t, z = std::sqrt(radius * radius - 0.13);
        EXPECT_NEAR(h.distance, 5 - z, 1e-3); // facets stray by a twentieth of a pixel: 3e-4 here
        expectNear(w.accel->point(h).n, Vec3(float(0.3 / radius), float(0.2 / radius), float(-z / radius)), 1e-3f, "n");
    }
}

// Closed bodies that move leak no ray: from inside each ray meets the skin, at its own time.
TEST(Placed, NothingLeaks) {
    for (bool deforms : {false, true}) {
        scene::Frame f;
        f.options.shutterClose = 1;
        auto p = ball(16);
        if (deforms) {
            auto q = ball(16);
            for (float& x : q->params[0].numbers) x *= 1.5f;
            p->motionKeys = {q};
            p->motionTimes = {0, 1};
        }
        p->toWorld.times = {0, .3f, 1};
        p->toWorld.keys = {translateMatrix(1000, 2, 20), rotateMatrix(70, 1, 2, 3) * translateMatrix(1000, 3, 22),
                           rotateMatrix(100, 1, 2, 3) * scaleMatrix(2, 1, .5) * translateMatrix(1002, 3, 22)};
        f.primitives = {p};
        World w(f, 0);
        std::mt19937 rng(5);
        std::uniform_real_distribution<float> u(-1, 1), time(0, 1);
        for (int i = 0; i < 200000; ++i) {
            Ray r;
            r.time = time(rng);
            const Vec3d at =
                w.shapes[0]->placed()->fromGeometry(r.time).point(transformPoint(w.shapes[0]->toCamera(), Vec3d(0.0)));
            r.org = Vec3(at);
            r.dir = Vec3(u(rng), u(rng), u(rng));
            ASSERT_TRUE(w.accel->occluded(r)) << i << " " << deforms;
        }
    }
}

namespace {
/// Every triangle of every place, by the same rule as the walk.
Hit slowly(const Accel::Impl& in, const Ray& r) {
    accel::Query q{&r, {INFINITY, accel::kNone, accel::kNone, 0, 0}, false};
    for (uint32_t s = 0; accel::usable(r) && s < in.shapes.size(); ++s) {
        const geometry::Placed* p = in.shapes[s]->placed();
        const Deforming* d = p ? p->deforming() : nullptr;
        const TriMesh* mesh = &(d ? d->keys()[0] : p ? p->geometry() : in.shapes[s])->mesh();
        Affine to;
        if (p) EXPECT_TRUE(p->toGeometry(r.time, to));
        const Accel::Impl::Inside at{p ? &in.geometryAt(s) : nullptr, p, s, to.point(Vec3d(r.org)), to.vector(Vec3d(r.dir))};
        for (uint32_t t = 0; t < mesh->triangles(); ++t) {
            Vec3d c[3];
            for (size_t k = 0; k < 3; ++k) c[k] = Vec3d(mesh->P[mesh->index[3 * size_t(t) + k]]);
            if (d) d->corners(t, r.time, c);
            if (p) in.intersectInside(q, at, t, c[0], c[1], c[2]);
            else in.meetOne(q, s, t, Vec3(c[0]), Vec3(c[1]), Vec3(c[2]));
        }
    }
    return {float(q.best.t), q.best.shape, q.best.prim, r.time, q.best.b1, q.best.b2, q.best.t};
}
} // namespace

// What a ray meets depends on nothing but itself: one by one, all together, in another order, on an older processor, mixed with
// rays that end at once; and it is what looking at every triangle finds. Shadow rays meet something where nearest hits are.
TEST(Placed, CompanyChangesNoBit) {
    scene::Frame f = manyBalls(2, 0);
    f.options.shutterClose = 1;
    auto still = ball(6), bent = ball(10), to = ball(10);
    still->toWorld = scene::Transform(translateMatrix(0, -4, 20));
    for (size_t i = 0; i < to->params[0].numbers.size(); i += 3) to->params[0].numbers[i] *= 2;
    bent->motionKeys = {to};
    bent->motionTimes = {0, 1};
    bent->toWorld.times = {0, 1};
    bent->toWorld.keys = {scaleMatrix(3, 3, 3) * translateMatrix(3, 0, 20),
                          scaleMatrix(3, 4, 3) * rotateMatrix(50, 1, 1, 0) * translateMatrix(0, 3, 20)};
    f.primitives = {still, bent};
    World w(f, 0);
    auto r = rays(3000);
    for (size_t i = 0; i < r.size(); ++i) {
        r[i].time = float(i % 17) / 16;
        if (i % 5 == 0) r[i].tfar = 0.01f;
        if (i % 11 == 0) r[i].dir = Vec3(NAN, 0, 0);
    }
    std::vector<Hit> together(r.size()), turned(r.size());
    std::vector<uint8_t> met(r.size());
    w.accel->intersect(r, together);
    w.accel->occluded(r, met);
    std::vector<Ray> backwards(r.rbegin(), r.rend());
    w.accel->intersect(backwards, turned);
    std::vector<Hit> plain(r.size());
    Accel::Impl in;
    in.shapes = w.shapes;
    in.visibility.assign(w.shapes.size(), accel::kAll);
    in.readyPlaced();
    in.buildTree();
    in.walkNearest(r, plain, true);
    size_t hits = 0, placed = 0;
    for (size_t i = 0; i < r.size(); ++i) {
        Hit one;
        w.accel->intersect(r[i], one);
        const Hit& other = turned[r.size() - 1 - i];
        const Hit slow = i % 8 ? one : slowly(in, r[i]);
        for (const Hit* h : std::initializer_list<const Hit*>{&together[i], &other, &plain[i], &slow}) {
            EXPECT_EQ(one.shape, h->shape);
            if (!one.valid()) continue;
            EXPECT_EQ(one.prim, h->prim);
            EXPECT_EQ(one.distance, h->distance);
            EXPECT_EQ(one.b1, h->b1);
            EXPECT_EQ(one.b2, h->b2);
        }
        EXPECT_EQ(met[i] != 0, one.valid());
        hits += one.valid();
        placed += one.valid() && w.shapes[one.shape]->placed() && w.shapes[one.shape]->placed()->deforming();
    }
    EXPECT_GT(hits, 500u);
    EXPECT_GT(placed, 100u);
}

// Rays from an eye to about one place, sixteen at a time, through instances whose geometry is a mesh, curves or a lone sphere:
// the hits are those that each has alone, with the instructions of every processor.
TEST(Placed, RaysTogetherMeetWhatTheyMeetAlone) {
    scene::Frame f = manyBalls(2, 0);
    auto curves = std::make_shared<scene::Primitive>();
    curves->kind = "Curves";
    curves->strings = {"linear", "nonperiodic"};
    curves->ints.assign(20, 3);
    std::mt19937 rng(5);
    std::uniform_real_distribution<float> u(-1, 1);
    std::vector<float> P;
    for (int i = 0; i < 20 * 9; ++i) P.push_back(u(rng));
    curves->params = {variable("P", scene::Class::Vertex, scene::Type::Point, P),
                      variable("constantwidth", scene::Class::Constant, scene::Type::Float, {0.2f})};
    auto sphere = std::make_shared<scene::Primitive>();
    sphere->kind = "Sphere";
    sphere->numbers = {1, -1, 1, 360};
    curves->attributes = sphere->attributes = f.objects[0].primitives[0]->attributes;
    f.objects.push_back({"curves", {curves}});
    f.objects.push_back({"sphere", {sphere}});
    for (size_t i = 0; i < f.instances.size(); ++i) f.instances[i].object = i % 3;
    const World w(f, 1);
    ASSERT_TRUE(w.accel->sound());
    Accel::Impl in;
    in.shapes = w.shapes;
    in.visibility.assign(w.shapes.size(), accel::kAll);
    in.readyPlaced();
    in.buildTree();
    ASSERT_FALSE(in.placesMove);
    std::vector<Ray> r;
    for (int bundle = 0; bundle < 300; ++bundle) {
        const Vec3 eye(8 * u(rng), 8 * u(rng), 8 * u(rng)), aim(6 * u(rng), 6 * u(rng), 20 + 6 * u(rng));
        for (int k = 0; k < 16; ++k) {
            Ray x;
            x.org = eye;
            x.dir = aim - eye + Vec3(u(rng), u(rng), u(rng)) * (bundle % 5 ? 0.3f : 9.f);
            if (k == 3) x.tfar = 1;
            if (k == 5 && bundle % 4 == 0) x.excludeShape = uint32_t(bundle) % uint32_t(w.shapes.size());
            r.push_back(x);
        }
    }
    std::vector<Hit> alone(r.size());
    in.walkNearest(r, alone);
    size_t hits[3] = {};
    for (const bool plain : {false, true}) {
        std::vector<Hit> together(r.size());
        in.walkNearestTogether(r, together, plain);
        for (size_t i = 0; i < r.size(); ++i) {
            ASSERT_EQ(together[i].shape, alone[i].shape) << i;
            if (!alone[i].valid()) continue;
            const std::string& kind = w.shapes[alone[i].shape]->kind();
            ++hits[kind == "Sphere" ? 0 : kind == "Curves" ? 1 : 2];
            ASSERT_EQ(together[i].prim, alone[i].prim);
            ASSERT_EQ(together[i].distance, alone[i].distance);
            ASSERT_EQ(together[i].b1, alone[i].b1);
            ASSERT_EQ(together[i].b2, alone[i].b2);
        }
    }
    for (const size_t n : hits) EXPECT_GT(n, 100u);
}

} // namespace placed_test
