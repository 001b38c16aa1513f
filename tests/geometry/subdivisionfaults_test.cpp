// What a file may hold: subdivision meshes with faults, of any topology, and large ones.
#include "cages.h"
#include <gtest/gtest.h>

namespace subdivision_test {

TEST(Subdivision, FaultyCagesAreReportedAndTheRestDrawn) {
    struct Case {
        const char* name;
        std::function<void(scene::Primitive&)> spoil;
        bool drawn;
    };
    const Case cases[] = {
        {"no P", [](auto& p) { p.params.erase(p.params.begin()); }, false},
        {"NaN", [](auto& p) { p.params[0].numbers[4] = NAN; }, false},
        {"infinite", [](auto& p) { p.params[0].numbers[4] = INFINITY; }, false},
        {"count beyond", [](auto& p) { p.ints[2] = 2000000000; }, false},
        {"negative count", [](auto& p) { p.ints[2] = -4; }, false},
        {"no faces",
         [](auto& p) {
             p.ints.clear();
             p.ints2.clear();
         },
         false},
        {"index beyond", [](auto& p) { p.ints2[1] = 99; }, true},
        {"index negative", [](auto& p) { p.ints2[1] = -1; }, true},
        {"a vertex twice", [](auto& p) { p.ints2[1] = p.ints2[0]; }, true},
        {"thin",
         [](auto& p) {
             p.ints[0] = 2;
             p.ints.push_back(2);
             std::rotate(p.ints2.begin() + 2, p.ints2.begin() + 4, p.ints2.end());
         },
         true},
        {"loop of quadrilaterals", [](auto& p) { p.strings[0] = "loop"; }, true},
        {"scheme", [](auto& p) { p.strings[0] = "butterfly"; }, true},
    };
    for (const Case& c : cases) {
        auto p = cube().primitive();
        c.spoil(*p);
        Diagnostics diag;
        ShapeRef s = build(p, Matrix(), diag);
        EXPECT_EQ(bool(s), c.drawn) << c.name;
        EXPECT_GE(diag.errors() + diag.warnings(), 1) << c.name;
        if (!s) continue;
        s->dice(camera(5), diag);
        EXPECT_GT(s->mesh().triangles(), 0u) << c.name;
    }
}

TEST(Subdivision, FaultyTagsAreReported) {
    const std::vector<Cage::Tag> faulty = {
        {"crease", {4}, {10}, {}},        {"crease", {4, 5}, {}, {}},           {"crease", {4, 99}, {2}, {}},
        {"crease", {4, 4}, {2}, {}},      {"crease", {4, 5, 6}, {1, 2, 3}, {}}, {"corner", {77}, {10}, {}},
        {"corner", {}, {1}, {}},          {"corner", {1, 2, 3}, {1, 2}, {}},    {"hole", {6}, {}, {}},
        {"hole", {-1}, {}, {}},           {"interpolateboundary", {7}, {}, {}}, {"facevaryinginterpolateboundary", {-1}, {}, {}},
        {"smoothtriangles", {5}, {}, {}}, {"creasemethod", {4}, {}, {}},        {"cream", {}, {}, {}},
        {"crease", {NAN, 1}, {1}, {}},
    };
    for (const Cage::Tag& t : faulty) {
        Diagnostics diag;
        ShapeRef s = build(with(cube(), "", {t}).primitive(), Matrix(), diag);
        EXPECT_TRUE(s);
        EXPECT_EQ(diag.warnings(), 1) << t.name;
    }
    auto p = with(cube(), "", {{"crease", {4, 5}, {2}, {}}}).primitive();
    p->ints3 = {2000000000, 1};
    Diagnostics diag;
    EXPECT_TRUE(build(p, Matrix(), diag));
    EXPECT_EQ(diag.errors(), 1);
}

TEST(Subdivision, AnyTopologyIsDrawnWithoutFault) {
    // Faces over few points: non-manifold edges and vertices, faces twice, turned faces, isolated points, fans, creases anywhere.
    std::mt19937 random(11);
    const auto number = [&](int n) { return int(random() % unsigned(n)); };
    for (int turn = 0; turn < 250; ++turn) {
        Cage c;
        const int points = 4 + number(8), faces = 1 + number(14);
        for (int i = 0; i < 3 * points; ++i) c.P.push_back(float(number(100)) / 50 - 1);
        const bool loop = turn % 3 == 0;
        if (loop) c.scheme = "loop";
        if (turn % 7 == 0) c.scheme = "bilinear";
        for (int f = 0; f < faces; ++f) {
            std::vector<int> v(static_cast<size_t>(points));
            for (int i = 0; i < points; ++i) v[size_t(i)] = i;
            std::shuffle(v.begin(), v.end(), random);
            const int n = loop ? 3 : 3 + number(std::min(4, points - 2));
            c.nverts.push_back(n);
            c.verts.insert(c.verts.end(), v.begin(), v.begin() + n);
        }
        for (int k = 0; k < 4; ++k)
            c.tags.push_back({"crease", {float(number(points)), float(number(points))}, {float(number(120)) / 10}, {}});
        c.tags.push_back({"corner", {float(number(points))}, {float(number(120)) / 10}, {}});
        if (number(3)) c.tags.push_back({"interpolateboundary", {float(number(3))}, {}, {}});
        c.tags.push_back({"facevaryinginterpolateboundary", {float(number(4))}, {}, {}});
        if (number(2)) c.tags.push_back({"hole", {float(number(faces))}, {}, {}});
        if (number(2)) c.tags.push_back({"creasemethod", {1}, {}, {}});
        if (number(2)) c.tags.push_back({"smoothtriangles", {2}, {}, {}});
        std::vector<float> corner;
        for (size_t i = 0; i < c.verts.size(); ++i) corner.push_back(float(number(3)));
        c.more = {param("s", scene::Class::FaceVarying, scene::Type::Float, corner)};
        Diagnostics diag;
        ShapeRef s = build(c.primitive(), translateMatrix(0, 0, 4), diag);
        if (!s) continue;
        s->dice(camera(20), diag);
        const TriMesh& m = s->mesh();
        for (uint32_t t = 0; t < m.triangles(); t += 7) {
            const SurfacePoint p = s->evaluateHit(t, 0.2, 0.5);
            EXPECT_TRUE(std::isfinite(p.P.x + p.P.y + p.P.z + p.n.x + p.n.y + p.n.z + p.s));
            EXPECT_LT(length(p.P), 10);
        }
        EXPECT_TRUE(std::isfinite(s->area()));
    }
}

TEST(Subdivision, AFanOfManyFacesTakesLittle) {
    for (int n : {64, 300, 2000}) {
        Cage c;
        c.P = {0, 0, 1};
        for (int i = 0; i < n; ++i) {
            const double a = 2 * kPi * i / n;
            c.P.insert(c.P.end(), {float(std::cos(a)), float(std::sin(a)), 0});
        }
        for (int i = 0; i < n; ++i) c.nverts.push_back(3), c.verts.insert(c.verts.end(), {0, 1 + i, 1 + (i + 1) % n});
        c.tags = {kBoundary};
        Diagnostics diag;
        ShapeRef s = build(c.primitive(), Matrix(), diag);
        ASSERT_TRUE(s) << n;
        s->dice(camera(3), diag);
        EXPECT_GT(s->mesh().triangles(), size_t(n));
        EXPECT_EQ(diag.warnings(), n >= 1000 ? 1 : 0) << n;
    }
}

} // namespace subdivision_test
