// The camera against the formulas of docs/design/ri.md, worked out by hand in each test.
#include "render/camera.h"
#include "scene/scene.h"
#include <cmath>
#include <gtest/gtest.h>

namespace camera_test {

using namespace alpenglow;
using namespace alpenglow::render;

namespace {

scene::Options perspective(float fov, int w = 640, int h = 480) {
    scene::Options o;
    o.xres = w;
    o.yres = h;
    o.projection = "perspective";
    o.fov = fov;
    return o;
}

const Vec2 kMiddle{0.5f, 0.5f};

} // namespace

TEST(Camera, PerspectiveSpansTheSmallerSide) {
    Diagnostics d;
    Camera c(perspective(90), d);
    // The middle of the raster looks along +z; the middle of the upper edge lies at y = tan(45), the right edge at x = 4/3.
    auto mid = c.ray(320, 240, kMiddle, 0), top = c.ray(320, 0, kMiddle, 0), right = c.ray(640, 240, kMiddle, 0);
    EXPECT_FLOAT_EQ(mid.direction.z, 1);
    EXPECT_FLOAT_EQ(top.direction.y / top.direction.z, 1);
    EXPECT_NEAR(top.direction.x, 0, 1e-7);
    EXPECT_FLOAT_EQ(right.direction.x / right.direction.z, 4.f / 3);
    EXPECT_FLOAT_EQ(top.cosine, std::sqrt(0.5f));
    // Half a pixel at depth 1: tan(45) * (2 * 4/3) / 640 / 2 = 1/480.
    EXPECT_FLOAT_EQ(mid.spread, 1.f / 480);
    EXPECT_EQ(mid.width, 0);
    // Portrait: the width spans -1..1.
    Camera p(perspective(90, 480, 640), d);
    EXPECT_FLOAT_EQ(p.ray(480, 320, kMiddle, 0).direction.x / p.ray(480, 320, kMiddle, 0).direction.z, 1);
    EXPECT_EQ(d.errors(), 0);
}

TEST(Camera, OrthographicAndScreenWindow) {
    Diagnostics d;
    scene::Options o;
    o.xres = 100;
    o.yres = 50;
    o.screenWindow = std::vector<float>{-4, 6, -1, 3};
    Camera c(o, d);
    auto r = c.ray(10, 50, kMiddle, 0); // x = -4 + 10 * 10/100, y = 3 - 4
    EXPECT_FLOAT_EQ(r.origin.x, -3);
    EXPECT_FLOAT_EQ(r.origin.y, -1);
    EXPECT_FLOAT_EQ(r.origin.z, 0);
    EXPECT_EQ(r.direction, Vec3(0, 0, 1));
    EXPECT_FLOAT_EQ(r.width, 0.05f); // half of max(10/100, 4/50)
    EXPECT_EQ(r.spread, 0);
    EXPECT_EQ(d.errors(), 0);
}

TEST(Camera, NearPlaneStartsTheRay) {
    Diagnostics d;
    scene::Options o = perspective(90);
    o.clipNear = 2;
    o.clipFar = 100;
    Camera c(o, d);
    auto r = c.ray(320, 0, kMiddle, 0);
    EXPECT_FLOAT_EQ(r.origin.z, 2);
    EXPECT_FLOAT_EQ(r.origin.y, 2);
    EXPECT_FLOAT_EQ(r.width, 2.f / 480);
}

TEST(Camera, CropWindowRounding) {
    Diagnostics d;
    scene::Options o = perspective(40);
    float edges[] = {0, 0.1f, 0.25f, 1 / 3.f, 0.5f, 0.777f, 1};
    int at = 0;
    for (int i = 0; i + 1 < int(std::size(edges)); ++i) { // neighbours tile: no gap, no overlap
        o.crop[0] = edges[i];
        o.crop[1] = edges[i + 1];
        Window w = Camera(o, d).window();
        EXPECT_EQ(w.x0, at);
        at = w.x1;
    }
    EXPECT_EQ(at, 640);
    o.crop[0] = 0.1f; // 640 * 0.1 = 64; ceil(640 * 0.25 - 1) = 159, the last pixel
    o.crop[1] = 0.25f;
    EXPECT_EQ(Camera(o, d).window(), (Window{64, 0, 160, 480}));
    EXPECT_EQ(d.errors(), 0);
    o.crop[0] = 0.9f;
    EXPECT_EQ(Camera(o, d).window().width(), 640);
    EXPECT_EQ(d.errors(), 1);
}

TEST(Camera, FrameAspectRatio) {
    scene::Options o;
    int w, h;
    o.frameAspect = 2.f; // at least 1: the width stays, height = 640 / 2
    imageSize(o, &w, &h);
    EXPECT_EQ(w, 640);
    EXPECT_EQ(h, 320);
    o.frameAspect = 0.5f; // below 1: the height stays, width = 480 / 2
    imageSize(o, &w, &h);
    EXPECT_EQ(w, 240);
    EXPECT_EQ(h, 480);
    o.frameAspect.reset();
    o.pixelAspect = -1; // the device's own
    Diagnostics d;
    EXPECT_EQ(Camera(o, d).pixelAspect(), 1);
    EXPECT_EQ(d.errors(), 0);
}

TEST(Camera, PlainRaysTogetherHaveTheBitsOfOne) {
    scene::Options orthographic;
    orthographic.xres = 300;
    scene::Options close = perspective(35);
    close.clipNear = 0.7f;
    for (const scene::Options& o : {perspective(90), close, orthographic}) {
        Diagnostics d;
        const Camera c(o, d);
        ASSERT_TRUE(c.plain());
        std::vector<Vec2> raster;
        for (int i = 0; i < 37; ++i) raster.push_back({float(i) * 17.3f - 20, 600 - float(i) * 19.7f});
        std::vector<integrator::CameraRay> rays(raster.size());
        c.plainRays(raster, rays.data());
        for (size_t i = 0; i < raster.size(); ++i) {
            const integrator::CameraRay one = c.ray(double(raster[i].x), double(raster[i].y), kMiddle, 0);
            EXPECT_EQ(rays[i].origin, one.origin);
            EXPECT_EQ(rays[i].direction, one.direction);
            for (const auto part : {&integrator::CameraRay::width, &integrator::CameraRay::spread, &integrator::CameraRay::cosine,
                                    &integrator::CameraRay::start, &integrator::CameraRay::time})
                EXPECT_EQ(rays[i].*part, one.*part);
        }
    }
}

TEST(Camera, DepthOfFieldMeetsInFocus) {
    Diagnostics d;
    scene::Options o = perspective(60);
    o.fstop = 2;
    o.focalLength = 1; // lens diameter 0.5
    o.focalDistance = 8;
    Camera c(o, d);
    ASSERT_TRUE(c.hasLens());
    Camera pinhole(perspective(60), d);
    auto p = pinhole.ray(100, 77, kMiddle, 0);
    Vec3 focus = p.direction * (8 / p.direction.z);
    double most = 0;
    for (float u : {0.f, 0.25f, 0.5f, 0.9999f})
        for (float v : {0.f, 0.3f, 0.9999f}) {
            auto r = c.ray(100, 77, {u, v}, 0);
            most = std::max(most, double(length(r.origin)));
            Vec3 at = r.origin + r.direction * ((8 - r.origin.z) / r.direction.z);
            EXPECT_NEAR(length(at - focus), 0, 1e-5);
        }
    EXPECT_NEAR(most, 0.25, 1e-3);
    EXPECT_LE(most, 0.25 + 1e-6);
}

TEST(Camera, LensIsUniform) {
    // The mean of r^2 over a disc of radius R is R^2 / 2.
    Diagnostics d;
    scene::Options o;
    o.fstop = 1;
    o.focalLength = 2; // radius 1
    o.focalDistance = 1;
    Camera c(o, d);
    double sum = 0;
    const int n = 200;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            auto r = c.ray(320, 240, {(float(i) + 0.5f) / n, (float(j) + 0.5f) / n}, 0);
            sum += double(r.origin.x) * r.origin.x + double(r.origin.y) * r.origin.y;
        }
    EXPECT_NEAR(sum / (n * n), 0.5, 1e-3);
}

