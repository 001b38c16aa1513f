// Where rays of the camera are the only ones, nothing is diced that they cannot come to; where a shader or a light sends others,
// all of it is.
#include "integrator/harness.h"
#include "world/impl.h"

namespace picturesides_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

const std::string kCamera = "Format 64 64 1 Projection \"perspective\" \"fov\" 60\n";
/// In the picture, and behind the eye.
const std::string kPatches =
    "AttributeBegin Translate 0 0 5 Patch \"bilinear\" \"P\" [-1 -1 0 1 -1 .3 -1 1 0 1 1 0] AttributeEnd\n"
    "AttributeBegin Translate 0 0 -5 Patch \"bilinear\" \"P\" [-1 -1 0 1 -1 .3 -1 1 0 1 1 0] AttributeEnd\n";

/// Triangles of the one in the picture, and of the one behind.
std::pair<uint32_t, uint32_t> diced(const std::string& frame, const std::string& world, Settings settings = {}) {
    const Scene s(kCamera + frame + "WorldBegin\n" + world + kPatches + "WorldEnd\n", std::move(settings));
    if (!s.world) return {};
    const auto& shapes = static_cast<const WorldImpl&>(*s.world).shapes();
    EXPECT_EQ(shapes.size(), 2u);
    return {shapes[0]->mesh().triangles(), shapes[1]->mesh().triangles()};
}

} // namespace

TEST(PictureSides, NothingIsDicedWhereNoRayComes) {
    for (const char* world : {"", "Surface \"matte\"\n", "LightSource \"pointlight\" 1 Surface \"plastic\"\n",
                              "LightSource \"spotlight\" 1 LightSource \"shadowspot\" 2 \"shadowname\" \"\" Surface "
                              "\"shinymetal\" \"texturename\" \"\"\n",
                              "Atmosphere \"fog\" Surface \"paintedplastic\" Opacity .5 .5 .5\n"}) {
        const auto [seen, behind] = diced("", world);
        EXPECT_GT(seen, 0u) << world;
        EXPECT_EQ(behind, 0u) << world;
        EXPECT_EQ(diced("Hider \"raytrace\"\n", world, {.hider = Hider::Raytrace}).second, 0u) << world;
    }
}

TEST(PictureSides, AllIsDicedWhereRaysMayCome) {
    writeShader("mirrored", "surface mirrored() { Ci = trace(P, reflect(I, N)); Oi = 1; }");
    writeShader("occluded", "surface occluded() { Ci = 1 - occlusion(P, N, 16); Oi = 1; }");
    writeShader(
        "looked",
        "light looked(point from = point \"shader\" (0,0,0);) { illuminate(from) { Cl = 1 - shadow(\"raytrace\", Ps); } }");
    writeShader("reflected", "surface reflected() { Ci = environment(\"raytrace\", reflect(I, N)); Oi = 1; }");
    writeShader("gathered", "surface gathered() { Ci = 0; gather(\"\", P, N, .5, 4) { Ci += .25; } Oi = 1; }");
    writeShader("through", "surface through() { Ci = transmission(P, P + N); Oi = 1; }");
    writeShader(
        "lampthrough",
        "light lampthrough(point from = point \"shader\" (0,0,0);) { illuminate(from) { Cl = transmission(Ps, from); } }");
    for (const char* world : {"Surface \"mirrored\"\n", "Surface \"occluded\"\n", "LightSource \"looked\" 1 Surface \"matte\"\n",
                              "Surface \"reflected\"\n", "Surface \"gathered\"\n", "Surface \"through\"\n",
                              "LightSource \"lampthrough\" 1 Surface \"matte\"\n",
                              "Attribute \"light\" \"shadows\" \"on\" LightSource \"pointlight\" 1 Surface \"matte\"\n"})
        EXPECT_GT(diced("", world).second, 0u) << world;
    EXPECT_GT(diced("Hider \"path\"\n", "", {.hider = Hider::Path}).second, 0u);
}

// Ground of 100 by 100 patches, each displaced, about an eye 2 above it: facets are there for what the picture shows.
TEST(PictureSides, TenThousandDisplacedPatchesTakeWhatThePictureShows) {
    writeShader("lifted", "displacement lifted(float Km = .05;) { P += Km * sin(9 * xcomp(P)) * normalize(N); }");
    std::string rib = "Format 64 64 1 Projection \"perspective\" \"fov\" 60\nWorldBegin\nDisplacement \"lifted\"\n"
                      "Attribute \"displacementbound\" \"sphere\" .06\n";
    const double pixels = 32 / std::tan(kPi / 6); // of a unit at distance 1
    double seen = 0, all = 0;
    for (int j = -50; j < 50; ++j)
        for (int i = -50; i < 50; ++i) {
            char line[200];
            std::snprintf(line, sizeof line, "Patch \"bilinear\" \"P\" [%d -2 %d %d -2 %d %d -2 %d %d -2 %d]\n", i, j, i + 1, j,
                          i, j + 1, i + 1, j + 1);
            rib += line;
            // Facets are a pixel long where the patch is nearest; those of its sides may be half as long, as edges are halved.
            const double x = i < 0 ? -i - 1 : i, z = j < 0 ? -j - 1 : j;
            const double n = std::ceil(pixels / std::sqrt(x * x + z * z + 4)), most = 2 * n * n + 8 * n;
            all += most;
            // Sides at 30 degrees, with eight pixels and the filter's one as margin, four facets, the bound and half a patch
            // more.
            const double far = j + 1 + .06, half = far * std::tan(kPi / 6) * (1 + 13.0 / 32) + .06 + .5;
            if (far > 0 && x <= half) seen += most;
        }
    const Scene s(rib + "WorldEnd\n");
    size_t facets = 0, bytes = 0;
    for (const geometry::ShapeRef& shape : static_cast<const WorldImpl&>(*s.world).shapes()) {
        facets += shape->mesh().triangles();
        bytes += shape->mesh().P.size() * sizeof(Vec3) + shape->mesh().made.size() * sizeof(uint32_t);
    }
    EXPECT_GT(facets, 64u * 32) << "half of the picture shows ground";
    EXPECT_LT(double(facets), seen);
    EXPECT_LT(seen, all / 3) << "what is said here is worth something";
    EXPECT_LT(bytes, size_t(2) << 20);
}

} // namespace picturesides_test
