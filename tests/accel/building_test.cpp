// What trees are built by: groups of references, halves of quads, pieces of curves, the order of children; and a tree of several
// levels of groups.
#include "../geometry/make.h"
#include "accel/bvh_cut.h"
#include "accel/bvh_groups.h"
#include "accel/impl.h"
#include "geometry/bernstein.h"
#include "geometry/curve_pieces.h"
#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace building_test {

using namespace alpenglow;
using namespace alpenglow::accel;
using namespace alpenglow::geometry::test;
using geometry::ShapeRef;

namespace {

using Rng = std::mt19937;
float uniform(Rng& r, float lo, float hi) { return lo + (hi - lo) * float(r() >> 8) * 0x1p-24f; }
Vec3 within(Rng& r, float size) { return {uniform(r, -size, size), uniform(r, -size, size), uniform(r, -size, size)}; }

std::shared_ptr<scene::Primitive> trianglesOf(const std::vector<Vec3>& corners) {
    auto p = std::make_shared<scene::Primitive>();
    p->kind = "PointsPolygons";
    std::vector<float> P;
    for (const Vec3& v : corners) {
        p->ints2.push_back(int(p->ints2.size()));
        P.insert(P.end(), {v.x, v.y, v.z});
    }
    p->ints.assign(corners.size() / 3, 3);
    p->params = {points(P)};
    return p;
}

/// Small boxes, in one of several ways: everywhere, in a plane, crowded at one corner, at one place.
std::vector<Ref> refsOf(Rng& rng, size_t n, int way) {
    std::vector<Ref> refs(n);
    for (size_t i = 0; i < n; ++i) {
        Vec3 at = within(rng, 1);
        if (way == 1) at.y = 0.25f;
        if (way == 2) at = at * std::exp(uniform(rng, -20, 0));
        if (way == 3) at = {1, 2, 3};
        const float size = way == 3 ? 0.5f : uniform(rng, 0, 0.01f);
        refs[i].lo = Four{at.x - size, at.y - size, at.z - size, 0};
        refs[i].hi = Four{at.x + size, at.y + size, at.z + size, float(1 + i % 3)};
        refs[i].setId(uint32_t(i));
    }
    return refs;
}

bool same(Four a, Four b) { return a[0] == b[0] && a[1] == b[1] && a[2] == b[2]; }

/// The halves below one: boxes are those of their references, and both parts of a half follow one another.
void expectHalves(const std::vector<Half>& halves, int at, const std::vector<Ref>& refs, size_t& groups) {
    const Half& h = halves[size_t(at)];
    Box box, centres;
    for (size_t i = h.range.begin; i < h.range.end; ++i) {
        box.add(refs[i].lo, refs[i].hi);
        centres.add(refs[i].twiceCentre(), refs[i].twiceCentre());
    }
    ASSERT_GT(h.range.size(), 0u);
    ASSERT_TRUE(same(box.lo, h.range.box.lo) && same(box.hi, h.range.box.hi));
    ASSERT_TRUE(same(centres.lo, h.range.centres.lo) && same(centres.hi, h.range.centres.hi));
    if (h.left < 0) {
        ++groups;
        return;
    }
    const Range &a = halves[size_t(h.left)].range, &b = halves[size_t(h.right)].range;
    ASSERT_TRUE(a.begin == h.range.begin && a.end == b.begin && b.end == h.range.end);
    expectHalves(halves, h.left, refs, groups);
    expectHalves(halves, h.right, refs, groups);
}

} // namespace

