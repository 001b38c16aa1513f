// Micropolygons compared with samples that are shaded one by one, which are the independent way: finer ones come to the same
// picture, rates that make no sense are bounded, volumes are left to samples; and raytrace, where it asks for micropolygons.
#include "display/imageio.h"
#include "integrator/gridscene.h"
#include "render/renderer.h"
#include <algorithm>
#include <array>
#include <limits>

namespace gridproof_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

constexpr float kSlope = 10; ///< of waves(), at most, along x and along y

void writeShaders() {
    writeShader("waves",
                "surface waves() { Oi = 1; Ci = color(.5 + .5 * sin(20 * xcomp(P)), .5 + .5 * sin(20 * ycomp(P)), 0); }");
    writeShader("derives", "surface derives() { Oi = Os; Ci = Os * color(area(P), abs(Du(s * t)), filterstep(.5, s)); }");
}

struct Differences {
    double mean = 0, rms = 0, most = 0;
};
/// Of red and green where both pictures have a surface.
Differences differences(const std::vector<SampleResult>& a, const std::vector<SampleResult>& b) {
    Differences d;
    double n = 0;
    for (size_t i = 0; i < a.size(); ++i) {
        if (!(b[i].opacity.x > 0)) continue;
        for (int k = 0; k < 2; ++k) {
            const double x = std::fabs(double(a[i].color[k]) - double(b[i].color[k]));
            d.mean += x, d.rms += x * x, d.most = std::max(d.most, x), ++n;
        }
    }
    d.mean /= n, d.rms = std::sqrt(d.rms / n);
    return d;
}

bool same(const SampleResult& a, const SampleResult& b) {
    return a.color == b.color && a.opacity == b.opacity && a.z == b.z && a.zSecond == b.zSecond && a.aovs == b.aovs;
}

/// Kinds in addition to those of kShapes.
const std::vector<std::string> kOthers = {
    kSquare,
    "Translate 0 0 5\nParaboloid .8 0 .9 360\n",
    "Translate 0 0 5\nHyperboloid .3 -.8 0 .8 .8 .3 360\n",
    "GeneralPolygon [4 3] \"P\" [-1 -1 5 -1 1 5 1 1 5 1 -1 5  -.3 -.3 5 .3 -.3 5 0 .4 5]\n",
    "PointsPolygons [3 3] [0 1 2 0 2 3] \"P\" [-1 -1 5  -1 1 5  1 1 6  1 -1 5]\n",
    "PointsGeneralPolygons [1 1] [4 3] [0 1 2 3 4 5 6] \"P\" [-1 -1 5 -1 1 5 0 1 5 0 -1 5  .1 -1 5 .1 1 5 1 0 6]\n",
    "PatchMesh \"bilinear\" 3 \"nonperiodic\" 2 \"nonperiodic\" \"P\" [-1 -1 5 0 -1 4 1 -1 5  -1 1 5 0 1 6 1 1 5]\n",
    "NuPatch 3 3 [0 0 0 1 1 1] 0 1 2 2 [0 0 1 1] 0 1 \"P\" [-1 -1 5 0 -1 4 1 -1 5  -1 1 5 0 1 6 1 1 5]\n",
    "Curves \"linear\" [2] \"nonperiodic\" \"P\" [-.9 -.9 5 .9 .9 5] \"constantwidth\" [.3] \"N\" [0 0 -1 0 0 -1]\n",
    "SubdivisionMesh \"loop\" [3 3] [0 1 2 0 2 3] [\"interpolateboundary\"] [0 0] [] [] \"P\" [-1 -1 5 -1 1 5 1 1 4 1 -1 5]\n",
    "MotionBegin [0 1]\nTranslate 0 0 0\nTranslate .2 0 0\nMotionEnd\nTranslate 0 0 5\nSphere .7 -.7 .7 360\n",
};
std::vector<std::string> allShapes() {
    std::vector<std::string> all = kShapes;
    all.insert(all.end(), kOthers.begin(), kOthers.end());
    return all;
}

/// A frame with a rate that RIB cannot spell, on all of its primitives.
std::shared_ptr<const scene::Frame> withRate(const scene::Frame& f, float rate) {
    const auto rated = [&](const scene::AttributesRef& a) {
        auto copy = std::make_shared<scene::Attributes>(*a);
        copy->shadingRate = rate;
        return copy;
    };
    auto frame = std::make_shared<scene::Frame>(f);
    const auto all = [&](std::vector<scene::PrimitiveRef>& primitives) {
        for (scene::PrimitiveRef& p : primitives) {
            auto copy = std::make_shared<scene::Primitive>(*p);
            copy->attributes = rated(p->attributes);
            p = copy;
        }
    };
    all(frame->primitives);
    for (scene::Object& o : frame->objects) all(o.primitives);
    for (scene::Instance& i : frame->instances) i.attributes = rated(i.attributes);
    return frame;
}

} // namespace

