// What shaders know of the micropolygon that they shade under hidden: du and dv are the steps of its lattice, and derivatives,
// areas and filters are differences over them (RISpec 3.2, 15.5).
#include "integrator/gridscene.h"
#include "integrator/maps.h"
#include "shading/gridpoint.h"
#include <array>

namespace gridsteps_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

/// What a shader makes of points of a shape, with (u, v) in "at", and in blue there the cosine between the surface and the ray.
struct Seen {
    Color made;
    float u, v, facing;
};
std::vector<Seen> see(const std::string& expression, const std::string& shape, const std::string& options = "",
                      bool micropolygons = true) {
    static int number = 0;
    const std::string name = "steps" + std::to_string(number++);
    writeShader(name, "surface " + name + "(output varying color at = 0) { Oi = 1; Ci = " + expression +
                          "; at = color(u, v, abs(normalize(Ng) . normalize(I))); }");
    Settings settings = bySettings(micropolygons);
    settings.outputs = {"at"};
    Scene s(gridPicture("Surface \"" + name + "\"\n" + options + shape), settings);
    std::vector<Seen> seen;
    for (const SampleResult& r : s.trace(samplesOf(1)))
        if (r.opacity.x > 0) seen.push_back({r.color, r.aovs[0], r.aovs[1], r.aovs[2]});
    EXPECT_GT(seen.size(), 50u) << shape;
    return seen;
}
double toWhole(double x) { return std::fabs(x - std::round(x)); }

/// The steps over so many edges: the nearest power of 2^(1/4), rounded.
int stepsFor(double edges) { return std::max(1, int(std::exp2(std::round(4 * std::log2(edges)) / 4) + .5)); }

/// Shapes over (u, v) without poles in sight.
const std::string kSmooth[] = {
    "Translate 0 0 5\nRotate 90 1 0 0\nSphere .9 -.5 .5 360\n",
    "Translate 0 0 5\nRotate 20 1 1 0\nTorus .6 .25 0 360 360\n",
    "Translate 0 0 5\nRotate 90 1 0 0\nCylinder .6 -.8 .8 360\n",
    "Patch \"bilinear\" \"P\" [-.9 -.9 5  .9 -.8 5  -.8 .9 5  .9 .9 6]\n",
    std::string(
        "Displacement \"lifts\"\nAttribute \"displacementbound\" \"float sphere\" .1\nTranslate 0 0 5\nRotate 90 1 0 0\n") +
        "Sphere .8 -.5 .5 360\n",
};
void writeDisplacement() { writeShader("lifts", "displacement lifts() { P += .1 * normalize(N); N = calculatenormal(P); }"); }

} // namespace

// A lattice of n steps has du = 1/n, and its cells are shaded in their middles: u/du is half way between two whole numbers.
TEST(GridSteps, AreThoseOfTheLattice) {
    writeDisplacement();
    for (const std::string& shape : kSmooth) {
        int facing = 0;
        const bool halves = shape.starts_with("Patch"); // of some facets triangles, one by one, are micropolygons
        for (const Seen& s : see("color(du, dv, 0)", shape)) {
            const bool rim = std::min({s.u, 1 - s.u, s.v, 1 - s.v}) < .1f; // of diced surfaces: triangles that close seams
            if (s.facing < .7f || rim) continue; // where a pixel covers several cells its footprint counts
            ++facing;
            for (const auto& [x, dx] : {std::pair{s.u, s.made.x}, {s.v, s.made.y}}) {
                const double n = 1 / double(dx);
                ASSERT_LE(toWhole(n), 1e-5 * n) << shape;
                if (!halves) ASSERT_LE(toWhole(x * n - .5), 1e-5 * n) << shape;
            }
        }
        EXPECT_GT(facing, 100) << shape;
    }
}

// Differences over the cell: of u and v exact, of a product (s(u + du, v) - s(u, v)) / du. A float of up to 2 is rounded by up to
// 2^-23 each time, which the division makes larger.
TEST(GridSteps, DerivativesAreDifferencesOverTheCell) {
    writeDisplacement();
    for (const std::string& shape : kSmooth) {
        for (const Seen& s : see("color(Du(u), Dv(u), Dv(v))", shape)) ASSERT_EQ(s.made, Color(1, 0, 1)) << shape;
        for (const Seen& s : see("color(Du(s * s + t), Dv(s * s + t), du)", shape)) {
            const double du = s.made.z, u = s.u;
            ASSERT_NEAR(s.made.x, ((u + du) * (u + du) - u * u) / du, 4 * 0x1p-23 / du) << shape;
            ASSERT_NEAR(s.made.y, 1, 1e-6) << shape;
        }
        for (const Seen& s : see("color(Deriv(v * v, v), gridmax(u) - gridmin(u), du)", shape)) {
            ASSERT_GT(s.made.x, 2 * s.v) << shape; // and dv more
            ASSERT_NEAR(s.made.y, s.made.z, 1e-6) << shape;
        }
    }
}