TEST(Groups, HoldEachReferenceOnce) {
    Rng rng(2);
    for (int way = 0; way < 3; ++way)
        for (const size_t n : {size_t(600), size_t(20'000), size_t(300'000)})
            for (const int depth : {0, 40}) {
                std::vector<Ref> refs = refsOf(rng, n, way);
                Range all;
                all.begin = 7; // what lies before and behind stays
                all.end = n - 5;
                for (size_t i = all.begin; i < all.end; ++i) {
                    all.box.add(refs[i].lo, refs[i].hi);
                    all.centres.add(refs[i].twiceCentre(), refs[i].twiceCentre());
                }
                const std::vector<Half> halves = inGroups(refs.data(), all, depth);
                ASSERT_FALSE(halves.empty());
                EXPECT_EQ(halves[0].range.begin, all.begin);
                EXPECT_EQ(halves[0].range.end, all.end);
                size_t groups = 0;
                expectHalves(halves, 0, refs, groups);
                EXPECT_EQ(halves.size(), 2 * groups - 1);
                std::vector<int> there(n);
                for (const Ref& r : refs) ++there[r.id()];
                EXPECT_EQ(std::count(there.begin(), there.end(), 1), long(n));
                for (size_t i = 0; i < 7; ++i) EXPECT_EQ(refs[i].id(), i);
                for (size_t i = n - 5; i < n; ++i) EXPECT_EQ(refs[i].id(), i);
            }
}

TEST(Groups, OneCellIsNoGroup) {
    Rng rng(3);
    std::vector<Ref> refs = refsOf(rng, 5000, 3);
    Range all;
    all.end = refs.size();
    all.box.add(refs[0].lo, refs[0].hi);
    all.centres.add(refs[0].twiceCentre(), refs[0].twiceCentre());
    EXPECT_TRUE(inGroups(refs.data(), all, 40).empty());
}

// More than a quarter of a million triangles: groups of groups. Nothing is overlooked: rays against every triangle.
TEST(Groups, TreesOverlookNone) {
    Rng rng(5);
    std::vector<Vec3> corners;
    for (int i = 0; i < 270'000; ++i) {
        const Vec3 a = within(rng, 1) * (i % 3 ? 1.f : 1e-3f);
        for (const Vec3& v : {a, a + within(rng, 0.02f), a + within(rng, 0.02f)}) corners.push_back(v);
    }
    Diagnostics diag;
    const std::vector<ShapeRef> shapes{build(trianglesOf(corners), Matrix(), diag)};
    Accel::Impl in;
    in.shapes = shapes;
    in.visibility.assign(1, kAll);
    in.buildTree();
    const geometry::TriMesh& m = shapes[0]->mesh();
    ASSERT_EQ(m.triangles(), 270'000u);
    int met = 0;
    for (int k = 0; k < 60; ++k) {
        Ray r;
        r.org = within(rng, 2);
        r.dir = within(rng, 0.5f) - r.org;
        Query q{&r, {INFINITY, kNone, kNone, 0, 0}, false};
        for (uint32_t t = 0; t < m.triangles(); ++t)
            in.meetOne(q, 0, t, m.P[m.index[3 * t]], m.P[m.index[3 * t + 1]], m.P[m.index[3 * t + 2]]);
        Hit h;
        uint8_t any;
        in.walkNearest({&r, 1}, {&h, 1});
        in.walkAny({&r, 1}, {&any, 1});
        ASSERT_EQ(h.valid(), q.best.shape != kNone) << k;
        ASSERT_EQ(any != 0, h.valid());
        if (!h.valid()) continue;
        ++met;
        ASSERT_EQ(h.prim, q.best.prim);
        ASSERT_EQ(h.distance, q.best.t);
    }
    EXPECT_GT(met, 30);
}

TEST(Building, HalvesOfAQuadStayTogether) {
    geometry::TriMesh m;
    m.P = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, -1, 0}, {1e31f, 0, 0}};
    m.made = {0, 1, 2, 0, 2, 3, 1, 0, 2, 0, 1, 4, 0, 1, 5, 3, 4, 5};
    m.finish();
    EXPECT_EQ(pair(m, 0, 6), 2u); // both fill the box
    EXPECT_EQ(pair(m, 0, 1), 1u); // the last of its run
    EXPECT_EQ(pair(m, 1, 6), 2u);
    EXPECT_EQ(pair(m, 2, 6), 1u); // the second makes the box twice as large
    EXPECT_EQ(pair(m, 3, 6), 1u); // reaches too far
    EXPECT_EQ(pair(m, 4, 6), 1u); // a corner is all they share
}