// Within a cell the shader is off by at most its slope times half an edge along each of two directions; its mean square over a
// cell is a sixth of that of a whole edge. Edges are rounded. ShadingInterpolation "smooth" may only be nearer.
TEST(GridProof, FinerRatesComeToTheSamples) {
    writeShaders();
    const auto rays = samplesOf(2);
    for (const std::string& shape : kShapes) {
        Scene exact(gridPicture("Surface \"waves\"\n" + shape), bySettings(false));
        const auto want = exact.trace(rays);
        for (const char* how : {"constant", "smooth"}) {
            double first = 0, last = 0;
            for (const float rate : {1.f, .5f, .25f, .1f}) {
                Scene s(gridPicture("Surface \"waves\"\nShadingInterpolation \"" + std::string(how) + "\"\nShadingRate " +
                                    std::to_string(rate) + "\n" + shape),
                        bySettings(true));
                const Differences d = differences(s.trace(rays), want);
                const double edge = double(std::sqrt(rate) * kPixel * kRounding);
                EXPECT_LE(d.most, double(kSlope) * edge) << shape << how << rate;
                EXPECT_LE(d.rms, double(kSlope) * edge / std::sqrt(6.)) << shape << how << rate;
                (rate == 1 ? first : last) = d.rms;
            }
            EXPECT_LE(last, first / 2) << shape << how; // edges are a third
        }
    }
}

// No shader runs more often than for four corners a sample, and all that comes is finite.
TEST(GridProof, RatesThatMakeNoSenseAreBounded) {
    writeShaders();
    const auto rays = samplesOf(1);
    const auto check = [&](const std::shared_ptr<const World>& world, const std::string& what) {
        Diagnostics d;
        Integrator i(world, d);
        std::vector<SampleResult> out(rays.size());
        ASSERT_TRUE(i.trace(rays, out, nullptr)) << what;
        EXPECT_LE(i.counters().points, 4 * rays.size()) << what;
        EXPECT_EQ(i.counters().nonFinite, 0u) << what;
        size_t seen = 0;
        for (const SampleResult& r : out) {
            ASSERT_TRUE(std::isfinite(r.color.x) && std::isfinite(r.color.y) && std::isfinite(r.color.z)) << what;
            ASSERT_TRUE(r.opacity.x == 0 || std::fabs(r.opacity.x - 1) < 1e-6f) << what; // weights of corners are rounded
            seen += r.opacity.x > 0;
        }
        EXPECT_GT(seen, 20u) << what;
    };
    for (const char* how : {"constant", "smooth"})
        for (const std::string& shape : allShapes()) {
            const std::string inside = "Surface \"derives\"\nShadingInterpolation \"" + std::string(how) + "\"\n";
            for (const char* rate : {"0", "-1", "1e-38", "1e38"}) {
                Scene s(gridPicture(inside + "ShadingRate " + rate + "\n" + shape), bySettings(true));
                check(s.world, shape + how + rate);
            }
            constexpr float kInf = std::numeric_limits<float>::infinity();
            for (const float rate : {std::numeric_limits<float>::quiet_NaN(), kInf, -kInf}) {
                Scene s(gridPicture(inside + shape), bySettings(true));
                Settings settings = bySettings(true);
                settings.shaderPaths.push_back(shaderFolder());
                check(buildWorld(withRate(*s.frame, rate), settings, s.diagnostics), shape + how + std::to_string(rate));
            }
        }
}

// What samples have of their own, their way through a volume, is theirs: the same bits as without micropolygons, whatever lies
// before and behind.
TEST(GridProof, VolumesHaveTheBitsOfSamples) {
    const std::string fog = "Interior \"medium\" \"color scattering\" [.3 .25 .2] \"color absorption\" [.05 .1 .2]\n";
    const std::string lit = "LightSource \"pointlight\" 1 \"point from\" [1 1 2] \"float intensity\" 8\n";
    const std::string things = "Surface \"matte\"\nAttributeBegin Translate .2 .1 5 Sphere .5 -.5 .5 360 AttributeEnd\n"
                               "Translate 0 0 2\n" +
                               kSquare;
    const std::pair<std::string, std::string> scenes[] = {
        {"about the eye", "AttributeBegin\nSurface \"null\"\n" + fog + "Sphere 14 -14 14 360\nAttributeEnd\n" + lit + things},
        {"before all", lit + "AttributeBegin\nSurface \"null\"\n" + fog +
                           "Translate 0 0 5\nPolygon \"P\" [-2 -2 -2 -2 2 -2 2 2 -2 2 -2 -2]\nSphere 4 -4 4 360\nAttributeEnd\n" +
                           things}};
    const auto rays = samplesOf(2);
    for (const auto& [what, inside] : scenes) {
        Scene grids(gridPicture(inside), bySettings(true)), samples(gridPicture(inside), bySettings(false));
        const auto a = grids.trace(rays), b = samples.trace(rays);
        double light = 0;
        for (size_t i = 0; i < rays.size(); ++i) {
            ASSERT_TRUE(same(a[i], b[i])) << what << i;
            light += double(luminance(a[i].color));
        }
        EXPECT_GT(light, 1) << what;
    }
}