TEST(Camera, ShutterAndMovingCamera) {
    Diagnostics d;
    scene::Options o = perspective(90);
    o.shutterOpen = 1;
    o.shutterClose = 3;
    o.worldToCamera.times = {1, 3};
    o.worldToCamera.keys = {translateMatrix(0, 0, 5), translateMatrix(2, 0, 5)}; // the camera itself moves 2 to the left
    Camera c(o, d);
    EXPECT_FLOAT_EQ(c.ray(0, 0, kMiddle, 0.25f).time, 1.5f);
    auto r = c.ray(320, 240, kMiddle, 0.5f);
    EXPECT_NEAR(r.origin.x, -1, 1e-6); // half way, in the space of the first key
    EXPECT_FLOAT_EQ(r.direction.z, 1);
    EXPECT_FLOAT_EQ(c.ray(320, 0, kMiddle, 0.5f).cosine, std::sqrt(0.5f));
}

TEST(Camera, WorldToNdcAgreesWithRays) {
    Diagnostics d;
    for (const char* projection : {"perspective", "orthographic"}) {
        scene::Options o = perspective(50, 300, 200);
        o.projection = projection;
        o.worldToCamera = translateMatrix(0.1, -0.2, 4);
        Camera c(o, d);
        auto r = c.ray(75, 150, kMiddle, 0);
        Vec3d camera = Vec3d(r.origin) + Vec3d(r.direction) * 3.0;
        Vec3d world = transformPoint(inverse(c.worldToCamera()), camera);
        Vec3d ndc = transformPoint(c.worldToNDC(), world);
        EXPECT_NEAR(ndc.x, 75.0 / 300, 1e-6) << projection;
        EXPECT_NEAR(ndc.y, 150.0 / 200, 1e-6) << projection;
    }
}

