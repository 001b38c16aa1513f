// T1 and T2 for light samplers: every primitive as an area light, seen from outside, close by, from inside and edge-on. Spheres
// and a few triangles near by are sampled by solid angle, what is diced over its facets, all else over (u, v).
//
// The property that makes an estimate unbiased: the sum of 1/pdf over samples that fall into a cell of directions is the solid
// angle of the surface in that cell, every layer counted. The other side is counted with rays. 1/pdf is bounded (cos A / d^2),
// pdf is not. Power: 200 cells over the shape's cone, about 100 of them filled, n draws a side: a relative error of alternating
// sign of 22 % is found at 30,000, of 4 % at 1e6 (noncentrality sum delta^2 n/2 per cell / r^2 against 7.1 sqrt(2 * 100), r^2
// about 1).
#include "accel/accel.h"
#include "bsdf/sampling.h"
#include "geometry/make.h"
#include "statistics/agreement.h"
#include "world/arealight.h"
#include <gtest/gtest.h>
#include <random>

namespace emitter_test {

using namespace alpenglow;
using namespace alpenglow::bsdf;
using namespace alpenglow::world;
using namespace alpenglow::geometry::test;
using teststat::samples, teststat::seedBase, teststat::kAlpha;

namespace {

using Primitives = std::vector<std::shared_ptr<scene::Primitive>>;

struct Case {
    const char* name;
    Primitives primitives;
    Matrix toCamera;
    bool solidAngle = false; ///< sampled by solid angle where seen from outside: the near side only
    scene::Attributes attributes = {};
};

std::shared_ptr<scene::Primitive> polyhedron() {
    auto p = std::make_shared<scene::Primitive>();
    p->kind = "PointsPolygons";
    p->ints = {4, 3, 3};
    p->ints2 = {0, 1, 2, 3, 0, 4, 1, 3, 2, 4};
    p->params = {points({-1, 0, 0, 1, 0, 0, 1, 1, .2f, -1, 1, .2f, 0, -1, 1})};
    return p;
}
/// A ball of quadrangles, and a triangle fan at each pole; some of its columns are left out at the end.
std::shared_ptr<scene::Primitive> ball(int columns, int without) {
    constexpr int kRows = 5;
    auto p = std::make_shared<scene::Primitive>();
    p->kind = "PointsPolygons";
    std::vector<float> P;
    for (int j = 0; j <= kRows; ++j)
        for (int i = 0; i < columns; ++i) {
            const double t = kPi * j / kRows, f = 2 * kPi * i / columns;
            P.insert(P.end(), {float(std::sin(t) * std::cos(f)), float(std::sin(t) * std::sin(f)), float(.7 * std::cos(t))});
        }
    for (int j = 0; j < kRows; ++j)
        for (int i = 0; i < columns - without; ++i) {
            const int a = j * columns + i, b = j * columns + (i + 1) % columns, c = b + columns, d = a + columns;
            const std::vector<int> face = j == 0           ? std::vector{a, d, c}
                                          : j == kRows - 1 ? std::vector{a, d, b}
                                                           : std::vector{a, d, c, b};
            p->ints.push_back(int(face.size()));
            p->ints2.insert(p->ints2.end(), face.begin(), face.end());
        }
    p->params = {points(P)};
    return p;
}
std::shared_ptr<scene::Primitive> holed() {
    auto p = std::make_shared<scene::Primitive>();
    p->kind = "GeneralPolygon";
    p->ints = {4, 4};
    p->params = {points({-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0, -.5f, -.5f, 0, -.5f, .5f, 0, .5f, .5f, 0, .5f, -.5f, 0})};
    return p;
}

std::vector<Case> cases() {
    Matrix skew = skewed();
    Matrix rigid = rotateMatrix(40, 1, 2, .5) * scaleMatrix(1.3, 1.3, 1.3) * translateMatrix(.3, -1, 7);
    std::vector<float> concave = {-1, -1, 0, 1, -1, 0, 1, 1, 0, 0, -.2f, 0, -1, 1, 0};
    Primitives many; // more than are chosen by area alone
    for (int i = 0; i < 12; ++i) {
        const float x = -1 + .18f * float(i), y = .8f * std::sin(float(i) * 2.1f), z = .5f * std::cos(float(i) * 1.7f),
                    r = .3f + .05f * float(i);
        many.push_back(polygon({x, y, z, x + r, y, z + r, x + r, y + r, z, x, y + r, z}));
    }
    return {{"sphere", {quadric("Sphere", {1, -1, 1, 360})}, rigid, true},
            {"mirrored sphere", {quadric("Sphere", {1, -1, 1, 360})}, scaleMatrix(-1, 1, 1) * rigid, true},
            {"part of a sphere", {quadric("Sphere", {1, -.6f, .8f, 250})}, rigid},
            {"ellipsoid", {quadric("Sphere", {1, -1, 1, 360})}, skew},
            {"disk", {quadric("Disk", {.2f, 1, 300})}, skew},
            {"cylinder", {quadric("Cylinder", {.6f, -1, 1, 360})}, skew},
            {"cone", {quadric("Cone", {1.5f, .7f, 360})}, skew},
            {"paraboloid", {quadric("Paraboloid", {1, .1f, 1.2f, 360})}, skew},
            {"hyperboloid", {quadric("Hyperboloid", {1, 0, -.8f, .3f, .6f, .9f, 360})}, skew},
            {"torus", {quadric("Torus", {.9f, .3f, 0, 360, 360})}, skew},
            {"rectangle", {polygon({-1, -.5f, 0, 1, -.5f, 0, 1, .5f, 0, -1, .5f, 0})}, skew},
            {"concave polygon", {polygon(concave)}, skew},
            {"polygon with a hole", {holed()}, skew},
            {"polyhedron", {polyhedron()}, skew},
            {"mesh of a ball", {ball(12, 0)}, skew},
            {"mesh with a gap", {ball(12, 4)}, skew},
            {"bilinear patch", {patch("bilinear", {-1, -1, 0, 1, -1, .4f, -1, 1, .3f, .8f, 1, -.2f})}, skew},
            {"bicubic patch", {patch("bicubic", bentNet())}, skew},
            {"bicubic mesh", {patchMesh("bicubic", 4, "nonperiodic", 4, "nonperiodic", bentNet())}, skew},
            {"sphere, disk and polygon",
             {quadric("Sphere", {.5f, -.5f, .5f, 360}), quadric("Disk", {1.2f, .9f, 360}), polygon(concave)},
             skew},
            {"twelve polygons", many, skew}};
}

/// An emitter with the shapes it is made of, and something that rays can meet.
struct Made {
    Diagnostics diagnostics;
    std::vector<geometry::ShapeRef> shapes;
    std::unique_ptr<accel::Accel> accel;
    std::unique_ptr<Emitter> emitter;
    explicit Made(const Case& c) {
        std::vector<const geometry::Shape*> plain;
        for (const auto& p : c.primitives)
            if (auto s = build(p, c.toCamera, diagnostics, c.attributes)) shapes.push_back(s);
        geometry::DiceOptions options;
        options.camera = {true, 2000};
        geometry::diceShapes(shapes, options, diagnostics);
        for (const auto& s : shapes) plain.push_back(s.get());
        accel = std::make_unique<accel::Accel>(shapes, std::vector<uint32_t>(), diagnostics);
        emitter = std::make_unique<Emitter>(plain);
    }
    /// Every layer along a ray.
    std::vector<accel::Hit> layers(const Vec3& from, const Vec3& w) const {
        std::vector<accel::Hit> all;
        accel::Ray r;
        r.org = from;
        r.dir = w;
        r.sides = accel::Sides::Both;
        accel::Hit h;
        while (all.size() < 16 && accel->intersect(r, h)) {
            all.push_back(h);
            // Curved shapes may be met again further on: step past the hit itself instead of leaving its primitive out.
            r.tnear = h.t + 1e-4f * std::max(1.f, h.t);
        }
        return all;
    }
};

template <class E, class S> bool draw(const E& e, const Vec3& from, Vec2 u, float choose, S& s, geometry::SurfacePoint& p) {
    return e.sample(from, u, choose, 0, s, p);
}

/// Places to be lit: far, near, behind, inside. Not so near that 1/pdf, which grows with 1/d^2, has a heavy tail.
std::vector<std::pair<const char*, Vec3>> places(const Made& m) {
    geometry::Bounds b = m.accel->bounds();
    Vec3 lo(b.lo), hi(b.hi), c = (lo + hi) * 0.5f, d = hi - lo;
    geometry::SurfacePoint p = m.shapes[0]->sampleArea(.3, .6);
    std::vector<std::pair<const char*, Vec3>> all = {
        {"far", {0, 0, 0}}, {"near", p.P + p.n * (.15f * length(d))}, {"behind", p.P - p.n * (.4f * length(d))}};
    for (float t : {.07f, -.07f, .15f, -.15f, .25f, -.25f}) all.push_back({"inside", c + d * t});
    std::erase_if(all, [&](const auto& place) {
        float nearest = 1e30f;
        for (const auto& s : m.shapes)
            for (int i = 0; i < 4000; ++i)
                nearest = std::min(nearest, length(s->sampleArea((i % 64 + .5) / 64, (i / 64 + .5) / 63).P - place.second));
        return nearest < .1f * length(d);
    });
    return all;
}

struct Grid {
    Basis basis;
    double cosLow, span; ///< the cone that holds the light: cos from cosLow to 1
    static constexpr int kCos = 10, kPhi = 20;
    size_t cell(const Vec3& w) const {
        double z = dot(w, basis.n), phi = std::atan2(dot(w, basis.u), dot(w, basis.t)) / (2 * kPi);
        int i = std::clamp(int((z - cosLow) / span * kCos), 0, kCos - 1),
            j = std::clamp(int((phi < 0 ? phi + 1 : phi) * kPhi), 0, kPhi - 1);
        return size_t(i * kPhi + j);
    }
};
Grid gridFor(const Made& m, const Vec3& from) {
    geometry::Bounds b = m.accel->bounds();
    Vec3 lo(b.lo), hi(b.hi), axis = (lo + hi) * 0.5f - from;
    double radius = 0.501 * length(hi - lo), distance = length(axis);
    double c = distance > radius * 1.02 ? std::sqrt(1 - radius * radius / (distance * distance)) : -1;
    return {Basis(normalize(axis)), c, 1 - c};
}

struct Cell {
    double s = 0, q = 0;
    int hits = 0;
};

/// Solid angles of cells, each from n samples, as light is drawn and as rays count it. whole: what a ray that counts is worth.
void expectSameCells(const std::vector<Cell>& drawn, const std::vector<Cell>& counted, int n, double whole,
                     const std::string& what) {
    // Welch's z of every cell with enough in it; the rest is one cell.
    double sum = 0, total[2] = {}, variance = 0;
    int used = 0;
    Cell restA, restB;
    auto compare = [&](const Cell& a, const Cell& b) {
        double ma = a.s / n, mb = b.s / n, v = (a.q / n - ma * ma + b.q / n - mb * mb) / n;
        double z = (ma - mb) / std::sqrt(v);
        sum += z * z;
        ++used;
        EXPECT_GT(teststat::sidakP(teststat::normalP(z), 200), kAlpha) << what << ": a cell has " << ma << ", rays say " << mb;
    };
    for (size_t i = 0; i < drawn.size(); ++i) {
        const Cell &a = drawn[i], &b = counted[i];
        total[0] += a.s / n, total[1] += b.s / n;
        variance += (a.q / n + b.q / n) / n;
        if (a.hits >= 50 && b.hits >= 50) compare(a, b);
        else
            restA = {restA.s + a.s, restA.q + a.q, restA.hits + a.hits},
            restB = {restB.s + b.s, restB.q + b.q, restB.hits + b.hits};
    }
    if (restA.hits >= 50 && restB.hits >= 50) compare(restA, restB);
    else { // a handful of rays, or none: Poisson
        double e = restA.s / whole;
        EXPECT_LE(std::fabs(restB.hits - e), 10 + 5 * std::sqrt(e)) << what;
    }
    ASSERT_GE(used, 5) << what;
    double p = teststat::gammaQ(used / 2.0, sum / 2);
    EXPECT_GT(p, kAlpha) << what << ": chi^2 " << sum << " over " << used << " cells";
    teststat::keepP("emitter " + what, p);
    EXPECT_LE(std::fabs(total[0] - total[1]), teststat::kZ * std::sqrt(variance))
        << what << ": " << total[0] << " sr, rays " << total[1];
}

class EmitterT1 : public ::testing::TestWithParam<int> {};

TEST_P(EmitterT1, SolidAngleOfEveryCell) {
    Case c = cases()[size_t(GetParam())];
    Made m(c);
    ASSERT_EQ(m.shapes.size(), c.primitives.size()) << c.name;
    ASSERT_EQ(m.diagnostics.errors(), 0);
    const int n = samples(30'000, 1'000'000);
    auto lit = places(m);
    ASSERT_GE(lit.size(), 2u) << c.name;
    uint64_t turn = 0;
    for (auto [where, from] : lit) {
        Grid grid = gridFor(m, from);
        std::string what = std::string(c.name) + ", " + where;
        std::mt19937_64 rng(uint64_t(GetParam()) * 100 + turn++ + seedBase());
        std::uniform_real_distribution<float> u01(0, 0x1.fffffep-1f);
        std::vector<Cell> drawn(Grid::kCos * Grid::kPhi), counted(drawn.size());
        int failed = 0, unlike = 0;
        bool nearOnly = false;
        for (int i = 0; i < n; ++i) {
            Emitter::Sample s;
            float a = u01(rng), b = u01(rng), choose = u01(rng);
            geometry::SurfacePoint point;
            if (!draw(*m.emitter, from, {a, b}, choose, s, point)) {
                ++failed;
                continue;
            }
            // T2: what is drawn agrees with itself and with the density of a hit there.
            ASSERT_TRUE(s.pdf > 0 && std::isfinite(s.pdf)) << what;
            ASSERT_NEAR(length(s.direction), 1, 1e-5) << what;
            ASSERT_LE(length(from + s.direction * s.distance - intersectsAt(point)), 1e-4f * (1 + s.distance)) << what;
            double pdf = m.emitter->pdf(s.shape, point, from);
            // Nearly edge-on the cosine is lost in rounding, the same on both sides of the comparison but for the direction
            // drawn.
            unlike += !(std::fabs(pdf - s.pdf) <= 1e-4 * s.pdf);
            Cell& cell = drawn[grid.cell(s.direction)];
            cell.s += 1 / double(s.pdf), cell.q += 1 / double(s.pdf) / s.pdf, ++cell.hits;
        }
        EXPECT_LE(failed, 1e-3 * n) << what;
        EXPECT_LE(unlike, 1e-4 * n) << what;
        if (c.solidAngle) // radius 1, made larger by 1.3
            nearOnly = length(from - Vec3(transformPoint(c.toCamera, {0, 0, 0}))) > 1.3f;
        int blind = 0;
        const double whole = 2 * kPi * grid.span;
        for (int i = 0; i < n; ++i) {
            Vec3 w = grid.basis.toWorld(sampleCone(float(grid.span), {u01(rng), u01(rng)}));
            auto hits = m.layers(from, w);
            for (const accel::Hit& h : std::span(hits).first(nearOnly ? std::min<size_t>(1, hits.size()) : hits.size())) {
                geometry::SurfacePoint p = m.accel->point(h);
                if (std::fabs(dot(p.n, w)) > 1e-3f) blind += !(m.emitter->pdf(m.shapes[h.shape].get(), p, from) > 0);
            }
            double layers = nearOnly ? std::min<double>(1, double(hits.size())) : double(hits.size());
            if (layers == 0) continue;
            Cell& cell = counted[grid.cell(w)];
            cell.s += whole * layers, cell.q += whole * layers * whole * layers, ++cell.hits;
        }
        EXPECT_EQ(blind, 0) << what << ": hits that the sampler cannot make"; // support
        expectSameCells(drawn, counted, n, whole, what);
    }
}
/// A ball of radius 1 seen from a distance of 4 shows (1 - 1/4) / 2 = .375 of its surface. At least twice as many samples lie
/// there as of samples by area.
TEST(Emitter, MeshesAreSampledOnTheSideThatIsSeen) {
    for (const bool inside : {false, true}) // where the normals point
        for (const auto to : {Emitter::Shines::Both, inside ? Emitter::Shines::Back : Emitter::Shines::Front}) {
            Case c{"ball", {ball(24, 0)}, translateMatrix(0, 0, 4)};
            c.attributes.inside = inside;
            Made m(c);
            m.emitter->shinesTo(to);
            std::mt19937 rng(unsigned(seedBase()) + 5);
            std::uniform_real_distribution<float> one(0, 0x1.fffffep-1f);
            const int n = 4000;
            int facing = 0;
            for (int i = 0; i < n; ++i) {
                Emitter::Sample s;
                geometry::SurfacePoint p;
                ASSERT_TRUE(draw(*m.emitter, {0, 0, 0}, {one(rng), one(rng)}, 0, s, p));
                facing += dot(p.P - Vec3(0, 0, 4), s.direction) < 0;
            }
            EXPECT_GT(facing, 2 * .375 * n) << inside << int(to);
        }
}

TEST(Emitter, MeshWithPointsThatAreNoNumbers) {
    for (const float bad : {NAN, INFINITY, 3e38f}) {
        Case c{"ball", {ball(24, 0)}, translateMatrix(0, 0, 4)};
        auto p = std::make_shared<scene::Primitive>(*c.primitives[0]);
        for (size_t i = 30; i < p->params[0].numbers.size(); i += 31) p->params[0].numbers[i] = bad;
        c.primitives = {p};
        Made m(c);
        std::mt19937 rng(3);
        std::uniform_real_distribution<float> one(0, 0x1.fffffep-1f);
        for (int i = 0; i < 500; ++i) {
            Emitter::Sample s;
            geometry::SurfacePoint point;
            if (draw(*m.emitter, {0, 0, 0}, {one(rng), one(rng)}, 0, s, point))
                EXPECT_TRUE(s.pdf > 0 && std::isfinite(s.pdf)) << bad;
        }
    }
}

/// A tube of radius r seen from a distance d of its axis shows the fraction acos(r / d) / pi of its points. Half a turn takes
/// none of them to another, so they get what the points opposite would have, all of it or three quarters.
TEST(Emitter, TubesAreSampledOnTheSideThatIsSeen) {
    const Case tube{"tube", {quadric("Cylinder", {.6f, -1, 1, 360})}, rotateMatrix(50, 0, 0, 1) * translateMatrix(0, 0, 4)};
    const Vec3 from(1.2f, 0, 2.4f); // 1.2 from the axis, that of z
    const double seen = std::acos(.6 / 1.2) / kPi;
    for (const bool inside : {false, true}) // where the normals point
        for (const auto to : {Emitter::Shines::Both, inside ? Emitter::Shines::Back : Emitter::Shines::Front}) {
            Case c = tube;
            c.attributes.inside = inside;
            Made m(c);
            m.emitter->shinesTo(to);
            std::mt19937 rng(unsigned(seedBase()) + 5);
            std::uniform_real_distribution<float> one(0, 0x1.fffffep-1f);
            const int n = samples(20'000, 200'000);
            int facing = 0;
            for (int i = 0; i < n; ++i) {
                Emitter::Sample s;
                geometry::SurfacePoint p;
                ASSERT_TRUE(draw(*m.emitter, from, {one(rng), one(rng)}, 0, s, p));
                facing += dot(Vec3(p.P.x, p.P.y, 0), s.direction) < 0;
            }
            const double want = seen * (to == Emitter::Shines::Both ? 1.75 : 2);
            EXPECT_NEAR(facing, n * want, 6 * std::sqrt(n * want * (1 - want))) << inside << int(to);
        }
}

INSTANTIATE_TEST_SUITE_P(Primitives, EmitterT1, ::testing::Range(0, int(cases().size())));

// A parametric surface is drawn uniformly over (u, v): chi^2 over 10 x 20 cells, +-5 % found at 1e5 draws.
TEST(EmitterSurface, UniformOverUv) {
    for (const Case& c : cases()) {
        if (c.primitives.size() > 1 || std::string(c.primitives[0]->kind).find("olygon") != std::string::npos) continue;
        Made m(c);
        const int n = samples(20'000, 1'000'000);
        std::mt19937_64 rng(4 + seedBase());
        std::uniform_real_distribution<double> u01(0, 1);
        std::vector<double> hits(200), expected(200, n / 200.0);
        for (int i = 0; i < n; ++i) {
            geometry::SurfacePoint p = m.shapes[0]->sampleArea(u01(rng), u01(rng));
            hits[size_t(std::clamp(int(p.u * 10), 0, 9) * 20 + std::clamp(int(p.v * 20), 0, 19))]++;
        }
        EXPECT_GT(teststat::chiSquareP(hits, expected), kAlpha) << c.name;
    }
}

} // namespace

} // namespace emitter_test