// A square that the eye sees straight on has cells of ShadingRate pixels, but for the rounding of steps, which is known.
TEST(GridSteps, AreaIsThatOfAMicropolygon) {
    for (const double rate : {.25, 1., 5., 16., 50.}) {
        const double edge = 2. / stepsFor(kSide / std::sqrt(rate)), pixels = edge * edge / (kPixel * kPixel);
        EXPECT_LE(std::fabs(std::log(pixels / rate)), 2 * std::log(kRounding) + .08)
            << rate; // few steps are rounded to whole ones
        for (const Seen& s :
             see("color(area(P), length(calculatenormal(P)), du)", kSquare, "ShadingRate " + std::to_string(rate) + "\n")) {
            ASSERT_NEAR(s.made.x, edge * edge, 1e-5 * edge * edge) << rate;
            ASSERT_NEAR(s.made.y, 1, 1e-5);
            ASSERT_NEAR(s.made.z, edge, 1e-5 * edge) << rate; // a polygon's u is x
        }
    }
}

// All cells of a sphere of n by n: the sum of 2 pi^2 r^2 cos(latitude) / n^2 over the middles is 4 pi r^2 (h / sin h), h = pi /
// 2n.
TEST(GridSteps, AreasOfAllCellsAreTheSphere) {
    writeShader("areas", "surface areas() { Ci = area(P); Oi = 1; }");
    Scene s(gridPicture("Surface \"areas\"\nTranslate 0 0 5\nSphere .9 -.9 .9 360\n"), bySettings(true));
    for (const int n : {1, 2, 7, 64}) {
        std::vector<shading::GridPoint> points(size_t(n * n));
        std::vector<CameraRay> rays;
        for (int k = 0; k < n * n; ++k) {
            shading::GridPoint& p = points[size_t(k)];
            p.b1 = (k % n + .5) / n, p.b2 = (k / n + .5) / n;
            p.du = p.dv = 1.f / float(n);
            p.distance = 5;
            p.micropolygon = uint64_t(k) + 1;
            CameraRay r = rayTo({0, 0, 0}, {0, 0, 1});
            r.grid = &p;
            rays.push_back(r);
        }
        double sum = 0;
        for (const SampleResult& r : s.trace(rays)) sum += double(r.color.x);
        const double h = kPi / (2 * n), want = 4 * kPi * .81 * h / std::sin(h);
        EXPECT_NEAR(sum, want, 1e-5 * want) << n;
    }
}

// A rate beyond all sizes leaves one cell, whose area is that of its tangents: 2 pi^2 r^2 in the middle of a sphere.
TEST(GridSteps, AWholeSurfaceIsTheLargestCell) {
    for (const Seen& s : see("color(area(P), du, dv)", "Translate 0 0 5\nSphere .9 -.9 .9 360\n", "ShadingRate 1e6\n")) {
        ASSERT_NEAR(s.made.x, 2 * kPi * kPi * .81, 1e-4);
        ASSERT_EQ(s.made.y, 1);
        ASSERT_EQ(s.made.z, 1);
    }
}

// A square whose parameters lie at 45 degrees to its edges: the cell is no smaller than it is, and as long along both.
TEST(GridSteps, CellsAcrossTheParametersKeepTheirArea) {
    const std::string turned =
        "Rotate 45 0 0 1\nPolygon \"P\" [-1.41421356 0 5  0 1.41421356 5  1.41421356 0 5  0 -1.41421356 5]\n";
    for (const Seen& s : see("color(area(P), du, dv)", turned)) {
        ASSERT_NEAR(s.made.x, kPixel * kPixel, 1e-4 * kPixel * kPixel);
        ASSERT_NEAR(s.made.y, kPixel, 1e-4 * kPixel);
        ASSERT_NEAR(s.made.z, kPixel, 1e-4 * kPixel);
    }
}