namespace {

struct Rendered {
    uint64_t points = 0;
    std::vector<float> pixels;
    int errors = 0, warnings = 0;
};
Rendered render(const std::string& options, const std::string& variables = "rgb") {
    writeShaders();
    const std::string file = shaderFolder() + "/gridproof.exr";
    Diagnostics diagnostics;
    render::RenderSettings s;
    s.threads = 1;
    s.allowWrite = true;
    s.shippedShaders = std::string(ALPENGLOW_SOURCE_DIR) + "/shaders";
    s.shaderPaths = {shaderFolder()};
    render::Progress progress(render::ProgressMode::None);
    render::Renderer renderer(s, render::transportEngine(), diagnostics, progress);
    ri::RibReader reader(ri::ReaderOptions{}, renderer, diagnostics);
    reader.readMemory("Format 48 32 1\nPixelSamples 4 4\nProjection \"perspective\" \"fov\" 40\n" + options + "Display \"" +
                          file + "\" \"openexr\" \"" + variables +
                          "\"\nTranslate 0 0 4\nWorldBegin\nSurface \"waves\"\nSphere 1 -1 1 360\nSurface \"matte\"\n"
                          "Translate 0 0 1 Polygon \"P\" [-3 -3 0 -3 3 0 3 3 0 3 -3 0]\nWorldEnd\n",
                      "gridproof.rib");
    Rendered r{renderer.stats().shading.points, {}, diagnostics.errors(), 0};
    for (const Diagnostic& d : diagnostics.all()) r.warnings += d.severity == Severity::Warning;
    if (const auto picture = display::readImage(file, diagnostics)) r.pixels = picture->data;
    EXPECT_FALSE(r.pixels.empty());
    std::filesystem::remove(file);
    return r;
}

} // namespace

// raytrace shades samples, and micropolygons where its parameter says so: then it has the picture of hidden.
TEST(GridProof, RaytraceShadesMicropolygonsWhereItIsAsked) {
    const std::string micropolygons = "\"string shading\" \"micropolygon\"\n";
    const Rendered hidden = render("Hider \"hidden\"\n"), samples = render("Hider \"raytrace\"\n"),
                   asked = render("Hider \"raytrace\" " + micropolygons);
    EXPECT_LT(4 * hidden.points, samples.points);
    EXPECT_EQ(asked.points, hidden.points);
    EXPECT_EQ(asked.pixels, hidden.pixels);
    EXPECT_EQ(render("Hider \"raytrace\" \"string shading\" \"sample\"\n").points, samples.points);
    EXPECT_EQ(render("Option \"hidden\" \"string shading\" \"micropolygon\"\nHider \"raytrace\"\n").points, samples.points);
    EXPECT_EQ(hidden.warnings + samples.warnings + asked.warnings, 0);
    const Rendered wrong = render("Hider \"raytrace\" \"string shading\" \"grid\"\n");
    EXPECT_EQ(wrong.errors, 1);
    EXPECT_EQ(wrong.points, samples.points);
}

// A lens or an open shutter has samples with places and times of their own: raytrace says that it goes on with these.
TEST(GridProof, RaytraceKeepsLensesAndTimes) {
    for (const std::string own : {"DepthOfField 8 .5 4\n", "Shutter 0 1\n"}) {
        const Rendered samples = render(own + "Hider \"raytrace\"\n"),
                       asked = render(own + "Hider \"raytrace\" \"string shading\" \"micropolygon\"\n"),
                       hidden = render(own + "Hider \"hidden\" \"string shading\" \"micropolygon\"\n");
        EXPECT_EQ(asked.warnings, samples.warnings + 1) << own;
        EXPECT_EQ(asked.errors, 0);
        EXPECT_EQ(asked.pixels, samples.pixels);
        EXPECT_LT(2 * hidden.points, samples.points) << own;
        EXPECT_EQ(hidden.warnings, samples.warnings) << own;
    }
}

// Depth filter "midpoint" asks for the depths of second surfaces alone: nothing is shaded for them.
TEST(GridProof, MidpointShadesNoSecondSurfaces) {
    for (const std::string hider :
         {"Hider \"hidden\" ", "Hider \"hidden\" \"string shading\" \"sample\" ", "Hider \"raytrace\" "}) {
        const Rendered nearest = render(hider + "\"string depthfilter\" \"min\"\n", "rgbaz"),
                       middle = render(hider + "\"string depthfilter\" \"midpoint\"\n", "rgbaz");
        EXPECT_EQ(middle.points, nearest.points) << hider;
        EXPECT_NE(middle.pixels, nearest.pixels) << hider;
    }
}

} // namespace gridproof_test
