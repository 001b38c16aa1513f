// Exact derivatives: normals of displaced surfaces, and bumps on top of them, against the analytic surface; footprints against
// closed forms. As grids have them: differences_test.cpp.
#include "integrator/harness.h"
#include "integrator/maps.h"

namespace derivatives_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

const double kAmplitude = .05, kFu = 12.566370614, kFv = 9.42477796;
double height(double u, double v) { return kAmplitude * std::sin(kFu * u) * std::cos(kFv * v); }
double bump(double u, double v) { return .02 * std::sin(31 * u + 1) * std::sin(17 * v); }

// The unit sphere of RISpec in its own space.
Vec3d sphere(double u, double v) {
    double phi = -kPi / 2 + v * kPi, theta = 2 * kPi * u;
    return {std::cos(phi) * std::cos(theta), std::cos(phi) * std::sin(theta), std::sin(phi)};
}
// A bilinear patch that is none: z is a product.
Vec3d saddle(double u, double v) { return {2 * u - 1, 2 * v - 1, 3 + .4 * (2 * u - 1) * (2 * v - 1)}; }

// Central differences in double, fourth order.
template <class F> Vec3d partialU(F f, double u, double v) {
    const double h = 1e-4;
    return (f(u - 2 * h, v) - f(u - h, v) * 8.0 + f(u + h, v) * 8.0 - f(u + 2 * h, v)) * (1 / (12 * h));
}
template <class F> Vec3d partialV(F f, double u, double v) {
    const double h = 1e-4;
    return (f(u, v - 2 * h) - f(u, v - h) * 8.0 + f(u, v + h) * 8.0 - f(u, v + 2 * h)) * (1 / (12 * h));
}
template <class F> Vec3d unitNormal(F f, double u, double v) { return normalize(cross(partialU(f, u, v), partialV(f, u, v))); }

// A wave as a map of 256 texels; what slopes that are differences over a texel, interpolated, miss of it is below 0.0015 of the
// most.
constexpr int kMap = 256;
double relief(double s, double t) { return std::sin(6 * kPi * s) * std::cos(4 * kPi * t); }

template <class F> std::string mapFile(const std::string& name, int width, int height, F value) {
    return writeMap(
        name, width, height, [&](int x, int y, int c) { return float((1 + c) * value((x + .5) / width, (y + .5) / height)); },
        "periodic,periodic");
}

/// A grid of ten by ten rays from the eye over the plane z = 3, of footprints that grow by `spread`.
std::vector<CameraRay> hundredRays(float spread) {
    std::vector<CameraRay> rays;
    for (int i = 0; i < 100; ++i) {
        rays.push_back(rayTo({0, 0, 0}, {.15f * float(i % 10) - .7f, .15f * float(i / 10) - .7f, 3}));
        rays.back().spread = spread;
    }
    return rays;
}

void writeMapShaders() {
    const std::string map = mapFile("relief.exr", kMap, kMap, relief);
    const std::string sky = mapFile("height.exr", 256, 128, [](double, double t) { return std::cos(kPi * t); });
    const std::string outputs = "(output varying normal shown = 0; output varying point uv = 0;)";
    writeShader("mapwaves",
                "displacement mapwaves() { P += 0.02 * float texture(" + map + ") * normalize(N); N = calculatenormal(P); }\n");
    writeShader("mapbump", "surface mapbump" + outputs + " { shown = normalize(calculatenormal(P + 0.02 * float texture(" + map +
                               ", s, t) * normalize(N))); uv = point(u, v, 0); Ci = 1; Oi = 1; }\n");
    writeShader("mapslopes", "surface mapslopes" + outputs + R"( {
    uniform string map = )" + map +
                                 R"(;
    float x = 2 * u + 0.3 * v, y = v * v, h = 0.5 / 256;
    color c = texture(map, x, y, "width", 0);
    float corners = texture(map, x, y, x, y, x, y, x, y);
    float byS = (texture(map, x + h, y, "width", 0) - texture(map, x - h, y, "width", 0)) / (2 * h);
    float byT = (texture(map, x, y + h, "width", 0) - texture(map, x, y - h, "width", 0)) / (2 * h);
    shown = normal(comp(Du(c), 1) / 2 - 2 * byS, comp(Dv(c), 2) / 3 - (0.3 * byS + 2 * v * byT), Du(corners) - 2 * byS);
    uv = point(comp(Du(c), 0), comp(Dv(c), 0), corners - comp(c, 0));
    Ci = color(u, v, 0);
    Oi = 1;
}
)");
    writeShader("mapcurves", "surface mapcurves" + outputs + R"( {
    float h = texture()" + map + R"([1], 2 * u + 0.3 * v, v * v, "width", 0);
    shown = normal(Du(Du(h)), Du(Dv(h)), Dv(Dv(h)));
    Ci = color(u, v, 0);
    Oi = 1;
}
)");
    writeShader("skyslopes", "surface skyslopes" + outputs + R"( {
    vector d = vector(2 * u - 1, v - 0.3, 0.7);
    float up = environment()" + sky +
                                 R"(, d);
    shown = normal(Du(up), Dv(up), up);
    float l = length(d);
    uv = point(-0.7 * 2 * xcomp(d) / (l * l * l), -0.7 * ycomp(d) / (l * l * l), 0.7 / l);
    Ci = 1;
    Oi = 1;
}
)");
}

