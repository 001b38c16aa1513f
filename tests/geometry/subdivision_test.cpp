// Subdivision surfaces against a slow evaluation that shares no code (subdivision_slow.h), closed forms, and what a file may
// hold.
#include "cages.h"
#include <gtest/gtest.h>

namespace subdivision_test {

TEST(Subdivision, LimitsAreThoseOfRepeatedRefinement) {
    for (const Cage& cage : cages()) {
        Diagnostics diag;
        ShapeRef s = build(cage.primitive(), Matrix(), diag);
        ASSERT_TRUE(s) << cage.name;
        EXPECT_EQ(diag.errors() + diag.warnings(), 0) << cage.name;
        SlowMesh m = cage.slow();
        for (int k = 0; k < 5; ++k) m = m.refined();
        const SlowMesh::Links links = m.links();
        double worst = 0, slope = 0, normal = 0;
        int slopes = 0;
        for (size_t f = 0; f < m.faces.size(); ++f)
            for (size_t k = 0; k < m.faces[f].c.size(); ++k) {
                const SlowMesh::Corner& c = m.faces[f].c[k];
                const SlowMesh::Limit l = m.limit(links, int(f), int(k));
                const bool split = !m.loop && cage.nverts[size_t(m.faces[f].base)] != 4;
                const SurfacePoint p = at(*s, m.faces[f], c, split);
                if (l.known) worst = std::max(worst, length(Vec3d(p.P) - l.P));
                if (!l.slopes) continue;
                ++slopes;
                slope = std::max({slope, length(Vec3d(p.dPdu) - l.du), length(Vec3d(p.dPdv) - l.dv)});
                normal = std::max(normal, length(Vec3d(p.n) - normalize(cross(l.du, l.dv)) * double(p.orientation)));
            }
        // 1e-5 of the size, which is 2 here.
        EXPECT_LT(worst, 2e-5) << cage.name;
        EXPECT_LT(slope, 2e-5) << cage.name;
        EXPECT_LT(normal, 1e-5) << cage.name;
        if (!m.loop) EXPECT_GT(slopes, 100) << cage.name;
    }
}

TEST(Subdivision, PartialsAreTheSlopesOfThePositions) {
    for (const Cage& cage : cages())
        for (const Matrix& m : {Matrix(), skewed()}) {
            Diagnostics diag;
            ShapeRef s = build(cage.primitive(), m, diag);
            for (int f = 0; f < std::min(s->faces(), 6); ++f)
                for (double u : {0.11, 0.23, 0.44})
                    for (double v : {0.13, 0.31, 0.47}) {
                        const double h = 2e-3;
                        const auto e = [&](double x, double y) { return s->evaluate(f, x, y); };
                        const SurfacePoint p = e(u, v), a = e(u + h, v), b = e(u - h, v), c = e(u, v + h), d = e(u, v - h);
                        const double scale = 1 + length(p.dPdu) + length(p.dPdv) + length(p.Puu) + length(p.Pvv);
                        const auto near = [&](const Vec3& x, const Vec3& hi, const Vec3& lo, double wide, const char* what) {
                            EXPECT_LT(length(Vec3d(x) - (Vec3d(hi) - Vec3d(lo)) / (2 * h)), 1e-3 * scale * wide)
                                << cage.name << " " << what << " " << f << " " << u << " " << v;
                        };
                        near(p.dPdu, a.P, b.P, 1, "dPdu");
                        near(p.dPdv, c.P, d.P, 1, "dPdv");
                        near(p.Puu, a.dPdu, b.dPdu, 20, "Puu"); // the third derivatives jump where a semi-sharp crease ends
                        near(p.Puv, a.dPdv, b.dPdv, 20, "Puv");
                        near(p.Pvv, c.dPdv, d.dPdv, 20, "Pvv");
                        near(p.dNdu, a.N, b.N, 20, "dNdu");
                        near(p.dNdv, c.N, d.N, 20, "dNdv");
                        EXPECT_LT(length(Vec3d(p.n) - normalize(cross(Vec3d(p.dPdu), Vec3d(p.dPdv))) * double(p.orientation)),
                                  1e-5);
                    }
        }
}

TEST(Subdivision, NormalsPointWhereThoseOfPolygonsDo) {
    Cage flat = grid(2);
    for (size_t i = 2; i < flat.P.size(); i += 3) flat.P[i] = 0;
    for (const Matrix& m : {Matrix(), scaleMatrix(-1, 1, 1)}) {
        Diagnostics diag;
        auto polygons = flat.primitive();
        polygons->kind = "PointsPolygons";
        polygons->strings.clear();
        polygons->params = {points(flat.P)};
        ShapeRef a = build(flat.primitive(), m, diag), b = build(polygons, m, diag);
        EXPECT_EQ(a->evaluate(1, 0.5, 0.5).n.z, b->evaluate(1, 1.5, 0.5).n.z);
    }
}

TEST(Subdivision, FacetsMeetToTheBitAndLieOnTheLimit) {
    for (const Cage& cage : cages()) {
        if (!cage.tags.empty() && cage.tags[0].name == "interpolateboundary") continue; // not closed
        for (double pixels : {0.5, 7.0, 60.0}) {
            Diagnostics diag;
            // Perspective and near, so that faces have different rates.
            DiceOptions o = camera(pixels);
            o.camera.perspective = true;
            ShapeRef s = build(cage.primitive(), translateMatrix(0, 0.3, 1.6), diag);
            s->dice(o, diag);
            const TriMesh& m = s->mesh();
            ASSERT_GT(m.triangles(), 0u);
            EXPECT_EQ(openEdges(m), 0u) << cage.name << " at " << pixels;
            double far = 0;
            for (uint32_t t = 0; t < m.triangles(); ++t) {
                const SurfacePoint p = s->evaluateHit(t, 1 / 3.0, 1 / 3.0);
                const Vec3d c =
                    (Vec3d(m.P[m.index[3 * t]]) + Vec3d(m.P[m.index[3 * t + 1]]) + Vec3d(m.P[m.index[3 * t + 2]])) / 3.0;
                far = std::max(far, o.camera.pixels(c, Vec3d(p.n) * dot(Vec3d(p.n), Vec3d(p.P) - c)));
                EXPECT_LE(length(Vec3d(p.P) - c), double(p.pError) * 1.001);
            }
            // A tenth of a pixel: the aim is 1/20, and probes miss some of the peaks. Forms a few pixels wide have facets of a
            // pixel, whose chord is up to 1/8 off.
            if (pixels > 1) EXPECT_LT(far, pixels > 10 ? 0.1 : 0.16) << cage.name << " at " << pixels;
        }
    }
}

TEST(Subdivision, DisplacedFacetsMeetToTheBit) {
    for (const Cage& cage : {cube(), prism(5), octahedron(), looped(octahedron()),
                             with(cube(), " creased", {{"crease", {4, 5, 6, 7, 4}, {10}, {}}})}) {
        Diagnostics diag;
        DiceOptions o = camera(60);
        o.camera.perspective = true;
        o.displaces = [](const Shape&) { return true; };
        o.displace = [](const Shape&, DiceGrid& g) {
            for (size_t i = 0; i < g.points.size(); ++i)
                g.P[i] = g.P[i] + g.points[i].n * (0.1f * (g.points[i].s + std::sin(9 * g.points[i].P.x)));
        };
        ShapeRef s = build(cage.primitive(), translateMatrix(0, 0.3, 3), diag);
        s->dice(o, diag);
        EXPECT_EQ(openEdges(s->mesh()), 0u) << cage.name;
        EXPECT_TRUE(s->evaluateHit(0, 0.3, 0.3).displaced);
    }
}

TEST(Subdivision, AreaAndItsSamples) {
    for (const Cage& cage : {cube(), prism(5), looped(octahedron())}) {
        Diagnostics diag;
        ShapeRef s = build(cage.primitive(), skewed(), diag);
        // Against the facets of a fine mesh.
        DiceOptions o = camera(60);
        ShapeRef fine = build(cage.primitive(), skewed(), diag);
        fine->dice(o, diag);
        double facets = 0;
        const TriMesh& m = fine->mesh();
        for (size_t t = 0; t < m.triangles(); ++t) {
            const Vec3d a(m.P[m.index[3 * t]]), b(m.P[m.index[3 * t + 1]]), c(m.P[m.index[3 * t + 2]]);
            facets += 0.5 * length(cross(b - a, c - a));
        }
        EXPECT_NEAR(s->area(), facets, 2e-3 * facets) << cage.name;
        double sum = 0;
        const int n = 96;
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i) sum += 1 / s->sampleDensity(s->sampleArea((i + 0.5) / n, (j + 0.5) / n));
        EXPECT_NEAR(sum / (n * n), s->area(), 5e-3 * s->area()) << cage.name;
    }
}

