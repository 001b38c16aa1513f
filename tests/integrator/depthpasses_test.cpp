// Pictures of depth alone compared with the same depths in a picture of colours.
#include "display/imageio.h"
#include "integrator/harness.h"
#include "render/renderer.h"
#include "scene/scene.h"

namespace depthpasses_test {

using namespace alpenglow;
using namespace alpenglow::integrator::testing;

namespace {

struct Rendered {
    display::Image picture;
    uint64_t points = 0;
};

/// A scene with one display.
Rendered render(const std::string& mode, const std::string& scene, const std::string& hider) {
    const std::string file = shaderFolder() + "/depth.exr";
    Diagnostics diagnostics;
    render::RenderSettings s;
    s.threads = 1;
    s.allowWrite = true;
    s.shippedShaders = std::string(ALPENGLOW_SOURCE_DIR) + "/shaders";
    s.shaderPaths = {shaderFolder()};
    render::Progress progress(render::ProgressMode::None);
    render::Renderer renderer(s, render::transportEngine(), diagnostics, progress);
    ri::RibReader reader(ri::ReaderOptions{}, renderer, diagnostics);
    reader.readMemory("Format 48 36 1\nPixelSamples 2 2\nProjection \"perspective\" \"fov\" 50\n" + hider + "Display \"" + file +
                          "\" \"openexr\" \"" + mode + "\"\nTranslate 0 0 4\nWorldBegin\n" + scene + "WorldEnd\n",
                      "depth.rib");
    for (const Diagnostic& d : diagnostics.all())
        if (d.severity == Severity::Error) ADD_FAILURE() << toString(d);
    auto picture = display::readImage(file, diagnostics);
    EXPECT_TRUE(picture);
    std::filesystem::remove(file);
    return {picture ? *picture : display::Image(), renderer.stats().shading.points};
}

const char* kThings =
    "LightSource \"distantlight\" 1\nSurface \"plastic\"\n"
    "AttributeBegin Translate -1 0 0 Sphere 1 -1 1 360 AttributeEnd\n"
    "AttributeBegin Sides 1 Translate .6 0 -.5 Rotate 30 1 1 0 Cylinder .5 -1 1 300 AttributeEnd\n"
    "AttributeBegin Translate 0 1 1 Torus .8 .3 0 360 360 AttributeEnd\n"
    "Polygon \"P\" [-3 -1 -2 -3 -1 5 3 -1 5 3 -1 -2]\n"
    "AttributeBegin Translate 1 -.5 0 Patch \"bicubic\" \"P\" [-1 -1 0 -.3 -1 1 .3 -1 -1 1 -1 0  -1 -.3 0 -.3 -.3 1 .3 "
    "-.3 1 1 -.3 0  -1 .3 0 -.3 .3 -1 .3 .3 1 1 .3 0  -1 1 0 -.3 1 1 .3 1 0 1 1 0] AttributeEnd\n";
const char* kBumps =
    "AttributeBegin Displacement \"depthbumps\" Attribute \"displacementbound\" \"float sphere\" .3\nTranslate 1 1 1 "
    "Sphere .6 -.6 .6 360 AttributeEnd\n";

} // namespace

TEST(DepthPasses, RunNoShadersAndHaveTheSameBits) {
    writeShader("depthbumps", "displacement depthbumps() { P += .2 * sin(9 * u) * normalize(N); N = calculatenormal(P); }");
    for (const char* filter : {"min", "max", "average", "midpoint"})
        for (const char* hider : {"hidden", "raytrace"}) {
            const std::string how = std::string("Hider \"") + hider + "\" \"string depthfilter\" \"" + filter + "\"\n";
            const std::string scene = std::string(kThings) + kBumps;
            const Rendered alone = render("z", scene, how), among = render("rgbaz", scene, how);
            EXPECT_EQ(alone.points, 0u) << filter << ' ' << hider;
            EXPECT_GT(among.points, 1000u);
            ASSERT_EQ(alone.picture.sampleCount() * 5, among.picture.sampleCount());
            size_t met = 0;
            for (int y = 0; y < 36; ++y)
                for (int x = 0; x < 48; ++x) {
                    EXPECT_EQ(alone.picture.pixel(x, y)[0], among.picture.pixel(x, y)[4])
                        << filter << ' ' << hider << ' ' << x << ' ' << y;
                    met += among.picture.pixel(x, y)[4] < 1e10f;
                }
            EXPECT_GT(met, 200u); // the picture is not empty
        }
}

TEST(DepthPasses, AnEmptyFilterIsTheFirst) {
    const Rendered empty = render("z", kThings, "Hider \"hidden\" \"string depthfilter\" [\"\"]\n"),
                   first = render("z", kThings, "Hider \"hidden\" \"string depthfilter\" \"min\"\n");
    for (int y = 0; y < 36; ++y)
        for (int x = 0; x < 48; ++x) EXPECT_EQ(empty.picture.pixel(x, y)[0], first.picture.pixel(x, y)[0]) << x << ' ' << y;
}

TEST(DepthPasses, RunShadersThatAreMissed) {
    writeShader("halfclear", "surface halfclear() { Oi = .5; Ci = Oi; }");
    writeShader("tellsz", "surface tellsz() { if (u < 0) printf(\"%p\", P); Oi = 1; Ci = 1; }");
    for (const char* surface : {"halfclear", "tellsz"}) {
        const std::string scene = std::string("Surface \"") + surface + "\"\nSphere 1 -1 1 360\n";
        EXPECT_GT(render("z", scene, "").points, 100u) << surface;
    }
    EXPECT_GT(render("z", "Opacity [.5 .5 .5]\nSphere 1 -1 1 360\n", "").points, 100u);
    EXPECT_EQ(render("z", "Sphere 1 -1 1 360\n", "").points, 0u);
}

} // namespace depthpasses_test