void writeShaders() {
    writeShader("waves", R"(displacement waves() {
    P += 0.05 * sin(12.566370614 * u) * cos(9.42477796 * v) * normalize(N);
    N = calculatenormal(P);
}
)");
    writeShader("shownormal", "surface shownormal(output varying normal shown = 0; output varying point uv = 0;) { shown = "
                              "normalize(N); uv = point(u, v, 0); Ci = 1; Oi = 1; }\n");
    writeShader("showbump", R"(surface showbump(output varying normal shown = 0; output varying point uv = 0;) {
    shown = normalize(calculatenormal(P + .02 * sin(31 * u + 1) * sin(17 * v) * normalize(N)));
    uv = point(u, v, 0);
    Ci = 1;
    Oi = 1;
}
)");
    writeShader("showstep", "surface showstep() { Ci = color(du, dv, filterstep(0, u) * 0); Oi = 1; }\n");
}

template <class F>
void expectNormals(const std::string& rib, F surface, Vec3 eye, Vec3 towards, const char* what, double tolerance = 1e-3) {
    Settings s;
    s.outputs = {"shown", "uv"};
    Scene scene(rib, s);
    ASSERT_TRUE(scene.world);
    std::vector<CameraRay> rays;
    for (int i = 0; i < 400; ++i) {
        CameraRay r = rayTo(eye, towards + Vec3(.9f * (float(i % 20) / 10 - .95f), .9f * (float(i / 20) / 10 - .95f), 0));
        r.spread = 1e-4f;
        rays.push_back(r);
    }
    auto out = scene.trace(rays);
    int hits = 0;
    double worst = 0;
    for (const SampleResult& r : out) {
        if (r.opacity.x < 1) continue;
        double u = r.aovs[3], v = r.aovs[4];
        if (u < .02 || u > .98 || v < .02 || v > .98) continue;
        Vec3d n = unitNormal(surface, u, v), got(r.aovs[0], r.aovs[1], r.aovs[2]);
        worst = std::max(worst, std::min(length(n - got), length(n + got)));
        ++hits;
    }
    EXPECT_GT(hits, 150) << what;
    EXPECT_LT(worst, tolerance) << what;
}

std::string sphereRib(const char* displacement, const char* surface) {
    return std::string("Format 200 200 1\nProjection \"perspective\" \"fov\" 40\nWorldBegin\nSides 2\nAttribute "
                       "\"displacementbound\" \"sphere\" .1\nAttribute \"shade\" \"derivatives\" \"exact\"\n") +
           displacement + "Surface \"" + surface + "\"\nTranslate 0 0 4\nSphere 1 -1 1 360\nWorldEnd\n";
}
std::string patchRib(const char* displacement, const char* surface) {
    return std::string("Format 200 200 1\nProjection \"perspective\" \"fov\" 40\nWorldBegin\nSides 2\nAttribute "
                       "\"displacementbound\" \"sphere\" .1\nAttribute \"shade\" \"derivatives\" \"exact\"\n") +
           displacement + "Surface \"" + surface +
           "\"\nPatch \"bilinear\" \"P\" [-1 -1 3.4  1 -1 2.6  -1 1 2.6  1 1 3.4]\nWorldEnd\n";
}
auto displacedSphere = [](double u, double v) {
    Vec3d p = sphere(u, v);
    return p * (1 + height(u, v));
};
auto displacedSaddle = [](double u, double v) { return saddle(u, v) + unitNormal(saddle, u, v) * height(u, v); };
const char* kWaves = "Displacement \"waves\"\n";