TEST(Subdivision, VariablesOfAllClasses) {
    for (Cage cage : {cube(), prism(5), looped(octahedron())}) {
        using scene::Class;
        using scene::Type;
        const size_t points = cage.P.size() / 3;
        std::vector<float> x, uniform, corner;
        for (size_t i = 0; i < points; ++i) x.push_back(cage.P[3 * i]);
        for (size_t f = 0; f < cage.nverts.size(); ++f) uniform.push_back(float(f));
        for (int v : cage.verts) corner.push_back(cage.P[3 * size_t(v)]);
        cage.more = {param("smooth", Class::Vertex, Type::Float, x),
                     param("linear", Class::Varying, Type::Float, x),
                     param("one", Class::Constant, Type::Float, {5}),
                     param("face", Class::Uniform, Type::Float, uniform),
                     param("corner", Class::FaceVarying, Type::Float, corner),
                     param("cornersmooth", Class::FaceVertex, Type::Float, corner)};
        Diagnostics diag;
        ShapeRef s = build(cage.primitive(), Matrix(), diag);
        EXPECT_EQ(diag.errors() + diag.warnings(), 0) << cage.name;
        for (int f = 0; f < s->faces(); ++f)
            for (double u : {0.2, 0.45})
                for (double v : {0.1, 0.4}) {
                    const SurfacePoint p = s->evaluate(f, u, v);
                    float du, dv;
                    // The x of the points, given as a variable, is the x of the surface.
                    EXPECT_NEAR(value(*s, "smooth", p, &du, &dv), p.P.x, 2e-6) << cage.name;
                    EXPECT_NEAR(du, p.dPdu.x, 1e-5);
                    EXPECT_NEAR(dv, p.dPdv.x, 1e-5);
                    EXPECT_NEAR(value(*s, "cornersmooth", p, &du, &dv), p.P.x, 2e-6)
                        << cage.name; // without a seam it is the same
                    EXPECT_NEAR(du, p.dPdu.x, 1e-5);
                    EXPECT_EQ(value(*s, "one", p), 5);
                    EXPECT_EQ(value(*s, "face", p), float(f));
                    EXPECT_EQ(p.face, f);
                    // Linear: of the corners, middles of edges and of the face.
                    size_t first = 0;
                    for (int k = 0; k < f; ++k) first += size_t(cage.nverts[size_t(k)]);
                    const int n = cage.nverts[size_t(f)];
                    const auto c = [&](int k) { return double(corner[first + size_t((k + n) % n)]); };
                    double expect;
                    if (cage.scheme == "loop") expect = c(0) * (1 - u - v) + c(1) * u + c(2) * v;
                    else if (n == 4) expect = (c(0) * (1 - u) + c(1) * u) * (1 - v) + (c(3) * (1 - u) + c(2) * u) * v;
                    else {
                        double all = 0;
                        for (int k = 0; k < n; ++k) all += c(k) / n;
                        expect =
                            (c(0) * (1 - u) + (c(0) + c(1)) / 2 * u) * (1 - v) + ((c(0) + c(-1)) / 2 * (1 - u) + all * u) * v;
                    }
                    EXPECT_NEAR(value(*s, "linear", p), expect, 1e-6) << cage.name;
                    EXPECT_NEAR(value(*s, "corner", p), expect, 1e-6) << cage.name;
                }
    }
}