TEST(Camera, NonsenseIsReportedAndReplaced) {
    Diagnostics d;
    scene::Options o = perspective(180);
    o.projection = "perspective";
    o.screenWindow = std::vector<float>{1, 1, 0, 1};
    o.shutterOpen = 2;
    o.shutterClose = 1;
    o.fstop = 2; // without a focal length
    Camera c(o, d);
    EXPECT_EQ(d.errors(), 4);
    EXPECT_TRUE(std::isfinite(c.ray(3, 4, kMiddle, 0.5f).direction.x));
    Diagnostics e;
    o = {};
    o.projection = "fisheye";
    Camera f(o, e);
    EXPECT_EQ(e.errors(), 1);
    EXPECT_EQ(f.ray(1, 1, kMiddle, 0).direction, Vec3(0, 0, 1));
}

TEST(Camera, CirclesOfConfusion) {
    // docs/design/ri.md: in perspective the blur of a point at depth z has the width A |1/z - 1/D| k xres / (right - left) in the
    // raster; in orthographic views A |z/D - 1| xres / (right - left).
    Diagnostics d;
    for (bool perspectively : {true, false})
        for (double z : {2.0, 5.0, 8.0, 20.0, 100.0}) {
            scene::Options o = perspective(40, 600, 400);
            if (!perspectively) o.projection = "orthographic";
            o.fstop = 4;
            o.focalLength = 2; // diameter 0.5
            o.focalDistance = 8;
            Camera c(o, d);
            // The raster positions that see a point through the rim of the lens: rays are linear in it.
            const auto xAt = [&](double rx, Vec2 lens) {
                auto r = c.ray(rx, 200, lens, 0);
                Vec3d p = Vec3d(r.origin) + Vec3d(r.direction) * ((z - r.origin.z) / r.direction.z);
                return p.x;
            };
            const auto seenFrom = [&](Vec2 lens) { // where x is 0.3
                const double a = xAt(200, lens), b = xAt(400, lens);
                return 200 + 200 * (0.3 - a) / (b - a);
            };
            const double blur = std::fabs(seenFrom({1, 0.5f}) - seenFrom({0, 0.5f}));
            const double k = 1 / std::tan(20 * kPi / 180), screen = 600 / 3.0;
            EXPECT_NEAR(blur, perspectively ? 0.5 * std::fabs(1 / z - 1 / 8.0) * k * screen : 0.5 * std::fabs(z / 8 - 1) * screen,
                        1e-3 * (1 + blur));
        }
}

