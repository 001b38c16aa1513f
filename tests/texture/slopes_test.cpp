// Slopes of lookups against closed forms and against differences of the lookups themselves.
#include "pictures.h"
#include <cmath>

namespace slopes_test {

using namespace alpenglow;
using namespace alpenglow::texture;
using namespace alpenglow::texture::test;
using display::Image;
using display::makeImage;

namespace {

template <class F> std::shared_ptr<const Texture> mapOf(int w, int h, const char* wrap, F value) {
    Image m = makeImage(w, h, {"a", "b"});
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x) {
            m.pixel(x, y)[0] = float(value((x + .5) / w, (y + .5) / h));
            m.pixel(x, y)[1] = -2 * m.pixel(x, y)[0];
        }
    return makeTextureFrom(withWrap(m, wrap));
}
double wave(double s, double t) { return std::sin(6 * kPi * s) * std::cos(4 * kPi * t); }

} // namespace

// Exact: channels, the two directions, sizes that differ, levels; the value stays the same float.
TEST(Slopes, OfARamp) {
    auto t = mapOf(32, 16, "clamp", [](double s, double t) { return 3 * s - 5 * t; });
    for (float width : {0.0f, 0.02f, 0.08f})
        for (float s = .3f; s < .7f; s += .0371f)
            for (float tt = .4f; tt < .6f; tt += .0613f) {
                float v[2], plain[2], g[4];
                lookup2D(t.get(), 0, 2, s, tt, width, 0, 0, width, {}, v, g);
                lookup2D(t.get(), 0, 2, s, tt, width, 0, 0, width, {}, plain);
                EXPECT_EQ(v[0], plain[0]);
                EXPECT_EQ(v[1], plain[1]);
                EXPECT_NEAR(g[0], 3, 2e-5) << s << " " << tt << " " << width;
                EXPECT_NEAR(g[1], -6, 4e-5);
                EXPECT_NEAR(g[2], -5, 2e-5);
                EXPECT_NEAR(g[3], 10, 4e-5);
            }
}

// A flat map tilts no normal at all, whatever the level.
TEST(Slopes, OfAFlatMapAreZero) {
    for (const char* wrap : {"clamp", "periodic"}) {
        auto t = makeTextureFrom(withWrap(constant(37, 64, 0.3f), wrap));
        for (float width : {0.0f, 0.0f, 1e-3f})
            for (float s : {-1.3f, 0.0f, 0.013f, 0.5f, 0.99f, 7.7f}) {
                float v[3], g[6] = {1, 1, 1, 1, 1, 1};
                lookup2D(t.get(), 0, 3, s, 1 - s, width, 0, 0, width, {}, v, g);
                for (float x : g) EXPECT_EQ(x, 0);
            }
    }
}

// The definition: differences over one texel; and the derivative of the wave, which they miss by (pi 3 / 128)^2 at most.
TEST(Slopes, OfAWave) {
    const int n = 128;
    auto t = mapOf(n, n, "periodic", wave);
    for (int i = 0; i < 400; ++i) {
        const float s = float(i) * .01731f - 1, tt = float(i) * .00717f, h = .5f / n;
        float v, g[2], e, w, north, south;
        lookup(t.get(), 0, 1, s, tt, {}, {}, &v, g);
        lookup(t.get(), 0, 1, s + h, tt, {}, {}, &e);
        lookup(t.get(), 0, 1, s - h, tt, {}, {}, &w);
        lookup(t.get(), 0, 1, s, tt + h, {}, {}, &north);
        lookup(t.get(), 0, 1, s, tt - h, {}, {}, &south);
        EXPECT_NEAR(g[0], (e - w) * n, 2e-3) << s;
        EXPECT_NEAR(g[1], (north - south) * n, 2e-3) << s;
        EXPECT_NEAR(g[0], 6 * kPi * std::cos(6 * kPi * s) * std::cos(4 * kPi * tt), .006 * 6 * kPi) << s;
        EXPECT_NEAR(g[1], -4 * kPi * std::sin(6 * kPi * s) * std::sin(4 * kPi * tt), .006 * 4 * kPi) << s;
    }
}

// Seen from afar the value is the mean, and the slope goes with it.
TEST(Slopes, FadeWithTheFootprint) {
    auto t = mapOf(128, 128, "periodic", wave);
    float v, g[2];
    lookup2D(t.get(), 0, 1, .5f, .5f, 1, 0, 0, 1, {}, &v, g);
    EXPECT_NEAR(v, 0, 1e-3);
    EXPECT_NEAR(g[0], 0, 1e-2);
    EXPECT_NEAR(g[1], 0, 1e-2);
}