TEST(Subdivision, FaceVaryingBordersFollowTheTag) {
    // s runs over each face of a row of three by itself: seams everywhere. A value that is continuous is smooth, one with seams
    // ends at them.
    Cage c = grid(3);
    std::vector<float> seamless, seamed;
    for (size_t k = 0; k < c.verts.size(); ++k) {
        seamless.push_back(float(c.verts[k] % 4) * float(c.verts[k] % 4)); // x squared at the vertices
        static constexpr float own[4] = {0, 1, 1, 0};
        seamed.push_back(own[k % 4]);
    }
    c.more = {param("a", scene::Class::FaceVarying, scene::Type::Float, seamless),
              param("b", scene::Class::FaceVarying, scene::Type::Float, seamed)};
    for (int rule : {0, 1, 2, 3}) {
        Cage t = c;
        t.tags.push_back({"facevaryinginterpolateboundary", {float(rule)}, {}, {}});
        Diagnostics diag;
        ShapeRef s = build(t.primitive(), Matrix(), diag);
        const SurfacePoint p = s->evaluate(4, 0.5, 0.5); // the middle face, 1 < x < 2
        // Linear: (1 + 4) / 2. Smooth: the cubic B-spline of x^2 at 1.5 is x^2 + 1/3.
        EXPECT_NEAR(value(*s, "a", p), rule == 0 ? 2.5 : 2.25 + 1 / 3.0, 1e-5) << rule;
        // A face of its own runs from 0 to 1 whatever the rule, along its middle.
        EXPECT_NEAR(value(*s, "b", p), 0.5, 1e-5) << rule;
        // A column of faces is one island, which ends at face 1: a corner there, or (0 + 4 0 + 1) / 6 of a border that runs
        // round.
        EXPECT_NEAR(value(*s, "b", s->evaluate(1, 0, 0)), rule == 2 ? 1 / 6.0 : 0, 1e-6) << rule;
    }
}