// What is linear over a micropolygon of du by dv differs by what follows from its slopes, and lies in the middle.
TEST(GridBounds, OfAMicropolygon) {
    writeShader("bounds", "surface bounds() { float a = 3 * u - 2 * v; Oi = 1; Ci = color((gridmax(u) - gridmin(u)) / du,\n"
                          "(gridmax(a) - gridmin(a)) / (3 * du + 2 * dv), (gridmin(a) + gridmax(a)) / (2 * a)); }\n");
    CameraRay ray = rayTo({.3f, .8f, -.4f}, {.1f, 0, -.2f});
    ray.width = .002f;
    for (const Hider h : {Hider::Hidden, Hider::Raytrace, Hider::Path}) {
        Settings settings;
        settings.hider = h;
        const Color c =
            Scene("WorldBegin\nSurface \"bounds\"\nPatch \"bilinear\" \"P\" [-1 0 -2  3 0 -2  -1 0 1  3 0 1]\nWorldEnd\n",
                  settings)
                .one(ray);
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(c[k], 1, 1e-3) << int(h) << ' ' << k;
    }
}

TEST(Derivatives, PlainNormals) {
    writeShaders();
    expectNormals(sphereRib("", "shownormal"), sphere, {0, 0, 0}, {0, 0, 4}, "sphere", 1e-5);
    expectNormals(patchRib("", "shownormal"), saddle, {0, 0, 0}, {0, 0, 3}, "patch", 1e-5);
}
TEST(Derivatives, DisplacedNormals) {
    writeShaders();
    expectNormals(sphereRib(kWaves, "shownormal"), displacedSphere, {0, 0, 0}, {0, 0, 4}, "sphere");
    expectNormals(patchRib(kWaves, "shownormal"), displacedSaddle, {0, 0, 0}, {0, 0, 3}, "patch");
}
TEST(Derivatives, BumpOnThePlainSurface) {
    writeShaders();
    expectNormals(
        sphereRib("", "showbump"), [](double u, double v) { return sphere(u, v) * (1 + bump(u, v)); }, {0, 0, 0}, {0, 0, 4},
        "sphere", 1e-4);
    expectNormals(
        patchRib("", "showbump"), [](double u, double v) { return saddle(u, v) + unitNormal(saddle, u, v) * bump(u, v); },
        {0, 0, 0}, {0, 0, 3}, "patch", 1e-4);
}
TEST(Derivatives, BumpOverDisplacement) {
    writeShaders();
    // unitNormal points to dPdu ^ dPdv; the shader's N to the outside: on the sphere of RISpec both agree up to the camera's
    // handedness.
    for (double sign : {1.0, -1.0}) {
        auto patch = [sign](double u, double v) {
            return displacedSaddle(u, v) + unitNormal(displacedSaddle, u, v) * (sign * bump(u, v));
        };
        if (sign > 0) expectNormals(patchRib(kWaves, "showbump"), patch, {0, 0, 0}, {0, 0, 3}, "patch");
        auto ball = [sign](double u, double v) {
            return displacedSphere(u, v) + unitNormal(displacedSphere, u, v) * (sign * bump(u, v));
        };
        if (sign > 0) expectNormals(sphereRib(kWaves, "showbump"), ball, {0, 0, 0}, {0, 0, 4}, "sphere");
    }
}
// A footprint is twice the half width; on a plane seen straight on it is that over |dPdu|.
TEST(Derivatives, Footprints) {
    writeShaders();
    for (double distance : {2.0, 5.0})
        for (double tilt : {0.0, 60.0}) {
            std::string z = std::to_string(distance);
            Scene scene("WorldBegin\nSides 2\nShadingRate 1\nSurface \"showstep\"\nTranslate 0 0 " + z + "\nRotate " +
                        std::to_string(tilt) + " 1 0 0\nPatch \"bilinear\" \"P\" [-4 -2 0  4 -2 0  -4 2 0  4 2 0]\nWorldEnd\n");
            CameraRay r = rayTo({0, 0, 0}, {0, 0, 1});
            r.width = .001f;
            r.spread = .002f;
            Color c = scene.one(r);
            double w = 2 * (.001 + .002 * distance);
            EXPECT_NEAR(c.x, w / 8, 1e-3 * w / 8) << distance;
            EXPECT_NEAR(c.y, w / 4 / std::cos(tilt * kPi / 180), 1e-3 * w / 4) << tilt;
        }
}

// Heights that come from a map: bumps and displacements tilt the normals as those of the surface that the map describes.
auto reliefSphere = [](double u, double v) { return sphere(u, v) * (1 + .02 * relief(u, v)); };
auto reliefSaddle = [](double u, double v) { return saddle(u, v) + unitNormal(saddle, u, v) * (.02 * relief(u, v)); };

