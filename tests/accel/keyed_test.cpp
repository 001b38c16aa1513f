// Curves and points whose own numbers move: at each time they are what stands there, and their points move as they say.
#include "../geometry/make.h"
#include "accel/accel.h"
#include "geometry/placed.h"
#include "scene/scene.h"
#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace keyed_test {

using namespace alpenglow;
using namespace alpenglow::geometry;
using namespace alpenglow::geometry::test;
using accel::Hit;
using accel::Ray;
using scene::Class;
using scene::Type;
using PrimitivePtr = std::shared_ptr<scene::Primitive>;

namespace {

// Numbers are 64ths, so that means of two keys are floats as well: what moves and what stands then have the same numbers.
struct Numbers {
    std::mt19937 rng;
    float one(float size) { return std::round((float(rng() >> 8) * 0x1p-23f - 1) * size * 64) / 64; }
    std::vector<float> many(size_t n, float size) {
        std::vector<float> v(n);
        for (float& f : v) f = one(size);
        return v;
    }
    std::vector<float> widths(size_t n) {
        std::vector<float> v(n);
        for (float& f : v) f = 0.25f + std::fabs(one(0.25f));
        return v;
    }
};

struct Kind {
    const char* name;
    bool curves;
    const char* form; ///< of curves: linear or cubic; of points: their type
    bool normals, round;
};
constexpr Kind kKinds[] = {
    {"ribbons that face the ray", true, "cubic", false, false},
    {"ribbons with N", true, "cubic", true, false},
    {"tubes", true, "cubic", false, true},
    {"linear ribbons", true, "linear", false, false},
    {"linear tubes", true, "linear", false, true},
    {"discs", false, "particle", false, false},
    {"discs with N", false, "particle", true, false},
    {"balls", false, "sphere", false, false},
    {"squares", false, "patch", false, false},
};

/// What a kind is at one key. before: the key before it, whose points it is near.
PrimitivePtr at(const Kind& k, Numbers& n, const scene::Primitive* before) {
    auto p = std::make_shared<scene::Primitive>();
    std::vector<float> P = n.many(3 * 21, before ? 0.5f : 2);
    if (before)
        for (size_t i = 0; i < P.size(); ++i) P[i] += before->params[0].numbers[i];
    p->kind = k.curves ? "Curves" : "Points";
    p->params = {points(P), param("width", k.curves ? Class::Varying : Class::Vertex, Type::Float, {}),
                 param("tint", Class::Vertex, Type::Color, n.many(3 * 21, 1))};
    size_t corners = 21;
    if (k.curves) {
        p->strings = {k.form, "nonperiodic"};
        p->ints = {7, 7, 7};
        corners = std::string(k.form) == "cubic" ? 3 * 3 : 21;
    } else {
        scene::Param type = param("type", Class::Uniform, Type::String, {});
        type.strings = {k.form};
        p->params.push_back(type);
    }
    p->params[1].numbers = n.widths(corners);
    if (k.normals) {
        p->params.push_back(param("N", Class::Varying, Type::Normal, n.many(3 * corners, 0.5f)));
        for (size_t i = 2; i < 3 * corners; i += 3) p->params.back().numbers[i] -= 2;
    }
    return p;
}

scene::AttributesRef attributes(const Kind& k, int sides = 2) {
    auto a = std::make_shared<scene::Attributes>();
    a->sides = sides;
    if (k.round) {
        scene::Param one = param("dice:roundcurve", Class::Constant, Type::Integer, {1});
        a->values["dice:roundcurve"] = one;
    }
    return a;
}

struct World {
    std::vector<ShapeRef> shapes;
    std::unique_ptr<accel::Accel> accel;
    Diagnostics diag;
    explicit World(const PrimitivePtr& p, double open = 0, double close = 1) {
        scene::Frame f;
        f.options.shutterOpen = float(open);
        f.options.shutterClose = float(close);
        f.options.hider = "path";
        f.primitives = {p};
        shapes = buildShapes(f, diag);
        diceShapes(shapes, DiceOptions{.camera = DiceCamera::from(f.options)}, diag);
        accel = std::make_unique<accel::Accel>(shapes, std::vector<uint32_t>{}, diag);
    }
};

/// Three keys at 0, 1/2 and 1, and what stands halfway between two of them or at one.
struct Case {
    PrimitivePtr keys[3];
    Case(const Kind& k, int sides, uint32_t seed) {
        Numbers n{std::mt19937(seed)};
        for (int i = 0; i < 3; ++i) keys[i] = at(k, n, i ? keys[i - 1].get() : nullptr);
        for (auto& p : keys) {
            p->attributes = attributes(k, sides);
            p->toWorld = scene::Transform(translateMatrix(0, 0, 8));
        }
        keys[0]->params[1].numbers[0] = 0; // grows from nothing
    }
    PrimitivePtr moving() const {
        auto p = std::make_shared<scene::Primitive>(*keys[0]);
        p->motionKeys = {keys[1], keys[2]};
        p->motionTimes = {0, .5f, 1};
        return p;
    }
    PrimitivePtr still(int quarter) const {
        auto p = std::make_shared<scene::Primitive>(*keys[quarter / 2]);
        if (quarter % 2)
            for (size_t j = 0; j < p->params.size(); ++j)
                for (size_t i = 0; i < p->params[j].numbers.size(); ++i)
                    p->params[j].numbers[i] = (p->params[j].numbers[i] + keys[quarter / 2 + 1]->params[j].numbers[i]) / 2;
        return p;
    }
};

Ray rayAt(std::mt19937& rng, float time) {
    const auto u = [&] { return float(rng() >> 8) * 0x1p-23f - 1; };
    Ray r;
    r.org = Vec3(3 * u(), 3 * u(), 8 + 6 * u());
    r.dir = Vec3(2 * u(), 2 * u(), 8 + 2 * u()) - r.org;
    r.time = time;
    return r;
}

} // namespace

