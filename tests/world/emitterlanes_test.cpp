// Stage place (lanes/stages.h): points of lamps of a few triangles have the bits of Emitter::sample(), at every width.
#include "geometry/make.h"
#include "integrator/names.h"
#include "lanes/stages.h"
#include "world/arealight.h"
#include <bit>
#include <gtest/gtest.h>
#include <random>

namespace emitterlanes_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::geometry::test;

namespace {

struct Lamp {
    Diagnostics diagnostics;
    geometry::ShapeRef shape;
    std::unique_ptr<Emitter> emitter;
    explicit Lamp(const std::shared_ptr<scene::Primitive>& p) {
        shape = build(p, rotateMatrix(40, 1, 2, .5) * scaleMatrix(1.3, 1.3, .8) * translateMatrix(.3, -1, 2), diagnostics);
        const geometry::DiceOptions options;
        geometry::diceShapes({shape}, options, diagnostics);
        emitter = std::make_unique<Emitter>(std::vector<const geometry::Shape*>{shape.get()});
    }
};

struct Draws {
    std::mt19937 random{3};
    float one(float low = 0, float high = 1) { return low + (high - low) * std::generate_canonical<float, 24>(random); }
    Vec3 vector(float size) { return {one(-size, size), one(-size, size), one(-size, size)}; }
};
bool same(float a, float b) { return std::bit_cast<uint32_t>(a) == std::bit_cast<uint32_t>(b); }

/// Points far and near, on the lamp's plane, at its corners and on it.
VertexBlock points(Draws& d, const geometry::Shape& s, int turn) {
    VertexBlock v{};
    v.points = 0xffffu;
    const geometry::Bounds box = s.bounds();
    for (int i = 0; i < kBlock; ++i) {
        const geometry::SurfacePoint on = s.sampleArea(d.one(), d.one());
        Vec3 P = Vec3((box.lo + box.hi) * .5f) + d.vector(turn % 3 == 0 ? 12 : turn % 3 == 1 ? 3 : .5f);
        if (i == turn % 19) P = on.P;
        if (i == turn % 23) P = s.mesh().P[size_t(turn) % s.mesh().vertices];
        if (i == turn % 29) P = on.P + on.dPdu * d.one(-3, 3);
        for (int q = 0; q < 3; ++q) v.P[q][i] = P[q];
    }
    return v;
}

void expectSame(const Emitter& e, const Stages& s, const FlatEmitter& f, const VertexBlock& v, const Row& x, const Row& y) {
    LightBlock l{};
    constexpr int kStride = 2 * kBlock;
    alignas(64) static float P[3 * kStride], N[3 * kStride];
    alignas(64) double share[kBlock];
    std::fill_n(share, kBlock, 1.0);
    const Lanes placed = s.place(v, f, x, y, share, l, P + kBlock, N + kBlock, kStride);
    for (int i = 0; i < kBlock; ++i) {
        Emitter::Sample one;
        geometry::SurfacePoint p;
        bool there = e.sample({v.P[0][i], v.P[1][i], v.P[2][i]}, {x[i], y[i]}, 0, 0, one, p);
        if (f.oneSided && there) there = dot(p.n, one.direction) < 0;
        ASSERT_EQ(placed >> i & 1, there);
        if (!there) continue;
        const Vec3 end = leavesFrom(p, -one.direction);
        EXPECT_TRUE(same(l.density[i], one.pdf)) << l.density[i] << " " << one.pdf;
        for (int q = 0; q < 3; ++q) {
            EXPECT_TRUE(same(P[q * kStride + kBlock + i], p.P[q]));
            EXPECT_TRUE(same(N[q * kStride + kBlock + i], p.n[q]));
            EXPECT_TRUE(same(l.w[q][i], one.direction[q]));
            EXPECT_TRUE(same(l.end[q][i], end[q]));
        }
    }
}
} // namespace