TEST(Subdivision, HolesAndBorders) {
    Diagnostics diag;
    Cage open = grid(3);
    open.tags.clear();
    ShapeRef s = build(open.primitive(), Matrix(), diag);
    ASSERT_TRUE(s);
    s->dice(camera(10), diag);
    // Only the middle face has a limit: that of the uniform B-spline.
    EXPECT_EQ(s->evaluateHit(0, 0.3, 0.3).face, 4);
    for (uint32_t t = 0; t < s->mesh().triangles(); ++t) EXPECT_EQ(s->evaluateHit(t, 0.3, 0.3).face, 4);
    Cage holes = with(cube(), " with holes", {{"hole", {1, 3}, {}, {}}});
    s = build(holes.primitive(), Matrix(), diag);
    s->dice(camera(10), diag);
    for (uint32_t t = 0; t < s->mesh().triangles(); ++t) {
        const int f = s->evaluateHit(t, 0.3, 0.3).face;
        EXPECT_TRUE(f != 1 && f != 3);
    }
    EXPECT_EQ(diag.warnings() + diag.errors(), 0);
    Cage single = grid(1);
    single.tags.clear();
    EXPECT_FALSE(build(single.primitive(), Matrix(), diag));
    EXPECT_EQ(diag.warnings(), 1);
}

} // namespace subdivision_test