// Both have the same numbers, and are met by the same code, which cuts a curve into other parts: roots agree to 1e-9.
TEST(Keyed, WhatMovesIsAtEachTimeWhatStandsThere) {
    for (const Kind& k : kKinds)
        for (int sides : {2, 1}) {
            const Case c(k, sides, 5);
            World moving(c.moving());
            ASSERT_EQ(moving.shapes.size(), 1u);
            EXPECT_TRUE(moving.diag.all().empty()) << k.name << moving.diag.all()[0].message;
            EXPECT_TRUE(moving.shapes[0]->placed() && moving.shapes[0]->placed()->moves()) << k.name;
            std::mt19937 rng(7);
            size_t hits = 0, grazes = 0;
            for (int quarter = 0; quarter <= 4; ++quarter) {
                World still(c.still(quarter));
                for (int i = 0; i < 2000; ++i) {
                    const Ray r = rayAt(rng, float(quarter) / 4);
                    Hit a, b;
                    moving.accel->intersect(r, a);
                    still.accel->intersect(r, b);
                    if (a.valid() != b.valid() || (a.valid() && std::fabs(a.distance - b.distance) > 1e-9)) {
                        ++grazes;
                        continue;
                    }
                    EXPECT_EQ(moving.accel->occluded(r), a.valid());
                    if (!a.valid()) continue;
                    ++hits;
                    const SurfacePoint p = moving.accel->point(a), q = still.accel->point(b);
                    for (auto v : {&SurfacePoint::P, &SurfacePoint::n, &SurfacePoint::N})
                        EXPECT_LT(length(p.*v - q.*v), 2e-5f) << k.name << quarter;
                    // Where u is 0 on a tube is turned from one axis at all times.
                    for (auto v : {&SurfacePoint::dPdu, &SurfacePoint::dPdv})
                        if (!k.round || v == &SurfacePoint::dPdu)
                            EXPECT_LT(length(p.*v - q.*v), 1e-4f * (1 + length(q.*v))) << k.name;
                    EXPECT_EQ(p.time, r.time);
                    float x[3], y[3];
                    const ShapeRef &s = moving.shapes[0], &t = still.shapes[0];
                    s->interpolate(s->findPrimvar("tint"), p, x, nullptr, nullptr);
                    t->interpolate(t->findPrimvar("tint"), q, y, nullptr, nullptr);
                    for (int e = 0; e < 3; ++e) EXPECT_NEAR(x[e], y[e], 1e-5f) << k.name;
                }
            }
            EXPECT_GT(hits, sides == 2 ? 250u : 100u) << k.name;
            EXPECT_LE(grazes, hits / 200) << k.name; // rays that pass an edge within rounding
        }
}