TEST(EmitterLanes, PlaceHasTheBitsOfOnePoint) {
    auto solid = std::make_shared<scene::Primitive>();
    solid->kind = "PointsPolygons";
    solid->ints = {4, 3, 3};
    solid->ints2 = {0, 1, 2, 3, 0, 4, 1, 3, 2, 4};
    solid->params = {geometry::test::points({-1, 0, 0, 1, 0, 0, 1, 1, .2f, -1, 1, .2f, 0, -1, 1})};
    const std::shared_ptr<scene::Primitive> lamps[] = {polygon({-1, -.5f, 0, 1, -.5f, 0, 1, .5f, 0, -1, .5f, 0}),
                                                       polygon({0, 0, 0, 2, 0, 0, 0, 1, 1}), solid};
    for (const auto& primitive : lamps) {
        const Lamp lamp(primitive);
        ASSERT_EQ(lamp.emitter->flat().size(), 1u);
        EXPECT_EQ(lamp.emitter->flat()[0].count, int(lamp.shape->mesh().triangles()));
        FlatEmitter oneSided = lamp.emitter->flat()[0];
        oneSided.oneSided = true;
        Draws d;
        int near = 0, all = 0;
        for (int turn = 0; turn < 200; ++turn) {
            const VertexBlock v = points(d, *lamp.shape, turn);
            Row x, y;
            for (int i = 0; i < kBlock; ++i, ++all) {
                const Vec3d way =
                    Vec3d(v.P[0][i], v.P[1][i], v.P[2][i]) - Vec3d(oneSided.centre[0], oneSided.centre[1], oneSided.centre[2]);
                near += dot(way, way) < oneSided.near2;
            }
            for (int i = 0; i < kBlock; ++i)
                x[i] = turn % 31 == i ? 0 : d.one(), y[i] = turn % 37 == i ? 0x1.fffffep-1f : d.one();
            for (int lanes : {4, 8, 16})
                if (const Stages* s = stages(lanes))
                    expectSame(*lamp.emitter, *s, turn % 2 ? oneSided : lamp.emitter->flat()[0], v, x, y);
        }
        EXPECT_GT(near, all / 4);
        EXPECT_LT(near, all * 3 / 4);
    }
}

/// Points of lamps that each point has of its own are those that each lamp gives by itself.
TEST(EmitterLanes, EachPointHasALampOfItsOwn) {
    std::vector<std::unique_ptr<Lamp>> lamps;
    for (const auto& p : {polygon({-1, -.5f, 0, 1, -.5f, 0, 1, .5f, 0, -1, .5f, 0}), polygon({0, 0, 0, 2, 0, 0, 0, 1, 1}),
                          polygon({0, 0, 0, .2f, 0, .1f, 0, .1f, 0})})
        lamps.push_back(std::make_unique<Lamp>(p));
    std::vector<FlatEmitter> flat;
    for (const auto& l : lamps) flat.push_back(l->emitter->flat()[0]);
    flat.push_back(flat[0]);
    flat.back().oneSided = true;
    Draws d;
    constexpr int kStride = 2 * kBlock;
    alignas(64) static float P[2][3 * kStride], N[2][3 * kStride];
    for (int turn = 0; turn < 300; ++turn) {
        const VertexBlock v = points(d, *lamps[size_t(turn) % 3]->shape, turn);
        Row x, y;
        alignas(64) double share[kBlock];
        const FlatEmitter* of[kBlock];
        for (int i = 0; i < kBlock; ++i) {
            x[i] = turn % 31 == i ? 0 : d.one(), y[i] = turn % 37 == i ? 0x1.fffffep-1f : d.one();
            share[i] = double(d.one(.1f));
            of[i] = &flat[turn % 2 ? d.random() % 4 : size_t(i / 4)];
        }
        for (int lanes : {4, 8, 16}) {
            const Stages* s = stages(lanes);
            if (!s) continue;
            LightBlock each{}, one{};
            const Lanes there = s->placeEach(v, of, x, y, share, each, P[0], N[0], kStride);
            for (const FlatEmitter& f : flat) {
                const Lanes alone = s->place(v, f, x, y, share, one, P[1], N[1], kStride);
                for (int i = 0; i < kBlock; ++i) {
                    if (of[i] != &f) continue;
                    ASSERT_EQ(there >> i & 1, alone >> i & 1) << turn << " " << i;
                    if (!(there >> i & 1)) continue;
                    EXPECT_TRUE(same(each.density[i], one.density[i]));
                    for (int q = 0; q < 3; ++q) {
                        EXPECT_TRUE(same(P[0][q * kStride + i], P[1][q * kStride + i]));
                        EXPECT_TRUE(same(N[0][q * kStride + i], N[1][q * kStride + i]));
                        EXPECT_TRUE(same(each.w[q][i], one.w[q][i]));
                        EXPECT_TRUE(same(each.end[q][i], one.end[q][i]));
                    }
                }
            }
        }
    }
}

TEST(EmitterLanes, OthersAreNotFlat) {
    std::vector<float> fan = {0, 0, 0};
    for (int i = 0; i < 7; ++i) fan.insert(fan.end(), {std::cos(float(i) * .8f), std::sin(float(i) * .8f), 0});
    for (const auto& p :
         {polygon(fan), quadric("Sphere", {1, -1, 1, 360}), patch("bilinear", {-1, -1, 0, 1, -1, .4f, -1, 1, .3f, .8f, 1, -.2f})})
        EXPECT_TRUE(Lamp(p).emitter->flat().empty()) << p->kind;
}

} // namespace emitterlanes_test