// Where a pixel sees many cells at once, filters are as wide as it: on triangles of a quarter of a pixel, and on a plane at 85
// degrees, whose cells are at most four pixels long.
TEST(GridSteps, FiltersCoverThePixel) {
    std::string mesh = "PointsPolygons [";
    constexpr int kCells = 64; // of half a picture, two triangles each
    for (int k = 0; k < 2 * kCells * kCells; ++k) mesh += "3 ";
    mesh += "] [";
    for (int j = 0; j < kCells; ++j)
        for (int i = 0; i < kCells; ++i) {
            const int a = j * (kCells + 1) + i, b = a + 1, c = a + kCells + 1, d = c + 1;
            for (const int k : {a, b, c, b, d, c}) mesh += std::to_string(k) + " ";
        }
    mesh += "] \"P\" [";
    for (int j = 0; j <= kCells; ++j)
        for (int i = 0; i <= kCells; ++i)
            mesh += std::to_string(-.5 + i / double(kCells)) + " " + std::to_string(-.5 + j / double(kCells)) + " 5 ";
    for (const Seen& s : see("color(du, dv, 0)", mesh + "]\n")) {
        ASSERT_NEAR(s.made.x, kPixel, 1e-4 * kPixel);
        ASSERT_NEAR(s.made.y, kPixel, 1e-4 * kPixel);
    }
    const double cosine = std::cos(85 * kPi / 180);
    for (const Seen& s :
         see("color(du, dv, 0)", "Translate 0 0 5\nRotate 85 1 0 0\nPolygon \"P\" [-1 -3 0 -1 3 0 1 3 0 1 -3 0]\n")) {
        ASSERT_NEAR(s.made.x, kPixel, .1 * kPixel); // along x a cell is a pixel, but for its rounding
        ASSERT_NEAR(s.made.y, kPixel / cosine, 1e-3 * kPixel / cosine);
    }
}

// texture() filters over the cell: as if its four corners were given. 13 cells a side; a pixel's footprint is a tenth narrower.
TEST(GridSteps, TexturesAreFilteredOverTheCell) {
    const std::string map = writeMap("edge.exr", 256, 256, [](int x, int, int) { return x < 128 ? 0.f : 1.f; });
    const std::string square = "Polygon \"P\" [-1 -1 5  -1 1 5  1 1 5  1 -1 5] \"st\" [0 0 0 1 1 1 1 0]\n";
    ASSERT_EQ(stepsFor(kSide / std::sqrt(5.)), 13);
    const auto at = [&](const char* h) {
        const std::string a = std::string("s - ") + h + ", t - " + h, b = std::string("s + ") + h + ", t - " + h,
                          c = std::string("s - ") + h + ", t + " + h, d = std::string("s + ") + h + ", t + " + h;
        return "float texture(" + map + ", " + a + ", " + b + ", " + c + ", " + d + ")";
    };
    double most = 0;
    for (const Seen& s : see("color(float texture(" + map + ", s, t), " + at("1 / 26") + ", " + at("sqrt(5) / 64") + ")", square,
                             "ShadingRate 5\n")) {
        ASSERT_NEAR(s.made.x, s.made.y, 2e-3);
        most = std::max(most, std::fabs(double(s.made.x - s.made.z)));
    }
    EXPECT_GT(most, .01); // of a pixel it would be another picture
}

// Steps follow from the micropolygon alone: whole tiles have the bits of single samples, in any order.
TEST(GridSteps, BitsDependOnNothingElse) {
    writeDisplacement();
    writeShader("stepbits", "surface stepbits() { Ci = color(area(P), Du(u * v), dv); Oi = .5; }");
    for (const char* interpolation : {"constant", "smooth"})
        for (const std::vector<std::string>& shapes : {kShapes, std::vector<std::string>(std::begin(kSmooth), std::end(kSmooth))})
            for (const std::string& shape : shapes) {
                Scene s(
                    gridPicture("Surface \"stepbits\"\nShadingInterpolation \"" + std::string(interpolation) + "\"\n" + shape),
                    bySettings(true));
                const auto rays = samplesOf(1);
                const auto whole = s.trace(rays);
                Integrator one(s.world, s.diagnostics);
                std::vector<SampleResult> result(1);
                for (size_t i = rays.size(); i-- > 0;) {
                    ASSERT_TRUE(one.trace({&rays[i], 1}, result, nullptr));
                    ASSERT_EQ(result[0].color, whole[i].color) << shape << i;
                    ASSERT_TRUE(std::isfinite(luminance(whole[i].color))) << shape;
                }
            }
}

// Rays of a camera meet surfaces before anything is shaded; with many surfaces in one place that takes long.
TEST(GridShading, StopsAmongTheRaysOfTheCamera) {
    Scene s(gridPicture("Surface \"constant\"\n" + kSquare), bySettings(true));
    const std::vector<CameraRay> rays = samplesOf(1);
    std::vector<SampleResult> out(rays.size());
    Integrator integrator(s.world, s.diagnostics);
    const StopFlag stop{1};
    EXPECT_FALSE(integrator.trace(rays, out, &stop));
    EXPECT_EQ(integrator.counters().hits, 0u);
    EXPECT_TRUE(integrator.trace(rays, out, nullptr));
    EXPECT_EQ(integrator.counters().hits, rays.size());
}

} // namespace gridsteps_test