// The shutter may open and close between keys, and at one.
TEST(Keyed, TheShutterOpensBetweenKeys) {
    for (const Kind& k : {kKinds[0], kKinds[7]}) {
        const Case c(k, 2, 9);
        for (double open : {.25, .5}) {
            World all(c.moving()), part(c.moving(), open, .75);
            EXPECT_TRUE(part.diag.all().empty());
            std::mt19937 rng(3);
            size_t hits = 0, differ = 0;
            for (int i = 0; i < 4000; ++i) {
                const float w = float(i % 5) / 4;
                Ray r = rayAt(rng, w);
                Hit a, b;
                part.accel->intersect(r, a);
                r.time = float(open + (.75 - open) * w);
                all.accel->intersect(r, b);
                differ += a.valid() != b.valid() || (a.valid() && std::fabs(a.distance - b.distance) > 1e-5);
                hits += a.valid();
            }
            EXPECT_GT(hits, 200u);
            EXPECT_LE(differ, 4u); // the numbers at the opening are floats again
        }
    }
}

// What moves says how: the slope of its points over time. What faces the ray says it of its middle.
TEST(Keyed, VelocitiesAreSlopes) {
    for (const Kind& k : kKinds) {
        const Case c(k, 2, 11);
        World w(c.moving());
        const ShapeRef& geometry = w.shapes[0]->placed()->geometry();
        const bool facing = !k.normals && !k.round && std::string(k.form) != "sphere";
        std::mt19937 rng(7);
        size_t hits = 0;
        for (int i = 0; i < 6000 && hits < 300; ++i) {
            const Ray r = rayAt(rng, .3f);
            Hit h;
            if (!w.accel->intersect(r, h)) continue;
            const SurfacePoint p = w.accel->point(h);
            const auto place = [&](float time) {
                SurfacePoint q;
                const double b1 = facing ? 2 * std::floor(h.b1 / 2) + .5 : h.b1,
                             b2 = !facing || k.curves ? h.b2 : 2 * std::floor(h.b2 / 2) + .5;
                const HitRef ref{h.prim, b1, b2, &q, time};
                geometry->points({&ref, 1}, kNeedAll);
                return Vec3d(q.P);
            };
            const float step = 1.f / 256;
            const Vec3d slope = (place(.3f + step) - place(.3f - step)) / double((.3f + step) - (.3f - step));
            // Places about 10 away are rounded by 1e-6; where directions turn, a 256th squared of how fast they do so.
            const bool turns = (k.curves && k.round) || k.normals;
            EXPECT_LT(length(Vec3d(w.shapes[0]->velocity(p)) - slope), turns ? 2e-3 : 3e-4) << k.name;
            ++hits;
        }
        EXPECT_GT(hits, 50u) << k.name;
    }
}

// Keys of other pieces: a message, and the first of them is drawn.
TEST(Keyed, KeysThatDoNotFitAreSaid) {
    for (const Kind& k : {kKinds[0], kKinds[5]}) {
        const Case c(k, 2, 13);
        auto p = c.moving();
        auto other = std::make_shared<scene::Primitive>(*c.keys[1]);
        other->params[0].numbers[4] = NAN;
        p->motionKeys[0] = other;
        World w(p), still(c.keys[0]);
        ASSERT_EQ(w.shapes.size(), 1u);
        bool said = false;
        for (const Diagnostic& d : w.diag.all())
            said |= d.message.find(" do not match: it is drawn at its first position") != std::string::npos;
        EXPECT_TRUE(said);
        std::mt19937 rng(7);
        for (int i = 0; i < 1000; ++i) {
            const Ray r = rayAt(rng, .75f);
            Hit a, b;
            EXPECT_EQ(w.accel->intersect(r, a), still.accel->intersect(r, b));
        }
    }
}

} // namespace keyed_test
