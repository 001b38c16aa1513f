// The edits of hierarchical subdivision meshes.
#include "cages.h"
#include <gtest/gtest.h>

namespace subdivision_test {

TEST(HierarchicalSubdivision, WithoutEffectTheSurfaceIsTheSame) {
    for (Cage cage :
         {cube(), prism(5), looped(octahedron()), with(cube(), " creased 1.5", {{"crease", {4, 5, 6, 7, 4}, {1.5f}, {}}})}) {
        std::vector<float> x, corner;
        for (size_t i = 0; i < cage.P.size(); i += 3) x.push_back(cage.P[i]);
        for (int v : cage.verts) corner.push_back(x[size_t(v)]);
        cage.more = {param("smooth", scene::Class::Vertex, scene::Type::Float, x),
                     param("corner", scene::Class::FaceVarying, scene::Type::Float, corner),
                     param("cornersmooth", scene::Class::FaceVertex, scene::Type::Float, corner),
                     param("s", scene::Class::Varying, scene::Type::Float, x)};
        Cage edited = cage;
        edited.tags.push_back({"vertexedit", {4, 1, 0, 2, 1}, {0, 0, 0}, {"add", "P", "value"}});
        Diagnostics diag;
        ShapeRef a = build(cage.primitive(), skewed(), diag),
                 b = build(edited.primitive("HierarchicalSubdivisionMesh"), skewed(), diag);
        ASSERT_TRUE(a && b) << cage.name;
        EXPECT_EQ(diag.errors() + diag.warnings(), 0) << cage.name;
        EXPECT_GT(b->faces(), a->faces() * 15);
        // A face of the fine cage says where on the face it came from it is: faces come in the order of those they came from.
        size_t at = 0;
        for (size_t f = 0; f < cage.nverts.size(); ++f) {
            const bool split = cage.scheme != "loop" && cage.nverts[f] != 4;
            const size_t children = 4 * (cage.scheme == "loop" ? 4 : size_t(cage.nverts[f]));
            for (size_t k = 0; k < children; ++k, ++at) {
                const SurfacePoint q = b->evaluate(int(at), 0.3, 0.4);
                const double piece = split ? double(k / 4) : 0;
                const SurfacePoint p = a->evaluate(int(f), piece + q.u, q.v);
                EXPECT_LT(length(Vec3d(p.P) - Vec3d(q.P)), 2e-5) << cage.name << " " << at;
                EXPECT_LT(length(Vec3d(p.dPdu) - Vec3d(q.dPdu)), 2e-5) << cage.name;
                EXPECT_LT(length(Vec3d(p.n) - Vec3d(q.n)), 2e-5) << cage.name;
                for (const char* v : {"smooth", "corner", "cornersmooth", "s"}) {
                    float du, dv, eu, ev;
                    EXPECT_NEAR(value(*a, v, p, &du, &dv), value(*b, v, q, &eu, &ev), 2e-5) << cage.name << " " << v;
                    EXPECT_NEAR(du, eu, 3e-5);
                    EXPECT_NEAR(dv, ev, 3e-5);
                }
            }
        }
        EXPECT_NEAR(a->area(), b->area(),
                    6e-3 * a->area()); // of 4 points a direction and face, where there are corners and creases
        double sum = 0;
        for (int i = 0; i < 64 * 64; ++i) sum += 1 / b->sampleDensity(b->sampleArea((i % 64 + 0.5) / 64, (i / 64 + 0.5) / 64));
        EXPECT_NEAR(sum / (64 * 64), b->area(), 1e-2 * b->area());
    }
}

TEST(HierarchicalSubdivision, ValuesSharpnessAndHolesAreEdited) {
    Cage c = grid(3);
    for (size_t i = 2; i < c.P.size(); i += 3) c.P[i] = 0;
    const auto height = [&](std::vector<Cage::Tag> tags, double x, double y) {
        Cage e = c;
        e.tags.insert(e.tags.end(), tags.begin(), tags.end());
        Diagnostics diag;
        ShapeRef s = build(e.primitive("HierarchicalSubdivisionMesh"), Matrix(), diag);
        EXPECT_EQ(diag.warnings() + diag.errors(), 0);
        double nearest = 1e9, z = 0;
        for (int f = 0; f < s->faces(); ++f)
            for (double u : {0.0, 0.5, 1.0})
                for (double v : {0.0, 0.5, 1.0}) {
                    const SurfacePoint p = s->evaluate(f, u, v);
                    const double d = std::hypot(p.P.x - x, p.P.y - y);
                    if (d < nearest) nearest = d, z = p.P.z;
                }
        return z;
    };
    // Corner 2 of part 0 of the middle face is that face's middle, raised by 1: 16/36 of it is the limit there (16/36 v + 4/36 e
    // + 1/36 f).
    const Cage::Tag raise{"vertexedit", {3, 4, 0, 2}, {0, 0, 1}, {"add", "P", "value"}};
    EXPECT_NEAR(height({raise}, 1.5, 1.5), 16 / 36.0, 1e-6);
    EXPECT_NEAR(height({{"vertexedit", {3, 4, 0, 2}, {1.5f, 1.5f, 1}, {"set", "P", "value"}}}, 1.5, 1.5), 16 / 36.0, 1e-6);
    // A sharp vertex is met.
    EXPECT_NEAR(height({{"vertexedit", {3, 4, 0, 2}, {0, 0, 1, 10}, {"add", "P", "value", "set", "P", "sharpness"}}}, 1.5, 1.5),
                1, 1e-6);
    // A vertex of the cage itself.
    EXPECT_NEAR(height({{"vertexedit", {2, 4, 0}, {0, 0, 1}, {"add", "P", "value"}}}, 1, 1), 16 / 36.0, 1e-6);
    // A crease through the raised vertex along x: (1 + 4 + 1)/6 with neighbours 0.
    EXPECT_NEAR(height({raise, {"edgeedit", {3, 4, 0, 2, 3, 4, 1, 3}, {10, 10}, {"set", "P", "sharpness"}}}, 1.5, 1.5), 4 / 6.0,
                1e-6);
    Cage holes = c;
    holes.tags.push_back({"faceedit", {2, 4, 1}, {}, {"hole"}});
    Diagnostics diag;
    ShapeRef s = build(holes.primitive("HierarchicalSubdivisionMesh"), Matrix(), diag);
    s->dice(camera(5), diag);
    double area = 0;
    for (uint32_t t = 0; t < s->mesh().triangles(); ++t) {
        const SurfacePoint p = s->evaluateHit(t, 0.3, 0.3);
        EXPECT_FALSE(p.P.x > 1.5 && p.P.x < 2 && p.P.y > 1 && p.P.y < 1.5);
        ++area;
    }
    EXPECT_GT(area, 0);
    EXPECT_NEAR(s->area(), 9 - 0.25, 1e-6);
    EXPECT_EQ(diag.warnings(), 0);
}

TEST(HierarchicalSubdivision, FaultyEditsAreReported) {
    const std::vector<Cage::Tag> faulty = {
        {"vertexedit", {2, 99, 0}, {0, 0, 1}, {"add", "P", "value"}},
        {"vertexedit", {2, 0, 7}, {0, 0, 1}, {"add", "P", "value"}},
        {"vertexedit", {9, 0, 1}, {0, 0, 1}, {"add", "P", "value"}},
        {"vertexedit", {2, 0, 1}, {0, 1}, {"add", "P", "value"}},
        {"vertexedit", {2, 0, 1}, {0, 0, 1}, {"add", "Q", "value"}},
        {"vertexedit", {2, 0, 1}, {0, 0, 1}, {"mul", "P", "value"}},
        {"edgeedit", {2, 0, 1}, {0, 0, 1}, {"add", "P", "value"}},
        {"faceedit", {2, 0, 9}, {}, {"hole"}},
        {"vertexedit", {NAN, 0, 1}, {0, 0, 1}, {"add", "P", "value"}},
        {"faceedit", {1, 0}, {}, {}},
        {"vertexedit", {14, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1}, {0, 0, 1}, {"add", "P", "value"}},
    };
    for (const Cage::Tag& t : faulty) {
        Diagnostics diag;
        EXPECT_TRUE(build(with(cube(), "", {t}).primitive("HierarchicalSubdivisionMesh"), Matrix(), diag));
        EXPECT_EQ(diag.warnings(), 1) << t.name << " " << t.ints[0];
    }
}

} // namespace subdivision_test