TEST(Slopes, OfWhatIsNotThereAreZero) {
    auto t = mapOf(8, 8, "clamp", wave);
    float v[4], g[8] = {9, 9, 9, 9, 9, 9, 9, 9};
    lookup(t.get(), 1, 4, .1f, .2f, {}, {}, v, g); // channel 1 is the only one of these
    EXPECT_NE(g[0], 0);
    EXPECT_NE(g[4], 0);
    for (int k : {1, 2, 3, 5, 6, 7}) EXPECT_EQ(g[k], 0) << k;
    g[0] = g[1] = 9;
    lookup(nullptr, 0, 1, .1f, .2f, {}, {}, v, g);
    EXPECT_EQ(g[0], 0);
    EXPECT_EQ(g[1], 0);
}

// A map that holds z of the unit direction: d / d(x, y, z) of z / |d|, for directions of any length.
TEST(Slopes, OfAnEnvironment) {
    auto t = mapOf(256, 128, "periodic", [](double, double t) { return std::cos(kPi * t); });
    for (float scale : {.01f, 1.0f, 50.0f})
        for (int i = 0; i < 40; ++i) {
            const Vec3 d = Vec3(std::cos(float(i)), std::sin(float(i)), .04f * float(i) - .8f) * scale;
            float v, g[3];
            environment(t.get(), {}, 0, 1, d, {}, {}, {}, &v, g);
            const double l = std::sqrt(double(dot(d, d))), z = double(d.z);
            EXPECT_NEAR(v, z / l, 1e-3);
            EXPECT_NEAR(double(g[0]) * l, -z * d.x / (l * l), 2e-3) << i;
            EXPECT_NEAR(double(g[1]) * l, -z * d.y / (l * l), 2e-3) << i;
            EXPECT_NEAR(double(g[2]) * l, 1 - z * z / (l * l), 2e-3) << i;
        }
}

// Second derivatives are exact where they do not change: channels, both directions, a level below, too.
TEST(Curves, OfAParabola) {
    auto t = mapOf(32, 16, "clamp", [](double s, double t) { return 3 * s * s + 2 * s * t - 5 * t * t; });
    for (float width : {0.0f, 0.02f, 0.08f})
        for (float s = .3f; s < .7f; s += .0371f)
            for (float tt = .4f; tt < .6f; tt += .0613f) {
                float v[2], plain[2], g[4], c[6];
                lookup2D(t.get(), 0, 2, s, tt, width, 0, 0, width, {}, v, g, c);
                lookup2D(t.get(), 0, 2, s, tt, width, 0, 0, width, {}, plain);
                EXPECT_EQ(v[0], plain[0]);
                const float want[3] = {6, 2, -10};
                for (int k = 0; k < 3; ++k) {
                    EXPECT_NEAR(c[2 * k], want[k], 5e-3) << s << " " << tt << " " << width;
                    EXPECT_NEAR(c[2 * k + 1], -2 * want[k], 1e-2);
                }
            }
}

// The height of a direction, z / |d|, as a map: its second derivatives in closed form. Without a map there are none.
TEST(Curves, OfAnEnvironment) {
    Image m = makeImage(512, 256, {"a"});
    for (int y = 0; y < 256; ++y)
        for (int x = 0; x < 512; ++x) m.pixel(x, y)[0] = float(std::cos(kPi * (y + .5) / 256));
    auto t = makeTextureFrom(withWrap(m, "periodic"));
    for (const Vec3& d : {Vec3(1, .2f, .3f), Vec3(-.4f, 1, -.7f), Vec3(.6f, -.9f, .5f), Vec3(-2, -1, 1.5f)}) {
        float v, g[3], c[6];
        environment(t.get(), {}, 0, 1, d, {}, {}, {}, &v, g, c);
        const double r = length(d), r3 = r * r * r;
        int n = 0;
        for (int k = 0; k < 3; ++k)
            for (int l = k; l < 3; ++l) {
                const double want = -((k == 2) * d[l] + (l == 2) * d[k]) / r3 - d.z * (k == l) / r3 +
                                    3 * double(d.z) * d[k] * d[l] / (r3 * r * r);
                EXPECT_NEAR(c[n++], want, .01) << k << l << " " << d.x;
            }
        environment(nullptr, {}, 0, 1, d, {}, {}, {}, &v, g, c);
        for (float x : c) EXPECT_EQ(x, 0);
    }
}

} // namespace slopes_test
