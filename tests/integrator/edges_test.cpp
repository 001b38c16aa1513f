// Rays through the edges and corners of meshes that let light through meet them once: a pane lets through what its opacity says
// also where its two triangles meet, and where pieces of a displaced or closed surface do.
#include "integrator/floorscene.h"
#include <fmt/format.h>

namespace edges_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

/// What comes straight down through the pane to the floor at (x, 0, z), of a light of one.
float through(const std::string& pane, float x, float z) {
    Scene s(inWorld("LightSource \"distantlight\" 1 \"point from\" [0 1 0] \"point to\" [0 0 0]\nAttributeBegin\n" + pane +
                    "AttributeEnd\nSurface \"matte\"\n" + kFloor),
            withShaders(Hider::Path));
    return s.one(rayTo({x + .3f, .2f, z - .4f}, {x, 0, z}))[0];
}

/// A varying opacity that the renderer cannot know before: the kernel runs.
void writeShaders() { writeShader("lets", "surface lets(float by = .5;) { Oi = by + 0 * u; Ci = 0; }\n"); }

const char* const kSquare = "Polygon \"P\" [-1 1 -1  -1 1 1  1 1 1  1 1 -1]\n";
const char* const kGrid = "Patch \"bilinear\" \"P\" [-1 1 -1  1 1 -1  -1 1 1  1 1 1]\n";

TEST(Edges, OfAPaneCountOnce) {
    writeShaders();
    for (const std::string pane : {"Surface \"lets\"\n", "Surface \"constant\" Color 0 0 0 Opacity .5 .5 .5\n"})
        for (const std::string shape : {kSquare, kGrid})
            // the middle, both diagonals, lines of a grid
            for (const auto& [x, z] : {std::pair{0.f, 0.f},
                                       {.5f, .5f},
                                       {-.25f, -.25f},
                                       {.5f, -.5f},
                                       {-.25f, .25f},
                                       {.25f, 0.f},
                                       {0.f, -.125f},
                                       {.37f, .11f}})
                EXPECT_NEAR(through(pane + shape, x, z), .5f, 1e-5f) << pane << shape << x << " " << z;
}

TEST(Edges, OfPiecesOfADisplacedSurfaceCountOnce) {
    writeShaders();
    writeShader("lifts", "displacement lifts() { P += vector \"world\" (0, .25 * u, 0); N = calculatenormal(P); }\n");
    const std::string pane =
        "ShadingRate 25\nAttribute \"displacementbound\" \"float sphere\" 1\nSurface \"lets\"\nDisplacement \"lifts\"\n" +
        std::string(kGrid);
    for (int i = -4; i <= 4; ++i) EXPECT_NEAR(through(pane, .125f * float(i), 0), .5f, 1e-5f) << i;
}

TEST(Edges, TwoPanesAtOnePlaceAreTwo) {
    writeShaders();
    const std::string pane = "Surface \"lets\"\n";
    EXPECT_NEAR(through(pane + kSquare + kSquare, .37f, .11f), .25f, 1e-5f);
    // A closed box: in at the top, out at the bottom, along its edges and its middle.
    const std::string box = pane + "Sides 2\nPointsPolygons [4 4 4 4 4 4] [0 1 2 3  4 7 6 5  0 4 5 1  1 5 6 2  2 6 7 3  3 7 4 0] "
                                   "\"P\" [-1 1 -1  -1 1 1  1 1 1  1 1 -1  -1 .5 -1  -1 .5 1  1 .5 1  1 .5 -1]\n";
    for (const float x : {0.f, .25f, .37f, -.5f}) EXPECT_NEAR(through(box, x, x), .25f, 1e-5f) << x;
}

// A box of half a thousandth, a thousand away on the slope of the light: in at the bottom, out at a side that touches it.
TEST(Edges, SmallThingsFarAwayHaveTwoSides) {
    writeShaders();
    std::string corners;
    const double h = 1. / 4096;
    for (int k = 0; k < 8; ++k)
        corners += fmt::format("{:.17g} {:.17g} {:.17g} ", 1000 + (k & 1 ? h : -h), 1000 + (k & 2 ? h : -h), k & 4 ? h : -h);
    Scene s(inWorld("LightSource \"distantlight\" 1 \"point from\" [1 1 0] \"point to\" [0 0 0]\nAttributeBegin\nSurface "
                    "\"lets\"\nSides 2\n"
                    "PointsPolygons [4 4 4 4 4 4] [0 1 3 2  4 6 7 5  0 4 5 1  2 3 7 6  0 2 6 4  1 5 7 3] \"P\" [" +
                    corners + "]\nAttributeEnd\nSurface \"matte\"\n" + kFloor),
            withShaders(Hider::Path));
    for (const float x : {2.4e-4f, -2.4e-4f})
        for (const float z : {1e-4f, -1e-4f})
            EXPECT_NEAR(s.one(rayTo({x + .3f, .2f, z - .4f}, {x, 0, z}))[0], .25f * std::sqrt(.5f), 1e-4f) << x << " " << z;
}

} // namespace

} // namespace edges_test
