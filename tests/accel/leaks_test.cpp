// T12: of a million rays from within a closed form none leaves it, whatever it is made of, still and moving, and what leaves a
// convex form outwards does not meet it again. Some thousand rays a case on every change, the million nightly.
#include "../geometry/make.h"
#include "../statistics/nightly.h"
#include "accel/accel.h"
#include "geometry/placed.h"
#include "scene/scene.h"
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace leaks_test {

using namespace alpenglow;
using namespace alpenglow::geometry;
using namespace alpenglow::geometry::test;
using accel::Hit;
using accel::Ray;
using scene::Class;
using scene::Type;
using PrimitivePtr = std::shared_ptr<scene::Primitive>;

namespace {

struct Rng {
    std::mt19937 engine;
    double one() { return double(engine()) / 4294967296.0; }
    Vec3d ball() { // even within the unit ball
        for (;;) {
            const Vec3d p(2 * one() - 1, 2 * one() - 1, 2 * one() - 1);
            if (dot(p, p) <= 1) return p;
        }
    }
};

PrimitivePtr primitive(const std::string& kind, std::vector<scene::Param> params) {
    auto p = std::make_shared<scene::Primitive>();
    p->kind = kind;
    p->params = std::move(params);
    return p;
}
void put(std::vector<float>& to, std::initializer_list<double> values) {
    for (double v : values) to.push_back(float(v));
}

/// Round a circle of this radius, up and down.
PrimitivePtr tube(const char* type, double scale) {
    std::vector<float> P;
    for (int i = 0; i < 12; ++i) put(P, {scale * std::cos(kPi * i / 6), scale * std::sin(kPi * i / 6), 0.3 * scale * (i % 2)});
    PrimitivePtr p = primitive("Curves", {points(P), param("constantwidth", Class::Constant, Type::Float, {float(.4 * scale)})});
    p->strings = {type, "periodic"};
    p->ints = {12};
    return p;
}
PrimitivePtr ballPoint(double scale) {
    scene::Param type = param("type", Class::Uniform, Type::String, {});
    type.strings = {"sphere"};
    return primitive("Points", {points({0, 0, 0}), param("constantwidth", Class::Constant, Type::Float, {float(scale)}), type});
}
PrimitivePtr blobs(double scale) {
    PrimitivePtr p = primitive("Blobby", {});
    p->ints = {2};
    p->ints2 = {1001, 0, 1001, 16, 0, 2, 0, 1};
    for (int i = 0; i < 2; ++i) {
        const Matrix m = scaleMatrix(1.2 * scale, scale, scale) * translateMatrix(.7 * i * scale, .1 * i * scale, 0);
        for (auto& row : m.m)
            for (double x : row) p->numbers.push_back(float(x));
    }
    return p;
}
/// A circle as a rational curve of order 3, x, y and weight of its points: from the eighth `first` on.
std::vector<std::array<double, 3>> arc(int count, int first) {
    std::vector<std::array<double, 3>> out;
    for (int i = 0; i < count; ++i) {
        const double a = kPi * (i + first) / 4, w = i % 2 ? std::sqrt(.5) : 1, r = i % 2 ? 1 / w : 1;
        out.push_back({r * std::cos(a), r * std::sin(a), w});
    }
    return out;
}
std::vector<float> arcKnots(int count) {
    std::vector<float> k{0, 0, 0};
    for (int i = 1; i < (count - 1) / 2; ++i) k.insert(k.end(), 2, float(i));
    k.insert(k.end(), 3, float((count - 1) / 2));
    return k;
}
/// A circle about (far, 0) of this radius in the plane of x and z, turned about z.
PrimitivePtr turned(double far, double radius, int count, int first) {
    std::vector<float> Pw;
    for (const auto& [x, z, wv] : arc(count, first))
        for (const auto& [c, s, wu] : arc(9, 0)) {
            const double w = wu * wv, r = far + radius * x;
            put(Pw, {r * c * w, r * s * w, radius * z * w, w});
        }
    PrimitivePtr p = primitive("NuPatch", {param("Pw", Class::Vertex, Type::HPoint, Pw)});
    p->ints = {9, 3, count, 3};
    p->numbers = {0, 4, 0, float((count - 1) / 2)};
    p->params.push_back(param("uknot", Class::Constant, Type::Float, arcKnots(9)));
    p->params.push_back(param("vknot", Class::Constant, Type::Float, arcKnots(count)));
    return p;
}
PrimitivePtr ring(double scale) { // a periodic mesh of B-spline patches
    std::vector<float> P;
    for (int j = 0; j < 8; ++j)
        for (int i = 0; i < 8; ++i) {
            const double a = kPi * i / 4, b = kPi * j / 4, r = 1 + .5 * std::cos(b);
            put(P, {scale * r * std::cos(a), scale * r * std::sin(a), scale * .5 * std::sin(b)});
        }
    PrimitivePtr p = patchMesh("bicubic", 8, "periodic", 8, "periodic", P);
    return p;
}
PrimitivePtr cage(const char* scheme, double scale) {
    std::vector<float> P;
    PrimitivePtr p = primitive("SubdivisionMesh", {});
    p->strings = {scheme};
    if (std::string(scheme) == "loop") {
        for (int k = 0; k < 6; ++k) {
            Vec3d at(0.0);
            at[k / 2] = k % 2 ? -scale : scale;
            put(P, {at.x, at.y, at.z});
        }
        p->ints.assign(8, 3);
        p->ints2 = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
    } else {
        for (int k = 0; k < 8; ++k) put(P, {k & 1 ? scale : -scale, k & 2 ? scale : -scale, k & 4 ? scale : -scale});
        p->ints.assign(6, 4);
        p->ints2 = {0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5};
    }
    p->params = {points(P)};
    return p;
}

struct Form {
    const char* name;
    PrimitivePtr (*make)(double scale);
    Vec3d inside; ///< at scale 1: as far as `room` about it is within
    double room;
    bool convex;
    bool displaced = false;
};
const Form kForms[] = {
    {"a tube of cubic curves", [](double s) { return tube("cubic", s); }, {.955, 0, .1}, .08, false},
    {"a tube of lines", [](double s) { return tube("linear", s); }, {.933, .25, .15}, .05, false},
    {"a ball of Points", ballPoint, {0, 0, 0}, .3, true},
    {"blobs", blobs, {.3, 0, 0}, .2, false},
    {"a sphere of NURBS", [](double s) { return turned(0, s, 5, -2); }, {0, 0, 0}, .5, true},
    {"a torus of NURBS", [](double s) { return turned(s, .4 * s, 9, 0); }, {1, 0, 0}, .2, false},
    {"a ring of B-spline patches", ring, {.9, 0, 0}, .15, false},
    {"Catmull and Clark's cube", [](double s) { return cage("catmull-clark", s); }, {0, 0, 0}, .4, true},
    {"Loop's octahedron", [](double s) { return cage("loop", s); }, {0, 0, 0}, .2, true},
    {"a bilinear cube", [](double s) { return cage("bilinear", s); }, {0, 0, 0}, .5, true},
    {"a sphere", [](double s) { return quadric("Sphere", {float(s), float(-s), float(s), 360}); }, {0, 0, 0}, .5, true},
    {"a torus", [](double s) { return quadric("Torus", {float(s), float(.4 * s), 0, 360, 360}); }, {1, 0, 0}, .2, false},
    {"a displaced cube of Catmull and Clark", [](double s) { return cage("catmull-clark", s); }, {0, 0, 0}, .3, false, true},
    {"a displaced torus of NURBS", [](double s) { return turned(s, .4 * s, 9, 0); }, {1, 0, 0}, .15, false, true},
    {"a displaced sphere",
     [](double s) { return quadric("Sphere", {float(s), float(-s), float(s), 360}); },
     {0, 0, 0},
     .5,
     false,
     true},
};

enum How { Still, Goes, Deforms, Both, Instance, Instances };
const char* const kHow[] = {"still", "going", "deforming", "both", "a moving instance", "a moving instance of what deforms"};
bool deforms(How how) { return how == Deforms || how == Both || how == Instances; }
constexpr double kGrows = 1.3;

struct World {
    scene::Frame f;
    std::vector<ShapeRef> shapes;
    std::unique_ptr<accel::Accel> accel;
    Diagnostics diag;
    World(const Form& form, How how, size_t shareFrom = 0, double scale = 1) {
        auto a = std::make_shared<scene::Attributes>();
        a->sides = 2;
        a->values["dice:roundcurve"] = param("dice:roundcurve", Class::Constant, Type::Integer, {1});
        constexpr double spline[4][4] = {
            {-1. / 6, .5, -.5, 1. / 6}, {.5, -1, .5, 0}, {-.5, 0, .5, 0}, {1. / 6, 2. / 3, 1. / 6, 0}};
        for (scene::Basis* b : {&a->ubasis, &a->vbasis}) {
            for (int i = 0; i < 16; ++i) b->m[i / 4][i % 4] = spline[i / 4][i % 4];
            b->step = 1;
        }
        f.options.shutterClose = 1;
        f.options.hider = "path";
        auto p = form.make(scale);
        p->attributes = a;
        if (deforms(how)) {
            p->motionKeys = {form.make(kGrows)};
            p->motionTimes = {0, 1};
        }
        scene::Transform place(skewed());
        if (how != Still && how != Deforms) {
            place.times = {0, .3f, 1};
            place.keys = {skewed(), rotateMatrix(20, 1, 2, 3) * skewed() * translateMatrix(.4, 0, 1),
                          rotateMatrix(35, 1, 2, 3) * skewed() * translateMatrix(.4, 1, 0)};
        }
        if (how >= Instance) {
            f.objects.push_back({"it", {p}});
            for (int i = 0; i < 2; ++i) {
                scene::Instance at;
                at.object = 0;
                at.attributes = a;
                at.toWorld = place;
                for (Matrix& m : at.toWorld.keys) m = m * translateMatrix(0, 0, 100 * i);
                f.instances.push_back(at);
            }
        } else {
            p->toWorld = place;
            f.primitives = {p};
        }
        shapes = buildShapes(f, diag, {.shareFrom = shareFrom});
        DiceOptions o{.camera = DiceCamera::from(f.options)};
        o.camera.pixelsPerUnit = 40;
        o.displaces = [&](const Shape&) { return form.displaced; };
        o.displace = [](const Shape&, DiceGrid& g) {
            for (size_t i = 0; i < g.points.size(); ++i)
                g.P[i] = g.P[i] + g.points[i].n * (0.05f * std::sin(11 * g.points[i].P.x));
        };
        diceShapes(shapes, o, diag);
        accel = std::make_unique<accel::Accel>(shapes, std::vector<uint32_t>{}, diag);
        for (const Diagnostic& d : diag.all()) // notes tell how long a slow machine took
            if (d.severity > Severity::Info) ADD_FAILURE() << form.name << ", " << kHow[how] << ": " << toString(d);
    }
    Matrix placeAt(float time) const {
        const scene::Transform& t = f.instances.empty() ? f.primitives[0]->toWorld : f.instances[0].toWorld;
        return scene::at(t, double(time));
    }
    /// A corner of a facet, where facets meet; false where there are none.
    bool corner(Rng& rng, float time, Vec3d& out) const {
        const Placed* p = shapes[0]->placed();
        const Shape& s = p ? *p->geometry() : *shapes[0];
        const Deforming* d = p ? p->deforming() : nullptr;
        const TriMesh& mesh = d ? d->keys()[0]->mesh() : s.mesh();
        if (mesh.triangles() == 0) return false;
        const uint32_t prim = uint32_t(rng.one() * mesh.triangles());
        Vec3d c[3];
        for (size_t k = 0; k < 3; ++k) c[k] = Vec3d(mesh.P[mesh.index[3 * size_t(prim) + k]]);
        if (d) d->corners(prim, time, c);
        out = p ? p->fromGeometry(time).point(c[0]) : c[0];
        return true;
    }
};

} // namespace

TEST(Leaks, NoRayLeavesAClosedForm) {
    const int n = teststat::samples(2'000, 12'000); // of 15 forms in 6 ways: a million
    for (const Form& form : kForms)
        for (const How how : {Still, Goes, Deforms, Both, Instance, Instances}) {
            const World w(form, how);
            ASSERT_FALSE(w.shapes.empty()) << form.name << ", " << kHow[how];
            Rng rng{std::mt19937(5 + teststat::seedBase())};
            int leaks = 0;
            for (int i = 0; i < n; ++i) {
                Ray r;
                r.time = float(rng.one());
                const double grown = deforms(how) ? 1 + (kGrows - 1) * double(r.time) : 1;
                const Vec3d from = form.inside * grown + rng.ball() * form.room;
                r.org = Vec3(transformPoint(w.placeAt(r.time), from));
                r.dir = Vec3(rng.ball());
                if (Vec3d at; i % 2 && w.corner(rng, r.time, at)) r.dir = Vec3(at) - r.org;
                r.sides = accel::Sides::Both;
                Hit h;
                leaks += !w.accel->intersect(r, h) || !w.accel->occluded(r);
            }
            EXPECT_EQ(leaks, 0) << form.name << ", " << kHow[how];
        }
}

// Rays that look along a tube meet it at a flat angle, where a cone is no good beginning for Newton's iteration.
TEST(Leaks, NoRayAlongATubeLeavesIt) {
    const World w(kForms[0], Still);
    Rng rng{std::mt19937(7 + teststat::seedBase())};
    int leaks = 0;
    for (int i = 0; i < teststat::samples(100'000, 1'000'000); ++i) {
        const Vec3d along = normalize(Vec3d(0, i % 2 ? 1 : -1, 0) + rng.ball() * 0.5);
        Ray r;
        r.org = Vec3(transformPoint(skewed(), kForms[0].inside + rng.ball() * kForms[0].room));
        r.dir = Vec3(transformVector(skewed(), along));
        Hit h;
        leaks += !w.accel->intersect(r, h) || !w.accel->occluded(r);
    }
    // Two that did.
    const Vec3d rays[2][2] = {{{0.977919699, 0.057869051, 0.122842923}, {-0.202502422, 0.494063745, -0.135783362}},
                              {{0.896145166, -0.0100087453, 0.0529654876}, {-0.0497586, -0.326921909, -0.0357304095}}};
    for (const auto& [from, along] : rays) {
        Ray r;
        r.org = Vec3(transformPoint(skewed(), from));
        r.dir = Vec3(transformVector(skewed(), along));
        leaks += !w.accel->occluded(r);
    }
    EXPECT_EQ(leaks, 0);
}

TEST(Leaks, WhatLeavesAConvexFormDoesNotMeetItAgain) {
    const int n = teststat::samples(4'000, 42'000); // of six forms in 4 ways: a million
    for (const Form& form : kForms)
        for (const How how : {Still, Goes, Deforms, Both}) {
            if (!form.convex) continue;
            const World w(form, how);
            Rng rng{std::mt19937(6 + teststat::seedBase())};
            int again = 0;
            for (int i = 0; i < n; ++i) {
                Ray r;
                r.time = float(rng.one());
                r.org = Vec3(transformPoint(w.placeAt(r.time), form.inside));
                r.dir = Vec3(rng.ball());
                Hit h;
                if (!w.accel->intersect(r, h)) continue; // a leak, reported above
                SurfacePoint p;
                const HitRef ref{h.prim, h.b1, h.b2, &p, r.time};
                w.shapes[h.shape]->points({&ref, 1}, kNeedAll);
                const Vec3 out = dot(p.n, r.dir) > 0 ? p.n : -p.n, d = Vec3(rng.ball());
                r.dir = dot(d, out) > 0 ? d : -d;
                r.org = offsetOrigin(p, r.dir);
                again += w.accel->intersect(r, h);
            }
            EXPECT_EQ(again, 0) << form.name << ", " << kHow[how];
        }
}

// Two moving instances that share a geometry, and two copies: the same points, but for the rounding of two spaces (coordinates up
// to 110, which normals of small facets feel), and but for rays along edges.
TEST(Placed, InstancesOfEveryFormAreCopies) {
    for (const Form& form : kForms) {
        const World shared(form, Instance), copies(form, Instance, SIZE_MAX);
        ASSERT_EQ(shared.shapes.size(), 2u) << form.name;
        ASSERT_EQ(copies.shapes.size(), 2u) << form.name;
        Rng rng{std::mt19937(9)};
        int met = 0, differ = 0;
        for (int i = 0; i < 4000; ++i) {
            Ray r;
            r.time = float(rng.one());
            const Vec3d centre = transformPoint(shared.placeAt(r.time), form.inside * 0.0), far(0, 0, i % 2 ? 100 : 0);
            r.org = Vec3(centre + far + rng.ball() * 6.0);
            r.dir = Vec3(centre + far + rng.ball() * 1.5) - r.org;
            Hit a, b;
            const bool ma = shared.accel->intersect(r, a), mb = copies.accel->intersect(r, b);
            if (!ma && !mb) continue;
            ++met;
            if (ma != mb || a.shape != b.shape || std::fabs(a.distance - b.distance) * double(length(r.dir)) > 1e-3) {
                ++differ;
                continue;
            }
            SurfacePoint p, q;
            const HitRef ra{a.prim, a.b1, a.b2, &p, r.time}, rb{b.prim, b.b1, b.b2, &q, r.time};
            shared.shapes[a.shape]->points({&ra, 1}, kNeedAll);
            copies.shapes[b.shape]->points({&rb, 1}, kNeedAll);
            differ += length(p.P - q.P) > 1e-3f || length(p.n - q.n) > 2e-2f || p.orientation != q.orientation;
        }
        EXPECT_GT(met, 300) << form.name;
        EXPECT_LE(differ, met / 50) << form.name;
    }
}

// Linear between two keys: at each time the form that has the points of that time, but for facets that stray by a twentieth of a
// pixel (here an 800th, both of them), and but for rays that graze. Subdivision surfaces, patches and curves are linear in their
// points.
TEST(Placed, WhatDeformsIsAtEachTimeWhatStandsThere) {
    for (const Form& form : kForms) {
        if (form.displaced) continue;
        const World moves(form, Deforms), placed(form, Instances);
        for (const float t : {0.f, .25f, .7f, 1.f}) {
            const double scale = 1 + (kGrows - 1) * double(t);
            const World stands(form, Still, 0, scale);
            Rng rng{std::mt19937(11)};
            int met = 0, differ = 0;
            for (int i = 0; i < 1500; ++i) {
                Ray r;
                r.org = Vec3(transformPoint(skewed(), rng.ball() * 4.0));
                r.dir = Vec3(transformPoint(skewed(), rng.ball() * 1.5)) - r.org;
                r.time = t;
                Hit a, b;
                const bool ma = moves.accel->intersect(r, a), mb = stands.accel->intersect(r, b);
                if (!ma && !mb) continue;
                ++met;
                SurfacePoint p, q;
                const HitRef ra{a.prim, a.b1, a.b2, &p, t}, rb{b.prim, b.b1, b.b2, &q, t};
                if (ma != mb) {
                    ++differ;
                    continue;
                }
                moves.shapes[a.shape]->points({&ra, 1}, kNeedAll);
                stands.shapes[b.shape]->points({&rb, 1}, kNeedAll);
                const double cosine = std::fabs(dot(Vec3d(q.n), normalize(Vec3d(r.dir))));
                differ += std::fabs(a.distance - b.distance) * double(length(r.dir)) * cosine > 3e-3 ||
                          length(p.P - q.P) * cosine > 5e-3f || (cosine > .2 && length(p.n - q.n) > .05f);
                // And as an instance that has moved: the same ray from there.
                const Matrix there = inverse(skewed()) * placed.placeAt(t);
                Ray s = r;
                s.org = Vec3(transformPoint(there, Vec3d(r.org)));
                s.dir = Vec3(transformVector(there, Vec3d(r.dir)));
                Hit c;
                if (!placed.accel->intersect(s, c)) ++differ;
                else differ += std::fabs(c.distance - b.distance) * double(length(r.dir)) * cosine > 4e-3;
            }
            EXPECT_GT(met, 100) << form.name;
            EXPECT_LE(differ, met / 25) << form.name << " at " << t << " of " << met;
        }
    }
}

} // namespace leaks_test