// Boxes that are filled stop rays: shadow rays begin with them, at the last child.
TEST(Building, WhatFillsItsBoxIsTheLastChild) {
    std::vector<Vec3> corners;
    for (int i = 0; i < 7; ++i) { // two specks, far apart, a leaf each
        const Vec3 a(float(3 * i), 0, float(i % 2)), b = a + Vec3(1, 1, 1);
        for (const Vec3& v : {a, a + Vec3(.01f, 0, 0), a + Vec3(0, .01f, 0), b, b - Vec3(.01f, 0, 0), b - Vec3(0, .01f, 0)})
            corners.push_back(v);
    }
    for (const Vec3& v : {Vec3(9, 5, 0), Vec3(10, 5, 0), Vec3(10, 6, 0), Vec3(9, 5, 0), Vec3(10, 6, 0), Vec3(9, 6, 0)})
        corners.insert(corners.begin() + 12, v);
    Diagnostics diag;
    const ShapeRef s = build(trianglesOf(corners), Matrix(), diag);
    Bvh tree;
    tree.build({&s, 1});
    const Bvh::Node& root = tree.nodes()[0];
    Bvh::Child last = Bvh::kNothing;
    for (const Bvh::Child c : root.child)
        if (c != Bvh::kNothing) last = c;
    ASSERT_TRUE(last & Bvh::kLeaf);
    const Bvh::Leaf& leaf = tree.leaves()[last & Bvh::kIndex];
    for (uint32_t t = 0; t < leaf.size(); ++t) EXPECT_TRUE(leaf.id[t] == 4 || leaf.id[t] == 5) << leaf.id[t];
}

// One primitive without bounds among a thousand small ones is parted from them first.
TEST(Building, WhatHasNoBoundsIsCutOff) {
    Rng rng(4);
    std::vector<Ref> refs = refsOf(rng, 1000, 0);
    refs[500].lo = Four{-kHuge, -kHuge, -kHuge, 0};
    refs[500].hi = Four{kHuge, kHuge, -0.9f, 1};
    refs[500].setId(500);
    const Range all = measuredRange(refs.data(), 0, refs.size());
    Range a, b;
    ASSERT_TRUE(cutInTwo(refs.data(), all, a, b));
    const Range& few = a.size() < b.size() ? a : b;
    ASSERT_EQ(few.size(), 1u);
    EXPECT_EQ(refs[few.begin].id(), 500u);
}

// Against pieces in double, near and far from the eye.
TEST(Building, PiecesOfCurvesAreInTheirBoxes) {
    Rng rng(9);
    for (int turn = 0; turn < 300; ++turn) {
        const double away = turn % 2 ? 100 : 0, wide = std::exp(double(uniform(rng, -8, -2)));
        const uint32_t parts = 1u << turn % 6;
        Vec3d p[4];
        for (Vec3d& q : p) q = Vec3d(within(rng, 1)) + Vec3d(0, away, away);
        geometry::CurvePieces pieces(parts);
        pieces.take(p, wide, Vec3d(wide));
        for (uint32_t k = 0; k < parts; ++k) {
            const geometry::Bounds b = pieces.box(k);
            Vec3d q[4];
            std::copy(p, p + 4, q);
            geometry::bernsteinPart<3>(q, double(k) / parts, double(k + 1) / parts);
            for (int a = 0; a < 3; ++a) {
                const double lo = std::min({q[0][a], q[1][a], q[2][a], q[3][a]}) - wide,
                             hi = std::max({q[0][a], q[1][a], q[2][a], q[3][a]}) + wide, room = 2e-5 + 5e-6 * away;
                ASSERT_LE(double(b.lo[a]), lo);
                ASSERT_GE(double(b.hi[a]), hi);
                ASSERT_GE(double(b.lo[a]), lo - room);
                ASSERT_LE(double(b.hi[a]), hi + room);
            }
        }
    }
}

} // namespace building_test