TEST(TextureDerivatives, Bumps) {
    writeMapShaders();
    expectNormals(sphereRib("", "mapbump"), reliefSphere, {0, 0, 0}, {0, 0, 4}, "sphere");
    expectNormals(patchRib("", "mapbump"), reliefSaddle, {0, 0, 0}, {0, 0, 3}, "patch");
}
TEST(TextureDerivatives, Displacements) {
    writeShaders();
    writeMapShaders();
    const char* waves = "Displacement \"mapwaves\"\n";
    expectNormals(sphereRib(waves, "shownormal"), reliefSphere, {0, 0, 0}, {0, 0, 4}, "sphere", 2e-3);
    expectNormals(patchRib(waves, "shownormal"), reliefSaddle, {0, 0, 0}, {0, 0, 3}, "patch", 2e-3);
}
// By the chain rule, of one channel and of another, of four corners; against differences that the shader takes itself, and the
// wave's.
TEST(TextureDerivatives, AgainstDifferences) {
    writeMapShaders();
    for (Hider hider : {Hider::Raytrace, Hider::Path}) {
        Settings s;
        s.hider = hider;
        s.outputs = {"shown", "uv"};
        Scene scene(patchRib("", "mapslopes"), s);
        const std::vector<CameraRay> rays = hundredRays(1e-5f);
        int hits = 0;
        for (const SampleResult& r : scene.trace(rays)) {
            if (r.opacity.x < 1) continue;
            ++hits;
            for (int k = 0; k < 3; ++k) EXPECT_NEAR(r.aovs[size_t(k)], 0, 2e-2) << k; // of slopes up to 38; the differences round
            EXPECT_NEAR(r.aovs[5], 0, 1e-4);
            const double u = r.color.x, v = r.color.y, x = 2 * u + .3 * v, y = v * v;
            const double byS = 6 * kPi * std::cos(6 * kPi * x) * std::cos(4 * kPi * y),
                         byT = -4 * kPi * std::sin(6 * kPi * x) * std::sin(4 * kPi * y);
            EXPECT_NEAR(r.aovs[3], 2 * byS, .0015 * 12 * kPi) << u << " " << v;
            EXPECT_NEAR(r.aovs[4], .3 * byS + 2 * v * byT, .0015 * 14 * kPi) << u << " " << v;
        }
        EXPECT_GT(hits, 80);
    }
}
// Second derivatives: the wave's, by the chain rule. What differences over a texel miss of them is below half a percent of the
// most.
TEST(TextureDerivatives, OfSecondOrder) {
    writeMapShaders();
    Settings s;
    s.outputs = {"shown", "uv"};
    Scene scene(patchRib("", "mapcurves"), s);
    const std::vector<CameraRay> rays = hundredRays(1e-5f);
    int hits = 0;
    for (const SampleResult& r : scene.trace(rays)) {
        if (r.opacity.x < 1) continue;
        ++hits;
        const double u = r.color.x, v = r.color.y, a = 6 * kPi, b = 4 * kPi, x = a * (2 * u + .3 * v),
                     y = b * v * v; // the map's second channel is 2 f
        const double xx = -2 * a * a * std::sin(x) * std::cos(y), xy = -2 * a * b * std::cos(x) * std::sin(y),
                     yy = -2 * b * b * std::sin(x) * std::cos(y);
        const double byY = -2 * b * std::sin(x) * std::sin(y), most = 4 * 2 * a * a;
        EXPECT_NEAR(r.aovs[0], 4 * xx, .005 * most) << u << " " << v;
        EXPECT_NEAR(r.aovs[1], .6 * xx + 4 * v * xy, .005 * most) << u << " " << v;
        EXPECT_NEAR(r.aovs[2], .09 * xx + 1.2 * v * xy + 4 * v * v * yy + 2 * byY, .005 * most) << u << " " << v;
    }
    EXPECT_GT(hits, 80);
    EXPECT_EQ(scene.diagnostics.warnings(), 0) << scene.messages();
}
TEST(TextureDerivatives, OfAnEnvironment) {
    writeMapShaders();
    Settings s;
    s.outputs = {"shown", "uv"};
    Scene scene(patchRib("", "skyslopes"), s);
    const std::vector<CameraRay> rays = hundredRays(1e-5f);
    int hits = 0;
    for (const SampleResult& r : scene.trace(rays)) {
        if (r.opacity.x < 1) continue;
        ++hits;
        for (size_t k = 0; k < 3; ++k) EXPECT_NEAR(r.aovs[k], r.aovs[3 + k], 3e-3) << k;
    }
    EXPECT_GT(hits, 80);
}

} // namespace

} // namespace derivatives_test
