// Displaced meshes: their facets meet, no ray passes between them, and bounds that are too small are said.
#include "accel/accel.h"
#include "cages.h"
#include <gtest/gtest.h>

namespace subdivision_test {

TEST(Displacement, FacesOfAPolygonMeshMeetToTheBit) {
    // A cube whose faces have no normals but their own: each corner and edge moves to the middle of where its faces take it. Once
    // with shared points, once with points of its own for every face.
    for (bool own : {false, true}) {
        Cage c = cube();
        if (own) {
            std::vector<float> P;
            for (int v : c.verts) P.insert(P.end(), {c.P[3 * size_t(v)], c.P[3 * size_t(v) + 1], c.P[3 * size_t(v) + 2]});
            c.P = P;
            for (size_t i = 0; i < c.verts.size(); ++i) c.verts[i] = int(i);
        }
        auto p = c.primitive();
        p->kind = "PointsPolygons";
        p->strings.clear();
        p->params = {points(c.P)};
        Diagnostics diag;
        DiceOptions o = camera(20);
        o.displaces = [](const Shape&) { return true; };
        o.displace = [](const Shape&, DiceGrid& g) {
            for (size_t i = 0; i < g.points.size(); ++i)
                g.P[i] = g.P[i] + g.points[i].n * (0.2f * std::sin(5 * g.points[i].P.x + 3 * g.points[i].P.y));
        };
        ShapeRef s = build(p, rotateMatrix(20, 1, 2, 3) * translateMatrix(0, 0.3, 3), diag);
        s->dice(o, diag);
        EXPECT_EQ(openEdges(s->mesh()), 0u) << own;
    }
}

TEST(Displacement, AnExceededBoundIsReportedWithTheFactor) {
    Diagnostics diag;
    DiceOptions o = camera(10);
    o.displaces = [](const Shape&) { return true; };
    o.displace = [](const Shape&, DiceGrid& g) {
        for (size_t i = 0; i < g.points.size(); ++i) g.P[i] = g.P[i] + Vec3(0, 0, 0.5f);
    };
    scene::Attributes a;
    a.values["displacementbound:sphere"] = param("sphere", scene::Class::Constant, scene::Type::Float, {0.15f});
    ShapeRef s = build(cube().primitive(), Matrix(), diag, a);
    s->dice(o, diag);
    ASSERT_EQ(diag.warnings(), 1);
    EXPECT_NE(diag.all()[0].hint.find("times 3.34"), std::string::npos) << diag.all()[0].hint;
}

TEST(Displacement, NoRayLeavesAClosedForm) {
    std::mt19937 random(3);
    const auto uniform = [&] { return double(random()) / 4294967296.0; };
    size_t rays = 0;
    for (const Cage& cage : {cube(), prism(5), octahedron(), looped(octahedron()),
                             with(cube(), " creased", {{"crease", {4, 5, 6, 7, 4}, {10}, {}}})})
        for (int kind : {0, 1, 2}) { // as it is, displaced, the cage as displaced polygons
            Diagnostics diag;
            DiceOptions o = camera(25);
            o.camera.perspective = true;
            o.displaces = [&](const Shape&) { return kind > 0; };
            o.displace = [](const Shape&, DiceGrid& g) {
                for (size_t i = 0; i < g.points.size(); ++i)
                    g.P[i] = g.P[i] + g.points[i].n * (0.05f * std::sin(11 * g.points[i].P.x) + 0.02f * g.points[i].s);
            };
            auto p = cage.primitive();
            if (kind == 2) {
                p->kind = "PointsPolygons";
                p->strings.clear();
                p->params = {points(cage.P)};
            }
            const Vec3d centre(0, 0.3, 3);
            ShapeRef s = build(p, translateMatrix(centre.x, centre.y, centre.z), diag);
            s->dice(o, diag);
            accel::Accel tree({s}, {}, diag);
            size_t lost = 0;
            for (int k = 0; k < 67000; ++k, ++rays) {
                accel::Ray r;
                r.org = Vec3(centre + Vec3d(uniform() - 0.5, uniform() - 0.5, uniform() - 0.5) * 0.2);
                // Half of them at a vertex of the mesh, where facets meet.
                const Vec3d at = k % 2 ? Vec3d(s->mesh().P[random() % s->mesh().vertices])
                                       : centre + Vec3d(uniform() - 0.5, uniform() - 0.5, uniform() - 0.5);
                r.dir = Vec3(at - Vec3d(r.org));
                r.sides = accel::Sides::Both;
                lost += !tree.occluded(r);
            }
            EXPECT_EQ(lost, 0u) << cage.name << " " << kind;
        }
    EXPECT_GE(rays, 1000000u);
}

} // namespace subdivision_test