TEST(Camera, BladesOfTheAperture) {
    const auto moments = [](const Aperture& a, double& x2, double& y2, double& most) {
        const int n = 400;
        x2 = y2 = most = 0;
        double x = 0, y = 0;
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j) {
                const Vec2 p = a.sample({(float(i) + 0.5f) / n, (float(j) + 0.5f) / n});
                x += p.x, y += p.y;
                x2 += double(p.x) * p.x, y2 += double(p.y) * p.y;
                most = std::max(most, std::sqrt(double(p.x) * p.x + double(p.y) * p.y));
            }
        x2 /= n * n, y2 /= n * n;
        EXPECT_NEAR(x / (n * n), 0, 2e-3);
        EXPECT_NEAR(y / (n * n), 0, 2e-3);
    };
    double x2, y2, most;
    // A regular polygon of n sides in the unit circle: mean of x^2 = (2 + cos(2 pi / n)) / 12.
    for (int sides : {3, 4, 5, 6, 8}) {
        moments(Aperture(sides, 17, 0, 0), x2, y2, most);
        EXPECT_NEAR(x2, (2 + std::cos(2 * kPi / sides)) / 12, 2e-3) << sides;
        EXPECT_NEAR(y2, (2 + std::cos(2 * kPi / sides)) / 12, 2e-3) << sides;
        EXPECT_LE(most, 1 + 1e-6);
        EXPECT_GT(most, 0.98);
        // All inside of the sides.
        const Aperture a(sides, 0, 0, 0);
        for (int i = 0; i < 2000; ++i) {
            const Vec2 p = a.sample({float(std::fmod(i * 0.618034, 1.0)), float(i) / 2000});
            for (int k = 0; k < sides; ++k) {
                const double middle = kPi * (2 * k + 1) / sides;
                EXPECT_LE(p.x * std::cos(middle) + p.y * std::sin(middle), std::cos(kPi / sides) + 1e-5);
            }
        }
    }
    moments(Aperture(5, 0, 1, 0), x2, y2, most); // quite round
    EXPECT_NEAR(x2, 0.25, 1e-3);
    // Density: mean of r^2 with weight 1 - d + 2 d r over the disc: ((1 - d) / 4 + 2 d / 5) / ((1 - d) / 2 + 2 d / 3).
    for (double density : {-1.0, -0.4, 0.5, 1.0}) {
        moments(Aperture(0, 0, 0, density), x2, y2, most);
        EXPECT_NEAR(x2 + y2, ((1 - density) / 4 + 2 * density / 5) / ((1 - density) / 2 + 2 * density / 3), 1e-3) << density;
    }
}

TEST(Camera, ApertureIsAHiderParameter) {
    Diagnostics d;
    scene::Options o = perspective(40);
    o.fstop = 1, o.focalLength = 2, o.focalDistance = 5; // radius 1
    scene::Param p;
    p.name = "aperture";
    p.numbers = {4, 0, 0, 0};
    o.hiderParams = {p};
    double most = 0;
    for (int i = 0; i < 1000; ++i) {
        auto r = Camera(o, d).ray(320, 240, {float(i) / 1000, 0.9999f}, 0);
        most = std::max(most, double(std::fabs(r.origin.x) + std::fabs(r.origin.y)));
    }
    EXPECT_NEAR(most, 1, 1e-3); // a square on its corner
    EXPECT_EQ(d.errors(), 0);
    o.hiderParams[0].numbers = {4, 0, 7, 0};
    Camera bad(o, d);
    EXPECT_EQ(d.errors(), 1);
}

TEST(Camera, StereoPairsMeetInTheFocalPlane) {
    Diagnostics d;
    scene::Options o = perspective(40, 600, 300);
    o.projectionParams.resize(3);
    o.projectionParams[0].name = "stereo";
    o.projectionParams[0].strings = {"sidebyside"};
    o.projectionParams[1].name = "eyeseparation";
    o.projectionParams[1].numbers = {0.2f};
    o.projectionParams[2].name = "focaldistance";
    o.projectionParams[2].numbers = {4};
    Camera c(o, d);
    for (double x : {10.0, 150.0, 290.0}) {
        auto l = c.ray(x, 100, kMiddle, 0), r = c.ray(x + 300, 100, kMiddle, 0);
        EXPECT_FLOAT_EQ(l.origin.x, -0.1f);
        EXPECT_FLOAT_EQ(r.origin.x, 0.1f);
        Vec3 a = l.origin + l.direction * (4 / l.direction.z), b = r.origin + r.direction * (4 / r.direction.z);
        EXPECT_NEAR(length(a - b), 0, 1e-5);
        // Both see the whole picture of one eye between them.
        o.projectionParams[0].strings[0] = "left";
        Camera left(o, d);
        auto whole = left.ray(2 * x, 100, kMiddle, 0);
        EXPECT_NEAR(length(whole.direction - l.direction), 0, 1e-6);
        o.projectionParams[0].strings[0] = "sidebyside";
    }
    EXPECT_EQ(d.errors(), 0);
    o.projectionParams[0].strings[0] = "upside";
    Camera bad(o, d);
    EXPECT_EQ(d.errors(), 1);
}

} // namespace camera_test
